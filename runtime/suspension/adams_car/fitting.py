"""A file that somebody else's hardpoints are put into: its side, and what goes along with them."""

import math
import re
from collections.abc import Iterator, Mapping
from typing import Any

from ..kinds import Suspension
from ..kinds.macpherson import MacPherson
from .subsystem import Point, Side

Place = tuple[str, ...]

# A key with its comment, which goes on in lines of its own.
_FREE_SLIDE = re.compile(r"^spring_free_slide_mm = .*\n(?:[ \t]+#.*\n)*", re.MULTILINE)


def put(document: Any, place: Place, value: Any) -> None:
    """Put a value at a place of an input file's text; comments stay."""
    *sections, key = place
    for section in sections:
        document = document[section]
    document[key] = value


def to_side(document: Any, old: Suspension, side: Side) -> Suspension:
    """Bring a file to a side of the vehicle, and return the suspension that it then has.

    Parameters
    ----------
    document : tomlkit.TOMLDocument
        Is changed.
    old : Suspension
        What it describes.
    side : {'left', 'right'}
    """
    if old.vehicle.side == side:
        return old
    new = old.mirrored()
    for place, value in _differences(old.to_dict(), new.to_dict()):
        put(document, place, value)
    return new


def _differences(old: Any, new: Any, place: Place = ()) -> Iterator[tuple[Place, Any]]:
    """Yield the places where two suspensions differ, and what is there in the new one."""
    if isinstance(new, Mapping):
        for key, value in new.items():
            yield from _differences(old[key], value, (*place, key))
    elif new != old:
        yield place, new


def by_force(text: str, suspension: Suspension) -> str:
    """Return the text of a packaged file that says by a force where its spring is free.

    The slide of the strut says so, too, but only of a spring that is concentric with it, and in a
    comment of the very car that the file is of.
    """
    if not isinstance(suspension, MacPherson):
        return text
    points, strut = suspension.hardpoints, suspension.strut
    seats = points.distance("spring_seat", "spring_top")
    force = _rounded(strut.spring_rate_N_per_m * (strut.free_length(seats) - seats))
    line = f"spring_force_at_design_N = {force}  # of the spring, at the design position\n"
    return _FREE_SLIDE.sub(line, text)


def move_along(document: Any, old: Suspension, points: Mapping[str, Point]) -> list[str]:
    """Bring what lies at a place of its own to where the new hardpoints are.

    That is for a packaged file, whose places are those of another car: bodies and tyre keep their
    distance from the wheel centre, the strut its stroke.

    Parameters
    ----------
    document : tomlkit.TOMLDocument
        Is changed.
    old : Suspension
        What it describes.
    points : mapping
        The new hardpoints, on the same side [mm].

    Returns
    -------
    list of str
        What was brought along, in words.
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
    told = ["tyre: touches the ground as far from the design position as in the packaged file"]
    if bodies:
        told.append(f"centre of mass of {', '.join(bodies)}: moved along with the wheel centre")
    if "strut" in document:
        told.append(_fit_strut(document, old, points))
    return told


def _fit_strut(document: Any, old: Suspension, points: Mapping[str, Point]) -> str:
    """Keep the stroke of a strut; its comments say between which points it is."""
    lower = "strut_lower" if "strut_lower" in points else "ball_joint"
    was = 1000.0 * old.hardpoints.distance("strut_lower", "strut_top")
    new = math.dist(points[lower], points["strut_top"])
    strut = document["strut"]
    slide = strut["length_max_mm"] - was
    strut["length_max_mm"] = _rounded(new + slide)
    if lower == "strut_lower":
        strut["length_max_mm"].comment("strut_lower to strut_top, the strut fully extended")
        document["hardpoints"]["ball_joint"].comment("control arm to knuckle")
    return f"strut: {slide:.1f} mm longer when fully extended than at design"


def _rounded(value: float) -> float:
    """Return a value without the digits that only the computation has brought."""
    return round(value, 6) + 0.0
