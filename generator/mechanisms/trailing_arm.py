"""A trailing or semi-trailing arm: one hinge on the chassis, whose two bearings may lie anywhere.

The arm carries the wheel, so that there is no loop to close, and no rack. The default values are
this project's own: a rear right corner, ISO 8855 axes, ground at z = 0.
"""

from __future__ import annotations

from .. import declare as d
from .suspension import ROAD_HEIGHT, further_laws, of_rubber

ARM_OUTER = d.Point("arm_outer", (0.44, -0.62, 0.29), "outer bearing of the arm")
ARM_INNER = d.Point("arm_inner", (0.30, -0.24, 0.27), "inner bearing of the arm")
SPRING_TOP = d.Point("spring_top", (0.06, -0.53, 0.60), "upper end of the spring, on the chassis")
SPRING_SEAT = d.Point("spring_seat", (0.08, -0.54, 0.25), "lower end of the spring, on the arm")
DAMPER_TOP = d.Point("damper_top", (-0.06, -0.56, 0.68), "upper end of the damper, on the chassis")
DAMPER_SEAT = d.Point("damper_seat", (-0.05, -0.60, 0.24), "lower end of the damper, on the arm")
WHEEL_CENTER = d.Point("wheel_center", (0.0, -0.74, 0.31), "wheel centre")
SPIN_AXIS = d.Direction("spin_axis", (0.0, 1.0, 0.0), "spin axis of the wheel, pointing left")

CHASSIS = d.Ground("chassis", 1)
ARM = d.Body("arm", 14.0, (0.12, -0.58, 0.28), (0.25, 0.30, 0.45))
WHEEL = d.Rotor("wheel", 20.0, WHEEL_CENTER, axis=SPIN_AXIS, spin=1.0, diametral=0.55)

# an angle to a point counts in the same sense on both sides of a car
HINGE = d.Revolute(
    "arm_hinge", CHASSIS, ARM, axis=d.Line(ARM_OUTER, ARM_INNER), angle_to=WHEEL_CENTER
)
BEARING = d.Revolute("bearing", ARM, WHEEL, axis=d.Line(WHEEL_CENTER, SPIN_AXIS))

SPRING = d.LinearSpring(
    rate=d.SpringRate("spring_rate", 55000.0, "rate of the spring"),
    free_length=d.Length(
        "spring_free_length", 0.44, "distance of its ends with the spring force-free"
    ),
)
DAMPER = d.LinearDamper(
    rate=d.DamperRate("damper_rate", 2500.0, "rate of the damper along its own line")
)
ACTUATOR = d.Actuator(
    input=d.Input(
        "damper_actuator", "N", "actuator force, positive when it pushes the damper's ends apart"
    )
)
TYRE = d.LinearTyre(
    name="rear",
    wheel=d.Wheel(ARM, WHEEL_CENTER, SPIN_AXIS),
    rate=d.SpringRate("tyre_rate", 200000.0, "radial rate of the tyre"),
    free_height=d.Displacement(
        "tyre_free_height", 0.328, "height of the wheel centre at which the tyre is free of force"
    ),
    road=ROAD_HEIGHT,
)

TRAILING_ARM = d.Mechanism(
    name="trailing_arm",
    title="Trailing arm, also semi-trailing",
    joints=(HINGE, BEARING),
    forces=(
        d.Weight(),
        d.ForceElement("spring", d.AlongLine((CHASSIS, SPRING_TOP), (ARM, SPRING_SEAT)), (SPRING,)),
        d.ForceElement(
            "damper",
            d.AlongLine((CHASSIS, DAMPER_TOP), (ARM, DAMPER_SEAT)),
            (DAMPER, *further_laws("damper", 1.0), ACTUATOR),
        ),
        of_rubber(TYRE),
    ),
    coordinates=(
        HINGE.angle(
            "arm_angle",
            "angle of the wheel centre from the chassis vertical; falls as the wheel rises",
        ),
        BEARING.angle(
            "spin_angle", "wheel spin angle relative to the arm, positive rolling forward"
        ),
    ),
)

MODELS = (
    d.Formulation(
        name="trailing_arm",
        title="Trailing arm with a damper curve, friction and stops",
        mechanism=TRAILING_ARM,
        independent=(HINGE, BEARING),
        massive=(ARM, WHEEL),
    ),
)
