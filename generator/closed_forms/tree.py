"""Loops of hinges and guides as a tree that carries the bodies, cut at joints and rods."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..declare.geometry import Direction
    from ..declare.joints import Joint, Prismatic, Revolute
    from ..loops.graph import Cycle
    from .rigid_rod import RigidRod


@dataclass(frozen=True)
class JointOfTree:
    """A hinge or guide, from the body nearer to the placed ones."""

    joint: Revolute | Prismatic
    parent: str
    child: str
    driven: bool = False  # whether its coordinate is given; otherwise it is an unknown

    @property
    def sense(self) -> int:
        """1 if the coordinate is that of the child relative to the parent, else -1."""
        return 1 if self.joint.second.name == self.child else -1


@dataclass(frozen=True)
class CutJoint:
    """A joint at which a loop is cut: its constraint is the closure equations."""

    joint: Joint
    # direction of the hinges of a planar loop, which closes with three equations less the joint's
    # degrees of freedom; None for a spatial loop, which has six
    normal: Direction | None = None

    @property
    def planar(self) -> bool:
        """Whether the loop moves in a plane."""
        return self.normal is not None

    @property
    def equations(self) -> int:
        """Number of closure equations."""
        return (3 if self.planar else 6) - self.joint.freedoms

    @property
    def between(self) -> tuple[str, ...]:
        """No links: a joint closes the loop."""
        return ()

    @property
    def closure(self) -> str:
        """Its constraint, for the report."""
        joint = self.joint
        return (
            f"{' and '.join(joint.bodies)} have {joint.common} in common at {joint.name}: "
            f"{self.equations} equations"
        )

    def closes(self, cycle: Cycle) -> bool:
        """Return whether it can close a loop."""
        return self.joint in cycle.joints


@dataclass(frozen=True)
class Tree:
    """Loops of hinges and guides that close together."""

    body: str  # first body to place
    # joints that carry the bodies, from placed ones outward; their coordinates are the unknowns,
    # but for the driven ones
    tree: tuple[JointOfTree, ...]
    # joints and rods that close a loop each. A rod is one equation.
    cuts: tuple[CutJoint, ...]
    rods: tuple[RigidRod, ...]

    @property
    def bodies(self) -> list[str]:
        """The bodies to place, without rods."""
        return [branch.child for branch in self.tree]

    @property
    def unknowns(self) -> list[JointOfTree]:
        """The joints of the tree whose coordinates are unknown."""
        return [branch for branch in self.tree if not branch.driven]

    def base_of(self, body: str) -> str:
        """Return the placed body at the inner end of the tree's path to a body."""
        parents = {branch.child: branch.parent for branch in self.tree}
        while body in parents:
            body = parents[body]
        return body

    @property
    def equations(self) -> int:
        """Number of closure equations."""
        return sum(cut.equations for cut in self.cuts) + len(self.rods)

    @property
    def joint_names(self) -> str:
        """The joints of the unknown coordinates, for messages."""
        return ", ".join(branch.joint.name for branch in self.unknowns)

    @property
    def closing_names(self) -> str:
        """The joints and rods that close the loops, for messages."""
        return ", ".join([*(c.joint.name for c in self.cuts), *(held.rod for held in self.rods)])
