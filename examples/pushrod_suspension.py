"""A pushrod suspension: the wheel's arm turns a rocker on the chassis, and that presses the spring.

The arm swings about a hinge along the vehicle. A pushrod with a ball joint at its lower end and a
cross at its upper end leads to the rocker, whose hinge is oblique. The numbers are invented.
"""

from kintrafo.generator import (
    AlongLine,
    Body,
    Direction,
    ForceElement,
    Input,
    Line,
    LinearDamper,
    LinearSpring,
    LinearTyre,
    Mechanism,
    Model,
    Parameter,
    Point,
    RelativeCoordinate,
    Revolute,
    Spherical,
    Universal,
    Weight,
    Wheel,
    direction,
    point,
    rigid_body,
)

# -- points, in metres: x forward, y left, z up, the wheel on the left ----------------------------

ARM_FRONT = Point("arm_front")
ARM_REAR = Point("arm_rear")
ROD_LOWER = Point("rod_lower")
ROD_UPPER = Point("rod_upper")
ROCKER_PIVOT = Point("rocker_pivot")
SPRING_ROCKER = Point("spring_rocker")
SPRING_CHASSIS = Point("spring_chassis")
WHEEL_CENTER = Point("wheel_center")

ROCKER_AXIS = Direction("rocker_axis")

# -- bodies and the joints between them -----------------------------------------------------------

BODIES = (
    Body("chassis", 0, center=ROCKER_PIVOT),
    Body("arm", 1, center=Point("arm_com")),
    Body("pushrod", 2, center=Point("pushrod_com")),
    Body("rocker", 3, center=Point("rocker_com")),
)

JOINTS = (
    Revolute(
        name="arm_hinge",
        first="chassis",
        second="arm",
        axis=Line(ARM_REAR, ARM_FRONT),
    ),
    Spherical(name="lower_end", first="arm", second="pushrod", at=ROD_LOWER),
    Universal(
        name="upper_end",
        first="rocker",
        second="pushrod",
        at=ROD_UPPER,
        shaft=Line(ROD_UPPER, ROD_LOWER),
        first_axis=ROCKER_AXIS,
    ),
    Revolute(
        name="rocker_hinge",
        first="chassis",
        second="rocker",
        axis=Line(ROCKER_PIVOT, ROCKER_AXIS),
    ),
)

# -- what acts on them ----------------------------------------------------------------------------

FORCES = (
    Weight(gravity="gravity"),
    ForceElement(
        name="coilover",
        path=AlongLine(("chassis", SPRING_CHASSIS), ("rocker", SPRING_ROCKER)),
        laws=(
            LinearSpring(rate="spring_rate", free_length="spring_free_length"),
            LinearDamper(rate="damper_rate"),
        ),
    ),
    LinearTyre(
        name="tyre",
        wheel=Wheel("arm", WHEEL_CENTER, Direction("spin_axis")),
        rate="tyre_rate",
        free_height="tyre_free_height",
        road="road_height",
    ),
)

# -- numbers --------------------------------------------------------------------------------------

PARAMETERS = (
    *point("arm_front", (0.15, 0.25, 0.20), "front bearing of the arm"),
    *point("arm_rear", (-0.15, 0.25, 0.20), "rear bearing of the arm"),
    *point("rod_lower", (0.0, 0.62, 0.22), "ball joint of the pushrod on the arm"),
    *point("rod_upper", (-0.02, 0.34, 0.52), "cross of the pushrod on the rocker"),
    *point("rocker_pivot", (-0.02, 0.28, 0.46), "hinge of the rocker"),
    *point("spring_rocker", (-0.02, 0.29, 0.545), "end of the spring on the rocker"),
    *point("spring_chassis", (-0.06, 0.06, 0.57), "end of the spring on the chassis"),
    *point("wheel_center", (0.0, 0.75, 0.26), "wheel centre"),
    *direction("rocker_axis", (1.0, 0.1, 0.0), "hinge of the rocker"),
    *direction("spin_axis", (0.0, 1.0, 0.0), "spin axis of the wheel"),
    *rigid_body("arm", 18.0, (0.0, 0.66, 0.25), (0.5, 0.3, 0.6)),
    *rigid_body("pushrod", 0.4, (-0.01, 0.48, 0.37), (0.006, 0.004, 0.003)),
    *rigid_body("rocker", 0.7, (-0.02, 0.29, 0.50), (0.001, 0.001, 0.001)),
    Parameter("spring_rate", 60e3, "N/m", "rate of the spring"),
    Parameter("spring_free_length", 0.28, "m", "length of the spring without force"),
    Parameter("damper_rate", 3500.0, "N s/m", "rate of the damper"),
    Parameter("tyre_rate", 180e3, "N/m", "radial rate of the tyre"),
    Parameter("tyre_free_height", 0.27, "m", "height of the wheel centre as the tyre touches"),
    Parameter("gravity", 9.81, "m/s^2", "acceleration of gravity"),
)

MECHANISM = Mechanism(
    name="pushrod_suspension",
    fixed="chassis",
    title="Pushrod suspension",
    bodies=BODIES,
    joints=JOINTS,
    forces=FORCES,
    parameters=PARAMETERS,
    coordinates=(
        RelativeCoordinate("arm_angle", "arm_hinge", "angle", "rad", "angle of the arm"),
        RelativeCoordinate("rocker_angle", "rocker_hinge", "angle", "rad", "angle of the rocker"),
    ),
    inputs=(Input("road_height", "m", "height of the road under the tyre, positive up"),),
)

MODEL = Model(
    name="pushrod_suspension",
    title="Pushrod suspension, one degree of freedom",
    mechanism=MECHANISM,
    independent=("arm_hinge",),
    massive=("arm", "pushrod", "rocker"),
)
