"""A body held by a rod, with a telescope whose axis misses the body's known point."""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

from ..kinematics.extent import extent_squared, require
from ..kinematics.motion import BodyMotion, OffLine, OnLine, PointMotion
from ..program.floors import BRANCH, NORMAL, ROOT
from ..program.functions import SignOf
from ..program.vectors import ZERO, Axes, Vector
from .constraints import FixedDistance
from .lines import axes_about, place_rod
from .solved_motion import ClosureCondition, TargetPoint, TurnOnLine, add_turn, place_at, projector

if TYPE_CHECKING:
    from ..kinematics.extent import Spanning
    from ..kinematics.kinematics import Kinematics
    from .leg import Leg


def solve_offset_turn(kin: Kinematics, step: Spanning, leg: Leg) -> None:
    r"""Find the orientation of a body from three of its points, two of them by distance.

    Let B be the known point of the body and C the anchor of the telescope, S = B - C. The axis of
    the telescope runs through C, fixed in the body's axes (e1 along it), so that in body axes

        S = (h, o2, o3),    D - B = (a, rho, 0),

    with the reach h from `telescope` and the constant offset (o2, o3) of B from the axis. The rod
    from E, with length l, ends at D; let w = E - B. Both products

        (D - B) . S = a h + rho o2 = s1,    (D - B) . w = (|D - B|^2 + |w|^2 - l^2) / 2 = s2

    are known, and so is |D - B|. Hence D - B = u S + v w + c N with N = S x w,

        u = (s1 |w|^2 - s2 S.w) / |N|^2,    v = (s2 |S|^2 - s1 S.w) / |N|^2,
        c = s sqrt(room) / |N|,    room = |D - B|^2 - u s1 - v s2,    s = +1 or -1,

    the equation ``a1 cos + a2 sin = a3`` of the turn about S without a reference for the angle.
    Branch: s is the sign of (D - B) . N at the design position. Valid while room > 0; the edge is
    the dead point where B, C, D and E are in one plane. Singular: E or D on the line through B, C.

    The body axes follow from S, D - B and their vector product, known in both axes. Velocity: C
    moves along e1 only, seen from the body, so that with Delta = v_B - v_C, in body axes,

        omega = (0, -Delta3, Delta2) / h + omega1 (1, o2 / h, o3 / h),

    and the turn omega1 follows from ``(D - E) . (v_D - v_E) = 0``, whose factor is c |N|^2 / h.
    With offset zero this is `turn`, at a higher price.
    """
    record = kin.off_line[leg.body]
    rod_anchor = leg.anchor_motion(kin)
    turn = _OffsetTurn(kin, step, leg, record, rod_anchor)
    place_rod(kin, leg)
    _aim(kin, record, turn.placed)


class _OffsetTurn:
    """The solution for one body, from its dimensions to its bias acceleration."""

    def __init__(
        self, kin: Kinematics, step: Spanning, leg: Leg, record: OffLine, rod_anchor: PointMotion
    ) -> None:
        self.kin, self.program = kin, kin.program
        self.step, self.leg, self.record, self.rod_anchor = step, leg, record, rod_anchor
        self.body = leg.body
        self._dimensions()
        self._position()
        self._motion()

    def _dimensions(self) -> None:
        """Constants of the body, from the design position."""
        kin, program, body = self.kin, self.program, self.body
        telescope, e1 = self.record.ends, self.record.axis
        self.base = telescope.end
        base, end, anchor = (kin.design(p) for p in (self.base, self.leg.end, self.leg.anchor))
        arm = program.vector(f"{body}_arm_design", end - base)
        (e1, e2, e3), self.arm = axes_about(kin, f"{body}_arm", e1, arm)
        rod = program.vector(f"{self.leg.rod}_design", end - anchor)
        self.rod_length = program.define(f"{self.leg.rod}_length", sp.sqrt(rod.dot(rod)))
        kin.rod_lengths[self.leg.rod] = self.rod_length
        span = kin.design(self.base) - kin.design(telescope.anchor)
        self.extent = extent_squared(kin, self.step)
        self._require(arm, span, anchor - base)
        self.branch = program.define(f"{body}_branch", SignOf(arm.dot(span.cross(anchor - base))))
        self.arm_squared = program.define(f"{body}_arm_squared", self.arm.dot(self.arm))
        self.offset = Vector(
            ZERO.x,
            program.define(f"{body}_offset_2", self.record.offset.dot(e2)),
            program.define(f"{body}_offset_3", self.record.offset.dot(e3)),
        )
        self.span = self.offset + Vector(self.record.reach, ZERO.y, ZERO.z)
        self.design_axes = (e1, e2, e3)

    def _require(self, arm: Vector, span: Vector, reach: Vector) -> None:
        """Have `prepare` check that the design position is away from all singular sets."""
        kin, body, leg = self.kin, self.body, self.leg
        size = sp.sqrt(self.extent)
        line = f"the line of {self.base.name} and {self.record.ends.anchor.name}"
        for name, point, way in (("arm", leg.end, arm), ("reach", leg.anchor, reach)):
            normal = self.program.vector(f"{body}_{name}_across_span", span.cross(way))
            require(
                kin,
                f"{body}_{name}_off_span",
                sp.sqrt(normal.dot(normal) / span.dot(span)),
                sp.sqrt(NORMAL) * self.extent / sp.sqrt(span.dot(span)),
                "m",
                f"at the design position, {point.name} is on {line}, about which {body} turns",
                f"move {point.name} away from that line",
            )
        normal = self.program.vector(f"{body}_reach_across_span", span.cross(reach))
        require(
            kin,
            f"{body}_height_design",
            arm.dot(normal) / sp.sqrt(normal.dot(normal)),
            BRANCH * size,
            "m",
            f"at the design position the rod {leg.rod} is at its dead point: it and {line} are "
            "in one plane",
            f"choose a design position where {leg.anchor.name} is beside that plane",
        )

    def _position(self) -> None:
        """Solve for D - B, then for the axes of the body."""
        program, body, record = self.program, self.body, self.record
        w = program.vector(f"{body}_reach", self.rod_anchor.position - record.end_motion.position)
        normal = program.vector(f"{body}_reach_normal", record.span.cross(w))
        self.normal_squared = program.guarded(
            f"{body}_reach_squared",
            normal.dot(normal),
            f"{self.kin.loop_of(self.step)}: point {self.leg.anchor.name} lies on the line of "
            f"{body}, whose rotation is undetermined",
            "m^4",
            NORMAL * self.extent**2,
        )
        along_span = program.define(f"{body}_arm_on_span", self.arm.dot(self.span))
        slant = program.define(f"{body}_reach_on_span", w.dot(record.span))
        distance = program.define(f"{body}_reach_distance_squared", w.dot(w))
        needed = program.define(
            f"{body}_reach_needed",
            (distance + (self.arm_squared - self.rod_length**2)) * sp.Rational(1, 2),
        )
        inverse = program.define(f"{body}_reach_inverse", 1 / self.normal_squared)
        u = program.define(
            f"{body}_share_of_span", (along_span * distance - needed * slant) * inverse
        )
        v = program.define(
            f"{body}_share_of_reach", (needed * record.span_squared - along_span * slant) * inverse
        )
        room = program.guarded(
            f"{body}_closure",
            self.arm_squared - u * along_span - v * needed,
            f"{self.kin.loop_of(self.step)} cannot close: the rod {self.leg.rod} cannot reach "
            f"{body}, beyond its dead point",
            "m^2",
            ROOT * self.extent,
        )
        self.height = program.define(
            f"{body}_share_of_normal", self.branch * sp.sqrt(room * inverse)
        )
        arm = program.vector(f"{body}_arm_now", record.span * u + w * v + normal * self.height)
        self.placed = place_at(
            self.kin,
            body,
            (record.ends.end_body, self.base),
            self._axes(arm, along_span),
            self.design_axes,
            local={
                self.leg.end: self.arm,
                record.ends.axis_point: Vector(record.lead, ZERO.y, ZERO.z) - self.offset,
            },
        )
        seen = projector(self.kin, self.placed)("reach_seen", w)
        self.rod_vector = program.vector(f"{body}_rod", self.arm - seen, "123")

    def _axes(self, arm: Vector, along_span: sp.Expr) -> Axes:
        """Return the body axes from S, D - B and their product, in work and in body axes."""
        program, body, span = self.program, self.body, self.record.span
        third = program.vector(f"{body}_plane_normal", span.cross(arm))
        third_local = program.vector(f"{body}_plane_local", self.span.cross(self.arm), "123")
        squared = program.guarded(
            f"{body}_plane_squared",
            third_local.dot(third_local),
            f"point {self.leg.end.name} lies on the line of {body}",
            "m^4",
            NORMAL * self.extent**2,
        )
        inverse = program.define(f"{body}_plane_inverse", 1 / squared)
        of_span = self.span * self.arm_squared - self.arm * along_span
        of_arm = self.arm * self.record.span_squared - self.span * along_span
        weights = zip("123", of_span, of_arm, third_local, strict=True)
        axes = []
        for i, a, b, c in list(weights)[:2]:
            axis = (
                span * program.define(f"{body}_weight_{i}_of_span", a * inverse)
                + arm * program.define(f"{body}_weight_{i}_of_arm", b * inverse)
                + third * program.define(f"{body}_weight_{i}_of_normal", c * inverse)
            )
            axes.append(program.vector(f"{body}_axis_{i}", axis))
        return axes[0], axes[1], program.vector(f"{body}_axis_3", axes[0].cross(axes[1]))

    def _motion(self) -> None:
        """Velocities and bias: C stays on the axis, the rod keeps its length."""
        program, body, record = self.program, self.body, self.record
        inverse = record.inverse_reach
        sway = Vector(
            sp.Integer(1),
            program.define(f"{body}_sway_2", self.offset.y * inverse),
            program.define(f"{body}_sway_3", self.offset.z * inverse),
        )
        lever = self.height * self.normal_squared
        inverse_lever = program.define(f"{body}_inverse_lever", -record.reach / lever)
        line = TurnOnLine(self.kin, self.placed, record.end_motion, record, inverse, sway)
        length = FixedDistance(
            self.rod_vector, self.arm - self.rod_vector, self.arm, self.rod_length**2
        )
        target = TargetPoint(self.kin, self.placed, self.rod_anchor)
        add_turn(self.kin, line, ClosureCondition(length, target, self.arm), inverse_lever)


def _aim(kin: Kinematics, record: OffLine, placed: BodyMotion) -> None:
    """Record the direction of the telescope, from the pose of its body."""
    ends = record.ends
    end = kin.point_motion(placed.body, ends.axis_point)
    inverse = kin.program.define(f"inverse_length_{ends.joint.name}", 1 / record.length)
    line = OnLine(
        ends.anchor,
        ends.axis_point,
        record.anchor_motion,
        end,
        ends.anchor_body,
        placed.body,
        placed.axes[0],
        record.length,
        inverse,
        end.minus(record.anchor_motion),
        record.length_motion,
        placed.axes[0] * record.length,
        inverse**2,
    )
    kin.on_line[ends.anchor_link] = line
    kin.telescopes[ends.joint.name] = line
