"""What the declarations of planar mechanisms share: flat points, hinges across the plane."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from ..declare.assembly import Parameter
from ..declare.geometry import UP, Direction, Line, Point
from ..declare.joints import Revolute
from ..program.vectors import UNIT_Y

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

Axis = Literal["x", "y", "z"]

ACROSS = Direction("across", UNIT_Y)

# Axis that the plane is perpendicular to, and its direction.
_NORMALS = {"z": UP, "y": ACROSS}


def flat(name: str, normal: Axis = "z") -> Point:
    """Return a point of the plane perpendicular to an axis."""
    return Point(name, flat=normal)


def hinge(name: str, first: str, second: str, at: str, normal: Axis = "z") -> Revolute:
    """Return a hinge across the plane; its angle is zero at the design position."""
    axis = Line(flat(at, normal), _NORMALS[normal])
    return Revolute(name=name, first=first, second=second, axis=axis)


def places(
    named: Mapping[str, tuple[tuple[float, float], str]], axes: str = "xy"
) -> Iterator[Parameter]:
    """Yield the coordinates of points, given as name to (place, meaning)."""
    for name, (place, meaning) in named.items():
        for axis, value in zip(axes, place, strict=True):
            yield Parameter(f"{name}_{axis}", value, "m", f"{meaning} at the start, {axis}")


def inertia(name: str, mass: float, moment: float, normal: Axis = "z") -> Iterator[Parameter]:
    """Yield the mass of a body and its moment of inertia about the normal of the plane."""
    yield Parameter(f"{name}_mass", mass, "kg", f"mass of {name}")
    element = f"{name}_inertia_{normal}{normal}"
    yield Parameter(element, moment, "kg m^2", f"inertia of {name} across the plane")
