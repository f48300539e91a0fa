"""Selection of loops of hinges and guides to solve together, where none has a closed form.

The joints of some waiting loops make a graph, in which all placed bodies are one vertex. Hinges and
guides of a spanning tree carry the bodies; their coordinates are the unknowns, unless they are
driven. Every other joint closes a loop. It is the one with the most degrees of freedom, since that
leaves the fewest unknowns and equations, as the characteristic pair does in a closed form. A link
of two joints with a common point each is a rod, and one equation.

As few loops as possible are taken. The other ones are solved after them, in closed form where
possible.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import networkx as nx

from ..declare.joints import Cylindrical, Prismatic, Revolute, Spherical, Universal
from .rigid_rod import RigidRod
from .tree import CutJoint, JointOfTree, Tree

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence

    from ..declare.geometry import Direction, Point
    from ..declare.joints import Joint
    from ..loops.graph import Cycle
    from ..loops.known import Known

_PLACED = ""  # the vertex of all placed bodies; no body has this name


class Coupling:
    """Some loops as a graph of joints, in which all placed bodies are one vertex."""

    def __init__(self, known: Known, cycles: Sequence[Cycle]) -> None:
        self._known, self._cycles = known, cycles
        joints = {joint for cycle in cycles for joint in cycle.joints}
        joints = {joint for joint in joints if not known.placed.issuperset(joint.bodies)}
        self._joints = [joint for joint in known.mechanism.joints if joint in joints]
        bodies = dict.fromkeys(body for joint in self._joints for body in joint.bodies)
        self._bodies = [body for body in bodies if body not in known.placed]
        self._rods = {b: ends for b in self._bodies if (ends := self._ends(b))}

    def tree(self) -> Tree | None:
        """Return the tree of the loops; None if they contain a joint that no iteration has."""
        if not all(self._is_provided_for(joint) for joint in self._joints):
            return None
        tree = self._spanning_tree()
        while rods := [rod for *_, rod in tree.edges(data="rod") if rod]:
            del self._rods[rods[0]]  # it carries another body, and is a body like others
            tree = self._spanning_tree()
        branches = self._branches(tree)
        if branches is None:
            return None
        carrying = {branch.joint for branch in branches}
        at_rods = {joint for ends in self._rods.values() for joint in ends}
        closing = [j for j in self._joints if j not in carrying | at_rods]
        if any(map(self._is_driven, closing)):
            return None
        cuts = tuple(CutJoint(joint, self._normal(joint, carrying)) for joint in closing)
        return Tree(branches[0].child, branches, cuts, tuple(self._held()))

    def _is_provided_for(self, joint: Joint) -> bool:
        idle = not self._known.on_line.intersection(joint.bodies)
        known = self._is_driven(joint) or self._known.unknowns_of(joint) == joint.freedoms
        return known and idle and not isinstance(joint, Cylindrical)

    def _is_driven(self, joint: Joint) -> bool:
        """Return whether the coordinate of a joint is given."""
        return isinstance(joint, Revolute | Prismatic) and self._known.unknowns_of(joint) == 0

    def _spanning_tree(self) -> nx.MultiGraph:
        """Return the tree of the fewest degrees of freedom; with rods only where needed."""
        graph = nx.MultiGraph()
        graph.add_nodes_from([_PLACED, *(b for b in self._bodies if b not in self._rods)])
        at_rods = [joint for ends in self._rods.values() for joint in ends]
        for place, joint in enumerate(self._joints):
            if joint not in at_rods:
                ends = (self._vertex(body) for body in joint.bodies)
                weight = self._known.unknowns_of(joint) * len(self._joints) + place
                graph.add_edge(*ends, joint=joint, weight=weight)
        for rod, joints in self._rods.items():
            ends = (self._vertex(joint.other(rod)) for joint in joints)
            weight = sum(joint.freedoms for joint in joints) * len(self._joints)
            graph.add_edge(*ends, rod=rod, weight=weight)
        return nx.minimum_spanning_tree(graph)

    def _vertex(self, body: str) -> str:
        return _PLACED if body in self._known.placed else body

    def _branches(self, tree: nx.MultiGraph) -> tuple[JointOfTree, ...] | None:
        """Return the joints of a tree, placed bodies first; None if one cannot be unknown."""
        if not nx.is_connected(tree) or not tree.edges:
            return None
        branches = []
        for here, child in nx.bfs_edges(tree, _PLACED):
            (edge,) = tree[here][child].values()
            joint = edge["joint"]
            if not isinstance(joint, Revolute | Prismatic):
                return None
            driven = self._is_driven(joint)
            branches.append(JointOfTree(joint, joint.other(child), child, driven))
        return tuple(branches)

    # -- rods -----------------------------------------------------------------------------------

    def _ends(self, body: str) -> tuple[Joint, Joint] | None:
        """Return the two joints of a link that only keeps two points at their distance."""
        joints = self._known.mechanism.joints_of(body)
        if len(joints) != 2 or not set(joints) <= set(self._joints):
            return None
        in_space = all(isinstance(joint, Spherical | Universal) for joint in joints)
        pinned = all(isinstance(joint, Revolute) for joint in joints)
        planar = all(cycle.planar for cycle in self._cycles if body in cycle.bodies)
        if any(map(self._is_driven, joints)):
            return None
        return (joints[0], joints[1]) if in_space or (pinned and planar) else None

    def _held(self) -> Iterator[RigidRod]:
        for rod, (start, end) in self._rods.items():
            hinge = start if isinstance(start, Revolute) else None
            held = end.other(rod), rod, _point(end), _point(start), start.other(rod)
            yield RigidRod(*held, hinge)

    # -- planes ---------------------------------------------------------------------------------

    def _normal(self, joint: Joint, carrying: Collection[Joint]) -> Direction | None:
        """Return the direction of the hinges, if the loop that a joint closes is planar."""
        topology, placed = self._known.topology, self._known.placed
        graph = nx.Graph([branch.bodies for branch in carrying])
        graph.add_edges_from(topology.graph.subgraph(placed).edges)
        cycle = topology.cycle(nx.shortest_path(graph, *joint.bodies))
        return cycle.normal


def _point(joint: Joint) -> Point:
    """Return the common point of a joint of a rod."""
    point = joint.axis.through if isinstance(joint, Revolute) else joint.center
    assert point is not None
    return point
