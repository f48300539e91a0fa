"""A body on a hinge, and the arm to its point that determines the angle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..program.vectors import Axes, from_axes, to_axes
from .arm import Arm
from .solved_motion import TurnOnHinge, place_at

if TYPE_CHECKING:
    from ..declare.geometry import Point
    from ..declare.joints import Revolute
    from ..kinematics.kinematics import Kinematics
    from ..kinematics.motion import BodyMotion, PointMotion
    from ..program.vectors import Vector


@dataclass(frozen=True)
class Hinge:
    """A hinge of a body on a placed parent, with the arm to a point that defines its angle."""

    joint: Revolute
    parent: BodyMotion
    body: str
    # unit vector of the axis: in work axes now, and in the parent's axes
    axis: Vector
    axis_on_parent: Vector
    origin: PointMotion  # motion of the hinge's point
    through: Point
    point: Point
    arm: Arm

    @classmethod
    def of(
        cls,
        kin: Kinematics,
        body: str,
        joint: Revolute,
        parent_name: str,
        point: Point,
        extent: sp.Expr,
    ) -> Hinge:
        """Return a hinge of a body on a placed parent, from the design position.

        `point` defines the angle; `extent` is the square of the extent of the loop.
        """
        parent, through = kin.placed[parent_name], joint.axis.through
        n = kin.unit(f"{body}_hinge_design", kin.to_work(joint.axis.vector))
        on_parent = kin.program.vector(
            f"{body}_hinge_on_parent", to_axes(parent.design_axes, n), "123"
        )
        return cls(
            joint,
            parent,
            body,
            kin.program.vector(f"{body}_hinge", from_axes(parent.axes, on_parent)),
            on_parent,
            kin.point_motion(parent_name, through),
            through,
            point,
            Arm.of(kin, body, n, through, point, extent),
        )

    @property
    def first_axis_of(self) -> str | None:
        """Name of the hinge, if its axis in its own sense is the first of the body axes."""
        own = self.joint.second.name == self.body and self.joint.angle_to is None
        return self.joint.name if own else None


def place_on_hinge(kin: Kinematics, hinge: Hinge, axes: Axes) -> TurnOnHinge:
    """Record the pose of a body on a hinge; return it, with its motion yet to be added."""
    arm, at = hinge.arm, (hinge.parent.body, hinge.through)
    local, first = {hinge.point: arm.local}, hinge.first_axis_of
    placed = place_at(kin, hinge.body, at, axes, arm.design_axes, local=local, hinge=first)
    return TurnOnHinge(kin, placed, *at)


def report_angle(kin: Kinematics, hinge: Hinge, axes: Axes) -> None:
    """Record the angle of a solved hinge: zero at design, positive as its second body turns."""
    joint, parent, program, name = hinge.joint, hinge.parent, kin.program, hinge.body
    start = program.vector(
        f"{name}_arm_on_parent", to_axes(parent.design_axes, hinge.arm.design_axes[1]), "123"
    )
    now = to_axes(parent.axes, axes[1])
    side = hinge.axis_on_parent.cross(start)
    sense = 1 if joint.second.name == hinge.body else -1
    kin.angles[joint.name] = sp.atan2(sense * side.dot(now), start.dot(now))
