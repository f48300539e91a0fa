"""Plotted range and decimals of a characteristic."""

import math

import numpy as np

from ...core.named_types import Array
from ...pictures.curves import leaps

# A range wider than that of the middle 80 % of the values by this factor is due to a pole.
_POLE = 12.0
# Plotted values of a curve with a pole, relative to their median.
_SHOWN_OF_POLE = 3.0
# Overshoot of the interpolation, as a part of the range of the samples.
_OVERSHOOT = 0.02
_MOST_DECIMALS = 5
# Further decimals can be neither built nor measured.
_MOST_OF_UNIT = {"deg": 2, "mm": 2, "%": 1, "N/mm": 2, "m": 2, "m/s": 2, "m/s\u00b2": 1, "N": 0}


def has_pole(values: Array) -> bool:
    """Return whether values on the grid have a pole, beside which the rest would be flat."""
    known = values[~np.isnan(values)]
    if np.isinf(known).any():
        return True
    low, high = np.quantile(known, (0.1, 0.9))
    if np.ptp(known) > _POLE * (high - low) > 0.0:
        return True
    grid = np.atleast_2d(values)
    return any(leaps(line).size for lines in (grid, grid.T) for line in lines)


def full_range(values: Array) -> tuple[float, float]:
    """Return the least and the greatest finite value, widened by the overshoot."""
    finite = values[np.isfinite(values)]
    return _widened(float(finite.min()), float(finite.max()))


def shown_range(values: Array) -> tuple[float, float]:
    """Return the plotted range: `full_range`, limited to usual values for a curve with a pole."""
    if not has_pole(values):
        return full_range(values)
    finite = values[np.isfinite(values)]
    limit = _SHOWN_OF_POLE * float(np.median(np.abs(finite)))
    return _widened(max(float(finite.min()), -limit), min(float(finite.max()), limit))


def _widened(low: float, high: float) -> tuple[float, float]:
    margin = max(_OVERSHOOT * (high - low), 1e-9 * max(abs(low), abs(high), 1.0))
    return low - margin, high + margin


def decimals(low: float, high: float, *, unit: str = "", value: float = 0.0) -> int:
    """Return the number of decimals of written values in a range, in the display unit.

    A value has three digits, if its unit has so many decimals.

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
