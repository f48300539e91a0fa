"""What a moving base carries: its motion in the world, from that on the base.

With v and omega those of the base at its centre of mass O, in its own axes, a point at r from
O with the velocity r' relative to the body has

    velocity      v + omega x r + r',
    acceleration  v' + omega' x r + omega x (v + omega x r) + 2 omega x r' + r''.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ..program.vectors import Twist, Vector
from .motion import from_axes, once, to_axes

if TYPE_CHECKING:
    from .base import Base
    from .kinematics import Kinematics
    from .motion import BodyMotion


class Carried:
    """A body that a base carries, or the base itself.

    Attributes
    ----------
    base
        What carries it.
    axes
        Those of the body, in the axes of the base.
    arm
        From the centre of mass of the base to the origin of the body, in the axes of the base.
    motion
        Its motion in the world: per unit rate of the coordinates that move it on the base, and of
        those of the base.
    """

    def __init__(self, base: Base, part: Kinematics, placed: BodyMotion) -> None:
        self.base, self._part, self._placed = base, part, placed
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
            bias=once(self._bias),
            total=once(self._total),
            carrier=self._carrier(),
        )

    def _from_center(self, work: Vector) -> Vector:
        """Return the way from the centre of mass of the base to a place in work axes."""
        place: Vector = self._part.to_ground(work) + self._part.work_origin - self.base.center
        return place

    def _columns(self) -> dict[str, Twist]:
        """Return the twist per unit of each speed of the base, in the axes of the body."""
        levers = [
            self._program.vector(f"{self._placed.body}_lever_{i}", self.arm.cross(axis))
            for i, axis in enumerate(self.axes, 1)
        ]
        # what turns the base moves a point by omega x r, whose part along an axis is omega . r x a
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

    def _carrier(self) -> tuple[str, Vector] | None:
        """Return the neighbour that shares the origin; of a point of the base, its own axes."""
        carrier = self._placed.carrier
        if carrier is None or carrier[0] != self.base.body:
            return carrier
        return carrier[0], self._from_center(carrier[1])

    def _omega(self) -> Vector:
        omega = to_axes(self.axes, self.base.omega)
        return self._program.vector(f"{self._placed.body}_carried_omega", omega, "123")

    def _velocity(self) -> Vector:
        """Return the velocity that the base has at the origin of the body, in its own axes."""
        velocity = self.base.velocity + self.base.omega.cross(self.arm)
        return self._program.vector(f"{self._placed.body}_carried_velocity", velocity)

    def _total(self) -> Twist:
        own = self._part.total(self._placed)
        linear = own.linear + to_axes(self.axes, self._velocity())
        twist = Twist(own.angular + self._omega(), linear)
        return self._part.define_twist(self._placed.body, "in_world", twist)

    def _bias(self) -> Twist:
        own, bias, omega = self._part.total(self._placed), self._placed.bias(), self._omega()
        base = self.base.bias
        carried = self.base.omega.cross(self._velocity()) + base.linear
        carried += base.angular.cross(self.arm)
        carried = self._program.vector(f"{self._placed.body}_carried_acceleration", carried)
        linear = bias.linear + omega.cross(own.linear) * 2 + to_axes(self.axes, carried)
        return self._part.define_bias(
            self._placed.body,
            Twist(
                bias.angular + omega.cross(own.angular) + to_axes(self.axes, base.angular), linear
            ),
        )

    def on_base(self, label: str, wrench: Twist) -> Twist:
        """Return a wrench, or a momentum, about the centre of mass of the base, in its axes.

        Parameters
        ----------
        label
            Begins the names of its steps.
        wrench
            Couple about the origin of the body, and force, in the axes of the body.
        """
        force = self._program.vector(f"{label}_force", from_axes(self.axes, wrench.linear))
        couple = from_axes(self.axes, wrench.angular) + self.arm.cross(force)
        return Twist(self._program.vector(f"{label}_couple", couple), force)
