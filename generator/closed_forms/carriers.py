"""Bodies that only rods hold, all together: wheel carriers on several links."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..declare.joints import Joint, Prismatic, Spherical, Universal
from ..loops.actions import HeldByRod, SolveCarrier

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..declare.assembly import Body
    from ..declare.geometry import Point
    from ..loops.graph import Cycle
    from ..loops.known import Settled

# A rod is one equation; the pose of a body about a known point has three unknowns, else six.
_RODS_ABOUT_A_POINT = 3
_RODS_WITHOUT_A_POINT = 6


def held_together(
    settled: Settled, waiting: Sequence[Cycle]
) -> tuple[SolveCarrier | None, list[Cycle]]:
    """Return the first body that rods hold together, with the loops that they close."""
    for body in settled.mechanism.bodies:
        action = _carrier(settled, body)
        if action is None:
            continue
        links = {link for held in action.rods for link in held.links}
        inside = {action.body} | links | settled.placed
        closed = [cycle for cycle in waiting if inside.issuperset(cycle.bodies)]
        if len(closed) == action.loops:
            return action, closed
    return None, []


def _carrier(settled: Settled, body: Body) -> SolveCarrier | None:
    """Return the action for a body that three rods and a point hold, or six rods."""
    if body.name in settled.bodies:
        return None
    joints = settled.mechanism.joints_of(body.name)
    rods = [held for joint in joints if (held := _rod(settled, body, joint))]
    bases = [j for j in joints if isinstance(j, Spherical) and j.other(body.name) in settled.placed]
    if len(bases) == 1 and len(rods) == _RODS_ABOUT_A_POINT:
        (base,) = bases
        return SolveCarrier(body.name, tuple(rods), (base.at, base.other(body.name)))
    if not bases and len(rods) == _RODS_WITHOUT_A_POINT:
        return SolveCarrier(body.name, tuple(rods))
    return None


def _rod(settled: Settled, body: Body, joint: Joint) -> HeldByRod | None:
    """Return the rod that holds a body at a joint, if its other end is at a placed body."""
    end, rod = joint.center, joint.other(body.name)
    far, guide, other = None, None, _beyond(settled, joint, rod)
    if isinstance(other, Prismatic) and settled.unknowns_of(other) == 0:
        guide, far, rod = other, rod, other.other(rod)
        other = _beyond(settled, guide, rod)
    anchor = other.center if other else None
    if other is None or end is None or anchor is None:
        return None
    if {rod, far} & settled.bodies or other.other(rod) not in settled.placed:
        return None
    if guide is not None and not _is_strut(guide, rod, other, end):
        return None
    return HeldByRod(body.name, rod, end, anchor, other.other(rod), guide, far)


def _beyond(settled: Settled, joint: Joint, link: str) -> Joint | None:
    """Return the other joint of a link that has two."""
    others = [j for j in settled.mechanism.joints_of(link) if j != joint]
    return others[0] if len(others) == 1 else None


def _is_strut(guide: Prismatic, rod: str, anchor: Joint, end: Point) -> bool:
    """Tell whether a guide is along the line of its ends, and a cross holds its first link."""
    between = guide.direction.between
    along = between is not None and set(between) == {anchor.center, end}
    crossed = isinstance(anchor, Universal) and anchor.second == rod
    return along and crossed and guide.first == rod
