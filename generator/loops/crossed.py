"""Links at universal joints that constrain less, or more, than intended.

A link with a universal joint at either end keeps its length and carries a moment, too: two
equations, and a shaft between two bearings could be neither longer nor shorter. Nothing in the
catalogue solves both, and to leave one out would be wrong.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..declare.joints import Prismatic, Universal

if TYPE_CHECKING:
    from ..declare.mechanism import Mechanism
    from .graph import Cycle


def between_crosses(mechanism: Mechanism, cycle: Cycle) -> str:
    """Return a sentence on a body of a loop with universal joints only; empty without one."""
    for body in cycle.bodies:
        crosses = mechanism.joints_of(body)
        if body == mechanism.ground or not all(isinstance(j, Universal) for j in crosses):
            continue
        first, second = (repr(joint.name) for joint in crosses[:2])
        found = f"Only the crosses {first} and {second} hold {body!r}"
        if any(joint.second.name != body for joint in crosses):
            return f"{found}: give it a hinge on a body that the others do not move"
        return (
            f"{found}. As a rod it needs only one: make the other a ball joint. As a shaft it must "
            "telescope: make it of two bodies, with a Prismatic along the line of the crosses"
        )
    return ""


def crosses_turned(mechanism: Mechanism, cycle: Cycle) -> str:
    """Return a sentence on a universal joint that is declared the wrong way round, or "".

    Its first body is a link on a guide.
    """
    for joint in cycle.joints:
        if isinstance(joint, Universal):
            link, other = joint.bodies
            held = [j for j in mechanism.joints_of(link) if j is not joint]
            if len(held) == 1 and isinstance(held[0], Prismatic):
                return (
                    f"The shaft is the second body of a cross: declare {other!r} first and "
                    f"{link!r} second in {joint.name!r}, with the shaft along that link"
                )
    return ""
