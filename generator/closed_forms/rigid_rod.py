"""A leg of one link: a rod of constant length."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import sympy as sp

from ..declare.joints import Joint, Revolute
from ..kinematics.extent import require
from ..loops.known import coordinates_of
from ..program.floors import LENGTH
from .leg import Leg, RodLeg
from .pin import PlaceByPin

if TYPE_CHECKING:
    from typing import Self

    from ..kinematics.kinematics import Kinematics
    from ..loops.cut import CutLoop
    from ..loops.known import Coordinate, Known
    from ..program.vectors import Vector


@dataclass(frozen=True)
class RigidRod(Leg):
    """A link between two points."""

    # in a plane, the hinge of the link at its anchor, by which it is placed
    hinge: Revolute | None = None

    rigid: ClassVar[bool] = True

    @classmethod
    def match(cls, known: Known, cut: CutLoop) -> Self | None:
        """Return the link of one arc of a loop."""
        if len(cut.bodies) != 1:
            return None
        rod, anchor_body = cut.bodies[0], cut.others[0]
        joint = known.topology.joint_between(anchor_body, rod)
        hinge = joint if isinstance(joint, Revolute) else None
        return cls(cut.others[-1], rod, cut.end, cut.anchor, anchor_body, hinge)

    @property
    def links(self) -> tuple[str, ...]:
        return (self.rod,)

    @property
    def placing(self) -> PlaceByPin | None:
        """The step that places it by its pins, in a plane; other rods may turn about their line."""
        if self.hinge is None:
            return None
        return PlaceByPin(self.rod, self.hinge, self.anchor_body, self.end, self.body)

    def record(self, known: Known, joint: Joint) -> set[Coordinate]:
        """Record the body that it drives, and the rod: placed by its hinge, or on its line."""
        at_rod = known.mechanism.joints_of(self.rod)
        self.settle(known)
        if self.pinned:
            return known.add_all(filter(known.joins, [joint, *at_rod]))
        # its turn about the line is not determined yet
        return known.add(coordinates_of([joint]) - coordinates_of(at_rod))

    def settle(self, known: Known) -> None:
        """Record the rod between two placed ends."""
        if self.placing is None:
            known.on_line.add(self.rod)
        else:
            known.steps.append(self.placing)
            known.placed.add(self.rod)

    def stretched(self, kin: Kinematics, design: Vector, extent: sp.Expr) -> RodLeg:
        """Append its length, a constant."""
        length = kin.program.define(f"{self.rod}_length", sp.sqrt(design.dot(design)))
        first, second = self.anchor, self.end
        require(
            kin,
            f"{self.rod}_length",
            length,
            LENGTH * sp.sqrt(extent),
            "m",
            f"at the design position, the ends {first.name} and {second.name} of {self.rod} "
            "coincide",
            "move one of the two",
        )
        return RodLeg(f"rod {self.rod}", design, length, length**2)
