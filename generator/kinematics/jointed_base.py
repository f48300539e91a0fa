"""A body that joints lead to from the ground, one behind the other, as a base of other bodies.

The body of a car is one, on a guide and two hinges: it heaves, pitches and rolls. The bodies that
hang on it are solved in its axes, as on the ground; the coordinates of the joints are states.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from ..program.vectors import IDENTITY, NO_TWIST, Twist, Vector, from_axes, to_axes
from .base import Base

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..declare.geometry import Point
    from ..program.program import Program
    from ..program.vectors import Axes
    from .kinematics import Kinematics
    from .motion import BodyMotion


@dataclass(frozen=True)
class JointedBase(Base):
    """A base at the end of driven joints, whose kinematics are `root`."""

    program: Program
    root: Kinematics
    name: str
    com: Point
    axes: Axes

    @classmethod
    def of(cls, program: Program, root: Kinematics, body: str) -> JointedBase:
        """Append the axes of a body that is placed."""
        placed, com = root.placed[body], root.mechanism.body(body).center
        axes = IDENTITY
        if placed.axes is not IDENTITY:
            names = (f"{body}_forward", f"{body}_left", f"{body}_up")
            axes = program.axes(names, (_turned(root, placed, v) for v in IDENTITY))
        return cls(program, root, body, com, axes)

    @property
    def body(self) -> str:
        return self.name

    @property
    def point(self) -> Point:
        return self.com

    @property
    def _placed(self) -> BodyMotion:
        return self.root.placed[self.name]

    @cached_property
    def _local(self) -> Vector:
        return self.root.local(self._placed, self.com)

    def _own(self, v: Vector) -> Vector:
        """Return components along the axes of the base of a vector in the axes of its hinge."""
        return self.root.to_ground(from_axes(self._placed.design_axes, v))

    @cached_property
    def position(self) -> Vector:
        return self.root.place_in_world(self.root.position(self._placed, self.com))

    @cached_property
    def twists(self) -> Mapping[str, Twist]:
        found = {}
        for k, twist in self._placed.motion.items():
            linear = self._own(twist.linear + twist.angular.cross(self._local))
            found[k] = Twist(
                self.program.vector(f"{self.name}_turn_by_{k}", self._own(twist.angular)),
                self.program.vector(f"{self.name}_way_by_{k}", linear),
            )
        return found

    @cached_property
    def _total(self) -> Twist:
        total = NO_TWIST
        for k, twist in self.twists.items():
            total += twist * self.root.coordinates.true_rate(k)
        return Twist(
            self.program.vector(f"{self.name}_turning", total.angular),
            self.program.vector(f"{self.name}_going", total.linear),
        )

    @property
    def velocity(self) -> Vector:
        return self._total.linear

    @property
    def omega(self) -> Vector:
        return self._total.angular

    @cached_property
    def bias(self) -> Twist:
        """Rate of its twist in its own, turning axes."""
        acceleration = self._own(self.root.point_bias(self._placed, self._local))
        change = acceleration - self.omega.cross(self.velocity)
        return Twist(
            self.program.vector(f"{self.name}_alpha_left", self._own(self._placed.bias().angular)),
            self.program.vector(f"{self.name}_change_left", change),
        )


def _turned(root: Kinematics, placed: BodyMotion, v: Vector) -> Vector:
    """Return a direction of the ground that a body has carried from design."""
    now = from_axes(placed.axes, to_axes(placed.design_axes, root.to_work(v)))
    return root.to_ground(now)
