"""A double wishbone suspension with a tie rod; spring and damper act on the lower arm.

Two transformers, like those of the strut: the distance of the ball joints gives the upper arm's
angle, and the tie rod turns the knuckle about the line through the ball joints. The default values
are this project's own: a front right corner, ISO 8855 axes, ground at z = 0.
"""

from __future__ import annotations

from dataclasses import replace

from ..declare.assembly import Body, Parameter, RelativeCoordinate
from ..declare.forces.force_element import ForceElement
from ..declare.forces.joint_force import JointForce
from ..declare.forces.linear_tyre import LinearTyre
from ..declare.forces.weight import Weight
from ..declare.geometry import UP, Direction, Line, Point
from ..declare.inputs import Input
from ..declare.joints import Prismatic, Revolute, Spherical, Universal
from ..declare.laws import Actuator, LinearDamper, LinearSpring
from ..declare.mechanism import Mechanism
from ..declare.model import Model
from ..declare.parameters import direction, point, rigid_body, rotor
from ..declare.paths import AlongLine
from ..declare.wheel import Wheel
from .suspension import INPUTS, further_laws, further_parameters

LOWER_FRONT, LOWER_REAR = Point("lower_arm_front"), Point("lower_arm_rear")
UPPER_FRONT, UPPER_REAR = Point("upper_arm_front"), Point("upper_arm_rear")
LOWER_BALL, UPPER_BALL = Point("lower_ball_joint"), Point("upper_ball_joint")
ROD_OUTER, ROD_INNER = Point("tie_rod_outer"), Point("tie_rod_inner")
SPRING_TOP, SPRING_SEAT = Point("spring_top"), Point("spring_seat")
WHEEL_CENTER = Point("wheel_center")
RACK, SPIN = Direction("rack_axis"), Direction("spin_axis")

BODIES = (
    Body("chassis", 1, center=SPRING_TOP),
    Body("lower_arm", 2, center=Point("lower_arm_com")),
    Body("knuckle", 3, center=Point("knuckle_com")),
    Body("tie_rod", 4, center=Point("tie_rod_com")),
    Body("rack", 5, center=Point("rack_com")),
    Body("upper_arm", 6, center=Point("upper_arm_com")),
    Body("wheel", 7, center=WHEEL_CENTER, rotor_axis=SPIN),
)

JOINTS = (
    Revolute(
        name="lower_hinge",
        first="chassis",
        second="lower_arm",
        axis=Line(LOWER_REAR, LOWER_FRONT),
        angle_to=LOWER_BALL,
    ),
    Spherical(name="lower_ball", first="lower_arm", second="knuckle", at=LOWER_BALL),
    Spherical(name="upper_ball", first="upper_arm", second="knuckle", at=UPPER_BALL),
    Revolute(
        name="upper_hinge",
        first="chassis",
        second="upper_arm",
        axis=Line(UPPER_REAR, UPPER_FRONT),
    ),
    Spherical(name="rod_ball", first="knuckle", second="tie_rod", at=ROD_OUTER),
    Universal(
        name="rod_cross",
        first="rack",
        second="tie_rod",
        at=ROD_INNER,
        shaft=Line(ROD_INNER, ROD_OUTER),
        first_axis=UP,
    ),
    Prismatic(name="rack_guide", first="chassis", second="rack", direction=RACK),
    Revolute(name="bearing", first="knuckle", second="wheel", axis=Line(WHEEL_CENTER, SPIN)),
)

COORDINATES = (
    RelativeCoordinate(
        "arm_angle",
        "lower_hinge",
        "angle",
        "rad",
        "angle of the lower arm from the chassis vertical; falls as the wheel rises",
    ),
    RelativeCoordinate(
        "spin_angle",
        "bearing",
        "angle",
        "rad",
        "wheel spin angle relative to the knuckle, positive rolling forward",
    ),
    RelativeCoordinate(
        "upper_angle",
        "upper_hinge",
        "angle",
        "rad",
        "angle of the upper arm from design, right-handed about its axis to the front",
    ),
    RelativeCoordinate(
        "rack_displacement", "rack_guide", "slide", "m", "rack displacement along its axis"
    ),
)

SPRING = AlongLine(("chassis", SPRING_TOP), ("lower_arm", SPRING_SEAT))
COIL = LinearSpring(rate="spring_rate", free_length="spring_free_length")
DAMPER = LinearDamper(rate="damper_rate")
ACTUATOR = Actuator(input="spring_actuator")
TYRE = LinearTyre(
    name="front",
    wheel=Wheel("knuckle", WHEEL_CENTER, SPIN),
    rate="tyre_rate",
    free_height="tyre_free_height",
    road="road_height",
)

FORCES = (
    Weight(gravity="gravity"),
    ForceElement(name="spring", path=SPRING, laws=(COIL, DAMPER, ACTUATOR)),
    TYRE,
    JointForce(joint="rack_guide", input="rack_force"),
)
GENERAL_FORCES = (
    Weight(gravity="gravity"),
    ForceElement(
        name="spring", path=SPRING, laws=(COIL, DAMPER, *further_laws("damper"), ACTUATOR)
    ),
    replace(TYRE, damper="tyre_damper_rate", lifts_off="tyre_lifts_off"),
    JointForce(joint="rack_guide", input="rack_force"),
)

PARAMETERS = (
    *point("lower_arm_front", (0.16, -0.36, 0.20), "front bush of the lower arm"),
    *point("lower_arm_rear", (-0.20, -0.36, 0.19), "rear bush of the lower arm"),
    *point("upper_arm_front", (0.12, -0.46, 0.51), "front bush of the upper arm"),
    *point("upper_arm_rear", (-0.14, -0.46, 0.49), "rear bush of the upper arm"),
    *point("lower_ball_joint", (0.005, -0.72, 0.185), "lower ball joint"),
    *point("upper_ball_joint", (-0.025, -0.67, 0.505), "upper ball joint"),
    *point("tie_rod_outer", (-0.13, -0.70, 0.26), "tie rod at the knuckle"),
    *point("tie_rod_inner", (-0.14, -0.38, 0.265), "tie rod at the rack"),
    *point("spring_top", (-0.03, -0.50, 0.62), "upper seat of the spring, on the chassis"),
    *point("spring_seat", (-0.01, -0.60, 0.20), "lower seat of the spring, on the lower arm"),
    *point("wheel_center", (0.0, -0.76, 0.3), "wheel centre"),
    *direction("rack_axis", (0.0, 1.0, 0.0), "direction of the rack"),
    *direction("spin_axis", (0.0, 1.0, 0.0), "spin axis of the wheel, pointing left"),
    Parameter("spring_rate", 60000.0, "N/m", "rate of the spring"),
    Parameter("spring_free_length", 0.53, "m", "distance of the seats with the spring force-free"),
    Parameter("damper_rate", 4000.0, "N s/m", "rate of the damper along the spring"),
    Parameter("tyre_rate", 200000.0, "N/m", "radial rate of the tyre"),
    Parameter(
        "tyre_free_height",
        0.319,
        "m",
        "height of the wheel centre at which the tyre is free of force",
    ),
    Parameter("gravity", 9.81, "m/s^2", "acceleration of gravity"),
    *rigid_body("lower_arm", 5.0, (-0.01, -0.5, 0.19), (0.06, 0.04, 0.09)),
    *rigid_body("knuckle", 12.0, (-0.01, -0.71, 0.3), (0.15, 0.13, 0.06)),
    *rigid_body("tie_rod", 0.0, (-0.135, -0.54, 0.2625)),
    *rigid_body("rack", 0.0, (-0.14, -0.38, 0.265)),
    *rigid_body("upper_arm", 2.5, (-0.015, -0.55, 0.5), (0.015, 0.012, 0.025)),
    *rotor("wheel", 22.0, 1.1, 0.6),
)

DOUBLE_WISHBONE = Mechanism(
    name="double_wishbone",
    fixed="chassis",
    title="Double wishbone suspension with tie rod",
    bodies=BODIES,
    joints=JOINTS,
    forces=FORCES,
    parameters=PARAMETERS,
    coordinates=COORDINATES,
    inputs=(
        *INPUTS,
        Input(
            "spring_actuator",
            "N",
            "actuator force, positive when it pushes the spring's seats apart",
        ),
    ),
)

GENERAL = replace(
    DOUBLE_WISHBONE,
    name="double_wishbone_general",
    title="Double wishbone suspension with stops",
    forces=GENERAL_FORCES,
    parameters=(*PARAMETERS, *further_parameters("damper", 1.0)),
)


def _model(mechanism: Mechanism, title: str) -> Model:
    return Model(
        name=mechanism.name,
        title=title,
        mechanism=mechanism,
        independent=("lower_hinge", "bearing"),
        prescribed={"rack_guide": "rack"},
        massive=("lower_arm", "knuckle", "upper_arm", "wheel"),
        held={"rack_held": ("rack_guide",)},
    )


MODELS = (
    _model(DOUBLE_WISHBONE, "Double wishbone suspension, rack prescribed"),
    _model(
        GENERAL,
        "Double wishbone suspension with a damper curve, friction, stops; rack prescribed",
    ),
)
