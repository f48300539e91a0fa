"""Reader of property files of tyres (.tir): sections, units, used and unused keys."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

from ...core.errors import InputError
from ...core.legible import legible, short
from ...formulas.coefficients import ODD
from ...formulas.magic_formula import Form
from ..input.teim_orbit import FileBlock, read_blocks
from ..input.teim_values import NEWTONS, number
from . import coefficients as known

_LENGTHS = {
    **dict.fromkeys(("m", "meter", "metre", "meters", "metres"), 1.0),
    **dict.fromkeys(("cm", "centimeter", "centimetre"), 0.01),
    **dict.fromkeys(("mm", "millimeter", "millimetre"), 0.001),
    **dict.fromkeys(("in", "inch", "inches"), 0.0254),
    **dict.fromkeys(("ft", "foot", "feet"), 0.3048),
}
_UNITS: Mapping[str, Mapping[str, float]] = {
    "LENGTH": _LENGTHS,
    "FORCE": NEWTONS,
    "ANGLE": {
        **dict.fromkeys(("rad", "radian", "radians"), 1.0),
        **dict.fromkeys(("deg", "degree", "degrees"), math.pi / 180.0),
    },
    "TIME": {
        **dict.fromkeys(("s", "sec", "second", "seconds"), 1.0),
        **dict.fromkeys(("ms", "millisecond", "milliseconds"), 0.001),
    },
    "PRESSURE": {
        **dict.fromkeys(("pa", "pascal", "newton/meter**2", "n/m^2"), 1.0),
        **dict.fromkeys(("kpa", "kilopascal"), 1e3),
        "bar": 1e5,
        "psi": 6894.757293168361,
    },
}
_COMMENTS = ("$", "!")
_OPTIONAL = "PRESSURE"  # pascal by default
_OLDER, _NEWER = (5, 6, 21), (61, 62)
_OF_TEXT = frozenset(("UNITS", "MODEL", "MDI_HEADER"))
_OF_TABLES = frozenset(("SHAPE", "DEFLECTION_LOAD_CURVE", "BOTTOMING_CURVE"))
_READ_OF_MODEL = frozenset(("FITTYP", "PROPERTY_FILE_FORMAT", "TYRESIDE", "FE_METHOD"))
_SIMILAR = 0.9  # ratio of `difflib` above which an unknown key is a misspelt one
_LONGEST = 60


@dataclass(frozen=True)
class TirFile:
    """The contents of a property file."""

    numbers: dict[str, float]  # by key, in SI units
    form: Form  # version of the formulas
    name: str  # name of the formulas, such as ``"PAC2002"`` or ``"MF 6.1"``
    side: str  # side of the vehicle for which it was measured: ``"left"``, ``"right"`` or empty
    # unused keys, and assumptions in place of missing ones: a sentence each
    left_out: tuple[str, ...]
    assumed: tuple[str, ...]


def read(path: str | Path) -> TirFile:
    """Return the contents of a property file: PAC2002 (also MF 5.2), MF 6.1 or MF 6.2.

    Raises `InputError` if the format is another one, or keys are missing, given twice or not
    numbers; the message lists all problems.
    """
    return _TirReader(read_blocks(path), str(path)).read()


class _TirReader:
    def __init__(self, blocks: list[FileBlock], source: str) -> None:
        self._source = source
        self._problems: list[str] = []
        self._blocks = [(block.name.strip().upper(), block) for block in blocks]

    def read(self) -> TirFile:
        newer, name = self._version()  # first: it refuses other formats
        scales = self._scales()
        texts, unused = self._found()
        numbers = {key: self._number(key, text) for key, text in texts.items()}
        self._refuse_sliding(unused)
        self._refuse_misspelt(texts, unused)
        self._refuse_missing(numbers)
        numbers = {k: v * scales.get(known.DIMENSIONS.get(k, ""), 1.0) for k, v in numbers.items()}
        if self._problems:
            raise InputError(self._problems, self._source)
        asked = self._text("MODEL", "FE_METHOD").upper() == "YES"
        weighted = not asked and any(numbers.get(key) for key in known.OF_COMBINED_SLIP)
        form = Form(newer=newer, weighted=weighted, angle=not newer)
        assumed = (*self._assumed_of_side(numbers), *self._assumed(numbers, form))
        if numbers.get("QSY7") == 0.0:
            del numbers["QSY7"]
        if _is_turned(numbers, form):
            numbers |= {key: -numbers.get(key, 0.0) for key in ("PDY1", "PDY2")}
        return TirFile(numbers, form, name, self._side(), tuple(_listed(unused)), assumed)

    def _assumed_of_side(self, numbers: Mapping[str, float]) -> Iterator[str]:
        """Yield that an asymmetric tyre without a side is not mirrored."""
        if not self._side() and any(numbers.get(key) for key in ODD):
            given = self._text("MODEL", "TYRESIDE")
            why = f"= '{_shown(given)}' is neither LEFT nor RIGHT" if given else "is missing"
            yield (
                "the same tyre on both sides: not mirrored, though it is not symmetric, since "
                f"TYRESIDE {why}"
            )

    def _text(self, section: str, key: str) -> str:
        """Return the text of a key's value; empty if it is missing."""
        for name, block in self._blocks:
            if name == section:
                found = dict(block.values()).get(key.lower(), "")
                if found:
                    return found
        return ""

    def _version(self) -> tuple[bool, str]:
        """Return whether the formulas are those of MF 6, and their name."""
        kind, fit = self._text("MODEL", "PROPERTY_FILE_FORMAT"), self._text("MODEL", "FITTYP")
        version = number(fit) if fit else math.nan
        if kind.upper() == "PAC2002" and (not fit or version in _OLDER):
            return False, "PAC2002"
        if kind.upper() == "MF_05" and version in _OLDER:
            return False, "MF 5"
        of_formula = kind.upper().replace("_", "-") in {"", "MF-TYRE", "MF-TIRE", "MF-SWIFT", "MF"}
        if of_formula and version in _NEWER:
            return True, f"MF 6.{int(version) % 10}"
        if of_formula and version in _OLDER:
            return False, "MF 5"
        if not (kind or fit):
            problem = "[MODEL] has neither PROPERTY_FILE_FORMAT nor FITTYP"
        else:
            text = f"PROPERTY_FILE_FORMAT = '{_shown(kind)}'" if kind else ""
            text += " and " if kind and fit else ""
            problem = f"[MODEL] {text}{f'FITTYP = {_shown(fit)}' if fit else ''} cannot be read"
        readable = "PROPERTY_FILE_FORMAT = 'PAC2002', or FITTYP = 5, 6, 21 (MF 5), 61 or 62"
        raise InputError([f"{problem}; {readable} can be read. Convert the tyre."], self._source)

    def _side(self) -> str:
        given = self._text("MODEL", "TYRESIDE").lower()
        return given if given in {"left", "right"} else ""

    def _scales(self) -> dict[str, float]:
        """Return the factors to SI units by dimension."""
        found = {}
        if not any(name == "UNITS" for name, _ in self._blocks):
            self._problems.append(
                "[UNITS] is missing. Write it with LENGTH = 'meter', FORCE = 'newton', "
                "ANGLE = 'radians', TIME = 'second'."
            )
            return {}
        for quantity, units in _UNITS.items():
            given = self._text("UNITS", quantity)
            if quantity == _OPTIONAL and not given:
                found[quantity] = 1.0
                continue
            if given.lower() not in units:
                text = f"= '{_shown(given)}' is not known" if given else "is missing"
                self._problems.append(
                    f"[UNITS] {quantity} {text}. Write one of: {', '.join(units)}."
                )
            found[quantity] = units.get(given.lower(), 1.0)
        length, force, time = found["LENGTH"], found["FORCE"], found["TIME"]
        return {
            "m": length,
            "N": force,
            "N/m": force / length,
            "N s/m": force * time / length,
            "m/s": length / time,
            "Pa": found["PRESSURE"],
            "rad": found["ANGLE"],
        }

    def _found(self) -> tuple[dict[str, str], dict[str, dict[str, str]]]:
        """Return the used keys, and the unused ones by section."""
        used: dict[str, str] = {}
        unused: dict[str, dict[str, str]] = {}
        for section, block in self._blocks:
            if section == "UNITS":
                continue
            for given, written in block.values():
                key, text = given.upper(), "" if written[:1] in _COMMENTS else written
                key = known.ALIASES.get(key, key)
                if key not in known.USED or section in _OF_TABLES:
                    if section != "MODEL" or key not in _READ_OF_MODEL:
                        unused.setdefault(section, {})[key] = text
                elif text and used.setdefault(key, text) != text:
                    self._problems.append(
                        f"[{section}] {key} is {_shown(used[key])} and {_shown(text)}. "
                        "Keep one of them."
                    )
            if section in _OF_TABLES and any(True for _ in block.rows()):
                unused.setdefault(section, {})["a table"] = ""
        return used, unused

    def _number(self, key: str, text: str) -> float:
        value = number(text)
        if not math.isfinite(value):
            self._problems.append(f"{key} = {_shown(text)}: a finite number is needed.")
        return value

    def _refuse_sliding(self, unused: Mapping[str, Mapping[str, str]]) -> None:
        """Refuse friction that depends on the sliding speed."""
        for section, keys in unused.items():
            if keys.get("LMUV") and number(keys["LMUV"]) != 0.0:
                self._problems.append(
                    f"[{section}] LMUV = {_shown(keys['LMUV'])}: friction that falls with the "
                    "speed of sliding is left out. Set it to 0."
                )

    def _refuse_misspelt(self, used: Mapping[str, str], unused: dict[str, dict[str, str]]) -> None:
        """Refuse keys that look like misspelt ones: their values would be ignored."""
        open_keys = sorted(known.USED - set(used))
        for section, keys in unused.items():
            if section in _OF_TEXT or section in _OF_TABLES:
                continue
            for key in keys:
                plain = {k.replace("_", ""): k for k in open_keys}
                near = plain.get(key.replace("_", "").replace("-", ""), "")
                if not near and len(key) > 6:
                    near = next(iter(get_close_matches(key, open_keys, 1, _SIMILAR)), "")
                if near:
                    self._problems.append(
                        f"[{section}] {_shown(key)} is not known. Is it {near}? Correct it, or "
                        "remove it."
                    )

    def _refuse_missing(self, numbers: Mapping[str, float]) -> None:
        """Refuse a file without the keys that every tyre needs."""
        sections = {name for name, _ in self._blocks}
        for section, keys in known.missing(numbers).items():
            there = "" if section in sections else f"The section [{section}] is missing; "
            needed = ", ".join(keys)
            self._problems.append(
                f"{there}[{section}] needs {needed}. Give the whole file of the tyre."
            )
        for several, needed in ((known.OF_PRESSURE, "NOMPRES"), (known.OF_SPEED, "LONGVL")):
            having = next((key for key in several if numbers.get(key)), "")
            if having and needed not in numbers:
                self._problems.append(f"{having} needs {needed}, which is missing. Add it.")

    @staticmethod
    def _assumed(numbers: Mapping[str, float], form: Form) -> Iterator[str]:
        """Yield assumptions in place of missing keys."""
        if not form.weighted:
            yield (
                "combined slip: by the friction ellipse, since RBX1 and RBY1 are missing or zero, "
                "or FE_METHOD asks for it"
            )
        for what, start in (
            ("the overturning moment", "QSX"),
            ("rolling resistance", "QSY"),
        ):
            if not any(value for key, value in numbers.items() if key.startswith(start)):
                yield f"{what} is zero, since its coefficients are missing or zero"
        if numbers.get("QSY7") == 0.0:
            yield "QSY7: 1 and not 0, since rolling resistance vanishes with the load"
        if _is_turned(numbers, form):
            yield "PDY1 and PDY2: with the other sign, which changes no force"
        for key, usual in (("LONGVL", "16.7 m/s"), ("VXLOW", "1 m/s")):
            if key not in numbers:
                yield f"{key}: {usual}, since it is missing"


def _is_turned(numbers: Mapping[str, float], form: Form) -> bool:
    """Return whether the lateral peak D is negative and no force depends on its sign.

    D sin(C arctan(K x / (C D) ...)) is even in D; the force induced by longitudinal slip is not.
    """
    induces = form.weighted and any(numbers.get(f"RVY{i}") for i in (1, 2, 3))
    return numbers.get("PDY1", 1.0) < 0.0 and not induces


def _listed(unused: Mapping[str, Mapping[str, str]]) -> Iterator[str]:
    """Yield a line for each section with unused keys, and the reason."""
    for section, keys in unused.items():
        reason = known.REASONS.get(section, "not known")
        names = ", ".join(_shown(key) for key in keys)
        yield f"[{_shown(section)}] {names}: {reason}"


def _shown(text: str) -> str:
    return short(legible(text), _LONGEST)
