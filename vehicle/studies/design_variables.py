"""The numbers of an input file that may vary, and their names."""

import math
import re
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from typing import Any, TypeVar

from ...core.named_types import Array
from ...core.quantities import Display, attributes
from ...core.suggestions import nearest
from ...core.validator import Validator, shown
from ..assembly.of import assembly_of
from ..input.units import unit_of, without_unit
from .evaluation import Subject

_SPACES = str.maketrans("._", "  ")
_DEG = math.pi / 180.0
# limits of the change of a value, in the unit of the file
_LEAST, _GREATEST = 1e-12, 1e12
_TO_SI = {"mm": 1e-3, "deg": _DEG, "N/mm^3": 1e9, "N/mm": 1e3, "N m/deg": 1.0 / _DEG}
_SI = {"mm": "m", "deg": "rad", "N/mm^3": "N/m^3", "N/mm": "N/m", "N m/deg": "N m/rad", "": "1"}
_Numbers = TypeVar("_Numbers", float, Array)

# Beginnings of the names of values of mirrored sides and of a single side, the latter after the end
# of a car.
_SIDE, _APART = "side.", re.compile(r"(front\.|rear\.|)(right|left)\.")
# Sections of points in the unit of the hardpoints: of a file, and of each rod of a rigid axle.
_POINTS, _RODS = ("hardpoints.", "left_hardpoints.", "drag_link."), "rods."
# Points on which the motion of the wheels depends, by section; those of a Pitman arm are keys.
_LINKAGE = ("hardpoints", "left_hardpoints", "rods", "drag_link", "pitman_arm.*_mm")
_OF_A_BAR = ("bush", "link_top", "link_foot")
# Ends of other keys of three numbers, and keys of directions.
_PLACES, _AXES = ("com_mm", "pivot_mm", "ball_mm"), ("axis", "idler_axis")
# The list that varies by a common factor: the forces of a spring's curve.
_SCALED = "spring.force_N"


@dataclass(frozen=True)
class DesignVariable:
    """A number of an input file.

    Attributes
    ----------
    name : str
        Section and key with dots between them, and the component of a point:
        ``hardpoints.ball_joint.z``. The name of a list is that of a factor on all of it.
    unit : str
        Display unit: ``mm``, ``deg``, ``N/m``; empty for a pure number.
    value : float
        In this unit; 1 for a factor.
    in_file : float
        Factor from this unit to that of the file: 0.001 for hardpoints in metres.
    """

    name: str
    unit: str
    value: float
    in_file: float = 1.0

    @property
    def of_bushes(self) -> bool:
        """Whether it is a value of a bush."""
        return names_bushes(self.name)

    @property
    def words(self) -> str:
        """The name in words: ``ball joint z``, ``strut spring rate``."""
        words = f".{without_unit(self.name)}".replace(f".{_SIDE}", ".", 1)[1:]
        words = words.replace("hardpoints.", "", 1)
        return words.translate(_SPACES) + (" factor" if is_factor(self.name) else "")

    @property
    def si_unit(self) -> str:
        """The SI unit."""
        return _SI.get(self.unit, self.unit)

    @property
    def to_si(self) -> float:
        """Factor from the display unit to the SI unit."""
        return _TO_SI.get(self.unit, 1.0)

    def attributes(self) -> dict[str, Any]:
        """Return the attributes of a variable of such values."""
        shown = Display(self.unit or "1", 1.0 / self.to_si)
        return attributes(self.words, self.si_unit) | {
            "display_units": shown.units,
            "display_factor": shown.factor,
        }

    def moved(self, by: _Numbers) -> dict[str, _Numbers]:
        """Return the value of one file or many after a change in SI units, by its name."""
        return {self.name: (self.value + by / self.to_si) * self.in_file}


def names_bushes(pattern: str) -> bool:
    """Return whether a place, or a pattern of places, is in a section of bushes."""
    return "bushings" in pattern.split(".")[:3]


def places_of(suspension: Subject) -> dict[str, DesignVariable]:
    """Return every number of the files of a suspension or an axle, by name."""
    return {
        f"{begin}{place.name}": replace(place, name=f"{begin}{place.name}")
        for begin, sections in assembly_of(suspension).design_sections.items()
        for place in _places(sections, "", _units_of_points(sections))
    }


def _units_of_points(sections: dict[str, Any]) -> dict[str, float]:
    """Return the factors from mm to the units of sections of points, and remove these units."""
    factors = {
        section: 1e-3 if sections[section].pop("unit") == "m" else 1.0
        for section in ("hardpoints", "anti_roll_bar")
        if "unit" in sections.get(section, {})
    }
    # other points are in the unit of the hardpoints
    return {"": factors.get("hardpoints", 1.0)} | factors


def matching(
    given: Validator, suspension: Subject, patterns: Any, section: str = ""
) -> dict[str, DesignVariable]:
    """Return the numbers whose names match patterns, in the order of the file.

    Patterns are names of numbers, sections or points; ``*`` matches any text: ``hardpoints.*.z``.
    `section` begins the messages about them: ``[free]``.
    """
    known = places_of(suspension)
    lists = _lists_of(suspension)
    wanted: set[str] = set()
    lost: dict[str, None] = {}
    texts = isinstance(patterns, list | tuple) and all(isinstance(p, str) for p in patterns)
    if not (texts and patterns):
        given.fail(f"places = {shown(patterns)}: a list of places is needed.")
        return {}
    for given_pattern in patterns:
        # a name without side or end is that of both sides, or of both axles of a car
        tried = (given_pattern, f"{_SIDE}{given_pattern}", f"*.{given_pattern}")
        title = f"{section} {given_pattern}".lstrip()
        pattern = next((p for p in tried if any(_fits(name, p) for name in known)), given_pattern)
        found = {name for name in known if _fits(name, pattern) and _is_meant(name, pattern, known)}
        if not found and pattern in lists:
            given.fail(f"{title} is a list, such as a curve; single numbers vary. Leave it out.")
        elif not found:
            hint = _hint(pattern, known)
            given.fail(f"{title} is neither a number nor a section of the input file. {hint}")
        wanted |= found
        if found:
            fixed = lists.keys() - found
            lost |= dict.fromkeys(sorted(name for name in fixed if _fits(name, pattern)))
    if lost:
        warnings.warn(
            f"{', '.join(lost)}: lists, such as a curve, do not vary. The forces of a spring's "
            f"curve vary by a factor if {_SCALED} is named.",
            RuntimeWarning,
            stacklevel=2,
        )
    return {name: place for name, place in known.items() if name in wanted}


def linkage_of(subject: Subject) -> list[str]:
    """Return the patterns of `matching` for all points of a linkage."""
    known = places_of(subject)
    return [
        pattern
        for pattern in _LINKAGE
        if any(_fits(name, each) for name in known for each in (pattern, f"*.{pattern}"))
    ]


def _is_meant(name: str, pattern: str, known: Mapping[str, DesignVariable]) -> bool:
    """Return whether a fitting pattern includes a value: one of mirrored sides only by its name."""
    if is_factor(name) and pattern.rpartition(".")[2] != name.rpartition(".")[2]:
        return False  # amounts of a section are in units of its numbers
    found = _APART.match(name)
    if found is None or not any(other.startswith(f"{found[1]}{_SIDE}") for other in known):
        return True
    return f".{found[2]}." in f".{pattern}."


def _hint(pattern: str, known: Mapping[str, DesignVariable]) -> str:
    """Return a suggestion for a pattern without a match."""
    has_bushes = any(place.of_bushes for place in known.values())
    if names_bushes(pattern) and not has_bushes:
        return "The file has no [bushings]. Add them."
    levels = {".".join(name.split(".")[:depth]) for name in known for depth in (1, 2, 3)}
    found = nearest(pattern, levels) if len(pattern) > 2 else ""
    if found:
        return f"Did you mean {found}?"
    return f"Its sections are: {', '.join(sorted({name.split('.')[0] for name in known}))}."


def amounts(
    given: Validator, suspension: Subject, by_pattern: Mapping[str, Any], name: str
) -> dict[DesignVariable, float]:
    """Return an amount in SI units for every number that a pattern matches, the last one if many.

    They are in the order of the file. An amount such as "20 %" is a part of each value. `name` is
    that of the argument, and of its section in a file.
    """
    found: dict[str, tuple[DesignVariable, float]] = {}
    for pattern, amount in by_pattern.items():
        title = f"[{name}] {pattern}"
        for full, place in matching(given, suspension, [str(pattern)], f"[{name}]").items():
            number = _part_of(given, title, amount, place) if isinstance(amount, str) else amount
            checked = given.number(title, number, place.unit, above=0.0, below=_GREATEST)
            if checked < _LEAST:
                unit = f"{place.unit and ' '}{place.unit}"
                given.fail(f"{title} = {checked:g}{unit}: {_LEAST:g}{unit} or more is needed.")
            found[full] = place, checked * place.to_si
    return dict(found[name] for name in places_of(suspension) if name in found)


def _part_of(given: Validator, title: str, text: str, place: DesignVariable) -> float:
    """Return a text such as "20 %" as an amount of a value, in its unit."""
    percent = re.fullmatch(r"\s*(\d+(?:\.\d*)?)\s*%\s*", text)
    if percent is None:
        given.fail(f'{title} = "{text}": a number is needed, or a text such as "20 %".')
        return 1.0
    if place.value == 0.0:
        given.fail(f"{title} = {text}: {place.name} is zero, of which there is no part.")
        return 1.0
    return float(percent[1]) / 100.0 * abs(place.value)


def _fits(name: str, pattern: str) -> bool:
    return fnmatchcase(name, pattern) or fnmatchcase(name, f"{pattern}.*")


def is_factor(name: str) -> bool:
    """Return whether a place is a list that varies by a factor."""
    return name == _SCALED or name.endswith(f".{_SCALED}")


def scaled(suspension: Subject, changes: Mapping[str, float]) -> dict[str, Any]:
    """Return changes of a file with factors replaced by the lists that they multiply."""
    if not any(map(is_factor, changes)):
        return {**changes}
    lists = _lists_of(suspension)
    return {
        name: [by * one for one in lists[name]] if is_factor(name) else by
        for name, by in changes.items()
    }


def _lists_of(suspension: Subject) -> dict[str, Sequence[float]]:
    """Return the lists other than points, such as the forces of a curve, by name."""
    every = assembly_of(suspension).design_sections.items()
    return {f"{begin}{name}": one for begin, table in every for name, one in _lists(table)}


def _lists(table: Mapping[str, Any], above: str = "") -> Iterator[tuple[str, Sequence[float]]]:
    """Yield the lists other than points, by their names."""
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield from _lists(value, f"{above}{key}.")
        elif (
            isinstance(value, list | tuple)
            and not key.endswith("axis")
            and (is_factor(f"{above}{key}") or not any(_places({key: value}, above, {"": 1.0})))
        ):
            yield f"{above}{key}", value


def _places(
    table: Mapping[str, Any], above: str, in_file: Mapping[str, float]
) -> Iterator[DesignVariable]:
    for key, value in table.items():
        name = f"{above}{key}"
        if isinstance(value, Mapping):
            yield from _places(value, f"{name}.", in_file)
            continue
        if above.startswith("bushings.") and key == "axis":
            continue  # a direction of any length
        of_points = above in _POINTS or above.startswith(_RODS)
        of_points = of_points or (above == "anti_roll_bar." and key in _OF_A_BAR)
        factor = in_file.get(above.rstrip("."), in_file[""])
        unit, factor = ("mm", factor) if of_points else (unit_of(key), 1.0)
        if isinstance(value, list) and (of_points or key.endswith(_PLACES) or key in _AXES):
            for axis, component in zip("xyz", value, strict=True):
                yield DesignVariable(f"{name}.{axis}", unit, component / factor, factor)
        elif isinstance(value, list | tuple) and is_factor(name):
            yield DesignVariable(name, "", 1.0)
        elif isinstance(value, float):
            yield DesignVariable(name, unit, value)
