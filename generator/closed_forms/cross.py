"""A shaft turned by its universal joint."""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

from ..kinematics.extent import require
from ..kinematics.motion import Axes, OnLine, Placed, from_axes, to_axes
from ..loops.actions import SolveTelescope
from ..program.floors import DIRECTION, LENGTH
from ..program.vectors import ZERO, Twist, Vector
from .lines import line_alpha, line_omega, once, projector

if TYPE_CHECKING:
    from ..kinematics.kinematics import Kinematics
    from ..loops.actions import PlaceByCross, PlaceIdle


def place_by_cross(kin: Kinematics, action: PlaceByCross) -> None:
    """Orientation of a shaft of known direction n from the cross of its universal joint.

    The second axis b of the cross is fixed in the shaft and perpendicular to n and to the first
    axis f. Both ``f x n`` and its opposite are that: two poses of the shaft, half a turn about its
    line apart. Branch: b = unit(f x n) at the design position, and so everywhere, since the two
    could change places only where f x n vanishes. Singular set: the shaft along the first axis.

    The body axes are (n, b, n x b). Since b stays perpendicular to f,
    ``(omega - omega_parent) . (b x f) = 0``, and in body axes b x f = (f . (n x b), 0, -f . n).

    That the shaft is declared along the line of the rod, n, is one of the `assumptions`.
    """
    joint, parent = action.joint, kin.placed[action.parent]
    _place(
        kin,
        action.child,
        parent,
        kin.local_direction(parent, joint.first_axis),
        kin.design_direction(joint.first_axis),
        f"the shaft {action.child} lies along the first axis of universal joint {joint.name}",
    )


def place_idle(kin: Kinematics, action: PlaceIdle) -> None:
    """Orientation of a link of known line whose turn about that line nothing holds.

    It has no mass, so its turn is nobody's business. It gets that of a cross at its first end, with
    an axis across the line at the design position.
    """
    body, record = action.body, _line(kin, action.body)
    parent = kin.placed[record.anchor_body]
    n = kin.unit(f"{body}_line_design", kin.design(record.end) - kin.design(record.anchor))
    axis, _ = kin.across(body, n)
    local = kin.program.vector(f"{body}_idle", to_axes(parent.design_axes, axis), "123")
    meaning = (
        f"the turn of {body} about its own line, which nothing holds, is not defined: the line has "
        f"turned by 90 degrees as seen from {record.anchor_body}"
    )
    _place(kin, body, parent, local, axis, meaning)


def _place(
    kin: Kinematics, body: str, parent: Placed, local_axis: Vector, at_design: Vector, meaning: str
) -> None:
    """Record pose, velocities and bias of a shaft, given the first axis of its cross.

    Parameters
    ----------
    local_axis, at_design
        The first axis: in the axes of its body, and at the design position.
    meaning
        What it means that the shaft lies along that axis.
    """
    program, record = kin.program, _line(kin, body)
    axis = program.vector(f"{body}_first_axis", from_axes(parent.axes, local_axis))
    n = record.direction
    cross = program.vector(f"{body}_cross", axis.cross(n))
    squared = program.guarded(f"{body}_cross_squared", cross.dot(cross), meaning, "1", DIRECTION)
    lever = program.define(f"{body}_lever", sp.sqrt(squared))
    second = program.vector(f"{body}_second_axis", cross * (1 / lever))
    axes: Axes = (n, second, program.vector(f"{body}_third_axis", n.cross(second)))
    placed = Placed(
        body,
        origin=record.anchor_motion.position,
        axes=axes,
        design_origin=kin.design(record.anchor),
        design_axes=_cross_design_axes(kin, body, record, at_design, meaning),
        local={record.anchor: ZERO},
        carrier=(
            record.anchor_body,
            kin.local(kin.placed[record.anchor_body], record.anchor),
        ),
    )
    _cross_motion(kin, parent, record, placed, lever, program.define(f"{body}_tilt", axis.dot(n)))
    kin.placed[body] = placed


def _line(kin: Kinematics, body: str) -> OnLine:
    """Return the line of a link, from a point of the link on."""
    record = kin.on_line[body]
    far = [a.end_link for a in kin.plan.actions if isinstance(a, SolveTelescope)]
    return record.reversed() if body in far else record


def _cross_design_axes(
    kin: Kinematics, body: str, record: OnLine, axis: Vector, meaning: str
) -> Axes:
    program = kin.program
    n = kin.unit(f"{body}_line_design", kin.design(record.end) - kin.design(record.anchor))
    across = program.vector(f"{body}_cross_design", axis.cross(n))
    require(
        kin,
        f"{body}_cross_design",
        sp.sqrt(across.dot(across)),
        LENGTH,
        "1",
        f"at the design position, {meaning}",
        "turn that axis, or move an end of the shaft",
    )
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
