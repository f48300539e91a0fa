"""A trailing arm: one hinge on the chassis, and the arm is the wheel carrier.

There is no loop, no tie rod and no rack, so that nothing steers the wheel. With an oblique axis of
the hinge it is a semi-trailing arm. Spring and damper act between the chassis and the arm, each
with ends of its own. The default values are this project's own: a rear right corner, ISO 8855 axes,
ground at z = 0.
"""

from __future__ import annotations

from .. import declare as d
from .suspension import actuator, damper, spring, spring_and_damper, tyre, with_damping_and_liftoff

ARM_INNER = d.Point("arm_inner", (0.40, -0.27, 0.28), "inner bearing of the arm on the chassis")
ARM_OUTER = d.Point("arm_outer", (0.52, -0.63, 0.28), "outer bearing of the arm on the chassis")
SPRING_TOP = d.Point("spring_top", (0.10, -0.50, 0.52), "upper seat of the spring, on the chassis")
SPRING_SEAT = d.Point("spring_seat", (0.10, -0.50, 0.24), "lower seat of the spring, on the arm")
DAMPER_TOP = d.Point("damper_top", (0.0, -0.56, 0.72), "upper end of the damper, on the chassis")
DAMPER_SEAT = d.Point("damper_seat", (-0.06, -0.60, 0.23), "lower end of the damper, on the arm")
WHEEL_CENTER = d.Point("wheel_center", (0.0, -0.74, 0.30), "wheel centre")
SPIN_AXIS = d.Direction("spin_axis", (0.0, 1.0, 0.0), "spin axis of the wheel, pointing left")

CHASSIS = d.Ground("chassis", 1)
ARM = d.Body("trailing_arm", 18.0, (0.12, -0.59, 0.28), (0.35, 0.65, 0.9))
WHEEL = d.Rotor("wheel", 20.0, WHEEL_CENTER, axis=SPIN_AXIS, spin=0.95, diametral=0.52)

HINGE = d.Revolute(
    "arm_hinge", CHASSIS, ARM, axis=d.Line(ARM_OUTER, ARM_INNER), angle_to=WHEEL_CENTER
)
BEARING = d.Revolute("bearing", ARM, WHEEL, axis=d.Line(WHEEL_CENTER, SPIN_AXIS))

SPRING = spring(55000.0, 0.36)
ACTUATOR = actuator()
DAMPER = damper(2000.0)
COIL, SHOCK = spring_and_damper(
    ((CHASSIS, SPRING_TOP), (ARM, SPRING_SEAT)),
    ((CHASSIS, DAMPER_TOP), (ARM, DAMPER_SEAT)),
    (SPRING, ACTUATOR, DAMPER),
)
TYRE = tyre("rear", d.Wheel(ARM, WHEEL_CENTER, SPIN_AXIS), 0.318)

TRAILING_ARM = d.Mechanism(
    name="trailing_arm",
    title="Trailing arm",
    joints=(HINGE, BEARING),
    forces=(d.Weight(), COIL, SHOCK, with_damping_and_liftoff(TYRE)),
    coordinates=(
        HINGE.angle(
            "arm_angle", "angle of the arm from the chassis vertical; falls as the wheel rises"
        ),
        BEARING.angle(
            "spin_angle", "wheel spin angle relative to the arm, positive rolling forward"
        ),
    ),
)

MODELS = (
    d.Formulation(
        name="trailing_arm",
        title="Trailing arm with an oblique axis",
        mechanism=TRAILING_ARM,
        independent=(HINGE, BEARING),
        massive=(ARM, WHEEL),
    ),
)
