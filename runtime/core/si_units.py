"""Units of declared quantities: SI units without prefixes and factors, as text.

A unit is a product of names with integer powers over others: ``N m``, ``m/s^2``, ``N s/m``; ``1``
is the unit of a pure number. Equations read all numbers in such units; a number in degrees or
millimetres would be taken for one in radians or metres.
"""

import re
from collections import Counter

COHERENT = (
    *("m", "kg", "s", "A", "K", "mol", "cd", "rad", "sr"),
    *("Hz", "N", "Pa", "J", "W", "C", "V", "F", "ohm", "S", "Wb", "T", "H", "lm", "lx", "Bq"),
)
"""Names of units without a factor, those of length, mass and time first."""

_FACTOR = re.compile(r"([A-Za-z]+)(?:\^(-?[0-9]{1,2}))?")


def powers_of(unit: str) -> dict[str, int] | None:
    """Return the powers in a unit by name; None if it is not an SI unit without a factor.

    Examples
    --------
    >>> powers_of("N s/m"), powers_of("1"), powers_of("deg")
    ({'N': 1, 's': 1, 'm': -1}, {}, None)
    """
    powers: Counter[str] = Counter()
    for place, part in enumerate(unit.split("/")):
        for word in part.split():
            found = _FACTOR.fullmatch(word)
            if found and found[1] in COHERENT:
                powers[found[1]] += int(found[2] or 1) * (-1 if place else 1)
            elif word != "1":
                return None
        if not part.strip():
            return None
    return {name: power for name, power in powers.items() if power}


def problem_of(unit: str) -> str:
    """Return a message about a unit that has a factor or is unknown; empty for an SI unit.

    Examples
    --------
    >>> problem_of("N m")
    ''
    """
    if powers_of(unit) is not None:
        return ""
    return (
        f"unit {unit!r} is none of SI without a factor: numbers are in m, kg, s, rad, N and so on; "
        "write a product such as 'N m' or 'm/s^2', and '1' for a pure number"
    )


def rate_of(unit: str) -> str:
    """Return the unit of the time derivative of a quantity in an SI unit.

    Examples
    --------
    >>> rate_of("m"), rate_of("rad/s")
    ('m/s', 'rad/s^2')
    """
    below, mark, power = unit.rpartition("/s")
    if mark and (not power or re.fullmatch(r"\^[0-9]+", power)):
        return f"{below}/s^{int(power[1:] or 1) + 1}"
    return f"{unit}/s"
