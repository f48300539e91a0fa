"""How a characteristic is shown: between which values, and with how many decimals."""

import math

import numpy as np

from ...core.named_types import Array

# A range so many times as wide as that of the middle 80 % of the values belongs to a pole.
_POLE = 12.0
# With a pole, values are shown up to so many times their median.
_SHOWN_OF_POLE = 3.0
# What interpolation may add to the extremes of the samples, as part of their range.
_OVERSHOOT = 0.02
_MOST_DECIMALS = 5
# More decimals can be neither built nor measured.
_MOST_OF_UNIT = {"deg": 2, "mm": 2, "%": 1, "N/mm": 2, "m": 2, "m/s": 2, "m/s\u00b2": 1, "N": 0}


def has_pole(values: Array) -> bool:
    """Return whether values run away at some place and would press the rest of a curve flat.

    Parameters
    ----------
    values : ndarray
        Everything that a curve takes on the grid; NaN where it is not defined.

    Returns
    -------
    bool
    """
    known = values[~np.isnan(values)]
    if np.isinf(known).any():
        return True
    low, high = np.quantile(known, (0.1, 0.9))
    return bool(np.ptp(known) > _POLE * (high - low) > 0.0)


def full_range(values: Array) -> tuple[float, float]:
    """Return the least and the greatest of values, with room for what interpolation adds.

    Parameters
    ----------
    values : ndarray
        NaN and infinity are left out.

    Returns
    -------
    tuple of float
    """
    finite = values[np.isfinite(values)]
    return _widened(float(finite.min()), float(finite.max()))


def shown_range(values: Array) -> tuple[float, float]:
    """Return the values between which a characteristic is plotted.

    Parameters
    ----------
    values : ndarray
        As of `has_pole`.

    Returns
    -------
    tuple of float
        As of `full_range`; with a pole, only those within some times the usual size.
    """
    if not has_pole(values):
        return full_range(values)
    finite = values[np.isfinite(values)]
    limit = _SHOWN_OF_POLE * float(np.median(np.abs(finite)))
    return _widened(max(float(finite.min()), -limit), min(float(finite.max()), limit))


def _widened(low: float, high: float) -> tuple[float, float]:
    margin = max(_OVERSHOOT * (high - low), 1e-9 * max(abs(low), abs(high), 1.0))
    return low - margin, high + margin


def decimals(low: float, high: float, *, unit: str = "", value: float = 0.0) -> int:
    """Return with how many decimals values are written.

    Parameters
    ----------
    low, high : float
        Range of the values, in the unit of the reader.
    unit : str, optional
        That unit.
    value : float, optional
        One of them that is to have three digits, as far as its unit has them.

    Returns
    -------
    int

    Examples
    --------
    >>> decimals(-3.0, 2.5), decimals(-40.0, 10.0), decimals(0.93, 0.96), decimals(0.0, 2e4)
    (2, 1, 4, 0)
    >>> decimals(-3.0, 2.5, value=-0.0131)
    4
    """
    width = max(high - low, 1e-3 * max(abs(low), abs(high)), 1e-12)
    most = _MOST_OF_UNIT.get(unit, _MOST_DECIMALS)
    wanted = math.ceil(1.8 - math.log10(width))
    if value != 0.0 and math.isfinite(value):
        wanted = max(wanted, 2 - math.floor(math.log10(abs(value))))
    return min(max(wanted, 0), most)


def meaningful(places: int, error: float) -> bool:
    """Return whether an error leaves the last of so many decimals right but for rounding."""
    return error <= 0.5 * 10.0**-places
