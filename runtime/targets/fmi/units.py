"""SI units as powers of base units."""

from collections import Counter

from ...core.si_units import powers_of

_DERIVED = {"N": {"kg": 1, "m": 1, "s": -2}, "J": {"kg": 1, "m": 2, "s": -2}}
_DERIVED |= {"W": {"kg": 1, "m": 2, "s": -3}, "Pa": {"kg": 1, "m": -1, "s": -2}, "Hz": {"s": -1}}
_BASE = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")


def powers(unit: str) -> dict[str, int] | None:
    """Return the powers of base units in a unit; None for a unit that is not known.

    Examples
    --------
    >>> powers("N s/m")
    {'kg': 1, 's': -1}
    >>> powers("furlong") is None
    True
    """
    factors = powers_of(unit)
    if factors is None or not factors.keys() <= {*_BASE, *_DERIVED}:
        return None
    found: Counter[str] = Counter()
    for name, power in factors.items():
        for base, exponent in _DERIVED.get(name, {name: 1}).items():
            found[base] += power * exponent
    return {base: found[base] for base in _BASE if found[base]}
