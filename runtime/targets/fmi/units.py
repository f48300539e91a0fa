"""SI units as powers of base units."""

import re
from collections import Counter

_DERIVED = {"N": {"kg": 1, "m": 1, "s": -2}, "J": {"kg": 1, "m": 2, "s": -2}}
_DERIVED |= {"W": {"kg": 1, "m": 2, "s": -3}, "Pa": {"kg": 1, "m": -1, "s": -2}, "Hz": {"s": -1}}
_BASE = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")
_FACTOR = re.compile(r"([A-Za-z]+)(?:\^(-?\d+))?")


def powers(unit: str) -> dict[str, int] | None:
    """Return the powers of base units that a unit is; None for one that is not known.

    Parameters
    ----------
    unit : str
        Factors with spaces between them, each with a power or without, and maybe a line of
        division, behind which all of them divide.

    Examples
    --------
    >>> powers("N s/m")
    {'kg': 1, 's': -1}
    >>> powers("furlong") is None
    True
    """
    above, *below = unit.split("/")
    found: Counter[str] = Counter()
    for sign, part in [(1, above), *((-1, part) for part in below)]:
        for word in part.split():
            if word == "1":
                continue
            match = _FACTOR.fullmatch(word)
            if match is None or match[1] not in (*_BASE, *_DERIVED):
                return None
            for base, power in _DERIVED.get(match[1], {match[1]: 1}).items():
                found[base] += sign * power * int(match[2] or 1)
    return {base: found[base] for base in _BASE if found[base]}
