"""Units as people write them, and their factors to SI units."""

import math
from fractions import Fraction

LENGTHS = {
    "m": Fraction(1),
    "mm": Fraction(1, 1000),
    "cm": Fraction(1, 100),
    "km": Fraction(1000),
    "in": Fraction(254, 10000),
    "ft": Fraction(3048, 10000),
}
"""Units of length in metres; those of the inch are exact."""

KM_PER_H = 3.6
"""A speed of 1 m/s in km/h."""

_UNITS = {
    **{name: ("m", float(length)) for name, length in LENGTHS.items()},
    "s": ("s", 1.0),
    "ms": ("s", 1e-3),
    "rad": ("rad", 1.0),
    "mrad": ("rad", 1e-3),
    "deg": ("rad", math.pi / 180.0),
    "arcmin": ("rad", math.pi / 10800.0),
    "N": ("N", 1.0),
    "kN": ("N", 1e3),
    "lbf": ("N", 4.4482216152605),
    "N m": ("N m", 1.0),
    "100 N m": ("N m", 1e2),
    "kN m": ("N m", 1e3),
    "m/s": ("m/s", 1.0),
    "km/h": ("m/s", 1.0 / KM_PER_H),
    "s^2": ("s^2", 1.0),
    "g": ("m/s^2", 9.80665),
    "Pa": ("Pa", 1.0),
    "kPa": ("Pa", 1e3),
    "bar": ("Pa", 1e5),
    "psi": ("Pa", 6894.757293168361),
    "%": ("1", 1e-2),
    "1": ("1", 1.0),
    "-": ("1", 1.0),
    "": ("1", 1.0),
}
_SPELLINGS = {
    "mm": ("millimetre", "millimetres", "millimeter", "millimeters"),
    "cm": ("centimetre", "centimetres", "centimeter", "centimeters"),
    "m": ("metre", "metres", "meter", "meters"),
    "in": ("inch", "inches", '"'),
    "ft": ("foot", "feet"),
    "s": ("sec", "second", "seconds"),
    "ms": ("msec", "millisecond", "milliseconds"),
    "deg": ("degree", "degrees", "\u00b0"),
    "rad": ("radian", "radians"),
    "mrad": ("milliradian", "milliradians"),
    "arcmin": ("arcminute", "arcminutes", "arc minute", "arc minutes", "minutes of arc"),
    "N": ("newton", "newtons"),
    "N m": ("Nm",),
    "100 N m": ("100 Nm",),
    "kN m": ("kNm",),
    "s^2": ("s\u00b2", "s2"),
    "%": ("percent",),
    "1": ("none",),
}
_KNOWN = {name.lower(): name for name in _UNITS} | {
    spelling.lower(): name for name, spellings in _SPELLINGS.items() for spelling in spellings
}


def unit_of(text: str) -> str:
    """Return the usual spelling of a single unit; empty if it is not known.

    Examples
    --------
    >>> unit_of("Inches"), unit_of("[mm]"), unit_of("furlong")
    ('in', 'mm', '')
    """
    plain = " ".join(text.replace("\u00b7", " ").replace("*", " ").split()).strip(" []().")
    return _KNOWN.get(plain.lower(), "")


def in_si(text: str) -> tuple[str, float]:
    """Return the SI unit of a written unit, and the factor to it; ("", nan) if it is not known.

    Examples
    --------
    >>> in_si("N/mm"), in_si("km/h")[0]
    (('N/m', 1000.0), 'm/s')
    >>> in_si("m/s\u00b2"), in_si("furlong")[0]
    (('m/s^2', 1.0), '')
    """
    text = text.strip()
    if len(text) > 1 and text[0] + text[-1] in ("[]", "()"):
        text = text[1:-1]
    parts = [text] if unit_of(text) else text.split("/")  # km/h has a name of its own
    known = [_UNITS[unit_of(part)] for part in parts if unit_of(part) or not text.strip()]
    if len(known) < len(parts) or len(parts) > 2:
        return "", math.nan
    factor = known[0][1] / (known[1][1] if len(known) == 2 else 1.0)
    if len(known) == 1 or known[1][0] == "1":
        return known[0][0], factor
    if known[1][0] == "m/s^2":
        return f"{known[0][0]} s^2/m", factor
    below = f"({known[1][0]})" if " " in known[1][0] else known[1][0]
    return ("1" if known[0][0] == known[1][0] else f"{known[0][0]}/{below}"), factor


def length_in(value: float, given: str, wanted: str) -> float:
    """Return a length in another unit of `LENGTHS`: the nearest double.

    Examples
    --------
    >>> length_in(205.0, "mm", "m"), length_in(4.078, "in", "mm")
    (0.205, 103.5812)
    """
    # exact arithmetic on the printed digits, rounded once: 4.078 in are 103.5812 mm
    return float(Fraction(repr(float(value))) * LENGTHS[given] / LENGTHS[wanted])
