"""A double wishbone suspension whose spring lies on the chassis: a pull rod and a rocker move it.

It is the push-rod suspension, but for the rod: it hangs on the upper arm and turns the rocker by
pulling. The default values are this project's own.
"""

from __future__ import annotations

from dataclasses import replace

from .. import declare as d
from . import double_wishbone as wishbones
from .double_wishbone import ACTUATOR, CHASSIS, DAMPER, DOUBLE_WISHBONE, RACK_GUIDE, TYRE, WEIGHT
from .suspension import RACK_FORCE, RACK_MOTION, further_laws, of_rubber, spring_table

ROD_OUTER = d.Point("pull_rod_outer", (-0.01, -0.62, 0.49), "pull rod at the upper arm")
ROD_INNER = d.Point("pull_rod_inner", (-0.01, -0.363, 0.233), "pull rod at the rocker")
ROCKER_FRONT = d.Point("rocker_front", (0.03, -0.29, 0.26), "front bearing of the rocker")
ROCKER_REAR = d.Point("rocker_rear", (-0.05, -0.29, 0.26), "rear bearing of the rocker")
SPRING_TOP = d.Point("spring_top", (-0.03, -0.05, 0.334), "end of the spring on the chassis")
SPRING_SEAT = d.Point("spring_seat", (-0.01, -0.354, 0.324), "end of the spring on the rocker")

ROCKER = d.Body("rocker", 0.8, (-0.01, -0.3, 0.26), (0.001, 0.001, 0.001))
PULL_ROD = d.Body("pull_rod", 0.0, (-0.01, -0.4915, 0.3615))

ROCKER_HINGE = d.Revolute("rocker_hinge", CHASSIS, ROCKER, axis=d.Line(ROCKER_REAR, ROCKER_FRONT))
HEAD = d.Spherical("pull_rod_ball", wishbones.UPPER_ARM, PULL_ROD, at=ROD_OUTER)
FOOT = d.Universal(
    "pull_rod_cross",
    ROCKER,
    PULL_ROD,
    at=ROD_INNER,
    shaft=d.Line(ROD_INNER, ROD_OUTER),
    first_axis=d.Direction("rocker_axis", between=(ROCKER_REAR, ROCKER_FRONT)),
)
SPRING = d.LinearSpring(
    rate=d.SpringRate("spring_rate", 60000.0, "rate of the spring"),
    free_length=d.Length(
        "spring_free_length", 0.426, "distance of its ends with the spring force-free"
    ),
)
COIL = d.ForceElement(
    "spring",
    d.AlongLine((CHASSIS, SPRING_TOP), (ROCKER, SPRING_SEAT)),
    (SPRING, spring_table(), DAMPER, *further_laws("damper", 1.0), ACTUATOR),
)

PULL_ROD_SUSPENSION = replace(
    DOUBLE_WISHBONE,
    name="pull_rod",
    title="Double wishbone suspension with pull rod and rocker",
    joints=(*DOUBLE_WISHBONE.joints, ROCKER_HINGE, HEAD, FOOT),
    forces=(WEIGHT, COIL, of_rubber(TYRE), d.JointForce(RACK_GUIDE, RACK_FORCE)),
    coordinates=(
        *DOUBLE_WISHBONE.coordinates,
        ROCKER_HINGE.angle(
            "rocker_angle", "angle of the rocker from design, right-handed about its axis forward"
        ),
    ),
)

MODELS = (
    d.Formulation(
        name="pull_rod",
        title="Double wishbone suspension with pull rod and rocker, rack prescribed",
        mechanism=PULL_ROD_SUSPENSION,
        independent=(wishbones.LOWER_HINGE, wishbones.BEARING),
        prescribed={RACK_GUIDE: RACK_MOTION},
        massive=(
            wishbones.LOWER_ARM,
            wishbones.KNUCKLE,
            wishbones.UPPER_ARM,
            wishbones.WHEEL,
            ROCKER,
        ),
        held={"rack_held": (RACK_GUIDE,)},
    ),
)
