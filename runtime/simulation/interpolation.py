"""Samples over time, and the interpolation between them."""

from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline, PchipInterpolator, PPoly

from ..core.named_types import Array

Between = Literal["monotone", "spline", "linear"]
WAYS: tuple[str, ...] = get_args(Between)

# Longest part of an interval at either end in which the acceleration changes.
_EASING = 0.25
_MOST_HALVINGS = 24


@dataclass(frozen=True)
class Samples:
    """Samples: values of an input at some times, and the interpolation between them.

    Parameters
    ----------
    times : array_like, shape (n,)
        Times in increasing order [s]; a time that is given twice is a jump, or a kink if the value
        is the same.
    values : array_like, shape (n,)
        Values of the input at these times, in its SI unit.
    between : str, optional
        'monotone': between two samples the input only rises, or only falls, so it never leaves
        their range, and its extrema are samples. Its derivative is continuous, and also its second
        derivative if the model reads the acceleration.
        'spline': the cubic spline with continuous second derivative. Its extrema may be between
        samples. It is for smooth motions that are sampled densely, and the best for accelerations.
        'linear': straight lines. Not for a position whose acceleration the model reads.

    Examples
    --------
    >>> from kintrafo import Model, Samples, equilibrium, simulate
    >>> model = Model("reference_car")
    >>> ramp = Samples([0.0, 0.1, 0.12, 0.2], [0.0, 0.0, 0.02, 0.02], "linear")
    >>> result = simulate(model, (0.0, 0.2), equilibrium(model), inputs={"road_height": ramp})
    >>> float(result.inputs.max())
    0.02
    """

    times: Any
    values: Any
    between: Between = "monotone"


def curves(times: Array, values: Array, between: str, *, accelerates: bool) -> list[PPoly]:
    """Return piecewise cubics through checked samples, one for each time span without a jump.

    `between` is as in `Samples`; `accelerates` is whether the model reads the second derivative.
    """
    cuts = np.flatnonzero(np.diff(times) == 0.0) + 1
    stretches = zip(np.split(times, cuts), np.split(values, cuts), strict=True)
    monotone = _eased if accelerates else PchipInterpolator
    through = {"monotone": monotone, "spline": CubicSpline, "linear": _lines}[between]
    # the caller refuses curves that are not finite
    with np.errstate(all="ignore"):
        return [through(t, v) for t, v in stretches]


def _lines(times: Array, values: Array) -> PPoly:
    """Return straight lines."""
    slopes = np.diff(values) / np.diff(times)
    return PPoly(np.stack([0.0 * slopes, 0.0 * slopes, slopes, values[:-1]]), times)


class Eased(PPoly):
    """A monotone curve with a continuous second derivative."""


def _eased(times: Array, values: Array) -> Eased:
    """Return a monotone curve with a continuous second derivative.

    The second derivative of the monotone cubic (PCHIP) jumps at samples. Here it is a continuous
    line over three parts of every interval: at a sample it has the smaller value of the two cubics
    there (zero where they differ in sign), and the middle part compensates for it. The curve
    approaches the monotone cubic as the outer parts become shorter; they are halved until it is
    monotone, too.
    """
    cubic = PchipInterpolator(times, values)
    width = np.diff(times)
    slopes = cubic(times, 1)
    begins, ends = 2.0 * cubic.c[1], 6.0 * cubic.c[0] * width + 2.0 * cubic.c[1]
    smaller = np.minimum(np.abs(begins[1:]), np.abs(ends[:-1]))
    shared = np.where(begins[1:] * ends[:-1] > 0.0, np.copysign(smaller, begins[1:]), 0.0)
    outer = np.concatenate((begins[:1], shared)), np.concatenate((shared, ends[-1:]))
    share = np.full(width.size, _EASING)
    rises = np.diff(values)
    ends_of = [width, rises, slopes[:-1], slopes[1:], *outer]
    bent = np.arange(width.size)
    for _ in range(_MOST_HALVINGS):
        parts = _Parts.of(share[bent], *(each[bent] for each in ends_of))
        bent = bent[parts.turn_back(np.sign(rises[bent]))]
        if not bent.size:
            break
        share[bent] *= 0.5
    return _Parts.of(share, *ends_of).joined(times, values)


@dataclass(frozen=True)
class _Parts:
    """Three cubics in each of n intervals, all of shape (3, n)."""

    width: Array  # [s]
    # at the begin of each part; values are relative to the begin of the interval
    slope: Array
    value: Array
    # second derivative at the ends of each part
    begin: Array
    end: Array

    @classmethod
    def of(
        cls, share: Array, width: Array, rise: Array, slope: Array, last: Array, *outer: Array
    ) -> "_Parts":
        """Return the cubics that meet value, slope and second derivative at both ends.

        Two equations determine the second derivatives at the two inner borders: their integral is
        the change of the slope, and their double integral that of the value.
        """
        begin, end = outer
        middle = 1.0 - 2.0 * share
        both = (2.0 * (last - slope) / width - share * (begin + end)) / (1.0 - share)
        moment = (rise / width - slope) / width
        moment = moment - share * (begin * (0.5 - share / 6.0) + end * share / 6.0)
        of_right = share**2 / 3.0 + middle * ((1.0 - share) / 2.0 - middle / 3.0)
        left = (moment - of_right * both) / (share / 2.0 - 2.0 * share**2 / 3.0 + middle**2 / 6.0)
        right = both - left
        widths = np.stack([share, middle, share]) * width
        begins, ends = np.stack([begin, left, right]), np.stack([left, right, end])
        slopes = slope + _before(widths * (begins + ends) / 2.0)
        values = _before(widths * (slopes + widths * (2.0 * begins + ends) / 6.0))
        return cls(widths, slopes, values, begins, ends)

    def turn_back(self, sense: Array) -> NDArray[np.bool_]:
        """Return in which intervals the slope is somewhere against the given sign."""
        slope, begin, end = sense * self.slope, sense * self.begin, sense * self.end
        dips = (begin < 0.0) & (end > 0.0)
        depth = 0.5 * self.width * begin**2 / np.where(dips, end - begin, 1.0)
        lowest = slope - np.where(dips, depth, 0.0)
        rounding = 1e-14 * np.abs(slope).max(axis=0)
        return (lowest < -rounding).any(axis=0)

    def joined(self, times: Array, values: Array) -> Eased:
        """Return all parts as one curve."""
        inner = times[:-1] + np.cumsum(self.width, axis=0)[:2]
        breaks = np.append(np.stack([times[:-1], *inner]).T.ravel(), times[-1])
        third = (self.end - self.begin) / (6.0 * self.width)
        rows = third, 0.5 * self.begin, self.slope, self.value + values[:-1]
        coefficients = np.stack([row.T.ravel() for row in rows])
        # a part may be narrower than the times resolve
        wide = np.diff(breaks) > 0.0
        return Eased(coefficients[:, wide], np.append(breaks[:-1][wide], breaks[-1]))


def _before(gains: Array) -> Array:
    """Return for each row the sum of the rows before it."""
    return np.concatenate((np.zeros((1, gains.shape[1])), np.cumsum(gains[:-1], axis=0)))
