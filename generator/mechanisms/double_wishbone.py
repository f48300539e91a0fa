"""A double wishbone suspension with a tie rod; spring and damper act on the lower arm.

Two transformers, like those of the strut: the distance of the ball joints gives the upper arm's
angle, and the tie rod turns the knuckle about the line through the ball joints. The default values
are this project's own: a front right corner, ISO 8855 axes, ground at z = 0.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from .. import declare as d
from .suspension import (
    RACK_FORCE,
    RACK_MOTION,
    ROAD_HEIGHT,
    actuator,
    damper,
    further_laws,
    spring,
    spring_table,
    with_damping_and_liftoff,
)

if TYPE_CHECKING:
    from ..declare.laws import Law

LOWER_FRONT = d.Point("lower_arm_front", (0.16, -0.36, 0.20), "front bush of the lower arm")
LOWER_REAR = d.Point("lower_arm_rear", (-0.20, -0.36, 0.19), "rear bush of the lower arm")
UPPER_FRONT = d.Point("upper_arm_front", (0.12, -0.46, 0.51), "front bush of the upper arm")
UPPER_REAR = d.Point("upper_arm_rear", (-0.14, -0.46, 0.49), "rear bush of the upper arm")
LOWER_BALL_JOINT = d.Point("lower_ball_joint", (0.005, -0.72, 0.185), "lower ball joint")
UPPER_BALL_JOINT = d.Point("upper_ball_joint", (-0.025, -0.67, 0.505), "upper ball joint")
ROD_OUTER = d.Point("tie_rod_outer", (-0.13, -0.70, 0.26), "tie rod at the knuckle")
ROD_INNER = d.Point("tie_rod_inner", (-0.14, -0.38, 0.265), "tie rod at the rack")
SPRING_TOP = d.Point("spring_top", (-0.03, -0.50, 0.62), "upper seat of the spring, on the chassis")
SPRING_SEAT = d.Point(
    "spring_seat", (-0.01, -0.60, 0.20), "lower seat of the spring, on the lower arm"
)
WHEEL_CENTER = d.Point("wheel_center", (0.0, -0.76, 0.3), "wheel centre")
RACK_AXIS = d.Direction("rack_axis", (0.0, 1.0, 0.0), "direction of the rack")
SPIN_AXIS = d.Direction("spin_axis", (0.0, 1.0, 0.0), "spin axis of the wheel, pointing left")

SPRING = spring(60000.0, 0.53)
DAMPER = damper(4000.0, along="the spring")
TYRE_RATE = d.SpringRate("tyre_rate", 200000.0, "radial rate of the tyre")
TYRE_HEIGHT = d.Displacement(
    "tyre_free_height", 0.319, "height of the wheel centre at which the tyre is free of force"
)
WEIGHT = d.Weight()

CHASSIS = d.Ground("chassis", 1)
LOWER_ARM = d.Body("lower_arm", 5.0, (-0.01, -0.5, 0.19), (0.06, 0.04, 0.09))
KNUCKLE = d.Body("knuckle", 12.0, (-0.01, -0.71, 0.3), (0.15, 0.13, 0.06))
TIE_ROD = d.Body("tie_rod", 0.0, (-0.135, -0.54, 0.2625))
RACK = d.Body("rack", 0.0, (-0.14, -0.38, 0.265))
UPPER_ARM = d.Body("upper_arm", 2.5, (-0.015, -0.55, 0.5), (0.015, 0.012, 0.025))
WHEEL = d.Rotor("wheel", 22.0, WHEEL_CENTER, axis=SPIN_AXIS, spin=1.1, diametral=0.6)

LOWER_HINGE = d.Revolute(
    "lower_hinge",
    CHASSIS,
    LOWER_ARM,
    axis=d.Line(LOWER_REAR, LOWER_FRONT),
    angle_to=LOWER_BALL_JOINT,
)
LOWER_BALL = d.Spherical("lower_ball", LOWER_ARM, KNUCKLE, at=LOWER_BALL_JOINT)
UPPER_BALL = d.Spherical("upper_ball", UPPER_ARM, KNUCKLE, at=UPPER_BALL_JOINT)
UPPER_HINGE = d.Revolute("upper_hinge", CHASSIS, UPPER_ARM, axis=d.Line(UPPER_REAR, UPPER_FRONT))
ROD_BALL = d.Spherical("rod_ball", KNUCKLE, TIE_ROD, at=ROD_OUTER)
ROD_CROSS = d.Universal(
    "rod_cross", RACK, TIE_ROD, at=ROD_INNER, shaft=d.Line(ROD_INNER, ROD_OUTER), first_axis=d.UP
)
RACK_GUIDE = d.Prismatic("rack_guide", CHASSIS, RACK, direction=RACK_AXIS)
BEARING = d.Revolute("bearing", KNUCKLE, WHEEL, axis=d.Line(WHEEL_CENTER, SPIN_AXIS))

ACTUATOR = actuator()
TYRE = d.LinearTyre(
    name="front",
    wheel=d.Wheel(KNUCKLE, WHEEL_CENTER, SPIN_AXIS),
    rate=TYRE_RATE,
    free_height=TYRE_HEIGHT,
    road=ROAD_HEIGHT,
)


def _forces(laws: tuple[Law, ...], tyre: d.LinearTyre) -> tuple[d.Force, ...]:
    path = d.AlongLine((CHASSIS, SPRING_TOP), (LOWER_ARM, SPRING_SEAT))
    element = d.ForceElement("spring", path, laws)
    return WEIGHT, element, tyre, d.JointForce(RACK_GUIDE, RACK_FORCE)


DOUBLE_WISHBONE = d.Mechanism(
    name="double_wishbone",
    title="Double wishbone suspension with tie rod",
    joints=(
        LOWER_HINGE,
        LOWER_BALL,
        UPPER_BALL,
        UPPER_HINGE,
        ROD_BALL,
        ROD_CROSS,
        RACK_GUIDE,
        BEARING,
    ),
    forces=_forces((SPRING, DAMPER, ACTUATOR), TYRE),
    coordinates=(
        LOWER_HINGE.angle(
            "arm_angle",
            "angle of the lower arm from the chassis vertical; falls as the wheel rises",
        ),
        BEARING.angle(
            "spin_angle", "wheel spin angle relative to the knuckle, positive rolling forward"
        ),
        UPPER_HINGE.angle(
            "upper_angle",
            "angle of the upper arm from design, right-handed about its axis to the front",
        ),
        RACK_GUIDE.slide("rack_displacement", "rack displacement along its axis"),
    ),
)

# with further elements of cars
GENERAL = replace(
    DOUBLE_WISHBONE,
    name="double_wishbone_general",
    title="Double wishbone suspension with stops",
    forces=_forces(
        (SPRING, spring_table(), DAMPER, *further_laws("damper", 1.0), ACTUATOR),
        with_damping_and_liftoff(TYRE),
    ),
)


def _model(mechanism: d.Mechanism, title: str) -> d.Formulation:
    return d.Formulation(
        name=mechanism.name,
        title=title,
        mechanism=mechanism,
        independent=(LOWER_HINGE, BEARING),
        prescribed={RACK_GUIDE: RACK_MOTION},
        massive=(LOWER_ARM, KNUCKLE, UPPER_ARM, WHEEL),
        held={"rack_held": (RACK_GUIDE,)},
    )


MODELS = (
    _model(DOUBLE_WISHBONE, "Double wishbone suspension, rack prescribed"),
    _model(GENERAL, "Double wishbone suspension with curves, friction, stops; rack prescribed"),
)
