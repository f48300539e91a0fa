"""What the declarations of planar mechanisms share: flat points, hinges across the plane."""

from __future__ import annotations

from typing import Literal

from .. import declare as d
from ..program.vectors import UNIT_Y

ACROSS = d.Direction("across", fixed=UNIT_Y)

# Axis that the plane is perpendicular to, and its direction.
_NORMALS = {"z": d.UP, "y": ACROSS}


def flat(
    name: str, place: tuple[float, float], meaning: str = "", normal: Literal["y", "z"] = "z"
) -> d.Point:
    """Return a point of the plane perpendicular to an axis."""
    return d.Point(name, place, meaning, flat=normal)


def hinge(name: str, first: d.Body, second: d.Body, at: d.Point) -> d.Revolute:
    """Return a hinge across the plane of a point; its angle is zero at the design position."""
    return d.Revolute(name, first, second, axis=d.Line(at, _NORMALS[at.flat]))
