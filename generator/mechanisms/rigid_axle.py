"""A beam with two wheels on four rods, which leave it heave and roll: a rigid axle.

Each rod leads from the chassis to the beam, anywhere. Three links and a Panhard rod are four rods,
and so are four links of which two are triangulated. The coordinates are those of an axle's motion:
the height of the middle between the wheels, and the inclination of the line through them. From the
chassis outward the beam is moved up, to the left and forward, turned about the vertical (yaw), then
about its axis forward (roll) and last about the line through the wheels (pitch). So the heights of
both wheels are those of these two coordinates alone, exactly; the other four close the loops of
the rods, by Newton's method.

A side has springs, dampers and a wheel; right and left have each their own values. The default
values are this project's own: a rear axle, ISO 8855 axes, ground at z = 0.
"""

from __future__ import annotations

from .. import declare as d
from ..program.vectors import UNIT_Y
from .suspension import (
    actuator,
    damper,
    own_values,
    rod_joints,
    spring,
    spring_and_damper,
    tyre,
    with_damping_and_liftoff,
)

Place = tuple[float, float, float]

AXLE_CENTER = d.Point("axle_center", (0.0, 0.0, 0.36), "middle between the wheels")
LEFTWARD = d.Direction("leftward", fixed=UNIT_Y)

CHASSIS = d.Ground("chassis", 1)
BEAM = d.Body("beam", 80.0, (0.02, 0.0, 0.37), (14.0, 1.1, 14.5))


# bodies between chassis and beam: without mass, at the middle of the axle
HEAVING, SWAYING, SHIFTING, YAWING, ROLLING = (
    d.Body(f"{name}_frame", 0.0, AXLE_CENTER) for name in ("heave", "sway", "shift", "yaw", "roll")
)
HEAVE = d.Prismatic("heave_guide", CHASSIS, HEAVING, direction=d.UP)
SWAY = d.Prismatic("sway_guide", HEAVING, SWAYING, direction=LEFTWARD)
SHIFT = d.Prismatic("shift_guide", SWAYING, SHIFTING, direction=d.FORWARD)
YAW = d.Revolute("yaw_hinge", SHIFTING, YAWING, axis=d.Line(AXLE_CENTER, d.UP))
ROLL = d.Revolute("roll_hinge", YAWING, ROLLING, axis=d.Line(AXLE_CENTER, d.FORWARD))
PITCH = d.Revolute("pitch_hinge", ROLLING, BEAM, axis=d.Line(AXLE_CENTER, LEFTWARD))
GUIDES = (HEAVE, SWAY, SHIFT, YAW, ROLL, PITCH)


def _rod(number: int, chassis: Place, axle: Place) -> tuple[d.Joint, d.Joint]:
    """Return the cross and the ball joint of a rod without mass."""
    name = f"rod_{number}"
    x, y, z = ((a + b) / 2.0 for a, b in zip(chassis, axle, strict=True))
    body = d.Body(name, 0.0, (x, y, z))
    inner = d.Point(f"{name}_chassis", chassis, f"end of rod {number} on the chassis")
    outer = d.Point(f"{name}_axle", axle, f"end of rod {number} on the axle")
    return rod_joints(body, (CHASSIS, inner), (BEAM, outer))


RODS = (
    *_rod(1, (0.62, 0.47, 0.38), (0.02, 0.53, 0.31)),
    *_rod(2, (0.62, -0.47, 0.38), (0.02, -0.53, 0.31)),
    *_rod(3, (0.50, 0.06, 0.54), (-0.02, 0.06, 0.52)),
    *_rod(4, (-0.13, -0.46, 0.43), (-0.13, 0.46, 0.40)),
)

# -- a side, the right one ------------------------------------------------------------------------

WHEEL_CENTER = d.Point("wheel_center", (0.0, -0.78, 0.36), "wheel centre")
SPIN_AXIS = d.Direction("spin_axis", (0.0, 1.0, 0.0), "spin axis of the wheel, pointing left")
SPRING_TOP = d.Point("spring_top", (0.05, -0.47, 0.68), "upper seat of the spring, on the chassis")
SPRING_SEAT = d.Point("spring_seat", (0.04, -0.49, 0.43), "lower seat of the spring, on the axle")
DAMPER_TOP = d.Point("damper_top", (-0.03, -0.47, 0.78), "upper end of the damper, on the chassis")
DAMPER_SEAT = d.Point("damper_seat", (-0.09, -0.56, 0.30), "lower end of the damper, on the axle")
WHEEL = d.Rotor("wheel", 26.0, WHEEL_CENTER, axis=SPIN_AXIS, spin=1.6, diametral=0.85)
BEARING = d.Revolute("bearing", BEAM, WHEEL, axis=d.Line(WHEEL_CENTER, SPIN_AXIS))

SPRING = spring(48000.0, 0.355)
DAMPER = damper(3200.0)
ACTUATOR = actuator()
TYRE = tyre("axle", d.Wheel(BEAM, WHEEL_CENTER, SPIN_AXIS), 0.382, rate=230000.0)
OF_A_SIDE = (
    *spring_and_damper(
        ((CHASSIS, SPRING_TOP), (BEAM, SPRING_SEAT)),
        ((CHASSIS, DAMPER_TOP), (BEAM, DAMPER_SEAT)),
        (SPRING, ACTUATOR, DAMPER),
    ),
    with_damping_and_liftoff(TYRE),
)

BAR = d.ForceElement(
    "bar",
    d.AlongHinge(ROLL),
    (
        d.LinearSpring(
            rate=d.TorsionRate("bar_rate", 0.0, "rate of the anti-roll bar, by roll of the axle"),
            free_length=d.Angle("bar_free_angle", 0.0, "roll at which the bar is free"),
        ),
    ),
)
WEIGHT = d.Weight()
OF_THE_BEAM = (
    HEAVE.slide("heave", "height of the middle of the axle above that at design"),
    ROLL.angle("roll", "inclination of the axle, positive with the left wheel up"),
    SWAY.slide("sway", "displacement of the axle to the left"),
    SHIFT.slide("shift", "displacement of the axle forward"),
    YAW.angle("yaw", "steer angle of the axle, positive to the left"),
    PITCH.angle("pitch", "turn of the axle about the line through its wheels, nose down"),
)

_SIDE = d.Mechanism(
    name="side",
    title="Half of a rigid axle",
    joints=(*GUIDES, *RODS, BEARING),
    forces=(WEIGHT, *OF_A_SIDE),
    coordinates=(
        *OF_THE_BEAM,
        BEARING.angle(
            "spin_angle", "wheel spin angle relative to the axle, positive rolling forward"
        ),
    ),
)
SHARED = tuple(body for body in _SIDE.bodies if body not in (CHASSIS, WHEEL))
_OWN = own_values((BEARING, OF_A_SIDE), BEAM)

RIGID_AXLE = d.combined(
    "rigid_axle",
    "Rigid axle on four rods",
    (
        d.Copy(_SIDE, "right_", shared=SHARED),
        d.Copy(_SIDE, "left_", mirrored=True, shared=SHARED, own=_OWN),
    ),
    forces=(BAR,),
)

MODELS = (
    d.Formulation(
        name="rigid_axle",
        title="Rigid axle on four rods",
        mechanism=RIGID_AXLE,
        independent=(
            HEAVE,
            ROLL,
            RIGID_AXLE.joint("right_bearing"),
            RIGID_AXLE.joint("left_bearing"),
        ),
        massive=(BEAM, RIGID_AXLE.body("right_wheel"), RIGID_AXLE.body("left_wheel")),
        allow_iteration=True,
    ),
)
