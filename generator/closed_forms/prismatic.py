r"""A body on a guide, held by a leg: two ball joints and a guide; slider-crank.

Let d be the direction of the guide, D_0 the rod's joint at zero slide, E the other end of the
rod of length l, and w = E - D_0. Then ``|D_0 + x d - E| = l`` is a quadratic in the slide x:

    x = d . w + s sqrt(l^2 - |w - (d . w) d|^2),    s = +1 or -1.

Branch: s is the sign of d . (D - E) at the design position. Valid while the root is real; the
edge is the dead point where the rod is perpendicular to the guide. The rate follows from
``(D - E) . (v_D - v_E) = l l'``, whose factor is (D - E) . d = s sqrt(...) and whose right side
is zero but for a telescope of known slide (`leg`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import sympy as sp

from ..declare.joints import Prismatic
from ..kinematics.extent import extent_squared, require
from ..program.floors import BRANCH, ROOT
from ..program.functions import SignOf
from ..program.vectors import from_axes
from .constraints import FixedDistance
from .held_by_leg import HeldOnJoint
from .lines import place_rod
from .solved_motion import ClosureCondition, SlideOnGuide, TargetPoint, add_turn, projector

if TYPE_CHECKING:
    from ..kinematics.kinematics import Kinematics
    from .leg import RodLeg


@dataclass(frozen=True)
class PrismaticByLength(HeldOnJoint):
    """A body on a guide of a placed body is held by a leg: its slide follows."""

    joint: Prismatic

    rank: ClassVar[int] = 6
    kind = Prismatic

    @property
    def solution(self) -> str:
        return f"quadratic in the slide of {self.joint.name}, branch as at design"

    def emit(self, kin: Kinematics) -> None:
        """Move the body along its guide until the leg fits."""
        leg = self.leg
        self.meet(kin)
        program, body, joint = kin.program, leg.body, self.joint
        parent = kin.placed[self.parent]
        local = kin.local_direction(parent, joint.direction)
        d = program.vector(f"{body}_guide", from_axes(parent.axes, local))
        anchor = leg.anchor_motion(kin)
        rod = leg.rod_of(kin, self)
        extent = extent_squared(kin, self)
        branch = self._branch(kin, rod, extent)
        start = program.vector(
            f"{body}_start", parent.origin + from_axes(parent.axes, kin.local(parent, leg.end))
        )
        w = program.vector(f"{body}_reach", anchor.position - start)
        along = program.define(f"{body}_reach_along", w.dot(d))
        across = program.vector(f"{body}_reach_across", w - d * along)
        room = program.guarded(
            f"{body}_closure",
            rod.squared - across.dot(across),
            f"{kin.loop_of(self)} cannot close: the {rod.name} is too short to reach the guide "
            f"of {body}",
            "m^2",
            ROOT * extent,
        )
        root = program.define(f"{body}_closure_root", sp.sqrt(room))
        slide = program.define(f"{body}_slide", along + branch * root)
        sense = 1 if joint.second.name == body else -1
        kin.slides[joint.name] = sense * slide
        offset = local * slide
        unsolved = SlideOnGuide(kin, body, parent, offset, [local])
        placed = unsolved.placed
        arm = kin.local(placed, leg.end)
        rod_vector = projector(kin, placed)("rod", d * (branch * root) - across)
        length = FixedDistance(rod_vector, arm - rod_vector, arm, rod.squared)
        add_turn(
            kin,
            unsolved,
            ClosureCondition(length, TargetPoint(kin, placed, anchor), arm, rod),
            program.define(f"{body}_inverse_lever", -branch / root),
        )
        if not leg.pinned:
            place_rod(kin, leg)

    def _branch(self, kin: Kinematics, rod: RodLeg, extent: sp.Expr) -> sp.Expr:
        """Return the sign of the side of its foot on which the leg is at the design position."""
        leg, body = self.leg, self.leg.body
        along = rod.design.dot(kin.design_direction(self.joint.direction))
        drawn = kin.program.define(f"{body}_rod_along_design", along)
        require(
            kin,
            f"{body}_rod_along_design",
            drawn,
            BRANCH * sp.sqrt(extent),
            "m",
            f"at the design position the {rod.name} is at its dead point: it is perpendicular "
            f"to the "
            f"guide of {body}",
            f"move {leg.anchor.name} or {leg.end.name} along the guide",
        )
        return kin.program.define(f"{body}_branch", SignOf(drawn))
