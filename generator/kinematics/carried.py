"""Motion in the world of a body on a moving base, from its motion on the base.

With v and omega those of the base at its centre of mass O, in its own axes, a point at r from O
with the velocity r' relative to the body has

    velocity      v + omega x r + r',
    acceleration  v' + omega' x r + omega x (v + omega x r) + 2 omega x r' + r''.

Source: relative motion, T. R. Kane and D. A. Levinson, Dynamics: Theory and Applications,
McGraw-Hill, 1985.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

from ..program.vectors import NO_TWIST, ZERO, Twist, Vector, from_axes, to_axes

if TYPE_CHECKING:
    from .base import Base
    from .kinematics import Kinematics
    from .motion import BodyMotion


class Carried:
    """A body that a base carries, or the base itself.

    `part` and `relative` are the kinematics that it is part of, and its motion on the base. In the
    axes of the base, `axes` are those of the body, and `arm` leads from the centre of mass of the
    base to the origin of the body. `motion` is that in the world: per unit rate of the coordinates
    that move it on the base, and of those of the base.
    """

    def __init__(self, base: Base, part: Kinematics, placed: BodyMotion) -> None:
        self.base, self.part, self.relative = base, part, placed
        self._program, body = part.program, placed.body
        first, second, third = (f"{body}_{n}_on_{base.body}" for n in ("first", "second", "third"))
        self.axes = self._program.axes(
            (first, second, third), (part.to_ground(axis) for axis in placed.axes)
        )
        arm = self._from_center(placed.origin)
        self.arm = self._program.vector(f"{body}_from_{base.body}", arm)
        self.motion = replace(
            placed,
            motion={**placed.motion, **self._columns()},
            bias=cache(self._bias),
            total=cache(self._total),
            carrier=self._carrier(),
        )

    def _from_center(self, work: Vector) -> Vector:
        """Return the vector from the centre of mass of the base to a position in work axes."""
        return self.part.to_ground(work) + self.part.work_origin - self.base.center

    def _columns(self) -> dict[str, Twist]:
        """Return the twist per unit of each speed of the base, in the axes of the body."""
        levers = [
            self._program.vector(f"{self.relative.body}_lever_{i}", self.arm.cross(axis))
            for i, axis in enumerate(self.axes, 1)
        ]
        # a turn of the base moves a point by omega x r, with omega . r x a along an axis a
        return {
            k: Twist(
                to_axes(self.axes, twist.angular),
                Vector(
                    *(
                        axis.dot(twist.linear) + lever.dot(twist.angular)
                        for axis, lever in zip(self.axes, levers, strict=True)
                    )
                ),
            )
            for k, twist in self.base.twists.items()
        }

    def of_origin(self, k: str | None) -> Vector:
        """Return the velocity of the origin on the base, in the axes of the base.

        It is that per unit rate of a coordinate; for None, at the rates at which biases are
        computed.
        """
        placed, part = self.relative, self.part
        if placed.at is None:
            own = part.total(placed) if k is None else placed.motion[k]
            return from_axes(self.axes, own.linear)
        ways, rate = placed.at.motion, part.coordinates.rate
        if k is not None:
            return part.to_ground(ways.get(k, ZERO))
        return part.to_ground(sum((v * rate(other) for other, v in ways.items()), ZERO))

    def bias_of_origin(self) -> Vector:
        """Return the bias acceleration of the origin on the base, in the axes of the base."""
        placed = self.relative
        if placed.at is None:
            return from_axes(self.axes, placed.bias().linear)
        return self.part.to_ground(placed.at.bias)

    def _carrier(self) -> tuple[str, Vector] | None:
        """Return the neighbour that shares the origin, with its own coordinates of that point."""
        carrier = self.relative.carrier
        if carrier is None or carrier[0] != self.base.body:
            return carrier
        return carrier[0], self._from_center(carrier[1])

    def _omega(self) -> Vector:
        omega = to_axes(self.axes, self.base.omega)
        return self._program.vector(f"{self.relative.body}_carried_omega", omega, "123")

    def _velocity(self) -> Vector:
        """Return the velocity of the base at the origin of the body, in its own axes."""
        velocity = self.base.velocity + self.base.omega.cross(self.arm)
        return self._program.vector(f"{self.relative.body}_carried_velocity", velocity)

    def _total(self) -> Twist:
        own = self._own()
        linear = own.linear + to_axes(self.axes, self._velocity())
        twist = Twist(own.angular + self._omega(), linear)
        return self.part.define_twist(self.relative.body, "in_world", twist)

    def _own(self) -> Twist:
        """Return the twist on the base."""
        coordinates = self.part.coordinates
        if coordinates.rate_scale_of(self.relative) == 1:
            return self.part.total(self.relative)
        twist = NO_TWIST
        for k, motion in self.relative.motion.items():
            twist += motion * coordinates.true_rate(k)
        return twist

    def _bias(self) -> Twist:
        scale = self.part.coordinates.rate_scale_of(self.relative)
        own, bias, omega = self._own(), self.relative.bias() * scale**2, self._omega()
        base = self.base.bias
        carried = self.base.omega.cross(self._velocity()) + base.linear
        carried += base.angular.cross(self.arm)
        carried = self._program.vector(f"{self.relative.body}_carried_acceleration", carried)
        linear = bias.linear + omega.cross(own.linear) * 2 + to_axes(self.axes, carried)
        return self.part.define_bias(
            self.relative.body,
            Twist(
                bias.angular + omega.cross(own.angular) + to_axes(self.axes, base.angular), linear
            ),
        )
