"""The body of a mechanism that is a base at the end of joints (`jointed_base`)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import networkx as nx

from ..declare.joints import Prismatic, Revolute

if TYPE_CHECKING:
    from ..declare.formulation import Formulation
    from ..declare.mechanism import Mechanism


def jointed_base(formulation: Formulation) -> tuple[list[str], str] | None:
    """Return the links to the body that carries all others, and that body; None without one.

    The path from the ground is along independent hinges and guides; each body on it but the last
    has no other joints and no mass, and bodies that hang on the last one close loops with it. No
    joint follows others through gears.
    """
    mechanism = formulation.mechanism
    if mechanism.geared or formulation.states.free:
        return None
    links: list[str] = []
    at, seen = mechanism.ground, set[str]()
    while True:
        onward = [joint for joint in mechanism.joints_of(at) if joint.name not in seen]
        if len(onward) != 1 or onward[0] not in formulation.independent:
            break
        (joint,) = onward
        if not isinstance(joint, Prismatic | Revolute) or joint.first.name != at or joint.gear:
            break
        if links and formulation.has_mass(at):
            break
        seen.add(joint.name)
        links.append(at)
        at = joint.second.name
    return (links[1:], at) if seen and _closes_loops(mechanism, at, {*links}) else None


def _closes_loops(mechanism: Mechanism, base: str, before: set[str]) -> bool:
    """Return whether bodies that hang on a base are joined to it twice."""
    graph = nx.Graph([joint.bodies for joint in mechanism.joints])
    graph.remove_nodes_from({base, *before})
    ends = [
        joint.other(base) for joint in mechanism.joints_of(base) if joint.other(base) not in before
    ]
    return any(sum(end in group for end in ends) > 1 for group in nx.connected_components(graph))
