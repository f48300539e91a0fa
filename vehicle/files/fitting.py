"""Changes of a file into which imported hardpoints are put: its side, and other positions."""

import math
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any, Literal

import tomlkit
from pydantic import BaseModel

from ..data import find
from ..input.curve import SEGMENTS
from ..kinds import KINDS, Suspension
from ..kinds.macpherson import MacPherson

Place = tuple[str, ...]
Point = tuple[float, float, float]
Side = Literal["left", "right"]

# A key with its comment, which may have further lines.
_FREE_SLIDE = re.compile(r"^spring_free_slide_mm = .*\n(?:[ \t]+#.*\n)*", re.MULTILINE)


# A line of a file: the begin of a section, and a key with its value and the comment beside it,
# which may have further lines.
_SECTION = re.compile(r"\s*\[([^\[\]#]+)\]\s*(#.*)?")
_LINE = re.compile(r"(\s*([A-Za-z0-9_.-]+)\s*=\s*[^#\n]*?)(\s*)(#.*)")
_COMMENT = re.compile(r"[ \t]*#.*")
_HEAD = re.compile(r"\A(?:#.*\n|\n)+")


def packaged(kind: str) -> tuple[str, str, Suspension]:
    """Return the packaged file of a kind: its name, its text, and its suspension.

    The text is without its first comment, which is about that car.
    """
    starter = KINDS[kind].STARTER
    text = _HEAD.sub("", find(starter).read_text(encoding="utf-8"))
    text = _by_force(text, Suspension.load(starter))
    return starter, text, Suspension.from_dict(tomlkit.parse(text).unwrap(), source=starter)


def put(document: Any, place: Place, value: Any) -> None:
    """Put a value at a place of an input file's text, which keeps its comments."""
    *sections, key = place
    for section in sections:
        document = document[section]
    document[key] = value


def to_side(document: Any, old: Suspension, side: Side) -> Suspension:
    """Change a file with a suspension to a side of the vehicle, and return the new suspension."""
    if old.vehicle.side == side:
        return old
    new = old.mirrored()
    for place, value in _differences(old.to_dict(), new.to_dict()):
        put(document, place, value)
    return new


def _differences(old: Any, new: Any, place: Place = ()) -> Iterator[tuple[Place, Any]]:
    """Yield the places at which two suspensions differ, and the values of the new one."""
    if isinstance(new, Mapping):
        for key, value in new.items():
            yield from _differences(old.get(key) if old else None, value, (*place, key))
    elif new != old:
        yield place, new


def _by_force(text: str, suspension: Suspension) -> str:
    """Return the text of a packaged file with the spring's force at design instead of a free slide.

    The slide of the strut is for a concentric spring only, and its comment is about that car.
    """
    if not isinstance(suspension, MacPherson):
        return text
    points, strut = suspension.hardpoints, suspension.strut
    assert strut.spring_rate_N_per_m is not None  # packaged files have no curve
    seats = points.distance("spring_seat", "spring_top")
    force = _rounded(strut.spring_rate_N_per_m * (strut.free_length(seats) - seats))
    return _FREE_SLIDE.sub(f"spring_force_at_design_N = {force}\n", text)


def move_along(document: Any, old: Suspension, points: Mapping[str, Point]) -> list[str]:
    """Move bodies, tyre and strut of a packaged file along with new hardpoints, and describe this.

    Bodies and tyre keep their distance from the wheel centre, the strut its stroke. `document` is
    the TOML document of the file, which is changed, `old` its suspension, `points` are on the same
    side [mm].
    """
    before = 1000.0 * old.hardpoints.metres("wheel_center")
    shift = [new - was for new, was in zip(points["wheel_center"], before, strict=True)]
    bodies = [n for n, body in document["bodies"].items() if "com_mm" in body]
    for name in bodies:
        com = document["bodies"][name]["com_mm"]
        moved = [_rounded(at + by) for at, by in zip(com, shift, strict=True)]
        put(document, ("bodies", name, "com_mm"), moved)
    tyre = document["tyre"]
    tyre["free_height_mm"] = _rounded(tyre["free_height_mm"] + shift[2])
    lines = ["tyre: touches the ground as far from the design position as in the packaged file"]
    if bodies:
        lines.append(f"centre of mass of {', '.join(bodies)}: moved along with the wheel centre")
    if "strut" in document:
        lines.append(_fit_strut(document, old, points))
    return lines


def _fit_strut(document: Any, old: Suspension, points: Mapping[str, Point]) -> str:
    """Change the extended length of a strut, so that it keeps its stroke; return a description."""
    lower = "strut_lower" if "strut_lower" in points else "ball_joint"
    was = 1000.0 * old.hardpoints.distance("strut_lower", "strut_top")
    new = math.dist(points[lower], points["strut_top"])
    strut = document["strut"]
    slide = strut["length_max_mm"] - was
    strut["length_max_mm"] = _rounded(new + slide)
    return f"strut: {slide:.1f} mm longer when fully extended than at design"


def fewer(curve: Sequence[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    """Return a curve of rising compressions and forces, with at most the allowed number of points.

    Points of extension, which suspensions hardly use, are left out; those of compression are not.
    """
    first = next((i for i, (place, _) in enumerate(curve) if place > 0.0), len(curve)) - 1
    return tuple(curve[max(0, min(first, len(curve) - SEGMENTS - 1)) :])


def ground(suspension: Suspension) -> list[str]:
    """Return the assumption on the ground, if no file has the radius of the tyre."""
    if suspension.tyre.radius_mm is not None:
        return []
    radius = suspension.tyre_radius()
    height = 1000.0 * float(suspension.hardpoints.metres("wheel_center")[2])
    return [
        f"wheel: {1000.0 * radius:g} mm of radius, as the ground is taken to be at z = 0"
        if radius
        else f"ground: not known, as the wheel centre is at z = {height:g} mm; enter the wheel's "
        "radius as radius_mm in [tyre]"
    ]


def differences(old: Suspension, new: Suspension) -> set[Place]:
    """Return the places at which two suspensions of a kind differ."""
    return {place for place, _ in _differences(old.to_dict(), new.to_dict())}


def fresh(text: str, suspension: Suspension, changed: Collection[Place] | None = None) -> str:
    """Return the text of a file in which the meaning of keys replaces comments on old values.

    `changed` are the places of changed values, by default of all.
    """
    lines, section, stale = [], "", False
    for line in text.splitlines():
        if stale and _COMMENT.fullmatch(line):
            continue
        stale, new = False, line
        if found := _SECTION.fullmatch(line):
            section = found[1].strip()
        elif found := _LINE.fullmatch(line):
            place = (*filter(None, section.split(".")), *found[2].split("."))
            stale = changed is None or place in changed
            meaning = _meaning(suspension, place)
            new = f"{found[1]}{found[3]}# {meaning}" if meaning else found[1]
        lines.append(new if stale else line)
    return "\n".join(lines) + "\n"


def _meaning(model: Any, place: Place) -> str:
    """Return the meaning of a key, from the description of its field."""
    *sections, key = place
    for section in sections:
        model = getattr(model, section, None)
    fields = type(model).model_fields if isinstance(model, BaseModel) else {}
    return (fields[key].description or "") if key in fields else ""


def _rounded(value: float) -> float:
    """Return a value without digits from rounding."""
    return round(value, 6) + 0.0
