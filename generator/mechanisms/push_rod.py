"""A double wishbone suspension whose spring lies on the chassis: a push rod and a rocker move it.

The push rod leads from the lower arm to the rocker, which turns about a hinge of any direction; its
loop closes in closed form, like that of an arm held by a rod. Spring and damper act between rocker
and chassis. The default values are this project's own.
"""

from __future__ import annotations

from .. import declare as d
from . import double_wishbone as wishbones
from .double_wishbone import (
    ACTUATOR,
    CHASSIS,
    DAMPER,
    DOUBLE_WISHBONE,
    LOWER_ARM,
    RACK_GUIDE,
    TYRE,
    WEIGHT,
)
from .suspension import RACK_FORCE, RACK_MOTION, further_laws, of_rubber, spring_table

ROD_OUTER = d.Point("push_rod_outer", (0.0, -0.65, 0.21), "push rod at the lower arm")
ROD_INNER = d.Point("push_rod_inner", (-0.01, -0.37, 0.53), "push rod at the rocker")
ROCKER_FRONT = d.Point("rocker_front", (0.03, -0.31, 0.47), "front bearing of the rocker")
ROCKER_REAR = d.Point("rocker_rear", (-0.05, -0.31, 0.47), "rear bearing of the rocker")
SPRING_TOP = d.Point("spring_top", (-0.03, -0.06, 0.585), "end of the spring on the chassis")
SPRING_SEAT = d.Point("spring_seat", (-0.01, -0.335, 0.56), "end of the spring on the rocker")

ROCKER = d.Body("rocker", 0.8, (-0.01, -0.31, 0.5), (0.001, 0.001, 0.001))
PUSH_ROD = d.Body("push_rod", 0.0, (-0.005, -0.51, 0.37))

ROCKER_HINGE = d.Revolute("rocker_hinge", CHASSIS, ROCKER, axis=d.Line(ROCKER_REAR, ROCKER_FRONT))
FOOT = d.Spherical("push_rod_ball", LOWER_ARM, PUSH_ROD, at=ROD_OUTER)
HEAD = d.Universal(
    "push_rod_cross",
    ROCKER,
    PUSH_ROD,
    at=ROD_INNER,
    shaft=d.Line(ROD_INNER, ROD_OUTER),
    first_axis=d.Direction("rocker_axis", between=(ROCKER_REAR, ROCKER_FRONT)),
)

SPRING = d.LinearSpring(
    rate=d.SpringRate("spring_rate", 42000.0, "rate of the spring"),
    free_length=d.Length(
        "spring_free_length", 0.398, "distance of its ends with the spring force-free"
    ),
)
COIL = d.ForceElement(
    "spring",
    d.AlongLine((CHASSIS, SPRING_TOP), (ROCKER, SPRING_SEAT)),
    (SPRING, spring_table(), DAMPER, *further_laws("damper", 1.0), ACTUATOR),
)

PUSH_ROD_SUSPENSION = d.Mechanism(
    name="push_rod",
    title="Double wishbone suspension with push rod and rocker",
    joints=(*DOUBLE_WISHBONE.joints, ROCKER_HINGE, FOOT, HEAD),
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
        name="push_rod",
        title="Double wishbone suspension with push rod and rocker, rack prescribed",
        mechanism=PUSH_ROD_SUSPENSION,
        independent=(wishbones.LOWER_HINGE, wishbones.BEARING),
        prescribed={RACK_GUIDE: RACK_MOTION},
        massive=(LOWER_ARM, wishbones.KNUCKLE, wishbones.UPPER_ARM, wishbones.WHEEL, ROCKER),
        held={"rack_held": (RACK_GUIDE,)},
    ),
)
