"""Views of a body for forces: in its own axes, or in those of a base that turns with it.

Forces are the same in any axes. For a body on a base that turns, they are those of the base, in
which its twists are nearly constant.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from ..declare.geometry import UP
from ..program.vectors import Twist, Vector, from_axes, to_axes

if TYPE_CHECKING:
    from collections.abc import Mapping

    import sympy as sp

    from ..declare.geometry import Direction, Point
    from ..kinematics.carried import Carried
    from ..kinematics.kinematics import Kinematics
    from ..kinematics.motion import BodyMotion


class InBody:
    """A body in its own axes: its motion in the world, and the kinematics that it is part of."""

    def __init__(self, placed: BodyMotion, part: Kinematics) -> None:
        self._placed, self._part, self._program = placed, part, part.program

    def local(self, point: Point) -> Vector:
        """Return the position of a point relative to the origin."""
        return self._part.local(self._placed, point)

    def direction(self, direction: Direction) -> Vector:
        """Return a direction fixed in the body."""
        return self._part.local_direction(self._placed, direction)

    def from_world(self, direction: Direction) -> Vector:
        """Return a direction fixed in the world."""
        line = to_axes(self._placed.axes, self._part.from_world(direction))
        name = "up" if direction == UP else f"{direction.name}_in_world"
        return self._program.vector(f"{self._placed.body}_{name}", line, "123")

    @property
    def twists(self) -> Mapping[str, Twist]:
        """The twist of the origin per unit rate of each coordinate."""
        return self._placed.motion

    def height(self, local: Vector) -> sp.Expr:
        """Return the height of a point in the world."""
        origin = self._placed.origin.dot(self._part.from_world(UP)) + self._part.height_of_origin
        return origin + local.dot(self.from_world(UP))

    def place(self, local: Vector) -> Vector:
        """Return the position of a point in the world."""
        return self._part.place_in_world(self._placed.origin + from_axes(self._placed.axes, local))

    def in_world(self, vector: Vector) -> Vector:
        """Return the components of a vector in the world."""
        return self._part.in_world(from_axes(self._placed.axes, vector))

    def rising(self, local: Vector) -> sp.Expr:
        """Return the upward acceleration of a point without accelerations of the coordinates."""
        own = self.from_world(UP).dot(self._part.point_bias(self._placed, local))
        return own * self._part.coordinates.rate_scale_of(self._placed) ** 2


class OnBase:
    """A body in the axes of the base that carries it."""

    def __init__(self, carried: Carried) -> None:
        self._carried, self._part, self._base = carried, carried.part, carried.base
        self._program = carried.part.program

    def _turned(self, name: str, v: Vector) -> Vector:
        axes = self._carried.axes
        body, base = self._carried.relative.body, self._base.body
        return self._program.vector(f"{body}_on_{base}_{name}", from_axes(axes, v))

    def local(self, point: Point) -> Vector:
        """Return the position of a point relative to the origin."""
        return self._turned(f"arm_{point.name}", self._part.local(self._carried.relative, point))

    def direction(self, direction: Direction) -> Vector:
        """Return a direction fixed in the body."""
        local = self._part.local_direction(self._carried.relative, direction)
        return self._turned(direction.name, local)

    def from_world(self, direction: Direction) -> Vector:
        """Return a direction fixed in the world."""
        line = self._part.to_ground(self._part.from_world(direction))
        name = "up" if direction == UP else f"{direction.name}_in_world"
        return self._program.vector(f"{name}_on_{self._base.body}", line)

    @cached_property
    def twists(self) -> Mapping[str, Twist]:
        """The twist of the origin per unit rate of each coordinate."""
        relative, arm = self._carried.relative, self._carried.arm
        found = {
            k: Twist(self._turned(f"omega_{k}", own.angular), self._carried.of_origin(k))
            for k, own in relative.motion.items()
        }
        for k, own in self._base.twists.items():
            found[k] = Twist(own.angular, own.linear + own.angular.cross(arm))
        return found

    def height(self, local: Vector) -> sp.Expr:
        """Return the height of a point in the world."""
        way = self._program.vector(
            f"{self._carried.relative.body}_seen_from_{self._base.body}", self._carried.arm + local
        )
        return self._base.position.z + self.from_world(UP).dot(way)

    def place(self, local: Vector) -> Vector:
        """Return the position of a point in the world."""
        return self._base.place(self._carried.arm + local + self._base.center)

    def in_world(self, vector: Vector) -> Vector:
        """Return the components of a vector in the world."""
        return self._base.to_world(vector)

    def rising(self, local: Vector) -> sp.Expr:
        """Return the upward acceleration of a point without accelerations of the coordinates."""
        carried = self._carried
        own = self._part.point_bias(carried.motion, to_axes(carried.axes, local))
        return self.from_world(UP).dot(from_axes(carried.axes, own))
