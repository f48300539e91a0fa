"""A body on a hinge, held by a leg: two ball joints and a hinge, or three hinges.

Turn a body about its hinge until a rod fits: two ball joints and a hinge, or three hinges.

The equation is that of `arm`, about the axis of the hinge, which is fixed in the parent. In a
plane w_n is zero, and this is the dyad of three hinges. A telescope of known slide may be the
rod: boom, cylinder and chassis of a crane, driven by the stroke.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from ..declare.joints import Revolute
from ..kinematics.extent import extent_squared
from ..kinematics.motion import Meeting
from ..loops.forms import ClosedForm
from .arm import Reach, fit_rod
from .hinge import Condition, Hinge, place_on_hinge, report_angle
from .leg import held_on
from .lines import place_rod

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Self

    from ..declare.geometry import Point
    from ..kinematics.kinematics import Kinematics
    from ..kinematics.step import Ends
    from ..loops.cut import CutLoop
    from ..loops.forms import Closing
    from ..loops.known import Coordinate, Known
    from .leg import Leg


@dataclass(frozen=True)
class RevoluteByLength(ClosedForm):
    """A body on a hinge of a placed body is held by a leg: its angle follows."""

    joint: Revolute
    parent: str
    leg: Leg

    rank: ClassVar[int] = 5

    @classmethod
    def match(cls, known: Known, cut: CutLoop) -> Self | None:
        """Return the turn of a body that a leg holds from a placed one."""
        held = held_on(known, cut)
        if held is None:
            return None
        joint, parent, leg = held
        return cls(joint, parent, leg) if isinstance(joint, Revolute) else None

    @property
    def about(self) -> str:
        """The body that is held."""
        return self.leg.body

    @property
    def title(self) -> str:
        """What the derivation calls this step."""
        return f"transformer: {self.leg.body} held by {self.leg.rod}"

    @property
    def points(self) -> tuple[Point, ...]:
        """The ends of the leg."""
        return self.leg.points

    def accept(self, known: Known) -> set[Coordinate]:
        """Record the body that the leg drives, and the leg."""
        known.placed.add(self.leg.body)
        return self.leg.hold(known, self.joint)

    def lines(self) -> Iterator[Ends]:
        """Yield the rod, along its line."""
        yield self.leg.rod, self.leg.anchor, self.leg.end

    def words(self, closing: Closing | None) -> tuple[str, str]:
        """Return the closure equation and its solution."""
        del closing
        return f"{self.leg.ends} = length of {self.leg.measure}", (
            f"a cos x + b sin x = c for the turn of {self.leg.body} about its line, branch as at "
            "design"
        )

    def carry_out(self, kin: Kinematics) -> None:
        """Turn the body about its hinge until the leg fits."""
        leg = self.leg
        kin.meetings.setdefault(
            self.joint.name,
            Meeting(self.parent, leg.body, leg.end, leg.anchor, leg.anchor_body, leg.rod),
        )
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
        place_on_hinge(kin, hinge, fit.axes, Condition(anchor, fit.gap, fit.hold, fit.rod))
        report_angle(kin, hinge, fit.axes)
        if not leg.pinned:
            place_rod(kin, leg, anchor, fit.rod.length)
