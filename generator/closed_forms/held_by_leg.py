"""Closed forms of a body with one degree of freedom left that a leg holds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from typing_extensions import override

from ..kinematics.motion import Meeting
from ..loops.forms import ClosedForm
from .leg import held_on

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Self

    from ..declare.geometry import Point
    from ..declare.joints import Joint
    from ..kinematics.kinematics import Kinematics
    from ..kinematics.step import Ends
    from ..loops.cut import CutLoop
    from ..loops.forms import Closing
    from ..loops.known import Coordinate, Known
    from .leg import Leg


class HeldByLeg(ClosedForm):
    """A body that a leg holds."""

    leg: Leg

    @property
    def about(self) -> str:
        return self.leg.body

    @property
    def title(self) -> str:
        return f"transformer: {self.leg.body} held by {self.leg.rod}"

    @property
    def points(self) -> tuple[Point, ...]:
        return self.leg.points

    def lines(self) -> Iterator[Ends]:
        yield self.leg.rod, self.leg.anchor, self.leg.end

    @override
    def words(self, closing: Closing | None) -> tuple[str, str]:
        return f"{self.leg.ends} = length of {self.leg.measure}", self.solution

    @property
    def solution(self) -> str:
        """Solution of the equation, for the report."""
        about = self.leg.body
        return f"a cos x + b sin x = c for the turn of {about} about its line, branch as at design"


@dataclass(frozen=True)
class HeldOnJoint(HeldByLeg):
    """A body on a joint of a placed body is held by a leg: the joint's coordinate follows."""

    # joint, and the placed body that carries it
    joint: Joint
    parent: str
    leg: Leg

    kind: ClassVar[type[Joint]]  # class of the joint

    @classmethod
    def match(cls, known: Known, cut: CutLoop) -> Self | None:
        """Return the coordinate of a body that a leg holds from a placed one."""
        held = held_on(known, cut)
        return cls(*held) if held and isinstance(held[0], cls.kind) else None

    def accept(self, known: Known) -> set[Coordinate]:
        """Record the body that the leg drives, and the leg."""
        known.placed.add(self.leg.body)
        return self.leg.record(known, self.joint)

    def meet(self, kin: Kinematics) -> None:
        """Record the points that the leg keeps apart, for the residual."""
        leg = self.leg
        kin.meetings.setdefault(
            self.joint.name,
            Meeting(self.parent, leg.body, leg.end, leg.anchor, leg.anchor_body, leg.rod),
        )
