"""Known poses and coordinates of a mechanism, while the order of solution is found."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ..declare.joints import Joint
    from ..declare.mechanism import Mechanism
    from ..kinematics.step import KinematicStep
    from .graph import Cycle, JointGraph

Coordinate = tuple[str, str]
"""Names of a joint and of one of its relative coordinates."""


@dataclass
class Known:
    """Bodies whose poses are known, and relative coordinates that are given or solved."""

    mechanism: Mechanism
    topology: JointGraph
    placed: set[str] = field(default_factory=set)  # bodies whose pose is known
    # bodies of which a line is known, free to turn about it
    on_line: set[str] = field(default_factory=set)
    # relative coordinates that are given or solved
    coordinates: set[Coordinate] = field(default_factory=set)
    steps: list[KinematicStep] = field(default_factory=list)  # steps so far, in order
    # by the name of a joint, the step that alone may place a body by it
    guided: dict[str, KinematicStep] = field(default_factory=dict)
    # pairs of bodies that parallel links keep from turning relative to each other
    alike: set[frozenset[str]] = field(default_factory=set)

    @property
    def bodies(self) -> set[str]:
        """Bodies that are placed, or on a line."""
        return self.placed | self.on_line

    def knows(self, joint: Joint, coordinate: str) -> bool:
        """Return whether a relative coordinate of a joint is given or already solved."""
        return (joint.name, coordinate) in self.coordinates

    def unknowns_of(self, joint: Joint) -> int:
        """Return the number of unknown relative coordinates of a joint."""
        return sum(not self.knows(joint, c) for c in joint.coordinates)

    def unknowns(self, cycle: Cycle) -> int:
        """Return the number of unknown relative coordinates of a loop."""
        return sum(self.unknowns_of(joint) for joint in cycle.joints)

    def joins(self, joint: Joint) -> bool:
        """Return whether a joint connects two bodies that are placed or on a line."""
        return self.bodies.issuperset(joint.bodies)

    def place(self, body: str) -> None:
        """Record a body as placed."""
        self.placed.add(body)
        self.on_line.discard(body)

    def add(self, coordinates: set[Coordinate]) -> set[Coordinate]:
        """Record coordinates as known, and return those that were not."""
        new = coordinates - self.coordinates
        self.coordinates |= new
        return new

    def add_all(self, joints: Iterable[Joint]) -> set[Coordinate]:
        """Record all coordinates of some joints as known, and return those that were not."""
        return self.add(coordinates_of(joints))


def coordinates_of(joints: Iterable[Joint]) -> set[Coordinate]:
    """Return all relative coordinates of some joints."""
    return {(joint.name, c) for joint in joints for c in joint.coordinates}
