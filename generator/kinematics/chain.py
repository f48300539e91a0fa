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
    """Return the first name under which a joint's coordinate is reported.

    Parameters
    ----------
    mechanism
        Whose report it is.
    joint, kind
        Name of the joint, and which of its coordinates.
    """
    entries = mechanism.coordinates
    return next((c.name for c in entries if (c.joint.name, c.kind) == (joint, kind)), None)


def chain_to(mechanism: Mechanism, body: str) -> list[Joint] | None:
    """Return the joints from the ground to a body, as few as can be; None if none lead there.

    None leads to what moves freely in the world, or hangs on it.

    Parameters
    ----------
    mechanism, body
        Whose joints, and which body.
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
    """Return whether a telescope is next behind a joint of a chain.

    Parameters
    ----------
    chain, joint
        The joints from the ground on, and one of them.
    """
    behind = chain[chain.index(joint) + 1 :]
    return bool(behind) and isinstance(behind[0], Cylindrical)
