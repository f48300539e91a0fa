"""Units in input files: the key of a quantity ends in its unit, as in ``mass_kg``."""

from collections.abc import Iterable
from typing import Literal

import numpy as np

from ...core.named_types import Array

LengthUnit = Literal["mm", "m"]

# Printed unit by ending of a key; an ending precedes those that it ends in.
_UNIT_OF_ENDING = {
    "N_per_mm3": "N/mm^3", "N_s_per_m": "N s/m", "N_per_mm": "N/mm", "N_per_m": "N/m",
    "m_per_s2": "m/s^2", "m_per_s": "m/s", "km_per_h": "km/h", "deg_per_s": "deg/s",
    "kg_m2": "kg m^2", "Nm_s_per_deg": "N m s/deg", "Nm_per_deg": "N m/deg",
    "N_per_rad": "N/rad", "kg_per_m3": "kg/m^3",
    "rad_per_s": "rad/s", "GPa": "GPa", "kPa": "kPa", "kg": "kg", "Nm": "N m", "m2": "m^2",
    "N": "N", "mm": "mm", "deg": "deg", "Hz": "Hz", "ms": "ms", "m": "m", "s": "s",
}  # fmt: skip


def unit_of(key: str) -> str:
    """Return the printed unit of a key of input files; empty for a key without a unit.

    Examples
    --------
    >>> unit_of("damper_rate_N_s_per_m")
    'N s/m'
    >>> unit_of("side")
    ''
    """
    for ending, unit in _UNIT_OF_ENDING.items():
        if key.endswith(f"_{ending}"):
            return unit
    return ""


def without_unit(key: str) -> str:
    """Return a key without its unit.

    Examples
    --------
    >>> without_unit("damper_rate_N_s_per_m")
    'damper_rate'
    """
    ending = next((e for e in _UNIT_OF_ENDING if key.endswith(f"_{e}")), "")
    return key.removesuffix(f"_{ending}")


def in_metres(length: float, unit: LengthUnit) -> float:
    """Return a length of an input file in metres."""
    # A division is rounded correctly and yields the double nearest to 0.205. The factor 0.001 is
    # itself rounded, and would give 0.20500000000000002.
    return length / 1000.0 if unit == "mm" else length


def point_in_metres(point: Iterable[float], unit: LengthUnit) -> Array:
    """Return the coordinates of a point of an input file in metres."""
    return np.array([in_metres(value, unit) for value in point])
