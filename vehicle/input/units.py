"""Units in input files: each key that carries a unit ends in it, as in ``mass_kg``."""

from typing import Literal

LengthUnit = Literal["mm", "m"]

# Ending of a key -> the unit as it is printed. Longer endings stand before those they end in.
_UNIT_OF_ENDING = {
    "N_per_mm3": "N/mm^3",
    "N_s_per_m": "N s/m",
    "N_per_mm": "N/mm",
    "N_per_m": "N/m",
    "m_per_s2": "m/s^2",
    "m_per_s": "m/s",
    "km_per_h": "km/h",
    "deg_per_s": "deg/s",
    "kg_m2": "kg m^2",
    "Nm_per_deg": "N m/deg",
    "N_per_rad": "N/rad",
    "kg_per_m3": "kg/m^3",
    "rad_per_s": "rad/s",
    "GPa": "GPa",
    "kPa": "kPa",
    "kg": "kg",
    "Nm": "N m",
    "m2": "m^2",
    "N": "N",
    "mm": "mm",
    "deg": "deg",
    "Hz": "Hz",
    "ms": "ms",
    "m": "m",
    "s": "s",
}


def unit_of(key: str) -> str:
    """Return the unit in which an input file gives the value of `key`.

    Parameters
    ----------
    key : str
        A key of an input file.

    Returns
    -------
    str
        The unit, as it is printed; empty for a key that carries none.

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
    """Return a key without the unit that it ends in.

    Examples
    --------
    >>> without_unit("damper_rate_N_s_per_m")
    'damper_rate'
    """
    ending = next((e for e in _UNIT_OF_ENDING if key.endswith(f"_{e}")), "")
    return key.removesuffix(f"_{ending}")


def in_metres(length: float, unit: LengthUnit) -> float:
    """Convert a length of an input file to metres.

    Parameters
    ----------
    length : float
        The length in `unit`.
    unit : {"mm", "m"}
        Its unit.

    Returns
    -------
    float
        The length in m.

    Examples
    --------
    >>> in_metres(205.0, "mm")
    0.205
    """
    # A division is rounded correctly and yields the double nearest to 0.205. The factor 0.001 is
    # itself rounded, and would give 0.20500000000000002.
    return length / 1000.0 if unit == "mm" else length
