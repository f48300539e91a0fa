"""Loops of hinges and guides that no closed form solves: which of them to solve together, and how.

Of some loops that wait, the joints make a graph, in which all that is placed is one vertex. Hinges
and guides of a spanning tree carry the bodies; their coordinates are the unknowns, unless they are
driven. Every joint that
is left out closes a loop. It is the one with the most freedoms, since that leaves the fewest
unknowns and equations: what the characteristic pair is to a closed form. A link that has two joints
with a point in common each is a rod, and one equation.

As few loops as possible are taken. What they leave is solved after them, as far as it can be in
closed form.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

import networkx as nx

from ..declare.joints import Cylindrical, Prismatic, Revolute, Spherical, Universal
from ..loops.acceptance import coordinates_of
from ..loops.actions import CutJoint, HeldByRod, JointOfTree, SolveTogether
from ..loops.mobility import Mobility

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence

    from ..declare.geometry import Direction, Point
    from ..declare.joints import Joint
    from ..loops.graph import Cycle
    from ..loops.known import Settled

MOST_LOOPS = 4
"""Most loops that are solved together."""

MOST_UNKNOWNS = 8
"""Most unknowns of an iteration: the adjugate of its Jacobian is written out."""

_PLACED = ""  # the vertex of all that is placed; no body has this name


@dataclass(frozen=True)
class Coupling:
    """Loops that could be solved together.

    Attributes
    ----------
    obstacle
        Why they cannot be; empty: they can.
    """

    action: SolveTogether
    cycles: tuple[Cycle, ...]
    obstacle: str


def coupled(settled: Settled, driven: Collection[str], waiting: Sequence[Cycle]) -> Coupling | None:
    """Return the fewest loops that determine as many coordinates as they have unknown.

    Parameters
    ----------
    driven
        Names of the joints whose coordinates are independent or prescribed.
    waiting
        Loops without a closed form.

    Returns
    -------
    Coupling or None
        The first one without an obstacle, or else the first one.
    """
    mobility = Mobility(settled.topology, driven)
    found = []
    for count in range(1, min(len(waiting), MOST_LOOPS) + 1):
        for cycles in combinations(waiting, count):
            action = _Loops(settled, cycles).together()
            if action is None or len(action.unknowns) > action.equations:
                continue
            found.append(Coupling(action, cycles, obstacle(action, mobility)))
            if not found[-1].obstacle:
                return found[-1]
    return found[0] if found else None


def obstacle(action: SolveTogether, mobility: Mobility) -> str:
    """Say why an iteration would not help."""
    unknowns, joints = len(action.unknowns), [branch.joint for branch in action.unknowns]
    if unknowns > MOST_UNKNOWNS:
        return f"{unknowns} unknowns are more than the {MOST_UNKNOWNS} of an iteration"
    if not mobility.is_known:
        return ""  # what is not declared is refused later, by its name
    if not mobility.determines(coordinates_of(joints)):
        return (
            "with the default parameters they do not determine these at the design position: it is "
            "a dead point, or something else must be driven"
        )
    if not mobility.driven_move():
        return (
            "with the default parameters they cannot move from the design position as the "
            "independent and prescribed coordinates demand"
        )
    return ""


class _Loops:
    """Some loops as a graph of joints, in which all that is placed is one vertex."""

    def __init__(self, settled: Settled, cycles: Sequence[Cycle]) -> None:
        self._settled, self._cycles = settled, cycles
        joints = {joint for cycle in cycles for joint in cycle.joints}
        joints = {joint for joint in joints if not settled.placed.issuperset(joint.bodies)}
        self._joints = [joint for joint in settled.mechanism.joints if joint in joints]
        bodies = dict.fromkeys(body for joint in self._joints for body in joint.bodies)
        self._bodies = [body for body in bodies if body not in settled.placed]
        self._rods = {b: ends for b in self._bodies if (ends := self._ends(b))}

    def together(self) -> SolveTogether | None:
        """Return the action that solves the loops; None if what is in them is not provided for."""
        if not all(self._is_provided_for(joint) for joint in self._joints):
            return None
        tree = self._spanning_tree()
        while rods := [rod for *_, rod in tree.edges(data="rod") if rod]:
            del self._rods[rods[0]]  # it carries: a body like others
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
        return SolveTogether(branches[0].child, branches, cuts, tuple(self._held()))

    def _is_provided_for(self, joint: Joint) -> bool:
        idle = not self._settled.on_line.intersection(joint.bodies)
        known = self._is_driven(joint) or self._settled.unknowns_of(joint) == joint.freedoms
        return known and idle and not isinstance(joint, Cylindrical)

    def _is_driven(self, joint: Joint) -> bool:
        """Tell whether the coordinate of a joint is given."""
        return isinstance(joint, Revolute | Prismatic) and self._settled.unknowns_of(joint) == 0

    def _spanning_tree(self) -> nx.MultiGraph:
        """Return the tree of the fewest freedoms; rods are in it where nothing else carries."""
        graph = nx.MultiGraph()
        graph.add_nodes_from([_PLACED, *(b for b in self._bodies if b not in self._rods)])
        at_rods = [joint for ends in self._rods.values() for joint in ends]
        for place, joint in enumerate(self._joints):
            if joint not in at_rods:
                ends = (self._vertex(body) for body in joint.bodies)
                weight = self._settled.unknowns_of(joint) * len(self._joints) + place
                graph.add_edge(*ends, joint=joint, weight=weight)
        for rod, joints in self._rods.items():
            ends = (self._vertex(joint.other(rod)) for joint in joints)
            weight = sum(joint.freedoms for joint in joints) * len(self._joints)
            graph.add_edge(*ends, rod=rod, weight=weight)
        return nx.minimum_spanning_tree(graph)

    def _vertex(self, body: str) -> str:
        return _PLACED if body in self._settled.placed else body

    def _branches(self, tree: nx.MultiGraph) -> tuple[JointOfTree, ...] | None:
        """Return the joints of a tree from what is placed outward, if an iteration has them."""
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
        """Return the two joints of a link that keeps two points at their distance, and no more."""
        joints = self._settled.mechanism.joints_of(body)
        if len(joints) != 2 or not set(joints) <= set(self._joints):
            return None
        in_space = all(isinstance(joint, Spherical | Universal) for joint in joints)
        pinned = all(isinstance(joint, Revolute) for joint in joints)
        planar = all(cycle.planar for cycle in self._cycles if body in cycle.bodies)
        if any(map(self._is_driven, joints)):
            return None
        return (joints[0], joints[1]) if in_space or (pinned and planar) else None

    def _held(self) -> Iterator[HeldByRod]:
        for rod, (start, end) in self._rods.items():
            yield HeldByRod(end.other(rod), rod, _point(end), _point(start), start.other(rod))

    # -- planes ---------------------------------------------------------------------------------

    def _normal(self, joint: Joint, carrying: Collection[Joint]) -> Direction | None:
        """Return the direction of the hinges, if the loop that a joint closes moves in a plane."""
        topology, placed = self._settled.topology, self._settled.placed
        graph = nx.Graph([branch.bodies for branch in carrying])
        graph.add_edges_from(topology.graph.subgraph(placed).edges)
        cycle = topology.cycle(nx.shortest_path(graph, *joint.bodies))
        return cycle.normal


def _point(joint: Joint) -> Point:
    """Return the point that a joint of a rod keeps in common."""
    point = joint.axis.through if isinstance(joint, Revolute) else joint.center
    assert point is not None
    return point
