"""Where an input turns: no step of an integration passes over these times."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PPoly

Array = NDArray[np.float64]

# Swings below this part of the range are noise: of a value, and of its derivatives, which a spline
# through the values of a function has less well.
_NOISE = (1e-9, 1e-6, 1e-3)


def turning_points(curve: PPoly, orders: Sequence[int]) -> Array:
    """Return the times at which a curve, or one of its derivatives, turns.

    Between two of them all rise or fall: a step from one to another sees how far. An integrator
    that is free to pass over them may see nothing of a bump that begins and ends within its step.

    Parameters
    ----------
    curve : PPoly
        Of time [s].
    orders : sequence of int
        Orders of the derivatives; 0 is the curve.

    Returns
    -------
    ndarray
        In order [s].

    Examples
    --------
    >>> from scipy.interpolate import CubicSpline
    >>> wave = CubicSpline([0.0, 1.0, 2.0, 3.0, 4.0], [0.0, 1.0, 0.0, -1.0, 0.0])
    >>> turning_points(wave, [0]).round(2).tolist()
    [0.85, 3.15]
    """
    found = [_of(curve.derivative(order), _NOISE[order]) for order in orders]
    return np.unique(np.concatenate(found))


def _of(curve: PPoly, noise: float) -> Array:
    candidates = np.union1d(curve.x, _extrema(curve))
    values = curve(candidates)
    rises = np.diff(values)
    moves = np.flatnonzero(rises)
    # of each stretch in one sense only the ends can be turning points
    turns = moves[1:][np.sign(rises[moves[1:]]) != np.sign(rises[moves[:-1]])]
    ends = np.concatenate(([0], turns, [values.size - 1]))
    return candidates[ends[_swings(values[ends], noise * np.ptp(values))]]


def _extrema(curve: PPoly) -> Array:
    """Return where the derivative vanishes between the breaks."""
    if curve.c.shape[0] < 3:
        return np.empty(0)
    slope = curve.derivative()
    # ((a x) + b) x + d: both roots without cancellation
    a, b, d = np.concatenate((np.zeros((4 - curve.c.shape[0], slope.c.shape[1])), slope.c))
    with np.errstate(all="ignore"):
        half = -0.5 * (b + np.copysign(np.sqrt(b**2 - 4.0 * a * d), b))
        offsets = np.stack([half / a, d / half])
    times = curve.x[:-1] + offsets
    inside: Array = times[(times > curve.x[:-1]) & (times < curve.x[1:])]
    return inside


def _swings(values: Array, least: float) -> list[int]:
    """Return which of alternating extrema exceed those beside them."""
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
