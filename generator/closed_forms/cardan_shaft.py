r"""A shaft that telescopes between two universal joints, as between steering column and pinion.

Two links on a guide along their common line are held by a cross each: one on a placed body, the
*driving* one, the other on a body that is *driven*, on a hinge through the centre of its cross. So
both centres are known, and with them the line n and the length. The cross on the driving body turns
the shaft about its line (`universal_joint`), and both links alike, since the guide does not turn.
The driven body turns on its hinge until its cross fits (`yoke`). Beside the singular set of `yoke`,
the shaft must not lie along the first axis of the driving cross.

The phase of the two yokes is the angle between the second axes of both crosses about n, a constant
that follows from the two first axes at the design position.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import sympy as sp
from typing_extensions import override

from ..declare.joints import Revolute, Universal
from ..loops.forms import ClosedForm
from ..program.conditions import Assumption
from ..program.functions import SignOf
from .guided_pair import GuidedPair
from .lines import line_of_ends
from .turned_alike import place_turned_alike
from .universal_joint import turn_with
from .yoke import DrivenYoke, GivenAxis, norm, second_axis, through_center, turn_through_cross

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Self

    from ..declare.geometry import Point
    from ..kinematics.kinematics import Kinematics
    from ..kinematics.motion import BodyMotion, OnLine
    from ..kinematics.step import Ends
    from ..loops.cut import CutLoop
    from ..loops.forms import Closing
    from ..loops.known import Coordinate, Known


@dataclass(frozen=True)
class CardanShaft(ClosedForm):
    """A placed body turns another one on its hinge, through two crosses and a sliding shaft."""

    shaft: GuidedPair  # two links, from the cross on the driving body to that on the driven one
    # two crosses; the shaft is the second body of each
    driving: Universal
    driven: Universal
    # that of the driven body, and the placed body at the other side of it
    hinge: Revolute
    parent: str

    rank: ClassVar[int] = 8
    equations: ClassVar[tuple[int, ...]] = (2,)
    """Cut at both crosses: the slide and the angle of the hinge remain."""

    @classmethod
    def match(cls, known: Known, cut: CutLoop) -> Self | None:
        """Return the shaft that is one arc of a loop; the other arc ends with the driven body."""
        shaft = GuidedPair.match(cut)
        if shaft is None or not cut.other_joints or known.unknowns_of(shaft.joint) == 0:
            return None
        driving, driven = shaft.joints_at_ends(known.mechanism.joints)
        if not (isinstance(driving, Universal) and isinstance(driven, Universal)):
            return None
        hinge, body = cut.other_joints[-1], shaft.end_body
        if not isinstance(hinge, Revolute) or known.unknowns_of(hinge) == 0:
            return None
        held = (driving.second.name, driven.second.name) == (shaft.near, shaft.far)
        parent, done = hinge.other(body), {shaft.near, shaft.far, body} & known.bodies
        if not held or done or not {shaft.anchor_body, parent} <= known.placed:
            return None
        return cls(shaft, driving, driven, hinge, parent)

    @property
    def about(self) -> str:
        return self.shaft.end_body

    @property
    def title(self) -> str:
        return f"transformer: {self.about} turned through the shaft of {self.shaft.links}"

    @property
    def points(self) -> tuple[Point, ...]:
        """The centres of both crosses."""
        return self.shaft.points

    def accept(self, known: Known) -> set[Coordinate]:
        """Record the shaft and the driven body, and their joints."""
        for body in (self.shaft.near, self.shaft.far, self.about):
            known.place(body)
        return known.add_all([self.driving, self.shaft.joint, self.driven, self.hinge])

    def lines(self) -> Iterator[Ends]:
        """Yield both links, along the line of the centres."""
        yield self.shaft.near, self.shaft.anchor, self.shaft.end
        yield self.shaft.far, self.shaft.end, self.shaft.anchor

    def assumptions(self) -> Iterator[Assumption]:
        """Yield the conditions that the guide is along the crosses, and a cross on its hinge."""
        shaft = self.shaft
        span = shaft.end.position - shaft.anchor.position
        way = shaft.joint.direction.components
        if not shaft.along_ends:
            yield Assumption(
                f"{shaft.joint.name}_askew",
                norm(span.cross(way)) / (norm(span) * norm(way)),
                sp.Integer(1),
                "1",
                f"the guide {shaft.joint.name} of {shaft.links} must be along the line of the "
                "crosses at their ends",
                f"give it Direction.between {shaft.anchor.name} and {shaft.end.name}",
            )
        yield from through_center(self.hinge, self.driven, norm(span))

    @override
    def words(self, closing: Closing | None) -> tuple[str, str]:
        return (
            f"{self.shaft.line} = length of {self.shaft.links}; {self.driven.name} at right angles",
            self._yoke.solution,
        )

    def emit(self, kin: Kinematics) -> None:
        """Place the shaft between the centres, and turn the driven body until its cross fits."""
        shaft = self.shaft
        ends = (shaft.anchor_body, shaft.anchor), (self.parent, shaft.end)
        line = line_of_ends(kin, self, shaft.near, ends, f"the shaft of {shaft.links}")
        kin.on_line |= {shaft.near: line, shaft.far: line.reversed()}
        self._slide(kin, line)
        turn_with(kin, shaft.near, shaft.anchor_body, self.driving)
        near = kin.placed[shaft.near]
        place_turned_alike(kin, shaft.far, near, self.parent, shaft.end)
        own = kin.design_direction(self.driven.first_axis)
        turn_through_cross(kin, self, self._yoke, own, self._second_axis(kin, near))

    @property
    def _yoke(self) -> DrivenYoke:
        named = f"the shaft of {self.shaft.links}"
        return DrivenYoke(self.driven, self.hinge, self.parent, self.shaft.far, named)

    def _slide(self, kin: Kinematics, line: OnLine) -> None:
        """Record the extension of the shaft since the design position."""
        shaft, program = self.shaft, kin.program
        span = kin.design(shaft.end) - kin.design(shaft.anchor)
        span = program.vector(f"{shaft.near}_span_design", span)
        start = program.define(f"{shaft.near}_length_design", sp.sqrt(span.dot(span)))
        if shaft.along_ends:
            sense = sp.Integer(1 if shaft.forward else -1)
        else:
            along = span.dot(kin.design_direction(shaft.joint.direction))
            sense = program.define(f"{shaft.near}_sense", SignOf(along))
        slide = shaft.sense * sense * (line.length - start)
        kin.slides[shaft.joint.name] = program.define(f"slide_{shaft.joint.name}", slide)

    def _second_axis(self, kin: Kinematics, near: BodyMotion) -> GivenAxis:
        """Return the axis of the driven cross that is fixed in the shaft."""
        program, far = kin.program, self.shaft.far
        n, second, third = near.design_axes
        b = second_axis(kin, self.driven, -n)
        c = program.define(f"{far}_phase_cosine", b.dot(second))
        s = program.define(f"{far}_phase_sine", b.dot(third))
        now = program.vector(f"{far}_second_axis", near.axes[1] * c + near.axes[2] * s)
        return GivenAxis(now, b)
