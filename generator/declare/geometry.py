"""Points, directions and lines of a mechanism at its design position, in the axes of the world.

The axes are those of ISO 8855: x forward, y left, z up. All components are parameters.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated, Any, Literal

import sympy as sp
from pydantic import BeforeValidator
from pydantic_core import PydanticCustomError

from ..program.vectors import UNIT_X, UNIT_Z, Vector
from .declared import DeclarationError, Name, Number, declared
from .parameters import Displacement, Owner, Parameter


def _vector(given: Any) -> Any:
    """Return the unit vector along three numbers that are not all zero."""
    components = given if isinstance(given, Vector | tuple) else ()
    try:
        vector = Vector.of(*components)
        usable = all(c.is_number and c.is_finite and c.is_real for c in vector)
    except (TypeError, ValueError, AttributeError, sp.SympifyError):
        usable = False
    if not usable or vector.is_zero:
        problem = "is not a direction; give three numbers, not all of them zero"
        raise PydanticCustomError("declared", problem)
    norm = sp.sqrt(vector.dot(vector))
    return Vector(*(c if norm == 1 else _written_out(c / norm) for c in vector))


def _written_out(number: sp.Expr) -> sp.Expr:
    """Return a number in a form of C: a ratio of integers, or a double."""
    return number if number.is_Rational else sp.Float(float(number))


@declared
@dataclass(frozen=True)
class Point(Owner):
    """A point of a mechanism at the design position; its coordinates are parameters [m].

    Parameters
    ----------
    name
        Prefix of the names of its parameters, ``<name>_x`` and so on.
    place
        Default coordinates at the design position, axes of the world [m].
    meaning
        Description in the documentation of the generated code; by default the name.
    flat
        Axis along which the coordinate is zero and not a parameter, for points of a planar
        mechanism; `place` then has the two other coordinates. By default all three are parameters.
        'xyz': the point is the origin, and has no parameters.
    """

    name: Name
    place: tuple[Number, ...]
    meaning: str = ""
    flat: Literal["", "x", "y", "z", "xyz"] = ""

    def __post_init__(self) -> None:
        if len(self.place) != len(self._axes):
            axes = " and ".join(self._axes)
            problem = f"place {self.place} has {len(self.place)} coordinates; {axes} are needed"
            raise DeclarationError(f"Point {self.name!r}", [problem])

    @property
    def _axes(self) -> str:
        return "".join(axis for axis in "xyz" if axis not in self.flat)

    @cached_property
    def numbers(self) -> tuple[Parameter, ...]:
        what = self.meaning or self.name
        return tuple(
            Displacement(
                f"{self.name}_{axis}",
                value,
                f"{what} at the start, {axis}"
                if self.flat
                else f"{what}, {axis} at the design position",
            )
            for axis, value in zip(self._axes, self.place, strict=True)
        )

    @property
    def turned(self) -> tuple[int, ...]:
        return tuple(-1 if axis == "y" else 1 for axis in self._axes)

    @cached_property
    def position(self) -> Vector:
        """Coordinates at the design position, in the axes of the world."""
        symbols = dict(zip(self._axes, (p.symbol for p in self.numbers), strict=True))
        return Vector(*(symbols.get(axis, sp.Integer(0)) for axis in "xyz"))


ORIGIN = Point("origin", (), flat="xyz")
"""Origin of the axes in which a mechanism is declared."""


@declared
@dataclass(frozen=True)
class Direction(Owner):
    """A direction: of three parameters, of constants, or from one point to another.

    Parameters
    ----------
    name
        Prefix of the names of its parameters, ``<name>_x`` and so on.
    along
        Default components, of any length, axes of the world at the design position.
    meaning
        Description in the documentation of the generated code; by default the name.
    fixed
        Instead of `along`: constant components, which are not parameters, of any length.
    between
        Instead of `along`: two points; from the first to the second at the design position.
    axial
        Whether it is an axis of rotation, whose mirror image has the opposite sense.
    """

    name: Name
    along: tuple[Number, Number, Number] | None = None
    meaning: str = ""
    fixed: Annotated[Vector, BeforeValidator(_vector)] | None = None
    between: tuple[Point, Point] | None = None
    axial: bool = field(default=False, repr=False)

    def __post_init__(self) -> None:
        problems = []
        if sum(given is not None for given in (self.along, self.fixed, self.between)) != 1:
            problems.append("give its components along, or fixed ones, or the points between which")
        if self.between is not None and self.between[0] == self.between[1]:
            name = self.between[0].name
            problems.append(f"it is between {name!r} and itself; give two different points")
        if problems:
            raise DeclarationError(f"Direction {self.name!r}", problems)

    @cached_property
    def numbers(self) -> tuple[Parameter, ...]:
        what = self.meaning or self.name
        return tuple(
            Parameter(f"{self.name}_{axis}", value, "1", f"{what}, {axis} component")
            for axis, value in zip("xyz", self.along or (), strict=False)
        )

    @property
    def turned(self) -> tuple[int, ...]:
        """Signs in the mirror, the plane y = 0; an axis of rotation has the opposite ones."""
        return (1, -1, 1)

    @cached_property
    def components(self) -> Vector:
        """Components at the design position, in the axes of the world, not normalised."""
        if self.between is not None:
            start, end = self.between
            return end.position - start.position
        return self.fixed or Vector(*(p.symbol for p in self.numbers))


FORWARD = Direction("forward", fixed=UNIT_X)
UP = Direction("up", fixed=UNIT_Z)


@declared
@dataclass(frozen=True)
class Line:
    """An oriented line: from one point to another, or through a point along a direction.

    Parameters
    ----------
    through
        A point of the line, its beginning.
    towards
        Another point of the line, or its direction.
    """

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
        """Return whether the point lies on the line by declaration."""
        return point in (self.through, self.towards)
