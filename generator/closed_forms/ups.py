"""A strut in space: two links on a guide along the line of their ends, a cross and a ball joint.

Equation: ``|P_end - P_anchor| = l_0 + x``, l_0 being the distance at the design position and x the
slide, or its negative where the strut shrinks with it. It is explicit in the slide, and in the
length. Branch: the positive length. Singular set: the two points coincide. The first link gets its
turn about the line from its cross (`universal_joint`), the second one from the first.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import sympy as sp
from typing_extensions import override

from ..declare.joints import Spherical, Universal
from ..loops.forms import ClosedForm, Follower
from ..program.floors import LENGTH
from .guided_pair import GuidedPair
from .leg import Leg, RodLeg
from .lines import line_of_ends
from .turned_alike import place_turned_alike

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
    from ..program.vectors import Vector


@dataclass(frozen=True)
class UPS(ClosedForm):
    """Two placed points are the ends of a strut: its slide and its line follow."""

    strut: GuidedPair

    rank: ClassVar[int] = 3

    @classmethod
    def match(cls, known: Known, cut: CutLoop) -> Self | None:
        """Return the strut of one arc of a loop, with both ends on placed bodies."""
        strut = _strut(known, cut)
        placed = {cut.others[0], cut.others[-1]} <= known.placed
        if strut is None or not placed or known.unknowns_of(strut.joint) == 0:
            return None
        return cls(strut)

    @property
    def about(self) -> str:
        return self.strut.near

    @property
    def title(self) -> str:
        return f"transformer: strut of {self.strut.links}"

    @property
    def points(self) -> tuple[Point, ...]:
        return self.strut.points

    def accept(self, known: Known) -> set[Coordinate]:
        """Record the line of the strut; its cross places the first link, and that the second."""
        return _accept(known, self.strut)

    def lines(self) -> Iterator[Ends]:
        """Yield the first link, along the line of both ends."""
        yield self.strut.near, self.strut.anchor, self.strut.end

    @override
    def words(self, closing: Closing | None) -> tuple[str, str]:
        return (
            f"{self.strut.line} = length of {self.strut.links} at {self.strut.joint.name}.slide",
            "explicit: the length is the root of a sum of squares",
        )

    def emit(self, kin: Kinematics) -> None:
        """Find slide and line of a strut between two known points."""
        strut = self.strut
        program, name = kin.program, strut.joint.name
        ends = (strut.anchor_body, strut.anchor), (strut.end_body, strut.end)
        record = line_of_ends(kin, self, name, ends, f"the strut of {strut.links}")
        kin.on_line[strut.near] = record
        design = program.vector(
            f"span_{name}_design", kin.design(strut.end) - kin.design(strut.anchor)
        )
        start = program.define(f"length_{name}_design", sp.sqrt(design.dot(design)))
        kin.slides[name] = program.define(f"slide_{name}", _growth(strut) * (record.length - start))


@dataclass(frozen=True)
class PlaceByGuide(Follower):
    """The second link of a strut: turned like the first, and at the end."""

    body: str
    strut: GuidedPair

    rank: ClassVar[int] = 2

    @classmethod
    def follow(cls, known: Known, joint: Joint, parent: str, child: str) -> Self | None:
        step = known.guided.get(joint.name)
        return step if isinstance(step, cls) and step.about == child else None

    @property
    def title(self) -> str:
        return f"{self.body}: on the guide of {self.strut.near}"

    def emit(self, kin: Kinematics) -> None:
        """Place the link: it turns like the first one, with its end at a placed point."""
        strut = self.strut
        place_turned_alike(kin, self.body, kin.placed[strut.near], strut.end_body, strut.end)


@dataclass(frozen=True)
class StrutLeg(Leg):
    """A strut of known slide, as a leg."""

    strut: GuidedPair

    @classmethod
    def match(cls, known: Known, cut: CutLoop) -> Self | None:
        """Return the strut of one arc of a loop."""
        strut = _strut(known, cut)
        if strut is None or known.unknowns_of(strut.joint) > 0:
            return None
        return cls.of(strut)

    @classmethod
    def of(cls, strut: GuidedPair) -> Self:
        """Return the leg of two links on a guide."""
        return cls(strut.end_body, strut.near, strut.end, strut.anchor, strut.anchor_body, strut)

    @property
    def links(self) -> tuple[str, ...]:
        return self.strut.near, self.strut.far

    @property
    def measure(self) -> str:
        return f"{self.strut.links} at {self.strut.joint.name}.slide"

    def record(self, known: Known, joint: Joint) -> set[Coordinate]:
        """Record the joint that it drives, and its own."""
        return known.add_all([joint]) | _accept(known, self.strut)

    def stretched(self, kin: Kinematics, design: Vector, extent: sp.Expr) -> RodLeg:
        """Append its length, l = l_0 + x or l_0 - x."""
        program, near, sense = kin.program, self.rod, _growth(self.strut)
        start = program.define(f"{near}_length_start", sp.sqrt(design.dot(design)))
        joint = self.strut.joint
        length = program.guarded(
            f"{near}_length",
            start + sense * kin.given(joint),
            f"the strut of {self.strut.links} is drawn in until its ends meet",
            "m",
            LENGTH * sp.sqrt(extent),
        )
        rod = RodLeg(f"strut {near}", design, length, length**2)
        return rod.driven(kin.coordinates, joint, sense * length, sp.Integer(1))


def is_strut(pair: GuidedPair, cross: Joint, ball: Joint) -> bool:
    """Return whether a cross holds the first one of two links, and a ball joint the other."""
    crossed = isinstance(cross, Universal) and cross.second.name == pair.near
    return crossed and isinstance(ball, Spherical) and pair.along_ends


def _strut(known: Known, cut: CutLoop) -> GuidedPair | None:
    """Return the spatial strut of one arc of a loop."""
    pair = GuidedPair.match(cut)
    if pair is None or not is_strut(pair, *pair.joints_at_ends(known.mechanism.joints)):
        return None
    return None if {pair.near, pair.far} & known.bodies else pair


def _accept(known: Known, strut: GuidedPair) -> set[Coordinate]:
    known.on_line.add(strut.near)
    known.guided[strut.joint.name] = PlaceByGuide(strut.far, strut)
    links = (strut.near, strut.far)
    return known.add_all(j for link in links for j in known.mechanism.joints_of(link))


def _growth(strut: GuidedPair) -> int:
    """Return 1 if the strut grows with the slide, -1 if it shrinks."""
    return strut.sense if strut.forward else -strut.sense
