"""A wheel carrier on five links, for which there is no closed form: Newton's method closes it.

Two upper and two lower links and a toe link hold the carrier; where two of them meet in a ball
joint, they are an arm. The spring acts on the rear lower link, the damper on the carrier. The
coordinate is that of a height sensor: the angle of a lever high above the wheel, from whose tip a
rod hangs down to the wheel centre, both without mass. So the coordinate is regular for any position
of links and spring. The default values are this project's own: a rear right corner, ISO 8855 axes,
ground at z = 0.
"""

from __future__ import annotations

from .. import declare as d
from .suspension import (
    RACK_FORCE,
    RACK_MOTION,
    actuator,
    damper,
    rod_joints,
    spring,
    spring_and_damper,
    tyre,
    with_damping_and_liftoff,
)

Place = tuple[float, float, float]

WHEEL_CENTER = d.Point("wheel_center", (0.0, -0.76, 0.31), "wheel centre")
SENSOR_FRONT = d.Point("sensor_front", (0.1, -0.26, 1.31), "front bearing of the height sensor")
SENSOR_REAR = d.Point("sensor_rear", (-0.1, -0.26, 1.31), "rear bearing of the height sensor")
SENSOR_TIP = d.Point("sensor_tip", (0.0, -0.76, 1.31), "tip of the height sensor's lever")
RACK_AXIS = d.Direction("rack_axis", (0.0, 1.0, 0.0), "direction of the rack")
SPIN_AXIS = d.Direction("spin_axis", (0.0, 1.0, 0.0), "spin axis of the wheel, pointing left")
SPRING_TOP = d.Point("spring_top", (-0.12, -0.50, 0.48), "upper seat of the spring, on the chassis")
SPRING_SEAT = d.Point(
    "spring_seat", (-0.085, -0.505, 0.2), "lower seat of the spring, on the rear lower link"
)
DAMPER_TOP = d.Point("damper_top", (-0.095, -0.58, 0.72), "upper end of the damper, on the chassis")
DAMPER_SEAT = d.Point(
    "damper_seat", (-0.08, -0.64, 0.225), "lower end of the damper, on the knuckle"
)

CHASSIS = d.Ground("chassis", 1)
KNUCKLE = d.Body("knuckle", 15.0, (-0.01, -0.71, 0.31), (0.17, 0.15, 0.08))
RACK = d.Body("rack", 0.0, (-0.17, -0.345, 0.261))
SENSOR_LEVER = d.Body("sensor_lever", 0.0, (0.0, -0.51, 1.31))
SENSOR_ROD = d.Body("sensor_rod", 0.0, (0.0, -0.76, 0.81))
WHEEL = d.Rotor("wheel", 21.0, WHEEL_CENTER, axis=SPIN_AXIS, spin=1.0, diametral=0.55)


def _link(
    name: str, words: str, inner: Place, outer: Place, mass: float, base: d.Body
) -> tuple[d.Body, tuple[d.Joint, d.Joint]]:
    """Return a link with a cross at its inner end and a ball joint at the carrier."""
    x, y, z = ((a + b) / 2.0 for a, b in zip(inner, outer, strict=True))
    inner_end = d.Point(f"{name}_inner", inner, f"inner end of the {words}")
    outer_end = d.Point(f"{name}_outer", outer, f"{words} at the knuckle")
    body = d.Body(name, mass, (x, y, z), (0.01 * mass, 0.001 * mass, 0.01 * mass))
    return body, rod_joints(body, (base, inner_end), (KNUCKLE, outer_end))


FRONT_UPPER, _front_upper = _link(
    "front_upper_link",
    "front upper link",
    (0.1, -0.43, 0.455),
    (0.015, -0.675, 0.475),
    0.0,
    CHASSIS,
)
REAR_UPPER, _rear_upper = _link(
    "rear_upper_link", "rear upper link", (-0.14, -0.41, 0.44), (-0.05, -0.68, 0.47), 0.0, CHASSIS
)
FRONT_LOWER, _front_lower = _link(
    "front_lower_link", "front lower link", (0.23, -0.44, 0.225), (0.03, -0.705, 0.19), 0.0, CHASSIS
)
REAR_LOWER, _rear_lower = _link(
    "rear_lower_link", "rear lower link", (-0.11, -0.3, 0.2), (-0.055, -0.705, 0.175), 4.0, CHASSIS
)
TIE_ROD, _tie_rod = _link(
    "tie_rod", "toe link", (-0.17, -0.345, 0.261), (-0.155, -0.695, 0.25), 0.0, RACK
)
RACK_GUIDE = d.Prismatic("rack_guide", CHASSIS, RACK, direction=RACK_AXIS)
BEARING = d.Revolute("bearing", KNUCKLE, WHEEL, axis=d.Line(WHEEL_CENTER, SPIN_AXIS))
SENSOR_HINGE = d.Revolute(
    "sensor_hinge",
    CHASSIS,
    SENSOR_LEVER,
    axis=d.Line(SENSOR_REAR, SENSOR_FRONT),
    angle_to=SENSOR_TIP,
)
SENSOR_CROSS = d.Universal(
    "sensor_cross",
    SENSOR_LEVER,
    SENSOR_ROD,
    at=SENSOR_TIP,
    shaft=d.Line(SENSOR_TIP, WHEEL_CENTER),
    first_axis=d.Direction("sensor_axis", between=(SENSOR_REAR, SENSOR_FRONT)),
)
SENSOR_BALL = d.Spherical("sensor_ball", KNUCKLE, SENSOR_ROD, at=WHEEL_CENTER)

SPRING = spring(90000.0, 0.359)
DAMPER = damper(2500.0)
ACTUATOR = actuator()
COIL, SHOCK = spring_and_damper(
    ((CHASSIS, SPRING_TOP), (REAR_LOWER, SPRING_SEAT)),
    ((CHASSIS, DAMPER_TOP), (KNUCKLE, DAMPER_SEAT)),
    (SPRING, ACTUATOR, DAMPER),
)
TYRE = tyre("rear", d.Wheel(KNUCKLE, WHEEL_CENTER, SPIN_AXIS), 0.329)

MULTI_LINK = d.Mechanism(
    name="multi_link",
    title="Multi-link suspension with five links",
    joints=(
        SENSOR_HINGE,
        SENSOR_CROSS,
        SENSOR_BALL,
        *_front_upper,
        *_rear_upper,
        *_front_lower,
        *_rear_lower,
        *_tie_rod,
        RACK_GUIDE,
        BEARING,
    ),
    forces=(
        d.Weight(),
        COIL,
        SHOCK,
        with_damping_and_liftoff(TYRE),
        d.JointForce(RACK_GUIDE, RACK_FORCE),
    ),
    coordinates=(
        SENSOR_HINGE.angle(
            "sensor_angle",
            "angle of the height sensor's lever from the chassis vertical; falls as the wheel "
            "rises",
        ),
        BEARING.angle(
            "spin_angle", "wheel spin angle relative to the knuckle, positive rolling forward"
        ),
        RACK_GUIDE.slide("rack_displacement", "rack displacement along its axis"),
    ),
)

MODELS = (
    d.Formulation(
        name="multi_link",
        title="Multi-link suspension with five links, rack prescribed",
        mechanism=MULTI_LINK,
        independent=(SENSOR_HINGE, BEARING),
        prescribed={RACK_GUIDE: RACK_MOTION},
        massive=(REAR_LOWER, KNUCKLE, WHEEL),
        held={"rack_held": (RACK_GUIDE,)},
        allow_iteration=True,
    ),
)
