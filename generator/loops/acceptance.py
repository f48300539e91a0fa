"""What a solution settles: the bodies that it places, and the coordinates that follow."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..declare.joints import Revolute
from .actions import (
    PinnedTelescope,
    PlaceByPin,
    SolveCarrier,
    SolveHinge,
    SolveSlide,
    SolveStroke,
    SolveStrut,
    SolveTelescope,
    SolveTogether,
    SolveTurn,
    Strut,
)

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ..declare.joints import Joint
    from .actions import Action, Solution
    from .known import Coordinate, Settled


def accept(settled: Settled, actions: list[Action], solution: Solution) -> set[Coordinate]:
    """Append a solution to the actions, with what it entails.

    Returns
    -------
    set
        The coordinates that were not known before.
    """
    actions.append(solution)
    match solution:
        case SolveHinge() | SolveSlide():
            new = _driven(settled, actions, solution)
        case SolveStroke():
            new = _pinned_telescope(settled, solution)
        case SolveStrut():
            new = _strut(settled, solution)
        case SolveCarrier():
            new = _carrier(settled, solution)
        case SolveTogether():
            new = _together(settled, actions, solution)
        case SolveTelescope():
            new = _telescope(settled, solution)
        case SolveTurn():
            new = _turned(settled, actions, solution)
    return new


def coordinates_of(joints: Iterable[Joint]) -> set[Coordinate]:
    """Return all relative coordinates of some joints."""
    return {(joint.name, c) for joint in joints for c in joint.coordinates}


def _driven(
    settled: Settled, actions: list[Action], solution: SolveHinge | SolveSlide
) -> set[Coordinate]:
    """Record the body that a rod drives, and the rod: placed by its hinge, or on its line."""
    settled.placed.add(solution.body)
    if isinstance(solution.telescope, Strut):
        new = settled.add(coordinates_of([solution.joint]))
        return new | _strut(settled, solution.telescope)
    if solution.telescope is not None:
        actions.append(solution.telescope)
        new = settled.add(coordinates_of([solution.joint]))
        return new | _pinned_telescope(settled, solution.telescope)
    carrier = settled.topology.joint_between(solution.anchor_body, solution.rod)
    at_rod = settled.mechanism.joints_of(solution.rod)
    if isinstance(carrier, Revolute):
        actions.append(
            PlaceByPin(solution.rod, carrier, solution.anchor_body, solution.end, solution.body)
        )
        settled.placed.add(solution.rod)
        return settled.add(coordinates_of(filter(settled.joins, [solution.joint, *at_rod])))
    settled.on_line.add(solution.rod)  # its turn about the line is still open
    return settled.add(coordinates_of([solution.joint]) - coordinates_of(at_rod))


def _turned(settled: Settled, actions: list[Action], solution: SolveTurn) -> set[Coordinate]:
    """Record a body that a rod keeps from turning, and the telescopes that it aims."""
    settled.on_line.discard(solution.body)
    settled.placed.add(solution.body)
    settled.on_line.add(solution.rod)
    telescopes = [a for a in actions if isinstance(a, SolveTelescope) and a.misses_end]
    aimed = [_aim(settled, a) for a in telescopes if a.end_link == solution.body]
    joints = [joint for joints in aimed for joint in joints]
    joints += settled.mechanism.joints_of(solution.rod)
    joints += filter(settled.joins, settled.mechanism.joints_of(solution.body))
    return settled.add(coordinates_of(joints))


def _telescope(settled: Settled, solution: SolveTelescope) -> set[Coordinate]:
    """Record the length of a telescope, and its direction unless its axis misses the end."""
    settled.on_line.add(solution.end_link)
    joints = [] if solution.misses_end else _aim(settled, solution)
    return settled.add({(solution.joint.name, "slide")} | coordinates_of(joints))


def _aim(settled: Settled, action: SolveTelescope) -> list[Joint]:
    """Record that the direction of a telescope is known; return what that settles."""
    settled.on_line.add(action.anchor_link)
    universal = settled.mechanism.universal_at(action.anchor_link, action.anchor)
    return [universal] if universal else []


def _pinned_telescope(settled: Settled, solution: PinnedTelescope) -> set[Coordinate]:
    """Record the two links of a telescope in a plane, and the joints at them."""
    settled.placed |= {solution.near, solution.far}
    links = (solution.joint, solution.near_hinge, solution.far_hinge)
    return settled.add(coordinates_of(links))


def _strut(settled: Settled, strut: Strut) -> set[Coordinate]:
    """Record the line of a strut; its cross places the first link, and that the second one."""
    settled.on_line.add(strut.near)
    links = (strut.near, strut.far)
    joints = [joint for link in links for joint in settled.mechanism.joints_of(link)]
    return settled.add(coordinates_of(joints))


def _carrier(settled: Settled, solution: SolveCarrier) -> set[Coordinate]:
    """Record a body that rods hold together, and the rods: each on its line."""
    settled.placed.add(solution.body)
    settled.on_line |= {held.rod for held in solution.rods}
    links = [link for held in solution.rods for link in held.links]
    at_rods = [j for link in links for j in settled.mechanism.joints_of(link)]
    at_body = filter(settled.joins, settled.mechanism.joints_of(solution.body))
    return settled.add(coordinates_of([*at_rods, *at_body]))


def _together(settled: Settled, actions: list[Action], solution: SolveTogether) -> set[Coordinate]:
    """Record the bodies of a tree, and the rods: pinned in a plane, or each on its line."""
    settled.placed.update(solution.bodies)
    joints = [branch.joint for branch in solution.tree] + [cut.joint for cut in solution.cuts]
    for held in solution.rods:
        hinge = settled.topology.joint_between(held.anchor_body, held.rod)
        if isinstance(hinge, Revolute):
            actions.append(PlaceByPin(held.rod, hinge, held.anchor_body, held.end, held.body))
            settled.placed.add(held.rod)
        else:
            settled.on_line.add(held.rod)
        joints += settled.mechanism.joints_of(held.rod)
    return settled.add(coordinates_of(joints))
