"""Legs: links that keep two points of two bodies at a known distance.

A leg is a link of constant length, or several links with a joint of known coordinate between them:
then it is a rod of known variable length. A closed form reads its length at position level, l l' at
velocity level, and (l l')' at acceleration level (`RodLeg`). The kinds of legs are in files of
their own; each is tried wherever a leg may be.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar

import sympy as sp

from ..kinematics.extent import extent_squared

if TYPE_CHECKING:
    from typing import Self

    from ..declare.geometry import Point
    from ..declare.joints import Joint
    from ..kinematics.coordinates import Coordinates
    from ..kinematics.extent import Spanning
    from ..kinematics.kinematics import Kinematics
    from ..kinematics.motion import PointMotion
    from ..loops.cut import CutLoop
    from ..loops.forms import PlannedStep
    from ..loops.graph import Cycle
    from ..loops.known import Coordinate, Known
    from ..program.vectors import Vector


@dataclass(frozen=True)
class RodLeg:
    """A leg as a rod between two points, from the anchor to the end."""

    name: str  # kind and its name, for messages
    design: Vector  # vector from the anchor to the end at the design position (work axes)
    # length and its square
    length: sp.Expr
    squared: sp.Expr
    # length times its rate, per unit rate of each coordinate that changes it
    stretch: dict[str, sp.Expr] = field(default_factory=dict)
    # second derivative of half the squared length, without accelerations of the independent
    # coordinates
    stretch_bias: sp.Expr = sp.S.Zero

    def driven(
        self, coordinates: Coordinates, joint: Joint, slope: sp.Expr, curvature: sp.Expr
    ) -> RodLeg:
        """Return the rod with a length that the known coordinate of a joint changes.

        `slope` and `curvature` are the first and second derivative of half the square of the length
        with respect to that coordinate.
        """
        if not coordinates.moves(joint):
            return self
        stretch = {coordinates.of(joint): slope * coordinates.ratio(joint)}
        given, speed = coordinates.given_acceleration(joint), coordinates.speed(joint)
        return replace(self, stretch=stretch, stretch_bias=slope * given + curvature * speed**2)


@dataclass(frozen=True)
class Leg(ABC):
    """Links from an anchor on a placed body to a point of a body that they hold."""

    # body that is held, and the point of it
    body: str
    rod: str  # link at the anchor
    end: Point
    anchor: Point
    anchor_body: str

    kinds: ClassVar[list[type[Leg]]] = []
    rigid: ClassVar[bool] = False
    """Whether its length is constant."""

    def __init_subclass__(cls, **named: Any) -> None:
        super().__init_subclass__(**named)
        Leg.kinds.append(cls)

    # -- structure ------------------------------------------------------------------------------

    @classmethod
    @abstractmethod
    def match(cls, known: Known, cut: CutLoop) -> Self | None:
        """Return the leg of the first arc of a cut loop, if it is of this kind."""

    @property
    @abstractmethod
    def links(self) -> tuple[str, ...]:
        """Its links, from the anchor to the end."""

    @property
    def placing(self) -> PlannedStep | None:
        """The step that places its links by their pins; None: they are left on their line."""
        return None

    @property
    def pinned(self) -> bool:
        """Whether its links are placed by their pins."""
        return self.placing is not None

    def record(self, known: Known, joint: Joint) -> set[Coordinate]:
        """Record that it holds a body on a joint; return the coordinates that were not known."""
        assert self.placing is not None
        known.steps.append(self.placing)
        return known.add_all([joint]) | self.placing.accept(known)

    @property
    def points(self) -> tuple[Point, ...]:
        """Its two ends."""
        return self.anchor, self.end

    # -- closing a loop -------------------------------------------------------------------------

    @property
    def between(self) -> tuple[str, ...]:
        """Its links, where it closes a loop."""
        return self.links

    def closes(self, cycle: Cycle) -> bool:
        """Return whether it can close a loop."""
        return set(self.links) <= set(cycle.bodies)

    @property
    def ends(self) -> str:
        """The distance of its ends, for the report."""
        return f"|{self.end.name} - {self.anchor.name}|"

    @property
    def closure(self) -> str:
        """Its equation, for the report."""
        return f"{self.ends} = length of {' and '.join(self.links)}"

    @property
    def measure(self) -> str:
        """Its length, for the report."""
        return self.rod

    # -- algebra --------------------------------------------------------------------------------

    @abstractmethod
    def stretched(self, kin: Kinematics, design: Vector, extent: sp.Expr) -> RodLeg:
        """Append its length and the derivatives of that.

        `design` is the vector from the anchor to the end at the design position, `extent` the
        square of the extent of the loop that it closes.
        """

    def rod_of(self, kin: Kinematics, step: Spanning) -> RodLeg:
        """Append the leg as a rod, in the loop that a step closes."""
        design = kin.design(self.end) - kin.design(self.anchor)
        design = kin.program.vector(f"{self.rod}_design", design)
        rod = self.stretched(kin, design, extent_squared(kin, step))
        kin.rod_lengths[self.rod] = rod.length
        return rod

    def anchor_motion(self, kin: Kinematics) -> PointMotion:
        """Return the motion of its anchor."""
        return kin.point_motion(self.anchor_body, self.anchor)


def leg_of(known: Known, cut: CutLoop) -> Leg | None:
    """Return the leg of the first arc of a cut loop, or None."""
    tried = (kind.match(known, cut) for kind in Leg.kinds)
    return next((leg for leg in tried if leg), None)


def held_on(known: Known, cut: CutLoop) -> tuple[Joint, str, Leg] | None:
    """Return the joint on which a leg holds a body, the placed body that carries it, and the leg.

    The other arc of the loop ends with that body; None if it is placed already, or if there is no
    such leg.
    """
    leg = leg_of(known, cut)
    if leg is None or not cut.other_joints:
        return None
    joint = cut.other_joints[-1]
    parent = joint.other(leg.body)
    done = {leg.rod, leg.body} & known.placed or known.unknowns_of(joint) == 0
    if done or not {parent, leg.anchor_body} <= known.placed:
        return None
    return joint, parent, leg
