"""A double wishbone suspension with a tie rod; spring and damper act on the lower arm.

Two transformers, like those of the strut: the distance of the ball joints gives the upper arm's
angle, and the tie rod turns the knuckle about the line through the ball joints. The default values
are this project's own: a front right corner, ISO 8855 axes, ground at z = 0.
"""

from __future__ import annotations

from ..declare.bodies import Body, Ground, Rotor
from ..declare.coordinates import RelativeCoordinate
from ..declare.forces import AlongLine, ForceElement, JointForce, LinearTyre, Weight
from ..declare.geometry import UP, Direction, Line, Point
from ..declare.inputs import Input
from ..declare.joints import Prismatic, Revolute, Spherical, Universal
from ..declare.laws import Actuator, LinearDamper, LinearSpring
from ..declare.mechanism import Mechanism
from ..declare.model import Model
from ..declare.parameters import DamperRate, Displacement, Length, SpringRate
from .suspension import RACK_FORCE, RACK_MOTION, ROAD_HEIGHT

LOWER_FRONT = Point("lower_arm_front", (0.16, -0.36, 0.20), "front bush of the lower arm")
LOWER_REAR = Point("lower_arm_rear", (-0.20, -0.36, 0.19), "rear bush of the lower arm")
UPPER_FRONT = Point("upper_arm_front", (0.12, -0.46, 0.51), "front bush of the upper arm")
UPPER_REAR = Point("upper_arm_rear", (-0.14, -0.46, 0.49), "rear bush of the upper arm")
LOWER_BALL_JOINT = Point("lower_ball_joint", (0.005, -0.72, 0.185), "lower ball joint")
UPPER_BALL_JOINT = Point("upper_ball_joint", (-0.025, -0.67, 0.505), "upper ball joint")
ROD_OUTER = Point("tie_rod_outer", (-0.13, -0.70, 0.26), "tie rod at the knuckle")
ROD_INNER = Point("tie_rod_inner", (-0.14, -0.38, 0.265), "tie rod at the rack")
SPRING_TOP = Point("spring_top", (-0.03, -0.50, 0.62), "upper seat of the spring, on the chassis")
SPRING_SEAT = Point(
    "spring_seat", (-0.01, -0.60, 0.20), "lower seat of the spring, on the lower arm"
)
WHEEL_CENTER = Point("wheel_center", (0.0, -0.76, 0.3), "wheel centre")
RACK_AXIS = Direction("rack_axis", (0.0, 1.0, 0.0), "direction of the rack")
SPIN_AXIS = Direction("spin_axis", (0.0, 1.0, 0.0), "spin axis of the wheel, pointing left")

SPRING = LinearSpring(
    rate=SpringRate("spring_rate", 60000.0, "rate of the spring"),
    free_length=Length("spring_free_length", 0.53, "distance of the seats with the spring force-free"),
)
DAMPER = LinearDamper(rate=DamperRate("damper_rate", 4000.0, "rate of the damper along the spring"))
TYRE_RATE = SpringRate("tyre_rate", 200000.0, "radial rate of the tyre")
TYRE_HEIGHT = Displacement(
    "tyre_free_height", 0.319, "height of the wheel centre at which the tyre is free of force"
)
WEIGHT = Weight()

CHASSIS = Ground("chassis", 1)
LOWER_ARM = Body("lower_arm", 5.0, (-0.01, -0.5, 0.19), (0.06, 0.04, 0.09))
KNUCKLE = Body("knuckle", 12.0, (-0.01, -0.71, 0.3), (0.15, 0.13, 0.06))
TIE_ROD = Body("tie_rod", 0.0, (-0.135, -0.54, 0.2625))
RACK = Body("rack", 0.0, (-0.14, -0.38, 0.265))
UPPER_ARM = Body("upper_arm", 2.5, (-0.015, -0.55, 0.5), (0.015, 0.012, 0.025))
WHEEL = Rotor("wheel", 22.0, WHEEL_CENTER, axis=SPIN_AXIS, spin=1.1, diametral=0.6)

LOWER_HINGE = Revolute(
    "lower_hinge",
    CHASSIS,
    LOWER_ARM,
    axis=Line(LOWER_REAR, LOWER_FRONT),
    angle_to=LOWER_BALL_JOINT,
)
LOWER_BALL = Spherical("lower_ball", LOWER_ARM, KNUCKLE, at=LOWER_BALL_JOINT)
UPPER_BALL = Spherical("upper_ball", UPPER_ARM, KNUCKLE, at=UPPER_BALL_JOINT)
UPPER_HINGE = Revolute("upper_hinge", CHASSIS, UPPER_ARM, axis=Line(UPPER_REAR, UPPER_FRONT))
ROD_BALL = Spherical("rod_ball", KNUCKLE, TIE_ROD, at=ROD_OUTER)
ROD_CROSS = Universal(
    "rod_cross", RACK, TIE_ROD, at=ROD_INNER, shaft=Line(ROD_INNER, ROD_OUTER), first_axis=UP
)
RACK_GUIDE = Prismatic("rack_guide", CHASSIS, RACK, direction=RACK_AXIS)
BEARING = Revolute("bearing", KNUCKLE, WHEEL, axis=Line(WHEEL_CENTER, SPIN_AXIS))

ACTUATOR = Actuator(
    input=Input(
        "spring_actuator", "N", "actuator force, positive when it pushes the spring's seats apart"
    )
)

DOUBLE_WISHBONE = Mechanism(
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
    forces=(
        WEIGHT,
        ForceElement(
            "spring",
            AlongLine((CHASSIS, SPRING_TOP), (LOWER_ARM, SPRING_SEAT)),
            (SPRING, DAMPER, ACTUATOR),
        ),
        LinearTyre(
            name="front",
            carrier=KNUCKLE,
            center=WHEEL_CENTER,
            spin=SPIN_AXIS,
            rate=TYRE_RATE,
            free_height=TYRE_HEIGHT,
            road=ROAD_HEIGHT,
        ),
        JointForce(RACK_GUIDE, RACK_FORCE),
    ),
    coordinates=(
        RelativeCoordinate(
            "arm_angle",
            LOWER_HINGE,
            "angle of the lower arm from the chassis vertical; falls as the wheel rises",
        ),
        RelativeCoordinate(
            "spin_angle",
            BEARING,
            "wheel spin angle relative to the knuckle, positive rolling forward",
        ),
        RelativeCoordinate(
            "upper_angle",
            UPPER_HINGE,
            "angle of the upper arm from design, right-handed about its axis to the front",
        ),
        RelativeCoordinate("rack_displacement", RACK_GUIDE, "rack displacement along its axis"),
    ),
)

MODELS = (
    Model(
        name="double_wishbone",
        title="Double wishbone suspension, rack prescribed",
        mechanism=DOUBLE_WISHBONE,
        independent=(LOWER_HINGE, BEARING),
        prescribed={RACK_GUIDE: RACK_MOTION},
        massive=(LOWER_ARM, KNUCKLE, UPPER_ARM, WHEEL),
        held={"rack_held": (RACK_GUIDE,)},
    ),
)
