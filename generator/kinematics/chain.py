"""The chain of joints with reported coordinates that leads from the ground to a body."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

import networkx as nx

from ..declare.joints import Cylindrical, Free

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..declare.joints import Joint
    from ..declare.mechanism import Mechanism


def reported(mechanism: Mechanism, joint: str, kind: str) -> str | None:
    """Return the first name under which a kind of coordinate of a joint is reported."""
    entries = mechanism.coordinates
    return next((c.name for c in entries if (c.joint.name, c.kind) == (joint, kind)), None)


def chain_to(mechanism: Mechanism, body: str) -> list[Joint] | None:
    """Return the fewest joints from the ground to a body, or None.

    There are none to a body that moves freely in the world, or that hangs on such a body.
    """
    graph = nx.DiGraph()
    for joint in mechanism.joints:
        if not isinstance(joint, Free) and all(
            reported(mechanism, joint.name, kind) for kind in joint.coordinates
        ):
            graph.add_edge(*joint.bodies, joint=joint)
    ends = mechanism.ground, body
    if not all(end in graph for end in ends) or not nx.has_path(graph, *ends):
        return None
    path = nx.shortest_path(graph, *ends)
    return [graph.edges[a, b]["joint"] for a, b in itertools.pairwise(path)]


def before_telescope(chain: Sequence[Joint], joint: Joint) -> bool:
    """Return whether the joint behind one of a chain is a telescope."""
    behind = chain[chain.index(joint) + 1 :]
    return bool(behind) and isinstance(behind[0], Cylindrical)
