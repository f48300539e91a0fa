"""The joints and force elements of a rigid axle: rods, bearings, springs and dampers.

The parts are the beam, both wheels and the rods by their names. Points of a rod have its name with
the ending ``_chassis`` or ``_axle``; those of a side end in ``_left`` or ``_right``.
"""

from collections.abc import Iterable

from ...corner.structure import (
    FixedJoint,
    PartJoint,
    SphericalJoint,
    Structure,
    UniversalJoint,
)
from ..sides import SIDES
from ..whole_axle import CHASSIS, lines_of_sides

BEAM = "beam"
CENTER = "wheel_center"
MIDDLE = "axle_middle"
"""The point between the wheel centres, at which an anti-roll bar acts."""

_UPWARD = (0.0, 0.0, 1.0)


def structure_of(rods: Iterable[str]) -> Structure:
    """Return the joints and force elements of an axle on named rods."""
    bearings = [FixedJoint(BEAM, f"wheel_{side}", (f"{CENTER}_{side}",)) for side in SIDES]
    lines = lines_of_sides(dict.fromkeys(SIDES, BEAM))
    # the links of the bar to the body are left out
    return Structure((*of_rods(rods), *bearings), lines, {MIDDLE: ""})


def of_a_file(rods: Iterable[str]) -> Structure:
    """Return the joints that have bushes in a file: both wheel bearings are one."""
    return Structure((*of_rods(rods), FixedJoint(BEAM, "wheel", (CENTER,))), ())


def of_rods(rods: Iterable[str]) -> list[PartJoint]:
    """Return a universal joint at the chassis and a ball joint at the axle for each rod."""
    return [
        joint
        for rod in rods
        for inner, outer in [(f"{rod}_{CHASSIS}", f"{rod}_axle")]
        for joint in (
            SphericalJoint(BEAM, rod, (outer,), inner),
            UniversalJoint(CHASSIS, rod, (inner,), outer, _UPWARD),
        )
    ]
