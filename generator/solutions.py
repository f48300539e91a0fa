"""The catalogue of closed forms.

Each entry solves one kind of closure for position, velocity and bias acceleration. Velocities are
those of the implicit equation, ``g_x x' = -g_u u'``, so the linear factor of the velocity level
serves the acceleration level again. Everything is written in the axes that the solution itself
gives to the body (line, steering arm, normal), in which most components vanish.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

from .arithmetic import SignOf
from .placement import Axes, OnLine, Placed, PointMotion, from_axes, to_axes
from .vectors import ZERO, Twist, Vector

if TYPE_CHECKING:
    from collections.abc import Callable

    from .geometry import Point
    from .kinematics import Kinematics
    from .transformer import PlaceByCross, SolveTelescope, SolveTurn


# -- distance along a telescope -----------------------------------------------------------------


def solve_telescope(kin: Kinematics, action: SolveTelescope) -> None:
    """Length and direction of a telescope between two known points (Eqs. 6 to 8).

    Equation: ``|P_end - P_anchor| = length``, explicit in the slide, ``slide = p - length``.
    Branch: the positive length. Singular set: the two points coincide.
    """
    anchor = kin.point_motion(action.anchor_body, action.anchor)
    end = kin.point_motion(action.end_body, action.end)
    name = action.joint.name
    relative = end.minus(anchor)
    span = kin.program.vector(f"span_{name}", relative.position)
    squared = kin.program.guarded(
        f"length_squared_{name}",
        span.dot(span),
        f"{kin.loop_of(action)}: the ends {action.anchor.name} and {action.end.name} of telescope "
        f"{name} coincide",
        "m^2",
    )
    length = kin.program.define(f"length_{name}", sp.sqrt(squared))
    record = _line(
        kin,
        name,
        (action.anchor, action.end),
        (anchor, end),
        (action.anchor_body, action.end_body),
        span,
        length,
    )
    kin.on_line[action.anchor_link] = record
    kin.on_line[action.end_link] = record
    kin.telescopes[name] = record
    kin.slides[name] = kin.program.define(
        f"slide_{name}", sp.Symbol(action.joint.length_at_zero_slide) - length
    )


def _line(
    kin: Kinematics,
    name: str,
    points: tuple[Point, Point],
    motions: tuple[PointMotion, PointMotion],
    bodies: tuple[str, str],
    span: Vector,
    length: sp.Expr,
) -> OnLine:
    """Describe the line between two points of known motion."""
    inverse = kin.program.define(f"inverse_length_{name}", 1 / length)
    direction = kin.program.vector(f"direction_{name}", span * inverse)
    relative = motions[1].minus(motions[0])
    motion = {
        k: kin.program.define(f"d_length_{name}_{k}", direction.dot(v))
        for k, v in relative.motion.items()
    }
    return OnLine(*points, *motions, *bodies, direction, length, inverse, relative, motion)


# -- a body held by a rod -----------------------------------------------------------------------


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
    record = kin.on_line[action.body]
    base_is_end = _is_end_link(kin, action.body, record)
    constants = _TurnConstants(kin, action, record, base_is_end=base_is_end)
    rod_anchor = kin.point_motion(action.anchor_body, action.anchor)
    placed, gap = _turned_axes(kin, action, record, constants, rod_anchor)
    _turn_motion(kin, action, record, constants, rod_anchor, placed, gap)
    kin.placed[action.body] = placed
    _place_rod(kin, action, rod_anchor, constants.rod_length)


def _is_end_link(kin: Kinematics, body: str, record: OnLine) -> bool:
    """Tell whether a telescope's link is the one at the end point of the line."""
    return any(record.end == j.center for j in kin.mechanism.joints_of(body))


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
    along = program.define(f"{body}_reach_along", e.dot(n))
    foot = constants.along + (record.length if constants.base_is_end else 0)
    w_n = program.define(f"{body}_reach_axial", along - foot)
    w_p = program.vector(f"{body}_reach_across", e - n * along)
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
    height = program.define(f"{body}_rod_height", constants.branch * sp.sqrt(room))
    inverse = program.define(f"{body}_reach_inverse", 1 / squared)
    cosine = program.define(f"{body}_turn_cosine", k * inverse)
    sine = program.define(f"{body}_turn_sine", height * inverse)
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
    to_body = _projector(kin, placed)
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
        across = _line_omega(record, to_body(f"swing_{k}", record.relative.motion.get(k, ZERO)))
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
        alpha = _line_alpha(kin, record, omega, to_body("swing_bias", record.relative.bias))
        alpha = program.vector(f"{body}_alpha", alpha, "123")
        whirl = program.vector(f"{body}_whirl", omega.cross(arm), "123")
        pull = base - anchor + omega.cross(whirl) + alpha.cross(arm)
        turn = program.define(f"{body}_turn_bias", (gap.dot(pull) + rate.dot(rate)) * hold)
        return Twist(Vector(turn, alpha.y, alpha.z), base)

    placed.bias = _once(bias)


def _line_omega(record: OnLine, swing: Vector) -> Vector:
    """Return the angular velocity of a line across itself, in body axes (line first).

    From ``d(span)/dt = length' n + length (omega x n)``.
    """
    return Vector(ZERO.x, -swing.z * record.inverse_length, swing.y * record.inverse_length)


def _line_alpha(kin: Kinematics, record: OnLine, omega: Vector, swing: Vector) -> Vector:
    """Return the angular bias acceleration of a line across itself, in body axes (line first).

    The second derivative of ``span = length n``, in its two components across the line.
    """
    rates = (motion * kin.rate(k) for k, motion in record.length_motion.items())
    twice = 2 * sum(rates, sp.Integer(0))
    return Vector(
        ZERO.x,
        omega.x * omega.z - (swing.z + twice * omega.y) * record.inverse_length,
        (swing.y - twice * omega.z) * record.inverse_length - omega.x * omega.y,
    )


def _place_rod(
    kin: Kinematics, action: SolveTurn, rod_anchor: PointMotion, length: sp.Expr
) -> None:
    """Record the line of the rod, from its anchor to the body that it holds."""
    end = kin.point_motion(action.body, action.end)
    span = kin.program.vector(f"span_{action.rod}", end.position - rod_anchor.position)
    kin.on_line[action.rod] = _line(
        kin,
        action.rod,
        (action.anchor, action.end),
        (rod_anchor, end),
        (action.anchor_body, action.body),
        span,
        length,
    )


# -- a shaft turned by its universal joint ------------------------------------------------------


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
        carrier=(action.parent, kin.local(parent, record.anchor)),
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
    to_body = _projector(kin, placed)
    hinge = Vector(lever, ZERO.y, -tilt)  # b x f
    grip = program.define(f"{body}_grip", 1 / lever)

    def parent_omega(label: str, v: Vector) -> Vector:
        return to_body(label, from_axes(parent.axes, v))

    names = dict.fromkeys([*record.anchor_motion.motion, *record.relative.motion, *parent.motion])
    for k in names:
        base = to_body(f"velocity_{k}", record.anchor_motion.motion.get(k, ZERO))
        across = _line_omega(record, to_body(f"swing_{k}", record.relative.motion.get(k, ZERO)))
        carried = parent_omega(
            f"carried_{k}", parent.motion[k].angular if k in parent.motion else ZERO
        )
        turn = (hinge.dot(carried) - hinge.dot(across)) * grip
        placed.motion[k] = kin.define_twist(body, k, Twist(Vector(turn, across.y, across.z), base))

    def bias() -> Twist:
        omega = kin.total(placed).angular
        alpha = _line_alpha(kin, record, omega, to_body("swing_bias", record.relative.bias))
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

    placed.bias = _once(bias)


# -- shared -------------------------------------------------------------------------------------


def _projector(kin: Kinematics, placed: Placed) -> Callable[[str, Vector], Vector]:
    """Return a function that appends the body components of a work vector."""

    def to_body(label: str, v: Vector) -> Vector:
        return kin.program.vector(f"{placed.body}_{label}", to_axes(placed.axes, v), "123")

    return to_body


def _once(compute: Callable[[], Twist]) -> Callable[[], Twist]:
    """Compute a bias on first use only: many functions never need it."""
    cache: list[Twist] = []

    def bias() -> Twist:
        if not cache:
            cache.append(compute())
        return cache[0]

    return bias
