"""A pushrod suspension: the wheel's arm turns a rocker on the chassis, and that presses the spring.

The arm swings about a hinge along the vehicle. A pushrod with a ball joint at its lower end and a
cross at its upper end leads to the rocker, whose hinge is oblique. The numbers are invented.
"""

from kintrafo import generator as g

# -- points, in metres: x forward, y left, z up, the wheel on the left ----------------------------

ARM_FRONT = g.Point("arm_front", (0.15, 0.25, 0.20), "front bearing of the arm")
ARM_REAR = g.Point("arm_rear", (-0.15, 0.25, 0.20), "rear bearing of the arm")
ROD_LOWER = g.Point("rod_lower", (0.0, 0.62, 0.22), "ball joint of the pushrod on the arm")
ROD_UPPER = g.Point("rod_upper", (-0.02, 0.34, 0.52), "cross of the pushrod on the rocker")
ROCKER_PIVOT = g.Point("rocker_pivot", (-0.02, 0.28, 0.46), "hinge of the rocker")
SPRING_ROCKER = g.Point("spring_rocker", (-0.02, 0.29, 0.545), "end of the spring on the rocker")
SPRING_CHASSIS = g.Point("spring_chassis", (-0.06, 0.06, 0.57), "end of the spring on the chassis")
WHEEL_CENTER = g.Point("wheel_center", (0.0, 0.75, 0.26), "wheel centre")
ROCKER_AXIS = g.Direction("rocker_axis", (1.0, 0.1, 0.0), "hinge of the rocker")
SPIN_AXIS = g.Direction("spin_axis", (0.0, 1.0, 0.0), "spin axis of the wheel")

# -- bodies and the joints between them -----------------------------------------------------------

CHASSIS = g.Ground("chassis")
ARM = g.Body("arm", 18.0, (0.0, 0.66, 0.25), (0.5, 0.3, 0.6))
PUSHROD = g.Body("pushrod", 0.4, (-0.01, 0.48, 0.37), (0.006, 0.004, 0.003))
ROCKER = g.Body("rocker", 0.7, (-0.02, 0.29, 0.50), (0.001, 0.001, 0.001))

ARM_HINGE = g.Revolute("arm_hinge", CHASSIS, ARM, axis=g.Line(ARM_REAR, ARM_FRONT))
LOWER_END = g.Spherical("lower_end", ARM, PUSHROD, at=ROD_LOWER)
ROD = g.Line(ROD_UPPER, ROD_LOWER)
UPPER_END = g.Universal(
    "upper_end", ROCKER, PUSHROD, at=ROD_UPPER, shaft=ROD, first_axis=ROCKER_AXIS
)
ROCKER_HINGE = g.Revolute("rocker_hinge", CHASSIS, ROCKER, axis=g.Line(ROCKER_PIVOT, ROCKER_AXIS))

# -- what acts on them ----------------------------------------------------------------------------

SPRING = g.LinearSpring(
    rate=g.SpringRate("spring_rate", 60e3, "rate of the spring"),
    free_length=g.Length("spring_free_length", 0.28, "length of the spring without force"),
)
DAMPER = g.LinearDamper(rate=g.DamperRate("damper_rate", 3500.0, "rate of the damper"))
BETWEEN_SEATS = g.AlongLine((CHASSIS, SPRING_CHASSIS), (ROCKER, SPRING_ROCKER))
COILOVER = g.ForceElement("coilover", BETWEEN_SEATS, (SPRING, DAMPER))
TYRE = g.LinearTyre(
    name="tyre",
    wheel=g.Wheel(ARM, WHEEL_CENTER, SPIN_AXIS),
    rate=g.SpringRate("tyre_rate", 180e3, "radial rate of the tyre"),
    free_height=g.Displacement("tyre_free_height", 0.27, "height at which the tyre touches"),
    road=g.Input("road_height", "m", "height of the road under the tyre, positive up"),
)

MODEL = g.Formulation(
    name="pushrod_suspension",
    title="Pushrod suspension, one degree of freedom",
    mechanism=g.Mechanism(
        name="pushrod_suspension",
        title="Pushrod suspension",
        joints=(ARM_HINGE, LOWER_END, UPPER_END, ROCKER_HINGE),
        forces=(g.Weight(), COILOVER, TYRE),
        coordinates=(
            ARM_HINGE.angle("arm_angle", "angle of the arm"),
            ROCKER_HINGE.angle("rocker_angle", "angle of the rocker"),
        ),
    ),
    independent=(ARM_HINGE,),
    massive=(ARM, PUSHROD, ROCKER),
)
