"""Values of keys in files in the TeimOrbit format: texts, numbers and units."""

import math
import re
from collections.abc import Iterable, Mapping

from ...core.errors import InputError
from ...core.legible import legible, short
from .teim_orbit import FileBlock

MILLIMETRES = {
    **dict.fromkeys(("mm", "millimeter", "millimetre"), 1.0),
    **dict.fromkeys(("cm", "centimeter", "centimetre"), 10.0),
    **dict.fromkeys(("m", "meter", "metre"), 1000.0),
    **dict.fromkeys(("in", "inch"), 25.4),
    **dict.fromkeys(("ft", "foot"), 304.8),
}
DEGREES = {
    **dict.fromkeys(("deg", "degree", "degrees"), 1.0),
    **dict.fromkeys(("rad", "radian", "radians"), math.degrees(1.0)),
}
NEWTONS = {
    **dict.fromkeys(("newton", "n"), 1.0),
    **dict.fromkeys(("knewton", "kn"), 1000.0),
    **dict.fromkeys(("pound_force", "lbf"), 4.4482216152605),
}
_NUMBER = re.compile(r"[-+]?(\d++\.?\d*+|\.\d++)([eEdD][-+]?\d++)?")


def shown(text: str) -> str:
    """Return a text of a file in printable form, shortened."""
    return short(legible(text))


def number(cell: str) -> float:
    """Return the number in a cell; NaN for other text."""
    if not _NUMBER.fullmatch(cell):
        return math.nan
    return float(re.sub("[dD]", "e", cell))


class Values:
    """The values of keys, each of which may occur once."""

    def __init__(self, blocks: Iterable[FileBlock], source: str) -> None:
        self.source = source
        self._found: dict[tuple[str, str], list[str]] = {}
        for block in blocks:
            for key, value in block.values():
                self._found.setdefault((block.name, key), []).append(value)

    def one(self, block: str, key: str) -> str:
        """Return a value, or an empty text; refuse two different ones."""
        found = list(dict.fromkeys(self._found.get((block, key), ())))
        if len(found) > 1:
            text = " and ".join(repr(shown(value)) for value in found)
            problem = f"[{block.upper()}] {key.upper()} is {text}. Keep one of them."
            raise InputError([problem], self.source)
        return found[0] if found else ""


def unit_of(values: Values, key: str, usual: str, known: Mapping[str, float]) -> float:
    """Return the conversion factor of a unit of the file."""
    given = values.one("units", key)
    if given.lower() in known:
        return known[given.lower()]
    text = f"is {shown(given)!r}, which is not known" if given else "is missing"
    problem = f"[UNITS] {key.upper()} {text}. Write {key.upper()} = '{usual}', or: " + ", ".join(
        name for name in known if name != usual
    )
    raise InputError([f"{problem}."], values.source)
