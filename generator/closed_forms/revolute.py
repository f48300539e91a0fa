"""A body on a hinge, held by a leg: two ball joints and a hinge, or three hinges.

The equation is that of `arm`, about the axis of the hinge, which is fixed in the parent. In a
plane w_n is zero, and this is the dyad of three hinges. A telescope of known slide may be the
rod: boom, cylinder and chassis of a crane, driven by the stroke.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from ..declare.joints import Revolute
from ..kinematics.extent import extent_squared
from .arm import Reach, add_turn_of_rod, fit_rod
from .held_by_leg import HeldOnJoint
from .hinge import Hinge, place_on_hinge, report_angle
from .lines import place_rod

if TYPE_CHECKING:
    from ..kinematics.kinematics import Kinematics


@dataclass(frozen=True)
class RevoluteByLength(HeldOnJoint):
    """A body on a hinge of a placed body is held by a leg: its angle follows."""

    joint: Revolute

    rank: ClassVar[int] = 5
    kind = Revolute

    def emit(self, kin: Kinematics) -> None:
        """Turn the body about its hinge until the leg fits."""
        leg = self.leg
        self.meet(kin)
        program, body = kin.program, leg.body
        hinge = Hinge.of(kin, body, self.joint, self.parent, leg.end, extent_squared(kin, self))
        anchor = leg.anchor_motion(kin)
        e = program.vector(f"{body}_reach", anchor.position - hinge.origin.position)
        along = program.define(f"{body}_reach_along", e.dot(hinge.axis))
        reach = Reach(
            program.define(f"{body}_reach_axial", along - hinge.arm.along),
            program.vector(f"{body}_reach_across", e - hinge.axis * along),
            program.vector(f"{body}_reach_normal", hinge.axis.cross(e)),
        )
        fit = fit_rod(kin, self, leg, hinge.arm, hinge.axis, reach)
        add_turn_of_rod(kin, place_on_hinge(kin, hinge, fit.axes), fit, hinge.arm, anchor)
        report_angle(kin, hinge, fit.axes)
        if not leg.pinned:
            place_rod(kin, leg)
