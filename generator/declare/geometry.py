"""Points, directions and lines of a mechanism at its design position, in the axes of the world.

They are those of ISO 8855: x forward, y left, z up. All components are parameters.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

import sympy as sp
from pydantic import BeforeValidator
from pydantic_core import PydanticCustomError

from ..program.vectors import UNIT_X, UNIT_Z, Vector
from .declared import DeclarationError, Name, declared


def _symbols(name: str) -> Vector:
    return Vector(*(sp.Symbol(f"{name}_{axis}") for axis in "xyz"))


def _vector(given: Any) -> Any:
    """Take three numbers for a vector, but not zeros."""
    components = given if isinstance(given, Vector | tuple) else ()
    try:
        vector = Vector.of(*components)
        usable = all(c.is_number and c.is_finite and c.is_real for c in vector)
    except (TypeError, ValueError, AttributeError, sp.SympifyError):
        usable = False
    if not usable or vector.is_zero:
        problem = "is no direction; give three numbers, not all of them zero"
        raise PydanticCustomError("declared", problem)
    return vector


@declared
@dataclass(frozen=True)
class Point:
    """A hardpoint, in metres.

    Parameters
    ----------
    name
        Begins the names of its parameters, ``<name>_x`` and so on.
    flat
        Axis along which the coordinate is zero and no parameter: the points of a planar mechanism.
    """

    name: Name
    flat: Literal["", "x", "y", "z"] = ""

    @property
    def position(self) -> Vector:
        """Coordinates at the design position, in the axes of the world."""
        x, y, z = (
            sp.Integer(0) if axis == self.flat else component
            for axis, component in zip("xyz", _symbols(self.name), strict=True)
        )
        return Vector(x, y, z)


@declared
@dataclass(frozen=True)
class Direction:
    """A direction: an axis of the world, a parameter of any length, or from one point to another.

    Parameters
    ----------
    name
        Begins the names of its parameters, ``<name>_x`` and so on, if the others are left out.
    fixed
        Components of a direction that is no parameter.
    between
        Two points; the direction is from the first to the second at the design position.
    """

    name: Name
    fixed: Annotated[Vector, BeforeValidator(_vector)] | None = None
    between: tuple[Point, Point] | None = None

    def __post_init__(self) -> None:
        problems = []
        if self.fixed is not None and self.between is not None:
            problems.append("it is fixed and between two points; leave one of the two out")
        if self.between is not None and self.between[0] == self.between[1]:
            name = self.between[0].name
            problems.append(f"it is between {name!r} and itself; give two different points")
        if problems:
            raise DeclarationError(f"Direction {self.name!r}", problems)

    @property
    def components(self) -> Vector:
        """Components at the design position, in the axes of the world, not normalised."""
        if self.between is not None:
            start, end = self.between
            return end.position - start.position
        return self.fixed if self.fixed is not None else _symbols(self.name)


FORWARD = Direction("forward", UNIT_X)
UP = Direction("up", UNIT_Z)


@declared
@dataclass(frozen=True)
class Line:
    """An oriented line: from one point to another, or through a point along a direction."""

    through: Point
    towards: Point | Direction

    def __post_init__(self) -> None:
        if self.through == self.towards:
            problem = f"it is from {self.through.name!r} to itself; give another point or direction"
            raise DeclarationError("Line", [problem])

    @property
    def vector(self) -> Vector:
        """A vector along the line, not normalised."""
        if isinstance(self.towards, Point):
            return self.towards.position - self.through.position
        return self.towards.components

    def contains(self, point: Point) -> bool:
        """Tell whether the point lies on the line by declaration."""
        return point in (self.through, self.towards)
