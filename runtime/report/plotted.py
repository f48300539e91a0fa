"""How a characteristic is shown: between which values, and with how many decimals."""

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# A range so many times as wide as that of the middle 80 % of the values belongs to a pole.
_POLE = 12.0
# What interpolation may add to the extremes of the samples, as part of their range.
_OVERSHOOT = 0.02
_MOST_DECIMALS = 5


def shown_range(values: Array) -> tuple[float, float]:
    """Return the values between which a curve is plotted.

    Parameters
    ----------
    values : ndarray
        Everything that the curve takes on the grid; NaN where it is not defined.

    Returns
    -------
    tuple of float
        All of it and a little more, unless a pole (such as that of a swing arm's length as the
        wheel moves straight) would press everything else flat: then what surrounds the middle of
        the values.
    """
    finite = values[np.isfinite(values)]
    low, high = float(finite.min()), float(finite.max())
    inner_low, inner_high = (float(v) for v in np.quantile(finite, (0.1, 0.9)))
    width = inner_high - inner_low
    if high - low <= _POLE * width or width == 0.0:
        margin = max(_OVERSHOOT * (high - low), 1e-9 * max(abs(low), abs(high), 1.0))
        return low - margin, high + margin
    return max(low, inner_low - 2.0 * width), min(high, inner_high + 2.0 * width)


def decimals(low: float, high: float, error: float = 0.0) -> int:
    """Return with how many decimals values are written.

    Parameters
    ----------
    low, high : float
        Range of the values, in the unit of the reader.
    error : float, optional
        Largest error; digits that it makes meaningless are left out.

    Returns
    -------
    int

    Examples
    --------
    >>> decimals(-3.0, 2.5), decimals(-40.0, 10.0), decimals(0.93, 0.96), decimals(0.0, 2e4)
    (2, 1, 4, 0)
    """
    width = max(high - low, 1e-3 * max(abs(low), abs(high)), 1e-12)
    wanted = min(max(math.ceil(1.8 - math.log10(width)), 0), _MOST_DECIMALS)
    while wanted > 0 and error > 0.5 * 10.0**-wanted:
        wanted -= 1
    return wanted
