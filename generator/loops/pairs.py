"""Characteristic pairs of joints, and the closed form that a loop cut at one of them has.

Everything here is structure; the algebra is in `solutions`.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

from ..declare.joints import Cylindrical, Joint, Prismatic, Revolute, Spherical, Universal
from .actions import (
    PinnedTelescope,
    PlaceTelescope,
    SolveHinge,
    SolveSlide,
    SolveStroke,
    SolveStrut,
    SolveTelescope,
    SolveTurn,
    Strut,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..declare.geometry import Point
    from .actions import Solution
    from .graph import Cycle
    from .known import Settled

_OF_TWO_CROSSES = 2  # a telescope between them: its length, and its rotation


@dataclass(frozen=True)
class PairCandidate:
    """A pair of joints at which a loop could be cut, and what that eliminates.

    Attributes
    ----------
    eliminated
        Number of unknown coordinates of the two joints.
    equations
        Number of closure equations that remain, of the six of a spatial loop or the three of a
        planar one. The turn of a link about the line through two ball joints takes part in none.
    """

    joints: tuple[Joint, Joint]
    eliminated: int
    equations: int


@dataclass(frozen=True)
class _CutLoop:
    """A loop cut at the centres of a pair of joints, seen as two arcs from anchor to end.

    ``joints`` and ``bodies`` are those of one arc; ``other_joints`` and ``others`` of the other.
    """

    anchor: Point
    end: Point
    joints: tuple[Joint, ...]
    bodies: tuple[str, ...]
    other_joints: tuple[Joint, ...]
    others: tuple[str, ...]


def _common_point(joint: Joint, cycle: Cycle) -> Point | None:
    """Return the point that a joint keeps common; in a plane, a hinge has one too."""
    if cycle.planar and isinstance(joint, Revolute):
        return joint.axis.through
    return joint.center


def _views(cycle: Cycle, pair: PairCandidate) -> list[_CutLoop]:
    """Return the four ways to look at a cut loop: either arc first, either direction."""
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
        views.append(_CutLoop(anchor, end, joints, bodies, other_joints, others))
        views.append(
            _CutLoop(end, anchor, joints[::-1], bodies[::-1], other_joints[::-1], others[::-1])
        )
    return views


def pair_candidates(settled: Settled, cycle: Cycle) -> list[PairCandidate]:
    """Return the pairs of joints that both keep a point in common, most eliminated first."""
    pairs = [
        _pair(settled, cycle, a, b)
        for a, b in combinations(cycle.joints, 2)
        if _common_point(a, cycle) is not None and _common_point(b, cycle) is not None
    ]
    return sorted(pairs, key=lambda p: -p.eliminated)


def _pair(settled: Settled, cycle: Cycle, a: Joint, b: Joint) -> PairCandidate:
    eliminated = settled.unknowns_of(a) + settled.unknowns_of(b)
    idle = isinstance(a, Spherical) and isinstance(b, Spherical)
    dimension = 3 if cycle.planar else 6
    return PairCandidate((a, b), eliminated, dimension - eliminated + idle)


def closed_form(settled: Settled, cycle: Cycle, pair: PairCandidate) -> Solution | None:
    """Return the solution of a loop cut at a pair, if its equation is in the catalogue.

    All that the equation reads must be known.
    """
    rules: tuple[Callable[[Settled, _CutLoop], Solution | None], ...]
    if pair.equations == 1:
        rules = (_telescope, _stroke, _free_strut, _turn, _driven_by_rod)
    elif pair.equations == _OF_TWO_CROSSES:
        rules = (_telescope,)  # its length does not depend on its rotation
    else:
        return None
    tried = (rule(settled, view) for view in _views(cycle, pair) for rule in rules)
    return next((action for action in tried if action), None)


def _stroke(settled: Settled, view: _CutLoop) -> SolveStroke | None:
    """Return the action for two links on a guide in a plane, both pins on placed bodies."""
    telescope = _pinned_telescope(settled, view)
    placed = {view.others[0], view.others[-1]} <= settled.placed
    if telescope is None or not placed or settled.unknowns_of(telescope.joint) == 0:
        return None
    return SolveStroke(**vars(telescope))


def _pinned_telescope(settled: Settled, view: _CutLoop) -> PinnedTelescope | None:
    """Return the telescope in a plane that one arc of a loop is."""
    if len(view.joints) != 1 or not isinstance(view.joints[0], Prismatic):
        return None
    near, far = view.bodies
    near_hinge = settled.topology.joint_between(view.others[0], near)
    far_hinge = settled.topology.joint_between(view.others[-1], far)
    if not (isinstance(near_hinge, Revolute) and isinstance(far_hinge, Revolute)):
        return None
    if {near, far} & settled.placed:
        return None
    at_anchor = near, near_hinge, view.anchor, view.others[0]
    return PinnedTelescope(view.joints[0], *at_anchor, far, far_hinge, view.end, view.others[-1])


def _free_strut(settled: Settled, view: _CutLoop) -> SolveStrut | None:
    """Return the action for a strut in space, both ends on placed bodies."""
    strut = _strut(settled, view)
    placed = {view.others[0], view.others[-1]} <= settled.placed
    if strut is None or not placed or settled.unknowns_of(strut.joint) == 0:
        return None
    return SolveStrut(**vars(strut))


def _strut(settled: Settled, view: _CutLoop) -> Strut | None:
    """Return the strut in space that one arc of a loop is."""
    if len(view.joints) != 1 or not isinstance(view.joints[0], Prismatic):
        return None
    near, far = view.bodies
    cross = settled.topology.joint_between(view.others[0], near)
    ball = settled.topology.joint_between(view.others[-1], far)
    crossed = isinstance(cross, Universal) and cross.second == near and isinstance(ball, Spherical)
    between = view.joints[0].direction.between
    along = between is not None and set(between) == {view.anchor, view.end}
    if not (crossed and along) or {near, far} & settled.bodies:
        return None
    return Strut(view.joints[0], near, view.anchor, view.others[0], far, view.end, view.others[-1])


def _driven_by_rod(settled: Settled, view: _CutLoop) -> SolveHinge | SolveSlide | None:
    """Return the action for a rod from a placed point to a body on a hinge or a guide."""
    pinned, strut = _pinned_telescope(settled, view), _strut(settled, view)
    if not (len(view.bodies) == 1 or pinned or strut) or not view.other_joints:
        return None
    rod, joint, body = view.bodies[0], view.other_joints[-1], view.others[-1]
    parent = joint.other(body)
    done = {rod, body} & settled.placed or settled.unknowns_of(joint) == 0
    if done or not {parent, view.others[0]} <= settled.placed:
        return None
    telescope = PlaceTelescope(**vars(pinned)) if pinned else strut
    if telescope and settled.unknowns_of(telescope.joint) > 0:
        return None
    held = parent, rod, view.end, view.anchor, view.others[0], telescope
    if isinstance(joint, Revolute):
        return SolveHinge(body, joint, *held)
    return SolveSlide(body, joint, *held) if isinstance(joint, Prismatic) else None


def _telescope(settled: Settled, view: _CutLoop) -> SolveTelescope | None:
    """Return the action for two links on a common axis, both ends on placed bodies."""
    if len(view.joints) != 1 or not isinstance(view.joints[0], Cylindrical):
        return None
    joint, (anchor_link, end_link) = view.joints[0], view.bodies
    # the axis of the joint runs from the second body to the anchor, a point of the first
    along_axis = joint.axis.towards == view.anchor
    placed = {view.others[0], view.others[-1]} <= settled.placed
    if settled.knows(joint, "slide") or not (along_axis and placed):
        return None
    if anchor_link != joint.first:
        return None
    return SolveTelescope(
        joint, view.anchor, view.others[0], anchor_link, view.end, view.others[-1], end_link
    )


def _turn(settled: Settled, view: _CutLoop) -> SolveTurn | None:
    """Return the action for a rod from a placed point to a body that can still turn."""
    if len(view.bodies) != 1:
        return None
    if view.others[0] not in settled.placed or view.others[-1] not in settled.on_line:
        return None
    return SolveTurn(view.others[-1], view.bodies[0], view.end, view.anchor, view.others[0])
