"""A body held by a rod: its turn about a line that is known (Eqs. 13 to 16 of the paper).

The equation ``a1 cos + a2 sin = a3`` of the paper is that of `arm`, about a line between two points
that both move. Where a telescope misses the known point of the body, `offset_turn` solves it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import sympy as sp

from ..kinematics.extent import extent_squared
from ..kinematics.motion import OnLine, PointMotion, RodEnds
from .arm import Arm, Reach, add_turn_of_rod, fit_rod
from .held_by_leg import HeldByLeg
from .lines import place_rod
from .offset_turn import solve_offset_turn
from .rigid_rod import RigidRod
from .solved_motion import TurnOnLine, place_at
from .telescope import Telescope

if TYPE_CHECKING:
    from typing import Self

    from ..declare.geometry import Point
    from ..kinematics.kinematics import Kinematics
    from ..loops.cut import CutLoop
    from ..loops.known import Coordinate, Known


@dataclass(frozen=True)
class TurnByLength(HeldByLeg):
    """A body known up to a rotation about a line is held by a rod: its rotation follows."""

    leg: RigidRod

    rank: ClassVar[int] = 4

    @classmethod
    def match(cls, known: Known, cut: CutLoop) -> Self | None:
        """Return the turn of a body on a line that a rod from a placed point holds."""
        leg = RigidRod.match(known, cut)
        if leg is None or leg.anchor_body not in known.placed or leg.body not in known.on_line:
            return None
        return cls(leg)

    def accept(self, known: Known) -> set[Coordinate]:
        """Record the body, and the telescopes that it aims."""
        body, rod = self.leg.body, self.leg.rod
        known.place(body)
        known.on_line.add(rod)
        found = [s for s in known.steps if isinstance(s, Telescope) and s.ends.misses_end]
        aimed = [s.aim(known) for s in found if s.ends.end_link == body]
        joints = [joint for joints in aimed for joint in joints]
        joints += known.mechanism.joints_of(rod)
        joints += filter(known.joins, known.mechanism.joints_of(body))
        return known.add_all(joints)

    def emit(self, kin: Kinematics) -> None:
        """Turn the body about its known line until the rod fits."""
        leg = self.leg
        kin.turned[leg.body] = RodEnds(leg.body, leg.rod, leg.end, leg.anchor, leg.anchor_body)
        if leg.body in kin.off_line:
            solve_offset_turn(kin, self, leg)
            return
        record = kin.on_line[leg.body]
        base = _Base.of(kin, leg.body, record)
        line = kin.unit(
            f"{leg.body}_line_design", kin.design(record.end) - kin.design(record.anchor)
        )
        extent = extent_squared(kin, self)
        arm = Arm.of(kin, leg.body, line, base.point, leg.end, extent)
        rod_anchor = leg.anchor_motion(kin)
        reach = _reach(kin, leg.body, record, base, arm, rod_anchor)
        fit = fit_rod(kin, self, leg, arm, record.direction, reach)
        at, local = (base.carrier, base.point), {leg.end: arm.local}
        placed = place_at(kin, leg.body, at, fit.axes, arm.design_axes, local=local)
        unsolved = TurnOnLine(kin, placed, base.motion, record, record.inverse_length)
        add_turn_of_rod(kin, unsolved, fit, arm, rod_anchor)
        place_rod(kin, leg)


@dataclass(frozen=True)
class _Base:
    """The point of the line that is fixed in the body, and its distance from the anchor."""

    point: Point
    motion: PointMotion
    carrier: str
    from_anchor: sp.Expr

    @classmethod
    def of(cls, kin: Kinematics, body: str, record: OnLine) -> _Base:
        """Return the anchor of the line, or its end if the body holds only that."""
        if any(record.anchor == j.center for j in kin.mechanism.joints_of(body)):
            return cls(record.anchor, record.anchor_motion, record.anchor_body, sp.Integer(0))
        return cls(record.end, record.end_motion, record.end_body, record.length)


def _reach(
    kin: Kinematics, body: str, record: OnLine, base: _Base, arm: Arm, rod_anchor: PointMotion
) -> Reach:
    """Return the position of the rod's anchor relative to the line.

    From the span and not from its direction, so that no step waits for the root of the length.
    """
    program = kin.program
    e = program.vector(f"{body}_reach", rod_anchor.position - record.anchor_motion.position)
    on_span = program.define(f"{body}_reach_on_span", e.dot(record.span))
    part = program.define(f"{body}_reach_part", on_span * record.inverse_squared)
    along = program.define(f"{body}_reach_along", on_span * record.inverse_length)
    return Reach(
        program.define(f"{body}_reach_axial", along - (arm.along + base.from_anchor)),
        program.vector(f"{body}_reach_across", e - record.span * part),
        program.vector(f"{body}_reach_normal", record.direction.cross(e)),
    )
