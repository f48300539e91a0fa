"""Bodies that parallel links keep from turning against each other, while others turn them.

Three parallel and equally long links between two bodies have one equation more than necessary. It
is fulfilled where the links themselves place a body, and where guides keep both from turning. A
loop that turns one of them against the other locks the mechanism, and is refused.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import networkx as nx

from ..declare.joints import Prismatic, Weld
from .parallel import ends_of

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from .known import Known


def turn_alike(known: Known, one: str, other: str) -> bool:
    """Return whether guides or parallel links keep two bodies from turning against each other.

    Special dimensions, as of a parallelogram of four hinges, do not count.
    """
    graph = nx.Graph([tuple(pair) for pair in known.alike])
    graph.add_nodes_from((one, other))
    rigid = (j for j in known.mechanism.joints if isinstance(j, Prismatic | Weld))
    graph.add_edges_from(joint.bodies for joint in rigid)
    return bool(nx.has_path(graph, one, other))


def held_apart(known: Known, driven: Collection[str]) -> str:
    """Return a sentence on parallel links of bodies that other loops turn, or ""."""
    for pair, links in known.topology.parallel_links.items():
        waiting = [link for link in links if link not in known.placed]
        if not waiting or len(waiting) == len(links) or not pair <= known.placed:
            continue
        one, other = (body.name for body in known.mechanism.bodies if body.name in pair)
        if turn_alike(known, one, other):
            continue
        names = ", ".join(waiting)
        return (
            f"The links {', '.join(links)} let {other} move on {one} only without turning, if they "
            f"are parallel and equally long; but loops that close without {names} may turn it, "
            f"and then nothing moves. Leave {names} out{_or_else(known, pair, links, driven)}"
        )
    return ""


def _or_else(
    known: Known, pair: Collection[str], links: Sequence[str], driven: Collection[str]
) -> str:
    """Return further advice about bodies that other loops turn against their parallel links."""
    ends = {b.name: ends_of(known.mechanism, b.name, pair) for b in known.mechanism.bodies}
    for body, hinges in ends.items():
        if hinges and body not in links:
            return f", or make the way between the hinges of {body} on them that of {links[0]}"
        if hinges and all(hinge.name in driven for hinge in hinges.values()):
            return f", or drive one of the hinges of {body} only"
    return ""
