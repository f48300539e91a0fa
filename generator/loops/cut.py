"""Characteristic pairs of joints, and a loop cut at one of them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

from ..declare.joints import Joint, Revolute, Spherical

if TYPE_CHECKING:
    from ..declare.geometry import Point
    from .graph import Cycle
    from .known import Known


@dataclass(frozen=True)
class PairCandidate:
    """A pair of joints at which a loop could be cut."""

    joints: tuple[Joint, Joint]
    eliminated: int  # number of unknown coordinates of the two joints
    # number of closure equations that remain, of the six of a spatial loop or the three of a planar
    # one or one about a point. The turn of a link about the line through two ball joints is in none
    # of them.
    equations: int


@dataclass(frozen=True)
class CutLoop:
    """A loop cut at the centres of a pair of joints, as two arcs from anchor to end.

    ``joints`` and ``bodies`` are those of one arc; ``other_joints`` and ``others`` of the other.
    """

    anchor: Point
    end: Point
    joints: tuple[Joint, ...]
    bodies: tuple[str, ...]
    other_joints: tuple[Joint, ...]
    others: tuple[str, ...]


def _common_point(joint: Joint, cycle: Cycle) -> Point | None:
    """Return the point that a joint keeps common to both bodies; that of a planar hinge, too."""
    if cycle.planar and isinstance(joint, Revolute):
        return joint.axis.through
    if cycle.center is not None:
        return cycle.center
    return joint.center


def views(cycle: Cycle, pair: PairCandidate) -> list[CutLoop]:
    """Return the four ways to see a cut loop: either arc first, in either direction."""
    i, j = sorted(cycle.joints.index(joint) for joint in pair.joints)
    anchor, end = (_common_point(cycle.joints[k], cycle) for k in (i, j))
    if anchor is None or end is None:
        return []
    inner = cycle.joints[i + 1 : j], cycle.bodies[i + 1 : j + 1]
    outer = (
        (cycle.joints[j + 1 :] + cycle.joints[:i])[::-1],
        (cycle.bodies[j + 1 :] + cycle.bodies[: i + 1])[::-1],
    )
    views = []
    for (joints, bodies), (other_joints, others) in ((inner, outer), (outer, inner)):
        views.append(CutLoop(anchor, end, joints, bodies, other_joints, others))
        views.append(
            CutLoop(end, anchor, joints[::-1], bodies[::-1], other_joints[::-1], others[::-1])
        )
    return views


def pair_candidates(known: Known, cycle: Cycle) -> list[PairCandidate]:
    """Return the pairs of joints with a common point each, most eliminated unknowns first."""
    pairs = [
        _pair(known, cycle, a, b)
        for a, b in combinations(cycle.joints, 2)
        if _common_point(a, cycle) is not None and _common_point(b, cycle) is not None
    ]
    if cycle.center is not None:  # all ends of arcs are one point: not for forms with two
        pairs = [pair for pair in pairs if pair.equations == 0]
    return sorted(pairs, key=lambda p: -p.eliminated)


def _pair(known: Known, cycle: Cycle, a: Joint, b: Joint) -> PairCandidate:
    eliminated = known.unknowns_of(a) + known.unknowns_of(b)
    idle = isinstance(a, Spherical) and isinstance(b, Spherical)
    dimension = 3 if cycle.planar or cycle.center is not None else 6
    return PairCandidate((a, b), eliminated, dimension - eliminated + idle)
