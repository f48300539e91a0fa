"""A body on a hinge, with one condition that determines its angle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..kinematics.motion import Axes, BodyMotion, PointMotion, from_axes, once, to_axes
from ..program.vectors import UNIT_X, ZERO, Twist, Vector
from .arm import Arm
from .turning_body import TurningBody

if TYPE_CHECKING:
    from ..declare.geometry import Point
    from ..declare.joints import Revolute
    from ..kinematics.kinematics import Kinematics
    from .leg import Rod


@dataclass(frozen=True)
class Hinge:
    """A hinge of a body on a placed parent, with the arm to a point that defines its angle.

    Attributes
    ----------
    axis, axis_on_parent
        Unit vector of the axis: in work axes now, and in the parent's axes.
    origin
        Motion of the hinge's point.
    """

    joint: Revolute
    parent: BodyMotion
    body: str
    axis: Vector
    axis_on_parent: Vector
    origin: PointMotion
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
        """Describe a hinge, from the design position."""
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


@dataclass(frozen=True)
class Condition:
    """What determines the rate of the angle: ``rod_vector . (v_D - v_E) = l l'`` for a target E.

    Without a rod the right side is zero.
    """

    target: PointMotion
    rod_vector: Vector
    inverse_lever: sp.Expr
    rod: Rod | None = None

    def stretch(self, coordinate: str) -> sp.Expr:
        """Return l l' per unit rate of a coordinate."""
        return self.rod.stretch.get(coordinate, sp.Integer(0)) if self.rod else sp.Integer(0)

    @property
    def stretch_bias(self) -> sp.Expr:
        """What l l' changes by without accelerations of the independent coordinates."""
        return self.rod.stretch_bias if self.rod else sp.Integer(0)


def place_on_hinge(kin: Kinematics, hinge: Hinge, axes: Axes, condition: Condition) -> None:
    """Record pose, velocities and bias of a body on a hinge."""
    program, body, parent, arm = kin.program, hinge.body, hinge.parent, hinge.arm.local
    placed = BodyMotion(
        body,
        origin=hinge.origin.position,
        axes=axes,
        design_origin=kin.design(hinge.through),
        design_axes=hinge.arm.design_axes,
        local={hinge.through: ZERO, hinge.point: arm},
        carrier=(parent.body, kin.local(parent, hinge.through)),
        hinge=hinge.first_axis_of,
    )
    turning = TurningBody(kin, placed, hinge.origin, condition.target)
    rod_vector, inverse_lever = condition.rod_vector, condition.inverse_lever
    rate: Vector = ZERO
    for k in turning.moved_by(condition.rod.stretch if condition.rod else ()):
        given = turning.rates(k)
        relative_velocity = given.base - given.target + given.carried.cross(arm)
        fitted = rod_vector.dot(relative_velocity) - condition.stretch(k)
        turn = program.define(f"{body}_turn_{k}", fitted * inverse_lever)
        omega = program.vector(f"{body}_omega_{k}", given.carried + UNIT_X * turn, "123")
        placed.motion[k] = Twist(omega, given.base)
        rate += (given.base - given.target + omega.cross(arm)) * kin.coordinates.rate(k)

    def bias() -> Twist:
        now = program.vector(f"{body}_rod_rate", rate, "123")
        given, omega = turning.biases(), kin.total(placed).angular
        whirl = program.vector(f"{body}_whirl", omega.cross(arm), "123")
        pull = given.base - given.target + omega.cross(whirl) + given.carried.cross(arm)
        slack = now.dot(now) if rod_vector.x != 0 or rod_vector.y != 0 else sp.Integer(0)
        fitted = rod_vector.dot(pull) + slack - condition.stretch_bias
        turn = program.define(f"{body}_turn_bias", fitted * inverse_lever)
        return kin.define_bias(body, Twist(given.carried + UNIT_X * turn, given.base))

    placed.bias = once(bias)
    kin.placed[body] = placed


def report_angle(kin: Kinematics, hinge: Hinge, axes: Axes) -> None:
    """Give the angle of a solved hinge: zero at design, positive as its second body turns."""
    joint, parent, program, name = hinge.joint, hinge.parent, kin.program, hinge.body
    start = program.vector(
        f"{name}_arm_on_parent", to_axes(parent.design_axes, hinge.arm.design_axes[1]), "123"
    )
    now = to_axes(parent.axes, axes[1])
    side = hinge.axis_on_parent.cross(start)
    sense = 1 if joint.second.name == hinge.body else -1
    kin.angles[joint.name] = sp.atan2(sense * side.dot(now), start.dot(now))
