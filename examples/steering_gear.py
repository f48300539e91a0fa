"""A steering gear: column, shaft on two crosses, pinion, and the rack that it moves.

The shaft telescopes between its crosses. The pinion is independent, since the rack follows it
through teeth, and the column turns with it. The numbers are invented.
"""

from kintrafo import generator as g

# -- points, in metres: x forward, y left, z up ----------------------------------------------------

UPPER = g.Point("upper", (0.0, 0.3, 0.0), "centre of the upper cross")
LOWER = g.Point("lower", (0.3, 0.3, -0.2), "centre of the lower cross")
AXIS = g.Direction("axis", (1.0, 0.0, -0.2), "of column and pinion")
LEFT = g.Direction("left", (0.0, 1.0, 0.0), "of the rack")
UPPER_FORK = g.Direction("upper_fork", (0.0, 1.0, 0.0), "axis of the upper cross in the column")
LOWER_FORK = g.Direction("lower_fork", (0.0, 1.0, 0.0), "axis of the lower cross in the pinion")

# -- bodies and the joints between them -----------------------------------------------------------

CHASSIS = g.Ground("chassis")
COLUMN = g.Body("column", 2.0, (-0.2, 0.3, 0.04), (2e-3, 0.03, 0.03))
TUBE = g.Body("tube", 0.6, (0.1, 0.3, -0.07), (3e-4, 2e-3, 2e-3))
SPLINE = g.Body("spline", 0.4, (0.2, 0.3, -0.13), (2e-4, 1e-3, 1e-3))
PINION = g.Body("pinion", 0.5, (0.35, 0.3, -0.21), (2e-4, 1e-3, 1e-3))
RACK = g.Body("rack", 2.5, (0.35, 0.0, -0.23), (0.15, 1e-3, 0.15))

STEER = g.Revolute("steer", CHASSIS, COLUMN, g.Line(UPPER, AXIS))
UPPER_CROSS = g.Universal("upper_cross", COLUMN, TUBE, UPPER, g.Line(UPPER, LOWER), UPPER_FORK)
SPLINES = g.Prismatic("splines", TUBE, SPLINE, g.Direction("along", between=(UPPER, LOWER)))
LOWER_CROSS = g.Universal("lower_cross", PINION, SPLINE, LOWER, g.Line(LOWER, UPPER), LOWER_FORK)
ROLLING = g.Revolute("rolling", CHASSIS, PINION, g.Line(LOWER, AXIS))

PITCH_RADIUS = g.Lead("pitch_radius", 7.5e-3, "pitch radius of the pinion")
GUIDE = g.Prismatic("rack_guide", CHASSIS, RACK, LEFT, follows=g.Gear(ROLLING, PITCH_RADIUS))

# -- what acts on them ----------------------------------------------------------------------------

TORQUE = g.AppliedMoment(COLUMN, AXIS, g.Input("hand_torque", "N m", "torque of the driver"))
FORCE = g.AppliedForce(RACK, RACK.center, LEFT, g.Input("rack_force", "N", "force of tie rods"))

MODEL = g.Formulation(
    name="steering_gear",
    title="Steering gear, one degree of freedom",
    mechanism=g.Mechanism(
        name="steering_gear",
        title="Steering gear",
        joints=(STEER, UPPER_CROSS, SPLINES, LOWER_CROSS, ROLLING, GUIDE),
        forces=(TORQUE, FORCE),
        coordinates=(
            STEER.angle("column_angle", "angle of the column"),
            ROLLING.angle("pinion_angle", "angle of the pinion"),
            GUIDE.slide("rack_slide", "travel of the rack, positive to the left"),
        ),
    ),
    independent=(ROLLING,),
)
