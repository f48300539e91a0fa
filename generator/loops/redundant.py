"""Redundant branches, such as a second coupler on the pins of the first.

The count of degrees of freedom takes every branch for a constraint of its own, so that a mechanism
with one too many seems to be locked. In numbers, at the design position, its mobility is the same
with the branch and without.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import networkx as nx

from ..declare.declared import DeclarationError
from .errors import TopologyError
from .graph import JointGraph
from .mobility import Mobility

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from ..declare.joints import Joint
    from ..declare.mechanism import Mechanism

_ENDS = 2  # of a link in a branch

Branch = tuple[tuple[str, ...], tuple["Joint", ...]]
"""Bodies, and all joints at them; a joint alone, where there are none."""


def redundant(mechanism: Mechanism, driven: Collection[str] = ()) -> str:
    """Return a sentence on branches that can be left out; empty: there are none.

    The default parameters are used. No branch with a `driven` joint, which is independent or
    prescribed, is left out.
    """
    whole = Mobility(JointGraph(mechanism), driven)
    if not whole.is_known:
        return ""
    needed = {*driven, *(j.name for j in mechanism.geared)}
    needed |= {joint.first_followed.name for joint in mechanism.geared}
    found = [
        branch
        for branch in _branches(mechanism)
        if needed.isdisjoint(joint.name for joint in branch[1])
        and _freedoms_without(mechanism, branch[1]) in range(1, whole.freedoms + 1)
    ]
    if not found:
        return ""
    named, them = " or ".join(map(_named, found)), "one of them" if len(found) > 1 else "it"
    return (
        f"At the design position with the default parameters it moves as freely without {named}: "
        "the other joints prevent the same motions, so that it is redundant, and the forces in "
        f"such a branch are not determined. Leave {them} out"
    )


def _branches(mechanism: Mechanism) -> Iterator[Branch]:
    """Yield chains of bodies with two joints each, then joints."""
    graph = nx.Graph([joint.bodies for joint in mechanism.joints])
    links = [b.name for b in mechanism.moving if len(mechanism.joints_of(b.name)) == _ENDS]
    for bodies in nx.connected_components(graph.subgraph(links)):
        inside = (joint for joint in mechanism.joints if not bodies.isdisjoint(joint.bodies))
        yield tuple(name for name in links if name in bodies), tuple(inside)
    bridges = {frozenset(bridge) for bridge in nx.bridges(graph)}
    for joint in mechanism.joints:
        if frozenset(joint.bodies) not in bridges:
            yield (), (joint,)


def _freedoms_without(mechanism: Mechanism, joints: Collection[Joint]) -> int:
    """Return the number of motions without some joints; -1 where no mechanism is left."""
    rest = tuple(joint for joint in mechanism.joints if joint not in joints)
    if not rest:
        return -1
    try:
        bare = replace(mechanism, joints=rest, forces=(), coordinates=(), outputs=())
        topology = JointGraph(bare)
    except (DeclarationError, TopologyError):  # it falls apart, or off the ground
        return -1
    return Mobility(topology, ()).freedoms


def _named(branch: Branch) -> str:
    bodies, joints = branch
    names = ", ".join(joint.name for joint in joints)
    return f"{' and '.join(bodies)} (joints {names})" if bodies else f"joint {names}"
