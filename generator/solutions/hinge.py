"""A body on a hinge: held by a rod, or pinned to a body that is placed already."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..arithmetic import SignOf
from ..placement import Axes, Placed, PointMotion, from_axes
from ..vectors import UNIT_X, ZERO, Twist, Vector
from .lines import once, place_rod, projector

if TYPE_CHECKING:
    from ..geometry import Point
    from ..joints import Revolute
    from ..kinematics import Kinematics
    from ..transformer import PlaceByPin, SolveHinge


@dataclass(frozen=True)
class _Hinge:
    """A hinge of a body on a placed parent, with a point of the body that defines its angle.

    Attributes
    ----------
    axis, axis_on_parent
        Unit vector of the axis: in work axes now, and in the parent's axes.
    origin
        Motion of the hinge's point.
    along, radius
        Coordinates of the point: along the axis, and across it (constants).
    design_axes
        Axis, direction to the point across it, normal to both: at the design position.
    """

    parent: Placed
    body: str
    axis: Vector
    axis_on_parent: Vector
    origin: PointMotion
    through: Point
    point: Point
    along: sp.Expr
    radius: sp.Expr
    design_axes: Axes

    @property
    def arm(self) -> Vector:
        """The point in body axes."""
        return Vector(self.along, self.radius, ZERO.z)


def _hinge(kin: Kinematics, body: str, joint: Revolute, parent_name: str, point: Point) -> _Hinge:
    """Describe a hinge, from the design position."""
    program, parent = kin.program, kin.placed[parent_name]
    n = kin.unit(f"{body}_hinge_design", kin.to_work(joint.axis.vector))
    arm = program.vector(f"{body}_arm_design", kin.design(point) - kin.design(joint.axis.through))
    along = program.define(f"{body}_arm_along", arm.dot(n))
    across = program.vector(f"{body}_arm_across", arm - n * along)
    radius = program.define(f"{body}_arm_radius", sp.sqrt(across.dot(across)))
    t = program.vector(f"{body}_arm_unit", across * (1 / radius))
    on_parent = program.vector(
        f"{body}_hinge_on_parent", Vector(*(n.dot(axis) for axis in parent.design_axes)), "123"
    )
    return _Hinge(
        parent,
        body,
        program.vector(f"{body}_hinge", from_axes(parent.axes, on_parent)),
        on_parent,
        kin.point_motion(parent_name, joint.axis.through),
        joint.axis.through,
        point,
        along,
        radius,
        (n, t, program.vector(f"{body}_normal_design", n.cross(t))),
    )


def solve_hinge(kin: Kinematics, action: SolveHinge) -> None:
    r"""Turn a body about its hinge until a rod fits: two ball joints and a hinge, or three hinges.

    Let n be the axis of the hinge, F the foot on it of the rod's joint D, rho = \|FD\|, E the other
    end of the rod of length l, and w = E - F with parts w_n along n and w_p across it. The unit
    vector t from F to D is perpendicular to n, and ``|D - E| = l`` becomes

        t . w_p = k,    k = (rho^2 + |w_p|^2 + w_n^2 - l^2) / (2 rho),
        t = (k w_p + s sqrt(|w_p|^2 - k^2) n x w_p) / |w_p|^2,    s = +1 or -1.

    That is the equation of `turn` about a line that is fixed in the parent. Branch: s is the sign
    of (D - E) . (n x t) at the design position. Valid while ``|w_p|^2 > k^2``; the edge is the
    dead point where rod, D and hinge are in one plane. Singular: E on the axis.

    In the body axes (n, t, n x t), D - E = (-w_n, rho - k, s sqrt(|w_p|^2 - k^2)), so the rate of
    the angle follows from ``(D - E) . (v_D - v_E) = 0`` with one division. In a plane w_n is zero,
    and this is the dyad of three hinges.
    """
    program, body = kin.program, action.body
    hinge = _hinge(kin, body, action.joint, action.parent, action.end)
    anchor = kin.point_motion(action.anchor_body, action.anchor)
    rod = program.vector(f"{action.rod}_design", kin.design(action.end) - kin.design(action.anchor))
    length = program.define(f"{action.rod}_length", sp.sqrt(rod.dot(rod)))
    branch = program.define(f"{body}_branch", SignOf(rod.dot(hinge.design_axes[2])))
    e = program.vector(f"{body}_reach", anchor.position - hinge.origin.position)
    n, rho = hinge.axis, hinge.radius
    reach_along = program.define(f"{body}_reach_along", e.dot(n))
    w_n = program.define(f"{body}_reach_axial", reach_along - hinge.along)
    w_p = program.vector(f"{body}_reach_across", e - n * reach_along)
    normal = program.vector(f"{body}_reach_normal", n.cross(e))
    squared = program.guarded(
        f"{body}_reach_squared",
        w_p.dot(w_p),
        f"{kin.loop_of(action)}: point {action.anchor.name} lies on the hinge of {body}, whose "
        "angle is undetermined",
        "m^2",
    )
    k = program.define(
        f"{body}_reach_needed", (squared + w_n**2 + (rho**2 - length**2)) * (1 / (2 * rho))
    )
    room = program.guarded(
        f"{body}_closure",
        squared - k**2,
        f"{kin.loop_of(action)} cannot close: the rod {action.rod} cannot reach {body}, beyond its "
        "dead point",
        "m^2",
    )
    root = program.define(f"{body}_closure_root", sp.sqrt(room))
    inverse = program.define(f"{body}_reach_inverse", 1 / squared)
    cosine = program.define(f"{body}_turn_cosine", k * inverse)
    sine = program.define(
        f"{body}_turn_sine", root * program.define(f"{body}_reach_inverse_signed", branch * inverse)
    )
    axes: Axes = (
        n,
        program.vector(f"{body}_arm", w_p * cosine + normal * sine),
        program.vector(f"{body}_normal", normal * cosine - w_p * sine),
    )
    gap = program.vector(f"{body}_rod", Vector(-w_n, rho - k, branch * root), "123")
    hold = program.define(f"{body}_hold", -branch / (rho * root))
    _place(kin, hinge, axes, _Condition(anchor, gap, hold))
    _report_angle(kin, action.joint, hinge, axes)
    if any(a.rod == action.rod for a in kin.plan.lines()):
        place_rod(kin, action, anchor, length)


def place_by_pin(kin: Kinematics, action: PlaceByPin) -> None:
    """Turn a body about its hinge until a point of it meets a placed pin.

    With O the hinge, n its axis and ``radius`` the distance of the point from it, the direction to
    the point is t = (pin - O) across n, divided by the radius. The pin's velocity gives the turn:
    ``omega1 radius = (v_pin - v_O - omega_parent x arm) . (n x t)``. Nothing is left to choose, and
    nothing is singular: the loop has closed before.
    """
    program, body = kin.program, action.body
    hinge = _hinge(kin, body, action.joint, action.parent, action.pin)
    pin = kin.point_motion(action.pin_body, action.pin)
    n = hinge.axis
    span = program.vector(f"{body}_span", pin.position - hinge.origin.position)
    inverse = program.define(f"{body}_radius_inverse", 1 / hinge.radius)
    t = program.vector(f"{body}_arm", (span - n * hinge.along) * inverse)
    axes: Axes = (n, t, program.vector(f"{body}_normal", n.cross(t)))
    _place(kin, hinge, axes, _Condition(pin, Vector.of(0, 0, 1), -inverse))
    _report_angle(kin, action.joint, hinge, axes)


@dataclass(frozen=True)
class _Condition:
    """What determines the rate of the angle: ``gap . (v_D - v_E) = 0`` for a target E."""

    target: PointMotion
    gap: Vector
    hold: sp.Expr


def _place(kin: Kinematics, hinge: _Hinge, axes: Axes, condition: _Condition) -> None:
    """Record pose, velocities and bias of a body on a hinge."""
    program, body, parent, arm = kin.program, hinge.body, hinge.parent, hinge.arm
    placed = Placed(
        body,
        origin=hinge.origin.position,
        axes=axes,
        design_origin=kin.design(hinge.through),
        design_axes=hinge.design_axes,
        local={hinge.through: ZERO, hinge.point: arm},
        carrier=(parent.body, kin.local(parent, hinge.through)),
    )
    to_body = projector(kin, placed)
    gap, hold = condition.gap, condition.hold
    rate: Vector = ZERO

    def carried(label: str, v: Vector) -> Vector:
        return to_body(label, from_axes(parent.axes, v))

    names = dict.fromkeys([*hinge.origin.motion, *parent.motion, *condition.target.motion])
    for k in names:
        base = to_body(f"velocity_{k}", hinge.origin.motion.get(k, ZERO))
        swing = carried(f"carried_{k}", parent.motion[k].angular) if k in parent.motion else ZERO
        target = to_body(f"target_{k}", condition.target.motion.get(k, ZERO))
        slip = base - target + swing.cross(arm)
        turn = program.define(f"{body}_turn_{k}", gap.dot(slip) * hold)
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
        turn = program.define(f"{body}_turn_bias", (gap.dot(pull) + slack) * hold)
        return kin.define_bias(body, Twist(alpha + UNIT_X * turn, base))

    placed.bias = once(bias)
    kin.placed[body] = placed


def _report_angle(kin: Kinematics, joint: Revolute, hinge: _Hinge, axes: Axes) -> None:
    """Give the angle of a solved hinge: zero at design, positive as its second body turns."""
    parent, program, name = hinge.parent, kin.program, hinge.body
    start = program.vector(
        f"{name}_arm_on_parent",
        Vector(*(hinge.design_axes[1].dot(axis) for axis in parent.design_axes)),
        "123",
    )
    now = Vector(*(axes[1].dot(axis) for axis in parent.axes))
    side = hinge.axis_on_parent.cross(start)
    sense = 1 if joint.second == hinge.body else -1
    kin.angles[joint.name] = sp.atan2(sense * side.dot(now), start.dot(now))
