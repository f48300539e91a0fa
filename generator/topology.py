"""Mobility, joint graph, shortest paths and cycles of a mechanism (sections 2 and 4 of the paper).

Vertices of the joint graph are bodies; edges are joints, and the length of an edge is the number of
freedoms of its joint. All results are computed from the declaration.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import networkx as nx

from .geometry import Direction
from .joints import Prismatic, Revolute

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .joints import Joint
    from .mechanism import Mechanism


class TopologyError(ValueError):
    """The joint graph is not that of a mechanism that can be analysed."""


@dataclass(frozen=True)
class Cycle:
    """A simple cycle of the joint graph.

    Attributes
    ----------
    joints
        The joints, in the order in which the cycle passes them.
    bodies
        ``bodies[i]`` lies between ``joints[i - 1]`` and ``joints[i]``.
    length
        Sum of the freedoms of the joints.
    """

    joints: tuple[Joint, ...]
    bodies: tuple[str, ...]
    length: int

    @property
    def planar(self) -> bool:
        """Whether the loop moves in a plane: hinges along one direction, slides across it.

        Directions are compared by declaration. That slides lie in the plane is taken on trust.
        """
        hinges = {j.axis.towards for j in self.joints if isinstance(j, Revolute)}
        kinds = all(isinstance(j, Revolute | Prismatic) for j in self.joints)
        parallel = len(hinges) == 1 and all(isinstance(h, Direction) for h in hinges)
        return kinds and parallel

    @property
    def key(self) -> frozenset[str]:
        """The set of joint names: a simple cycle is given by its edges."""
        return frozenset(j.name for j in self.joints)


@dataclass(frozen=True)
class Topology:
    """The joint graph of a mechanism and what follows from it."""

    mechanism: Mechanism

    def __post_init__(self) -> None:
        names = [b.name for b in self.mechanism.bodies]
        for joint in self.mechanism.joints:
            for body in joint.bodies:
                if body not in names:
                    message = f"joint {joint.name!r} connects {body!r}, which is no declared body"
                    raise TopologyError(message)
        unreached = set(names) - set(nx.node_connected_component(self.graph, names[0]))
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
                message = (
                    f"bodies {joint.first!r} and {joint.second!r} have two joints between them"
                )
                raise TopologyError(message)
            graph.add_edge(*joint.bodies, joint=joint, length=joint.freedoms)
        return graph

    def joint_between(self, first: str, second: str) -> Joint:
        """Return the joint that connects two bodies."""
        joint: Joint = self.graph.edges[first, second]["joint"]
        return joint

    # -- counting -------------------------------------------------------------------------------

    @property
    def mobility(self) -> int:
        """Degrees of freedom by the Grübler-Kutzbach criterion (Eq. 1).

        A planar loop closes with three equations; the spatial count of six would take its mechanism
        for over-constrained.
        """
        moving = len(self.mechanism.bodies) - 1
        spatial = 6 * moving - sum(6 - j.freedoms for j in self.mechanism.joints)
        return spatial + 3 * self.planar_loop_count

    @cached_property
    def planar_loop_count(self) -> int:
        """Number of loops of a minimal basis that move in a plane."""
        basis: list[Cycle] = []
        while len(basis) < self.loop_count:
            basis.append(self.minimal_next(basis)[0])
        return sum(cycle.planar for cycle in basis)

    @property
    def loop_count(self) -> int:
        """Number of independent loops (section 4)."""
        return len(self.mechanism.joints) - (len(self.mechanism.bodies) - 1)

    # -- paths ----------------------------------------------------------------------------------

    def shortest_paths(self, start: str, end: str) -> list[tuple[str, ...]]:
        """Return all shortest paths between two bodies, as sequences of bodies, in a fixed order.

        The paper's Table 2 shows one of them where several have the same length.
        """
        paths = nx.all_shortest_paths(self.graph, start, end, weight="length")
        return sorted((tuple(p) for p in paths), key=self._path_numbers)

    def path_length(self, path: Sequence[str]) -> int:
        """Return the sum of the joint freedoms along a path."""
        return sum(self.joint_between(a, b).freedoms for a, b in pairwise(path))

    def _path_numbers(self, path: Sequence[str]) -> tuple[int, ...]:
        return tuple(self.mechanism.body(b).number for b in path)

    # -- cycles ---------------------------------------------------------------------------------

    @cached_property
    def candidate_cycles(self) -> list[Cycle]:
        """Distinct simple cycles by Horton's construction, shortest first.

        Every vertex is joined with both ends of every edge by shortest paths; what is degenerate
        (the two paths share a body or contain the edge) or repeated is left out.
        """
        found: dict[frozenset[str], Cycle] = {}
        for cycle in self.horton_candidates():
            found.setdefault(cycle.key, cycle)
        return sorted(found.values(), key=lambda c: (c.length, self._cycle_numbers(c)))

    def horton_candidates(self) -> list[Cycle]:
        """Return every simple cycle that a pair of vertex and edge gives, with repetitions."""
        cycles = []
        for vertex in self.graph.nodes:
            for joint in self.mechanism.joints:
                for there in self.shortest_paths(vertex, joint.first):
                    for back in self.shortest_paths(vertex, joint.second):
                        round_trip = (*there, *reversed(back[1:]))
                        if len(set(round_trip)) == len(round_trip) > 2:
                            cycles.append(self.cycle(round_trip))
        return cycles

    def cycle(self, bodies: Sequence[str]) -> Cycle:
        """Return the cycle through some bodies, beginning at the one of the lowest number."""
        numbers = self._path_numbers(bodies)
        start = numbers.index(min(numbers))
        turned = [*bodies[start:], *bodies[:start]]
        joints = tuple(self.joint_between(a, b) for a, b in pairwise([*turned, turned[0]]))
        return Cycle(joints, tuple(turned), sum(j.freedoms for j in joints))

    def _cycle_numbers(self, cycle: Cycle) -> tuple[int, ...]:
        return tuple(sorted(self.mechanism.body(b).number for b in cycle.bodies))

    def independent(self, cycles: Sequence[Cycle]) -> bool:
        """Tell whether no cycle is a sum of others (edges modulo two)."""
        rows: list[int] = []
        index = {j.name: i for i, j in enumerate(self.mechanism.joints)}
        for cycle in cycles:
            row = sum(1 << index[name] for name in cycle.key)
            for pivot in rows:
                row = min(row, row ^ pivot)
            if row == 0:
                return False
            rows.append(row)
        return True

    def minimal_next(self, chosen: Sequence[Cycle]) -> list[Cycle]:
        """Return the shortest cycles that extend a basis.

        Taking any one of them until `loop_count` are chosen gives a minimal cycle basis (the
        independent sets of cycles are a matroid, so the greedy choice is optimal).
        """
        extending = [c for c in self.candidate_cycles if self.independent([*chosen, c])]
        return [c for c in extending if c.length == extending[0].length] if extending else []
