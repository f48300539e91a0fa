"""What the declarations of planar mechanisms share: flat points, hinges across the plane."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from ..declare.geometry import UP, Direction, Line, Point
from ..declare.joints import Revolute
from ..program.vectors import UNIT_Y

if TYPE_CHECKING:
    from ..declare.bodies import Body

ACROSS = Direction("across", fixed=UNIT_Y)

# Axis that the plane is perpendicular to, and its direction.
_NORMALS = {"z": UP, "y": ACROSS}


def flat(
    name: str, place: tuple[float, float], meaning: str = "", normal: Literal["y", "z"] = "z"
) -> Point:
    """Return a point of the plane perpendicular to an axis."""
    return Point(name, place, meaning, flat=normal)


def hinge(name: str, first: Body, second: Body, at: Point) -> Revolute:
    """Return a hinge across the plane of a point; its angle is zero at the design position."""
    return Revolute(name, first, second, axis=Line(at, _NORMALS[at.flat]))
