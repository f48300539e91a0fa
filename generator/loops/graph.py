"""Mobility, joint graph, shortest paths and cycles of a mechanism (sections 2 and 4 of the paper).

Vertices of the joint graph are bodies; edges are joints, and the length of an edge is the number of
degrees of freedom of its joint. All results are computed from the declaration.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import networkx as nx

from .errors import TopologyError
from .parallel import ENOUGH, families
from .planes import Planes
from .points import common_center

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ..declare.geometry import Direction, Point
    from ..declare.joints import Joint
    from ..declare.mechanism import Mechanism


@dataclass(frozen=True)
class Cycle:
    """A simple cycle of the joint graph."""

    joints: tuple[Joint, ...]  # joints, in the order in which the cycle passes them
    bodies: tuple[str, ...]  # `bodies[i]` lies between `joints[i - 1]` and `joints[i]`
    length: int  # sum of the degrees of freedom of the joints
    normal: Direction | None  # direction of the hinges of a planar loop; none for others
    center: Point | None  # point about which a loop of a cross and hinges turns; none for others

    @property
    def planar(self) -> bool:
        """Whether the loop moves in a plane: hinges along each other, guides across them."""
        return self.normal is not None

    @property
    def key(self) -> frozenset[str]:
        """The set of joint names: a simple cycle is given by its edges."""
        return frozenset(j.name for j in self.joints)


@dataclass(frozen=True)
class JointGraph:
    """The joint graph of a mechanism, and its properties."""

    mechanism: Mechanism

    def __post_init__(self) -> None:
        reached = nx.node_connected_component(self.graph, self.mechanism.ground)
        unreached = {b.name for b in self.mechanism.bodies} - set(reached)
        if unreached:
            message = f"no joint path leads from the ground to {', '.join(sorted(unreached))}"
            raise TopologyError(message)

    @cached_property
    def graph(self) -> nx.Graph:
        """The joint graph; edges carry ``joint`` and ``length``."""
        graph = nx.Graph()
        graph.add_nodes_from(b.name for b in self.mechanism.bodies)
        for joint in self.mechanism.joints:
            if graph.has_edge(*joint.bodies):
                first, second = joint.bodies
                message = f"bodies {first!r} and {second!r} have two joints between them"
                raise TopologyError(message)
            # a weld is in no loop; with a length of zero the path back would be as short
            graph.add_edge(*joint.bodies, joint=joint, length=joint.freedoms or 1)
        return graph

    def joint_between(self, first: str, second: str) -> Joint:
        """Return the joint that connects two bodies."""
        return self.graph.edges[first, second]["joint"]

    # -- counting -------------------------------------------------------------------------------

    @property
    def mobility(self) -> int:
        """Degrees of freedom by the Grübler-Kutzbach criterion (Eq. 1); every gear takes one.

        A planar loop closes with three equations, and so does one about a point; the spatial count
        of six would take its mechanism for over-constrained. Parallel links beyond the second take
        none.
        """
        moving = len(self.mechanism.moving)
        spatial = 6 * moving - sum(6 - j.freedoms for j in self.mechanism.joints)
        special = 3 * (self.planar_loop_count + self.central_loop_count) + self.redundant
        return spatial + special - len(self.mechanism.geared)

    @property
    def redundant(self) -> int:
        """Number of redundant equations: one for each parallel link too many."""
        return sum(len(links) - ENOUGH for links in self.parallel_links.values())

    @cached_property
    def parallel_links(self) -> dict[frozenset[str], tuple[str, ...]]:
        """The links between two bodies that move in a plane, by these, where there are too many."""
        return families(self.mechanism, lambda loop: self.cycle(loop).planar)

    @property
    def planar_loop_count(self) -> int:
        """Number of loops of a minimal basis that move in a plane."""
        return sum(cycle.planar for cycle in self._basis)

    @property
    def central_loop_count(self) -> int:
        """Number of loops of a minimal basis that turn about a point."""
        return sum(cycle.center is not None for cycle in self._basis)

    @cached_property
    def _basis(self) -> tuple[Cycle, ...]:
        basis, chosen = MinimalBasis(self), []
        while options := basis.options():
            basis.choose(options[0])
            chosen.append(options[0])
        return tuple(chosen)

    @property
    def loop_count(self) -> int:
        """Number of independent loops (section 4)."""
        return len(self.mechanism.joints) - len(self.mechanism.moving)

    # -- paths ----------------------------------------------------------------------------------

    def shortest_paths(self, start: str, end: str) -> list[tuple[str, ...]]:
        """Return all shortest paths between two bodies, as sequences of bodies, in a fixed order.

        The paper's Table 2 shows one of them where several have the same length.
        """
        return self._paths_from(start).to(end)

    def _paths_from(self, start: str) -> _ShortestPaths:
        """Return the shortest paths from a body, of one search."""
        if start not in self._searches:
            self._searches[start] = _ShortestPaths(self.graph, start, self._numbers)
        return self._searches[start]

    @cached_property
    def _searches(self) -> dict[str, _ShortestPaths]:
        return {}

    @cached_property
    def _numbers(self) -> dict[str, int]:
        return self.mechanism.numbers

    def path_table(self) -> list[list[list[str]]]:
        """Return all shortest paths (Table 2): by their first bodies, then by their last ones.

        A path is the numbers of its bodies, with hyphens between them where some have two digits.
        """
        between = "" if max(self._numbers.values()) < 10 else "-"
        return [
            [
                [
                    between.join(map(str, self._path_numbers(path)))
                    for path in self.shortest_paths(start, end)
                    if start != end
                ]
                for end in self._numbers
            ]
            for start in self._numbers
        ]

    def _path_numbers(self, path: Sequence[str]) -> tuple[int, ...]:
        return tuple(self._numbers[b] for b in path)

    # -- cycles ---------------------------------------------------------------------------------

    @cached_property
    def candidate_cycles(self) -> list[Cycle]:
        """Distinct simple cycles by Horton's construction, shortest first.

        Every vertex is joined with both ends of every edge by shortest paths; degenerate cycles
        (the two paths share a body or contain the edge) and repeated ones are left out.
        """
        found: dict[frozenset[str], Cycle] = {}
        for cycle in self.horton_candidates():
            found.setdefault(cycle.key, cycle)
        return sorted(
            found.values(), key=lambda c: (c.length, sorted(self._path_numbers(c.bodies)))
        )

    def horton_candidates(self) -> list[Cycle]:
        """Return the simple cycles of all pairs of vertex and edge, with repetitions."""
        return [
            self.cycle(round_trip)
            for vertex in self.graph.nodes
            for joint in self.mechanism.joints
            for round_trip in self._closed(vertex, joint)
        ]

    def _closed(self, vertex: str, joint: Joint) -> list[tuple[str, ...]]:
        """Return the bodies of each simple cycle of a pair of vertex and edge."""
        paths = self._paths_from(vertex)
        if paths.all_part_alike(*joint.bodies):
            return []
        trips = (
            (*there, *reversed(back[1:]))
            for there in paths.to(joint.first.name)
            for back in paths.to(joint.second.name)
        )
        return [trip for trip in trips if len(set(trip)) == len(trip) > 2]

    @property
    def pair_count(self) -> int:
        """Number of pairs of a body and a joint that do not touch: the paper's 40 cycles."""
        return len(self.mechanism.joints) * (len(self.mechanism.bodies) - 2)

    @property
    def closing_pairs(self) -> int:
        """Number of those pairs that close at least one simple cycle."""
        return sum(
            bool(self._closed(v, j)) for v in self.graph.nodes for j in self.mechanism.joints
        )

    def cycle(self, bodies: Sequence[str]) -> Cycle:
        """Return the cycle through some bodies, beginning at the one of the lowest number."""
        numbers = self._path_numbers(bodies)
        start = numbers.index(min(numbers))
        turned = [*bodies[start:], *bodies[:start]]
        joints = tuple(self.joint_between(a, b) for a, b in pairwise([*turned, turned[0]]))
        length = sum(j.freedoms for j in joints)
        normal = self._planes.normal(joints)
        center = common_center(joints, self._planes.at_defaults)
        return Cycle(joints, tuple(turned), length, normal, center)

    @cached_property
    def _planes(self) -> Planes:
        return Planes(self.mechanism)

    def independent(self, cycles: Sequence[Cycle]) -> bool:
        """Return whether no cycle is a sum of others (edges modulo two)."""
        span = CycleSpan(self)
        return all(span.add(cycle) for cycle in cycles)


class _ShortestPaths:
    """All shortest paths of a joint graph from one body."""

    def __init__(self, graph: nx.Graph, start: str, numbers: Mapping[str, int]) -> None:
        self.start = start
        self._numbers = numbers
        self._before, _ = nx.dijkstra_predecessor_and_distance(graph, start, weight="length")
        self._paths: dict[str, list[tuple[str, ...]]] = {start: [(start,)]}

    def to(self, end: str) -> list[tuple[str, ...]]:
        """Return the paths to a body, in the order of the bodies' numbers."""
        if end not in self._paths:
            found = [(*path, end) for body in self._before[end] for path in self.to(body)]
            found.sort(key=lambda path: [self._numbers[b] for b in path])
            self._paths[end] = found
        return self._paths[end]

    def all_part_alike(self, one: str, other: str) -> bool:
        """Return whether all paths to two bodies begin with the same neighbour of the start."""
        if self.start in (one, other):
            return False
        return len({path[1] for body in (one, other) for path in self.to(body)}) == 1


class CycleSpan:
    """The cycles that are sums of some cycles (edges modulo two), as a matrix in echelon form.

    A cycle is a number with a bit for each of its joints.
    """

    def __init__(self, topology: JointGraph) -> None:
        self._bits = {j.name: 1 << i for i, j in enumerate(topology.mechanism.joints)}
        self._rows: dict[int, int] = {}  # by the place of their highest bit

    def contains(self, cycle: Cycle) -> bool:
        """Return whether a cycle is a sum of those that were added."""
        return self._rest(cycle) == 0

    def add(self, cycle: Cycle) -> bool:
        """Add a cycle; return whether it was not contained before."""
        rest = self._rest(cycle)
        if rest:
            self._rows[rest.bit_length()] = rest
        return rest != 0

    def _rest(self, cycle: Cycle) -> int:
        """Return the remainder of a cycle after division by those that were added."""
        rest = sum(self._bits[joint.name] for joint in cycle.joints)
        while rest.bit_length() in self._rows:
            rest ^= self._rows[rest.bit_length()]
        return rest


class MinimalBasis:
    """A minimal cycle basis under construction: the cycles chosen so far, and the next candidates.

    A cycle that is a sum of chosen ones remains so, and is not tried again.
    """

    def __init__(self, topology: JointGraph, chosen: Sequence[Cycle] = ()) -> None:
        self._span = CycleSpan(topology)
        self._open = list(topology.candidate_cycles)
        for cycle in chosen:
            self._span.add(cycle)

    def options(self) -> list[Cycle]:
        """Return the shortest cycles that extend the basis; none if it is complete."""
        self._open = [c for c in self._open if not self._span.contains(c)]
        return [c for c in self._open if c.length == self._open[0].length]

    def choose(self, cycle: Cycle) -> None:
        """Take a cycle into the basis."""
        self._span.add(cycle)
