"""Extrema of inputs, and the steps of an integration that may pass over them."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PPoly

from ..core.named_types import Array

# Swings below this part of the range are noise: of a value, and of its derivatives, which are less
# accurate in a spline through values.
_NOISE = (1e-9, 1e-6, 1e-3)
# A step over an extremum is at most `_STEPS` times as long as the time in which the value changes
# by `_NEAR` of the swing beside it. For a sine that is 2.4 times the time between two extrema, so
# that at most about one is between two stages of a step, and pulses cause no more error than with
# steps that end at all extrema.
_NEAR, _STEPS = 0.1, 12.0
# It is also at most `_FAR_STEPS` times as long as the time for `_FAR` of the swing, which for a
# sine is the same: after a flat top, a value may change fast within the step.
_FAR, _FAR_STEPS = 0.9, 3.1


def turning_points(curve: PPoly, orders: Sequence[int]) -> Array:
    """Return the times of extrema of a curve or its derivatives, and the longest steps over them.

    Between two of them every order is monotone: a step from one to the next captures the change. An
    integrator that may pass over them could miss a bump that begins and ends within its step. A
    step of at most the reach of an extremum has stages that are close enough. The curve is one of
    time [s], `orders` are those of the derivatives, 0 for the curve. The result, (2, n), has times
    in order, and the reach of each [s].

    Examples
    --------
    >>> from scipy.interpolate import CubicSpline
    >>> wave = CubicSpline([0.0, 1.0, 2.0, 3.0, 4.0], [0.0, 1.0, 0.0, -1.0, 0.0])
    >>> turning_points(wave, [0]).round(2).tolist()
    [[0.85, 3.15], [2.36, 2.36]]
    """
    return merged([_of(curve.derivative(order), _NOISE[order]) for order in orders])


def merged(turns: Sequence[Array], near: float = 0.0) -> Array:
    """Return extrema of curves in order; of those closer than `near` [s] the least reach."""
    together = np.concatenate([*turns, np.empty((2, 0))], axis=1)
    together = together[:, np.argsort(together[0], kind="stable")]
    begins = np.flatnonzero(np.diff(together[0], prepend=-np.inf) > near)
    if not begins.size:
        return together
    return np.stack([together[0, begins], np.minimum.reduceat(together[1], begins)])


def _of(curve: PPoly, noise: float) -> Array:
    candidates = np.union1d(curve.x, _extrema(curve))
    values = curve(candidates)
    rises = np.diff(values)
    moves = np.flatnonzero(rises)
    # extrema are at the ends of monotone parts
    turns = moves[1:][np.sign(rises[moves[1:]]) != np.sign(rises[moves[:-1]])]
    ends = np.concatenate(([0], turns, [values.size - 1]))
    kept = ends[_swings(values[ends], noise * np.ptp(values))]
    bend = curve.derivative(2)
    sides = [np.abs(bend(np.nextafter(candidates[kept], towards))) for towards in (-np.inf, np.inf)]
    return np.stack([candidates[kept], _reaches(candidates, values, kept, np.maximum(*sides))])


def _reaches(times: Array, values: Array, turns: NDArray[np.intp], bends: Array) -> Array:
    """Return the longest steps over extrema, from the times that the values stay beside them.

    Times and values are those of the curve, which is monotone between two of them; `turns` are
    indices of its extrema, `bends` magnitudes of the second derivative there.
    """
    borders = np.concatenate(([0], turns, [values.size - 1]))
    swing = np.searchsorted(turns, np.arange(values.size), side="right")
    rise = np.diff(values[borders])
    # each swing from 0 to 1, in order; the first and last may be empty
    part = (values - values[borders[swing]]) / np.where(rise == 0.0, 1.0, rise)[swing]
    along = np.maximum.accumulate(swing + np.clip(part, 0.0, 1.0))
    number = np.arange(1, turns.size + 1)
    reaches = np.full(turns.size, np.inf)
    for sense in (-1, 1):
        straight, most = (
            np.abs(np.interp(number + sense * part, along, times) - times[turns])
            for part in (_NEAR, _FAR)
        )
        # beside the extremum the curve is a parabola, farther away a line between its points
        size = np.abs(rise[number if sense > 0 else number - 1])
        with np.errstate(divide="ignore"):
            bent = np.sqrt(2.0 * _NEAR * size / bends)
        beside = np.abs(times[turns + sense] - times[turns])
        near = np.maximum(straight, np.minimum(bent, beside))
        reaches = np.minimum(reaches, np.minimum(_STEPS * near, _FAR_STEPS * most))
    return reaches


def _extrema(curve: PPoly) -> Array:
    """Return the zeros of the derivative between the breaks."""
    if curve.c.shape[0] < 3:
        return np.empty(0)
    slope = curve.derivative()
    # ((a x) + b) x + d: both roots without cancellation
    a, b, d = np.concatenate((np.zeros((4 - curve.c.shape[0], slope.c.shape[1])), slope.c))
    with np.errstate(all="ignore"):
        half = -0.5 * (b + np.copysign(np.sqrt(b**2 - 4.0 * a * d), b))
        offsets = np.stack([half / a, d / half])
    times = curve.x[:-1] + offsets
    return times[(times > curve.x[:-1]) & (times < curve.x[1:])]


def _swings(values: Array, least: float) -> list[int]:
    """Return which of alternating extrema exceed their neighbours by a least difference."""
    if (np.abs(np.diff(values)) > least).all():
        return list(range(1, values.size - 1))
    kept: list[int] = []
    best, sense = 0, 0
    low = high = 0
    for index, value in enumerate(values.tolist()):
        if sense == 0:
            low = index if value < values[low] else low
            high = index if value > values[high] else high
            if values[high] - values[low] > least:
                sense, best = (1, high) if high > low else (-1, low)
        elif sense * (value - values[best]) > 0.0:
            best = index
        elif sense * (values[best] - value) > least:
            kept.append(best)
            sense, best = -sense, index
    return kept
