"""A body held by a rod: its turn about a line that is known."""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

from ..arithmetic import SignOf
from ..placement import Axes, OnLine, Placed, PointMotion
from ..vectors import ZERO, Twist, Vector
from .lines import line_alpha, line_omega, once, place_rod, projector
from .offset_turn import solve_offset_turn

if TYPE_CHECKING:
    from ..kinematics import Kinematics
    from ..transformer import SolveTurn


def solve_turn(kin: Kinematics, action: SolveTurn) -> None:
    r"""Turn a body about its known line until a rod fits (Eqs. 13 to 16).

    Let n be the direction of the line, F the foot on it of the rod's joint D, rho = \|FD\|, E the
    other end of the rod of length l, and w = E - F with parts w_n along n and w_p across it. The
    unit vector t from F to D is perpendicular to n, and ``|D - E| = l`` becomes

        t . w_p = k,    k = (rho^2 + |w_p|^2 + w_n^2 - l^2) / (2 rho),

    which is the paper's ``a1 cos + a2 sin = a3`` without a reference for the angle. Its solutions:

        t = (k w_p + s sqrt(|w_p|^2 - k^2) n x w_p) / |w_p|^2,    s = +1 or -1.

    Branch: s is the sign of (D - E) . (n x t) at the design position. Valid while
    ``|w_p|^2 > k^2``; the edge is the dead point where rod, D and the line are in one plane.

    The body axes are (n, t, n x t). In them D - E = (-w_n, rho - k, s sqrt(|w_p|^2 - k^2)), so the
    turning rate follows from ``(D - E) . (v_D - v_E) = 0`` with one division.
    """
    if action.body in kin.off_line:
        solve_offset_turn(kin, action)
        return
    record = kin.on_line[action.body]
    base_is_end = _is_end_link(kin, action.body, record)
    constants = _TurnConstants(kin, action, record, base_is_end=base_is_end)
    rod_anchor = kin.point_motion(action.anchor_body, action.anchor)
    placed, gap = _turned_axes(kin, action, record, constants, rod_anchor)
    _turn_motion(kin, action, record, constants, rod_anchor, placed, gap)
    kin.placed[action.body] = placed
    place_rod(kin, action, rod_anchor, constants.rod_length)


def _is_end_link(kin: Kinematics, body: str, record: OnLine) -> bool:
    """Tell whether a body holds the end point of the line and not its anchor."""
    return all(record.anchor != j.center for j in kin.mechanism.joints_of(body))


class _TurnConstants:
    """Dimensions of the body, from the design position."""

    def __init__(
        self, kin: Kinematics, action: SolveTurn, record: OnLine, *, base_is_end: bool
    ) -> None:
        body, program = action.body, kin.program
        self.base_is_end = base_is_end
        self.base = record.end if base_is_end else record.anchor
        self.base_motion = record.end_motion if base_is_end else record.anchor_motion
        self.carrier = record.end_body if base_is_end else record.anchor_body
        base, end, anchor = (kin.design(p) for p in (self.base, action.end, action.anchor))
        n = kin.unit(f"{body}_line_design", kin.design(record.end) - kin.design(record.anchor))
        arm = program.vector(f"{body}_arm_design", end - base)
        self.along = program.define(f"{body}_arm_along", arm.dot(n))
        across = program.vector(f"{body}_arm_across", arm - n * self.along)
        self.radius = program.define(f"{body}_arm_radius", sp.sqrt(across.dot(across)))
        t = program.vector(f"{body}_arm_unit", across * (1 / self.radius))
        m = program.vector(f"{body}_normal_design", n.cross(t))
        rod = program.vector(f"{action.rod}_design", end - anchor)
        self.rod_length = program.define(f"{action.rod}_length", sp.sqrt(rod.dot(rod)))
        self.branch = program.define(f"{body}_branch", SignOf(rod.dot(m)))
        self.design_origin, self.design_axes = base, (n, t, m)
        self.arm = Vector(self.along, self.radius, ZERO.z)


def _turned_axes(
    kin: Kinematics,
    action: SolveTurn,
    record: OnLine,
    constants: _TurnConstants,
    rod_anchor: PointMotion,
) -> tuple[Placed, Vector]:
    """Solve for t; return the placed body, and D - E in its axes."""
    body, program = action.body, kin.program
    n, rho = record.direction, constants.radius
    e = program.vector(f"{body}_reach", rod_anchor.position - record.anchor_motion.position)
    # from the span and not from its direction, so that nothing waits for the length's root
    on_span = program.define(f"{body}_reach_on_span", e.dot(record.span))
    part = program.define(f"{body}_reach_part", on_span * record.inverse_squared)
    along = program.define(f"{body}_reach_along", on_span * record.inverse_length)
    foot = constants.along + (record.length if constants.base_is_end else 0)
    w_n = program.define(f"{body}_reach_axial", along - foot)
    w_p = program.vector(f"{body}_reach_across", e - record.span * part)
    normal = program.vector(f"{body}_reach_normal", n.cross(e))
    squared = program.guarded(
        f"{body}_reach_squared",
        w_p.dot(w_p),
        f"{kin.loop_of(action)}: point {action.anchor.name} lies on the line of {body}, whose "
        "rotation is undetermined",
        "m^2",
    )
    k = program.define(
        f"{body}_reach_needed",
        (squared + w_n**2 + (rho**2 - constants.rod_length**2)) * (1 / (2 * rho)),
    )
    room = program.guarded(
        f"{body}_closure",
        squared - k**2,
        f"{kin.loop_of(action)} cannot close: the rod {action.rod} cannot reach {body}, beyond its "
        "dead point",
        "m^2",
    )
    root = program.define(f"{body}_closure_root", sp.sqrt(room))
    height = program.define(f"{body}_rod_height", constants.branch * root)
    inverse = program.define(f"{body}_reach_inverse", 1 / squared)
    signed = program.define(f"{body}_reach_inverse_signed", constants.branch * inverse)
    cosine = program.define(f"{body}_turn_cosine", k * inverse)
    sine = program.define(f"{body}_turn_sine", root * signed)
    axes: Axes = (
        n,
        program.vector(f"{body}_arm", w_p * cosine + normal * sine),
        program.vector(f"{body}_normal", normal * cosine - w_p * sine),
    )
    placed = Placed(
        body,
        origin=constants.base_motion.position,
        axes=axes,
        design_origin=constants.design_origin,
        design_axes=constants.design_axes,
        local={constants.base: ZERO, action.end: constants.arm},
        carrier=(constants.carrier, kin.local(kin.placed[constants.carrier], constants.base)),
    )
    gap = program.vector(f"{body}_rod", Vector(-w_n, rho - k, height), "123")
    return placed, gap


def _turn_motion(
    kin: Kinematics,
    action: SolveTurn,
    record: OnLine,
    constants: _TurnConstants,
    rod_anchor: PointMotion,
    placed: Placed,
    gap: Vector,
) -> None:
    """Velocities and bias: the line turns with its points, the rod keeps its length."""
    body, program = action.body, kin.program
    to_body = projector(kin, placed)
    arm = constants.arm
    hold = program.define(
        f"{body}_hold", 1 / (-constants.radius * constants.branch * (constants.branch * gap.z))
    )
    rod_rate = ZERO
    names = dict.fromkeys(
        [*constants.base_motion.motion, *record.relative.motion, *rod_anchor.motion]
    )
    for k in names:
        base = to_body(f"velocity_{k}", constants.base_motion.motion.get(k, ZERO))
        across = line_omega(record, to_body(f"swing_{k}", record.relative.motion.get(k, ZERO)))
        across = program.vector(f"{body}_omega_{k}", across, "123")
        anchor = to_body(f"rod_anchor_{k}", rod_anchor.motion.get(k, ZERO))
        slip = base - anchor + across.cross(arm)
        turn = program.define(f"{body}_turn_{k}", gap.dot(slip) * hold)
        omega = Vector(turn, across.y, across.z)
        placed.motion[k] = Twist(omega, base)
        rod_rate += (base - anchor + omega.cross(arm)) * kin.rate(k)

    def bias() -> Twist:
        rate = program.vector(f"{body}_rod_rate", rod_rate, "123")
        omega = kin.total(placed).angular
        base = to_body("acceleration", constants.base_motion.bias)
        anchor = to_body("rod_anchor_bias", rod_anchor.bias)
        alpha = line_alpha(kin, record, omega, to_body("swing_bias", record.relative.bias))
        alpha = program.vector(f"{body}_alpha", alpha, "123")
        whirl = program.vector(f"{body}_whirl", omega.cross(arm), "123")
        pull = base - anchor + omega.cross(whirl) + alpha.cross(arm)
        turn = program.define(f"{body}_turn_bias", (gap.dot(pull) + rate.dot(rate)) * hold)
        return Twist(Vector(turn, alpha.y, alpha.z), base)

    placed.bias = once(bias)
