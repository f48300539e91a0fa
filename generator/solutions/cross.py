"""A shaft turned by its universal joint."""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

from ..placement import Axes, OnLine, Placed, from_axes
from ..vectors import ZERO, Twist, Vector
from .lines import line_alpha, line_omega, once, projector

if TYPE_CHECKING:
    from ..actions import PlaceByCross
    from ..kinematics import Kinematics


def place_by_cross(kin: Kinematics, action: PlaceByCross) -> None:
    """Orientation of a shaft of known direction n from the cross of its universal joint.

    The second axis of the cross is b = unit(f x n), f being the first axis; the body axes are
    (n, b, n x b). Since b stays perpendicular to f, ``(omega - omega_parent) . (b x f) = 0``, and
    in body axes b x f = (f . (n x b), 0, -f . n). Singular set: the shaft along the first axis.
    """
    joint, body, program = action.joint, action.child, kin.program
    parent, record = kin.placed[action.parent], kin.on_line[body]
    local_axis = kin.local_direction(parent, joint.first_axis)
    axis = program.vector(f"{body}_first_axis", from_axes(parent.axes, local_axis))
    n = record.direction
    cross = program.vector(f"{body}_cross", axis.cross(n))
    squared = program.guarded(
        f"{body}_cross_squared",
        cross.dot(cross),
        f"the shaft {body} lies along the first axis of universal joint {joint.name}",
        "1",
    )
    lever = program.define(f"{body}_lever", sp.sqrt(squared))
    second = program.vector(f"{body}_second_axis", cross * (1 / lever))
    axes: Axes = (n, second, program.vector(f"{body}_third_axis", n.cross(second)))
    placed = Placed(
        body,
        origin=record.anchor_motion.position,
        axes=axes,
        design_origin=kin.design(record.anchor),
        design_axes=_cross_design_axes(kin, action, record),
        local={record.anchor: ZERO},
        carrier=(
            record.anchor_body,
            kin.local(kin.placed[record.anchor_body], record.anchor),
        ),
    )
    _cross_motion(kin, parent, record, placed, lever, program.define(f"{body}_tilt", axis.dot(n)))
    kin.placed[body] = placed


def _cross_design_axes(kin: Kinematics, action: PlaceByCross, record: OnLine) -> Axes:
    body = action.child
    n = kin.unit(f"{body}_line_design", kin.design(record.end) - kin.design(record.anchor))
    axis = kin.design_direction(action.joint.first_axis)
    second = kin.unit(f"{body}_second_design", axis.cross(n))
    return n, second, kin.program.vector(f"{body}_third_design", n.cross(second))


def _cross_motion(
    kin: Kinematics,
    parent: Placed,
    record: OnLine,
    placed: Placed,
    lever: sp.Expr,
    tilt: sp.Expr,
) -> None:
    body, program = placed.body, kin.program
    to_body = projector(kin, placed)
    hinge = Vector(lever, ZERO.y, -tilt)  # b x f
    grip = program.define(f"{body}_grip", 1 / lever)

    def parent_omega(label: str, v: Vector) -> Vector:
        return to_body(label, from_axes(parent.axes, v))

    names = dict.fromkeys([*record.anchor_motion.motion, *record.relative.motion, *parent.motion])
    for k in names:
        base = to_body(f"velocity_{k}", record.anchor_motion.motion.get(k, ZERO))
        across = line_omega(record, to_body(f"swing_{k}", record.relative.motion.get(k, ZERO)))
        carried = parent_omega(
            f"carried_{k}", parent.motion[k].angular if k in parent.motion else ZERO
        )
        turn = (hinge.dot(carried) - hinge.dot(across)) * grip
        placed.motion[k] = kin.define_twist(body, k, Twist(Vector(turn, across.y, across.z), base))

    def bias() -> Twist:
        omega = kin.total(placed).angular
        alpha = line_alpha(kin, record, omega, to_body("swing_bias", record.relative.bias))
        alpha = program.vector(f"{body}_alpha", alpha, "123")
        carried = parent_omega("carried", kin.total(parent).angular)
        carried_bias = parent_omega("carried_bias", parent.bias().angular)
        b, f = Vector.of(0, 1, 0), Vector(tilt, ZERO.y, lever)
        hinge_rate = omega.cross(b).cross(f) + b.cross(carried.cross(f))
        turn = (
            hinge.dot(carried_bias) - hinge.dot(alpha) - (omega - carried).dot(hinge_rate)
        ) * grip
        base = to_body("acceleration", record.anchor_motion.bias)
        return kin.define_bias(body, Twist(Vector(turn, alpha.y, alpha.z), base))

    placed.bias = once(bias)
