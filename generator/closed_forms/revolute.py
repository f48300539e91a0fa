"""A body on a hinge: held by a rod, or pinned to a body that is placed already."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..kinematics.extent import extent_squared
from ..kinematics.motion import Axes, Placed, PointMotion, from_axes, to_axes
from ..program.vectors import UNIT_X, ZERO, Twist, Vector
from .arm import Arm, Reach, fit_rod
from .lines import once, place_rod, projector

if TYPE_CHECKING:
    from ..declare.geometry import Point
    from ..declare.joints import Revolute
    from ..kinematics.kinematics import Kinematics
    from ..loops.actions import PlaceByPin, SolveHinge
    from .rod import Rod


@dataclass(frozen=True)
class _Hinge:
    """A hinge of a body on a placed parent, with the arm to a point that defines its angle.

    Attributes
    ----------
    axis, axis_on_parent
        Unit vector of the axis: in work axes now, and in the parent's axes.
    origin
        Motion of the hinge's point.
    """

    parent: Placed
    body: str
    axis: Vector
    axis_on_parent: Vector
    origin: PointMotion
    through: Point
    point: Point
    arm: Arm


def _hinge(
    kin: Kinematics, action: SolveHinge | PlaceByPin, point: Point, extent: sp.Expr
) -> _Hinge:
    """Describe a hinge, from the design position."""
    body, joint, parent_name = action.body, action.joint, action.parent
    parent, through = kin.placed[parent_name], joint.axis.through
    n = kin.unit(f"{body}_hinge_design", kin.to_work(joint.axis.vector))
    on_parent = kin.program.vector(f"{body}_hinge_on_parent", to_axes(parent.design_axes, n), "123")
    return _Hinge(
        parent,
        body,
        kin.program.vector(f"{body}_hinge", from_axes(parent.axes, on_parent)),
        on_parent,
        kin.point_motion(parent_name, through),
        through,
        point,
        Arm.of(kin, body, n, through, point, extent),
    )


def solve_hinge(kin: Kinematics, action: SolveHinge) -> None:
    """Turn a body about its hinge until a rod fits: two ball joints and a hinge, or three hinges.

    The equation is that of `arm`, about the axis of the hinge, which is fixed in the parent. In a
    plane w_n is zero, and this is the dyad of three hinges. A telescope of known slide may be the
    rod: boom, cylinder and chassis of a crane, driven by the stroke.
    """
    program, body = kin.program, action.body
    hinge = _hinge(kin, action, action.end, extent_squared(kin, action))
    anchor = kin.point_motion(action.anchor_body, action.anchor)
    e = program.vector(f"{body}_reach", anchor.position - hinge.origin.position)
    along = program.define(f"{body}_reach_along", e.dot(hinge.axis))
    reach = Reach(
        program.define(f"{body}_reach_axial", along - hinge.arm.along),
        program.vector(f"{body}_reach_across", e - hinge.axis * along),
        program.vector(f"{body}_reach_normal", hinge.axis.cross(e)),
    )
    fit = fit_rod(kin, action, hinge.arm, hinge.axis, reach)
    _place(kin, hinge, fit.axes, _Condition(anchor, fit.gap, fit.hold, fit.rod))
    _report_angle(kin, action.joint, hinge, fit.axes)
    if not kin.plan.is_pinned(action.rod):
        place_rod(kin, action, anchor, fit.rod.length, rigid=action.telescope is None)


def place_by_pin(kin: Kinematics, action: PlaceByPin) -> None:
    """Turn a body about its hinge until a point of it meets a placed pin.

    With O the hinge, n its axis and ``radius`` the distance of the point from it, the direction to
    the point is t = (pin - O) across n, divided by the radius. The pin's velocity gives the turn:
    ``omega1 radius = (v_pin - v_O - omega_parent x arm) . (n x t)``. Nothing is left to choose, and
    nothing is singular: the loop has closed before.
    """
    program, body = kin.program, action.body
    hinge = _hinge(kin, action, action.pin, extent_squared(kin, action))
    pin = kin.point_motion(action.pin_body, action.pin)
    n = hinge.axis
    span = program.vector(f"{body}_span", pin.position - hinge.origin.position)
    inverse = program.define(f"{body}_radius_inverse", 1 / hinge.arm.radius)
    t = program.vector(f"{body}_arm", (span - n * hinge.arm.along) * inverse)
    axes: Axes = (n, t, program.vector(f"{body}_normal", n.cross(t)))
    _place(kin, hinge, axes, _Condition(pin, Vector.of(0, 0, 1), -inverse))
    _report_angle(kin, action.joint, hinge, axes)


@dataclass(frozen=True)
class _Condition:
    """What determines the rate of the angle: ``gap . (v_D - v_E) = l l'`` for a target E.

    Without a rod the right side is zero.
    """

    target: PointMotion
    gap: Vector
    hold: sp.Expr
    rod: Rod | None = None

    def stretch(self, coordinate: str) -> sp.Expr:
        """Return l l' per unit rate of a coordinate."""
        return self.rod.stretch.get(coordinate, sp.Integer(0)) if self.rod else sp.Integer(0)

    @property
    def stretch_bias(self) -> sp.Expr:
        """What l l' changes by without accelerations of the independent coordinates."""
        return self.rod.stretch_bias if self.rod else sp.Integer(0)


def _place(kin: Kinematics, hinge: _Hinge, axes: Axes, condition: _Condition) -> None:
    """Record pose, velocities and bias of a body on a hinge."""
    program, body, parent, arm = kin.program, hinge.body, hinge.parent, hinge.arm.local
    placed = Placed(
        body,
        origin=hinge.origin.position,
        axes=axes,
        design_origin=kin.design(hinge.through),
        design_axes=hinge.arm.design_axes,
        local={hinge.through: ZERO, hinge.point: arm},
        carrier=(parent.body, kin.local(parent, hinge.through)),
    )
    to_body = projector(kin, placed)
    gap, hold = condition.gap, condition.hold
    rate: Vector = ZERO

    def carried(label: str, v: Vector) -> Vector:
        return to_body(label, from_axes(parent.axes, v))

    stretching = condition.rod.stretch if condition.rod else {}
    names = [*hinge.origin.motion, *parent.motion, *condition.target.motion, *stretching]
    for k in dict.fromkeys(names):
        base = to_body(f"velocity_{k}", hinge.origin.motion.get(k, ZERO))
        swing = carried(f"carried_{k}", parent.motion[k].angular) if k in parent.motion else ZERO
        target = to_body(f"target_{k}", condition.target.motion.get(k, ZERO))
        slip = base - target + swing.cross(arm)
        fitted = gap.dot(slip) - condition.stretch(k)
        turn = program.define(f"{body}_turn_{k}", fitted * hold)
        omega = program.vector(f"{body}_omega_{k}", swing + UNIT_X * turn, "123")
        placed.motion[k] = Twist(omega, base)
        rate += (base - target + omega.cross(arm)) * kin.rate(k)

    def bias() -> Twist:
        now = program.vector(f"{body}_rod_rate", rate, "123")
        omega = kin.total(placed).angular
        parent_omega = carried("carried_now", kin.total(parent).angular)
        base = to_body("acceleration", hinge.origin.bias)
        target = to_body("target_bias", condition.target.bias)
        spin = Vector(omega.x - parent_omega.x, ZERO.y, ZERO.z)
        alpha = carried("carried_bias", parent.bias().angular) + parent_omega.cross(spin)
        alpha = program.vector(f"{body}_alpha_carried", alpha, "123")
        whirl = program.vector(f"{body}_whirl", omega.cross(arm), "123")
        pull = base - target + omega.cross(whirl) + alpha.cross(arm)
        slack = now.dot(now) if gap.x != 0 or gap.y != 0 else sp.Integer(0)
        fitted = gap.dot(pull) + slack - condition.stretch_bias
        turn = program.define(f"{body}_turn_bias", fitted * hold)
        return kin.define_bias(body, Twist(alpha + UNIT_X * turn, base))

    placed.bias = once(bias)
    kin.placed[body] = placed


def _report_angle(kin: Kinematics, joint: Revolute, hinge: _Hinge, axes: Axes) -> None:
    """Give the angle of a solved hinge: zero at design, positive as its second body turns."""
    parent, program, name = hinge.parent, kin.program, hinge.body
    start = program.vector(
        f"{name}_arm_on_parent", to_axes(parent.design_axes, hinge.arm.design_axes[1]), "123"
    )
    now = to_axes(parent.axes, axes[1])
    side = hinge.axis_on_parent.cross(start)
    sense = 1 if joint.second == hinge.body else -1
    kin.angles[joint.name] = sp.atan2(sense * side.dot(now), start.dot(now))
