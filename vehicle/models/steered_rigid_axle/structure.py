"""The joints and force elements of a steered rigid axle, besides those of a rigid axle.

Parts are beam, knuckles and wheels, the rods by their names, drag link and track rod; the Pitman
arm is held by the steering. Points of a side end in ``_left`` or ``_right``.
"""

from collections.abc import Iterable

from ...corner.structure import (
    FixedJoint,
    HingeJoint,
    PartJoint,
    SphericalJoint,
    Structure,
    UniversalJoint,
)
from ..rigid_axle.structure import BEAM, CENTER, MIDDLE, of_rods
from ..sides import SIDES
from ..whole_axle import lines_of_sides
from .file import LOWER, TRACK_ROD, UPPER

PITMAN_ARM, DRAG_LINK = "pitman_arm", "drag_link"
BALL, KNUCKLE_END = "pitman_ball", "drag_link_knuckle"
"""The ends of the drag link, at the Pitman arm and at a knuckle."""

_UPWARD = (0.0, 0.0, 1.0)


def knuckle(side: str) -> str:
    """Return the name of the knuckle of a side."""
    return f"knuckle_{side}"


def structure_of(rods: Iterable[str], near: str) -> Structure:
    """Return the joints and force elements of an axle on named rods.

    `near` is the side of the drag link.
    """
    (far,) = {*SIDES} - {near}
    of_sides = [
        joint
        for side in SIDES
        for joint in (
            HingeJoint(BEAM, knuckle(side), (f"{LOWER}_{side}", f"{UPPER}_{side}")),
            FixedJoint(knuckle(side), f"wheel_{side}", (f"{CENTER}_{side}",)),
        )
    ]
    ends = f"{TRACK_ROD}_{near}", f"{TRACK_ROD}_{far}"
    steering = _steering(knuckle(near), knuckle(far), ends)
    lines = lines_of_sides(dict.fromkeys(SIDES, BEAM))
    return Structure((*of_rods(rods), *of_sides, *steering), lines, {MIDDLE: ""})


def of_a_file(rods: Iterable[str]) -> Structure:
    """Return the joints that have bushes in a file: those of both sides are one."""
    of_a_side = (
        HingeJoint(BEAM, "knuckle", (LOWER, UPPER)),
        FixedJoint("knuckle", "wheel", (CENTER,)),
    )
    steering = _steering("knuckle", "knuckle", (f"{TRACK_ROD}_other", TRACK_ROD))
    return Structure((*of_rods(rods), *of_a_side, *steering), ())


def _steering(near: str, far: str, ends: tuple[str, str]) -> tuple[PartJoint, ...]:
    """Return the joints of drag link and track rod, whose ends are at the near and far knuckle."""
    first, last = ends
    return (
        UniversalJoint(PITMAN_ARM, DRAG_LINK, (BALL,), KNUCKLE_END, _UPWARD),
        SphericalJoint(near, DRAG_LINK, (KNUCKLE_END,), BALL),
        UniversalJoint(near, TRACK_ROD, (first,), last, _UPWARD),
        SphericalJoint(far, TRACK_ROD, (last,), first),
    )
