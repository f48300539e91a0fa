"""Redundant parallel links between two bodies, as on the driving wheels of a locomotive.

Three links with a hinge at either end, in one plane and between the same two bodies, lock these
unless all of them are parallel and equally long. Then one body moves along the other without
turning, however many such links there are. Any other body with a hinge on both, such as the frame
with the bearings of two cranks, is one more link; where it is not parallel, it locks them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..declare.evaluation import AtDefaults
from ..declare.joints import Revolute
from ..program.floors import ROUNDING

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Sequence

    from ..declare.mechanism import Mechanism
    from ..program.vectors import Vector

ENOUGH = 2  # to hold two bodies together in a plane

_Ends = dict[str, Revolute]
"""Two hinges of a link, by the bodies at their other side."""


def families(
    mechanism: Mechanism, in_a_plane: Callable[[Sequence[str]], bool]
) -> dict[frozenset[str], tuple[str, ...]]:
    """Return the redundant links between two bodies, by these.

    `in_a_plane` returns whether the loop through some bodies moves in a plane.
    """
    found: dict[frozenset[str], list[str]] = {}
    for body in mechanism.moving:
        joints = mechanism.joints_of(body.name)
        ends = frozenset(joint.other(body.name) for joint in joints)
        if len(joints) == ENOUGH and ends_of(mechanism, body.name, ends):
            found.setdefault(ends, []).append(body.name)
    held = {
        pair: (*links, *_frames(mechanism, pair, links))
        for pair, links in found.items()
        if len(links) > ENOUGH
    }
    return {
        pair: links
        for pair, links in held.items()
        if all(in_a_plane(_loop(pair, links[0], link)) for link in links[1:])
    }


def ends_of(mechanism: Mechanism, link: str, pair: Collection[str]) -> _Ends | None:
    """Return the hinges of a link on both bodies of a pair, by these; None without both."""
    joints = [(joint.other(link), joint) for joint in mechanism.joints_of(link)]
    hinges = {o: joint for o, joint in joints if o in pair and isinstance(joint, Revolute)}
    return hinges if len(hinges) == ENOUGH else None


def is_along(mechanism: Mechanism, hinge: Revolute, off: Vector, length: Vector) -> bool:
    """Return whether a vector is along a hinge by default, but for the rounding of another one."""
    value = AtDefaults(mechanism)
    n, off_at, beside = (np.array([value(c) for c in v]) for v in (hinge.axis.vector, off, length))
    least = float(ROUNDING) * np.linalg.norm(n) * np.linalg.norm(beside)
    return bool(np.linalg.norm(np.cross(n, off_at)) <= least)  # not so if one is NaN


def _frames(mechanism: Mechanism, pair: Collection[str], links: Sequence[str]) -> list[str]:
    """Return other bodies with hinges on two bodies that are parallel to their links by default."""
    one, other = sorted(pair)
    found = {b.name: ends_of(mechanism, b.name, pair) for b in mechanism.bodies}
    ways = {
        b: ends[other].axis.through.position - ends[one].axis.through.position
        for b, ends in found.items()
        if ends
    }
    hinges, model = found[links[0]], ways.pop(links[0])
    assert hinges
    return [
        body
        for body, way in ways.items()
        if body not in links and is_along(mechanism, hinges[one], way - model, model)
    ]


def _loop(pair: Collection[str], first: str, second: str) -> tuple[str, ...]:
    """Return two bodies with a link on either side between them."""
    one, other = sorted(pair)
    return one, first, other, second
