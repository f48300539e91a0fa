"""Links between two bodies that are there once too often, as on the driving wheels of a locomotive.

Three links with a hinge at either end, in one plane and between the same two bodies, lock these
unless all of them are parallel and equally long. Then one body moves along the other without
turning, however many such links there are.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..declare.joints import Revolute

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Sequence

    from ..declare.mechanism import Mechanism

ENOUGH = 2  # to hold two bodies together in a plane


def families(
    mechanism: Mechanism, in_a_plane: Callable[[Sequence[str]], bool]
) -> dict[frozenset[str], tuple[str, ...]]:
    """Return the links between two bodies, by these, where there are more than enough.

    Parameters
    ----------
    in_a_plane
        Tells whether the loop through some bodies moves in a plane.
    """
    found: dict[frozenset[str], list[str]] = {}
    for body in mechanism.moving:
        ends = ends_of(mechanism, body.name)
        if ends is not None:
            found.setdefault(frozenset(ends), []).append(body.name)
    return {
        pair: tuple(links)
        for pair, links in found.items()
        if len(links) > ENOUGH
        and all(in_a_plane(_loop(pair, links[0], link)) for link in links[1:])
    }


def ends_of(mechanism: Mechanism, link: str) -> dict[str, Revolute] | None:
    """Return the hinges of a link by the bodies at their other side; None: it is no such link."""
    joints = mechanism.joints_of(link)
    hinges = {joint.other(link): joint for joint in joints if isinstance(joint, Revolute)}
    return hinges if len(joints) == len(hinges) == ENOUGH else None


def _loop(pair: Collection[str], first: str, second: str) -> tuple[str, ...]:
    """Return two bodies with a link on either side between them."""
    one, other = sorted(pair)
    return one, first, other, second
