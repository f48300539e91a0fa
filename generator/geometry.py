"""Points, directions and lines of a mechanism at its design position, in chassis axes.

Chassis axes are ISO 8855: x forward, y left, z up. All components are parameters.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from .vectors import UNIT_X, UNIT_Z, Vector


def _symbols(name: str) -> Vector:
    return Vector(*(sp.Symbol(f"{name}_{axis}") for axis in "xyz"))


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

    name: str
    flat: str = ""

    @property
    def position(self) -> Vector:
        """Coordinates at the design position, in chassis axes."""
        x, y, z = (
            sp.Integer(0) if axis == self.flat else component
            for axis, component in zip("xyz", _symbols(self.name), strict=True)
        )
        return Vector(x, y, z)


@dataclass(frozen=True)
class Direction:
    """A direction: a chassis axis, a parameter of any length, or from one point to another.

    Parameters
    ----------
    name
        Begins the names of its parameters, ``<name>_x`` and so on, if the others are left out.
    fixed
        Components of a direction that is no parameter.
    between
        Two points; the direction is from the first to the second at the design position.
    """

    name: str
    fixed: Vector | None = None
    between: tuple[Point, Point] | None = None

    @property
    def components(self) -> Vector:
        """Components at the design position, in chassis axes, not normalised."""
        if self.between is not None:
            start, end = self.between
            return end.position - start.position
        return self.fixed if self.fixed is not None else _symbols(self.name)


FORWARD = Direction("forward", UNIT_X)
UP = Direction("up", UNIT_Z)


@dataclass(frozen=True)
class Line:
    """An oriented line: from one point to another, or through a point along a direction."""

    through: Point
    towards: Point | Direction

    @property
    def vector(self) -> Vector:
        """A vector along the line, not normalised."""
        if isinstance(self.towards, Point):
            return self.towards.position - self.through.position
        return self.towards.components

    def contains(self, point: Point) -> bool:
        """Tell whether the point lies on the line by declaration."""
        return point in (self.through, self.towards)
