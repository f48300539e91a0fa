"""Tires of Project Chrono's templates: radius, mass and inertia, and a constant rate."""

import math
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

from pydantic import Field, ValidationError

from ....core.errors import InputError
from ....core.legible import legible, short
from ...input.bodies import impossible_inertia
from ...input.commented_json import entry
from ...input.teim_orbit import read_blocks
from ...input.teim_values import MILLIMETRES, Values, number, unit_of
from .keys import Part, Place, Unread, leaves, listed, meant, problem_of, shown, slip
from .parts import Finite, Point

TYRE_RATE = 200e3
"""Default radial rate of a tyre [N/m]."""


class _Places(NamedTuple):
    """The places of data in a template; empty for missing ones."""

    radius: Place
    mass: Place = ("Mass",)
    inertia: Place = ("Inertia",)
    rate: Place = ()
    curve: Place = ()
    """Replaces the rate, if it is given."""
    file: Place = ()
    """Name of a file in the TeimOrbit format with the radius."""


_DESIGN = _Places(
    ("Design", "Unloaded Radius [m]"),
    ("Design", "Mass [kg]"),
    ("Design", "Inertia [kg.m2]"),
    ("Parameters", "Vertical", "Vertical Tire Stiffness [N/m]"),
)
_ELEMENTS = _Places(("Tire Radius",), (), ())
_TEMPLATES: Mapping[str, _Places] = {
    "RigidTire": _Places(("Radius",)),
    "TMeasyTire": _DESIGN,
    "TMsimpleTire": _DESIGN,
    "FialaTire": _Places(
        ("Fiala Parameters", "Unloaded Radius"),
        rate=("Fiala Parameters", "Vertical Stiffness"),
        curve=("Fiala Parameters", "Vertical Curve Data"),
    ),
    "Pac89Tire": _Places(
        ("Design Parameters", "Unloaded Radius"),
        rate=("Design Parameters", "Vertical Stiffness"),
        curve=("Design Parameters", "Vertical Curve Data"),
    ),
    "Pac02Tire": _Places(("Dimension", "Unloaded Radius"), file=("TIR Specification File",)),
    "PacejkaTire": _Places((), file=("Pacejka Parameter File",)),
    "MFTire": _Places(("DIMENSION", "UNLOADED_RADIUS")),
    # tires of finite elements, with the mass of their materials
    "ANCFTire": _ELEMENTS,
    "ReissnerTire": _ELEMENTS,
    "FEATire": _ELEMENTS,
}

_FORMAL: tuple[Place, ...] = (("Type",), ("Template",))


class _Values(Part):
    radius: Finite | None = Field(default=None, gt=0.0)
    mass: Finite = Field(default=20.0, ge=0.0)
    inertia: Point = (0.8, 1.0, 0.8)
    rate: Finite | None = Field(default=None, ge=0.0)


@dataclass(frozen=True)
class Tire:
    """A tire."""

    radius: float | None  # without load [m]; None if not known
    mass: float  # [kg]
    # moments about its axes; the second one is the axis of its spin [kg m^2]
    inertia: tuple[float, float, float]
    rate: float | None = None  # vertical rate [N/m]; None if it is not constant or not known
    template: str = ""  # empty for the default tire
    # assumptions and unread data, a sentence each
    assumed: tuple[str, ...] = ()
    left_out: tuple[str, ...] = ()

    @property
    def is_usual(self) -> bool:
        """Whether it is the default tire."""
        return not self.template


USUAL = Tire(None, _Values().mass, _Values().inertia)
"""The default tire, of a passenger car, with its rim."""


def tire_of(data: dict[str, Any], path: str | Path) -> Tire:
    """Return the tire of the content of a file, which may name another one beside it."""
    template = _template(data, path)
    places = _TEMPLATES[template]
    there = {n: p for n, p in places._asdict().items() if p and entry(data, p) is not None}
    if "curve" in there:
        there.pop("rate", None)
    problems = [
        f'"{" > ".join(place)}" is missing in a file of the template {template}. Add it, in SI '
        "units."
        for name, place in (("radius", places.radius), ("mass", places.mass),
                            ("inertia", places.inertia))
        if place and name not in there and not (name == "radius" and "file" in there)
    ]  # fmt: skip
    given = {name: place for name, place in there.items() if name in _Values.model_fields}
    try:
        values = _Values.model_validate({name: entry(data, p) for name, p in given.items()})
    except ValidationError as error:
        details = error.errors()
        problems += [
            problem_of(d, (*given[str(d["loc"][0])], *map(str, d["loc"][1:]))) for d in details
        ]
    else:
        xx, yy, zz = values.inertia
        if reason := impossible_inertia(dict.fromkeys(("xy", "xz", "yz"), 0.0)
                                        | {"xx": xx, "yy": yy, "zz": zz}):  # fmt: skip
            problems.append(
                f'"{" > ".join(places.inertia)}" = {[xx, yy, zz]} kg m^2: {reason}. Correct it, or '
                "leave the tire out and enter its values in the new file."
            )
    unread = list(_unread(data, {*_FORMAL, *given.values()}))
    missing = [place for place in places if place and entry(data, place) is None]
    problems += _slips(unread, missing)
    if problems:
        raise InputError(problems, str(path))
    tire = Tire(values.radius, values.mass, values.inertia, values.rate, template)
    of_elements = f"tire: {USUAL.mass:g} kg and the inertia of a usual one, as its file has none"
    assumed = [] if places.mass else [of_elements]
    if "file" in there:
        radius, text = _radius_in(Path(path).parent, str(entry(data, there["file"])))
        tire = replace(tire, radius=radius if tire.radius is None else tire.radius)
        assumed.append(text)
    left = [f"tire > {line}" for line in listed(unread)]
    return replace(tire, assumed=tuple(assumed), left_out=tuple(left))


def _template(data: dict[str, Any], path: str | Path) -> str:
    """Return the template of a tire's file; refuse other files."""
    kind, template = data.get("Type", "Tire"), data.get("Template", "RigidTire")
    if kind != "Tire":
        problem = f'"Type" is {shown(kind)}; the file of a tire is needed, in which it is "Tire".'
    elif not isinstance(template, str) or template not in _TEMPLATES:
        known = ", ".join(_TEMPLATES)
        problem = (
            f'"Template" is {shown(template)}; of tires, these can be read: {known}. Leave the '
            "tire out and enter its values in the new file."
        )
    elif template == "MFTire" and (unit := entry(data, ("UNITS", "LENGTH"))) not in ("meter", "m"):
        problem = f'"UNITS > LENGTH" is {shown(unit)}; only "meter" can be read.'
    else:
        return template
    raise InputError([problem], str(path))


def _radius_in(folder: Path, name: str) -> tuple[float | None, str]:
    """Return the radius of a tire in the TeimOrbit format [m], and notes about it."""
    file = folder / re.split(r"[\\/]", name)[-1]
    try:
        values = Values(read_blocks(file), str(file))
        given = number(values.one("dimension", "unloaded_radius"))
        radius = given * unit_of(values, "length", "meter", MILLIMETRES) / 1000.0
        problem = "" if 0.0 < radius < math.inf else "there is no UNLOADED_RADIUS in [DIMENSION]."
    except InputError as error:
        radius, problem = math.nan, error.problems[0]
    if problem:
        text = f"not known, since it is in {legible(short(name))}: {problem} Enter radius_mm"
        return None, f"radius of the tire: {text} in [tyre]"
    return radius, f"tire: of {legible(short(name))} only UNLOADED_RADIUS is read"


def _unread(data: dict[str, Any], used: set[Place], above: Place = ()) -> Iterator[Unread]:
    """Yield the keys that are not read."""
    for key, value in data.items():
        place = (*above, key)
        if any(one[: len(place)] == place for one in used):
            if place not in used and isinstance(value, dict):
                yield from _unread(value, used, place)
        else:
            yield place, value


def _slips(unread: Iterable[Unread], missing: Iterable[Place]) -> list[str]:
    """Return the problems of keys that are probably misspelt ones of missing keys."""
    return [
        slip(place, right)
        for one in missing
        for place, _ in leaves(unread)
        if len(place) == len(one) and meant(place[-1], [one[-1]])
        and all(meant(a, [b]) for a, b in zip(place, one, strict=True))
        for right in [" > ".join(one)]
    ]  # fmt: skip
