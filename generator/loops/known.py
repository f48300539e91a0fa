"""What is known of a mechanism while the order of solution is being found."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..declare.joints import Joint
    from ..declare.mechanism import Mechanism
    from .graph import Cycle, Topology

Coordinate = tuple[str, str]
"""A relative coordinate: its joint, and which of the joint's."""


@dataclass
class Settled:
    """Bodies that have their place, and relative coordinates that are given or solved.

    Attributes
    ----------
    placed
        Bodies whose pose is known.
    on_line
        Bodies of which a line is known, free to turn about it.
    known
        Relative coordinates that are given or solved.
    """

    mechanism: Mechanism
    topology: Topology
    placed: set[str] = field(default_factory=set)
    on_line: set[str] = field(default_factory=set)
    known: set[Coordinate] = field(default_factory=set)

    @property
    def bodies(self) -> set[str]:
        """Bodies that are placed, or on a line."""
        return self.placed | self.on_line

    def knows(self, joint: Joint, coordinate: str) -> bool:
        """Tell whether a relative coordinate is given or already solved."""
        return (joint.name, coordinate) in self.known

    def unknowns_of(self, joint: Joint) -> int:
        """Return how many relative coordinates of a joint are unknown."""
        return sum(not self.knows(joint, c) for c in joint.coordinates)

    def unknowns(self, cycle: Cycle) -> int:
        """Return how many relative coordinates of a loop are unknown."""
        return sum(self.unknowns_of(joint) for joint in cycle.joints)

    def joins(self, joint: Joint) -> bool:
        """Tell whether a joint connects two bodies that are placed or on a line."""
        return self.bodies.issuperset(joint.bodies)

    def add(self, coordinates: set[Coordinate]) -> set[Coordinate]:
        """Record coordinates as known, and return those that were not."""
        new = coordinates - self.known
        self.known |= new
        return new
