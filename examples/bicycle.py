"""The benchmark bicycle of Meijaard, Papadopoulos, Ruina and Schwab (2007), whose wheels roll.

"Linearized dynamics equations for the balance and steer of a bicycle: a benchmark and review",
Proceedings of the Royal Society A 463, 1955-1982, table 1; there z points down, here it points up.
The rider is rigid on the rear frame. Lean, steer and the rear wheel turn freely; the other speeds
follow since neither wheel slips.
"""

import math

from kintrafo import generator as g

TILT = math.pi / 10.0

# -- points and directions: x forward, y left, z up -----------------------------------------------

REAR_CENTER = g.Point("rear_center", (0.0, 0.0, 0.3), "centre of the rear wheel")
FRONT_CENTER = g.Point("front_center", (1.02, 0.0, 0.35), "centre of the front wheel")
STEER_POINT = g.Point("steer_point", (1.1, 0.0, 0.0), "where the steer axis meets the ground")
STEER_AXIS = g.Direction("steer_axis", (-math.sin(TILT), 0.0, math.cos(TILT)), "upward")
LEFT = g.Direction("left", (0.0, 1.0, 0.0), "axis of the wheels")

# -- bodies and the joints between them -----------------------------------------------------------

FRAME = g.Body("frame", 85.0, (0.3, 0.0, 0.9), (9.2, 11.0, 2.8, 0.0, -2.4, 0.0))
FORK = g.Body("fork", 4.0, (0.9, 0.0, 0.7), (0.05892, 0.06, 0.00708, 0.0, 0.00756, 0.0))
REAR = g.Rotor("rear_wheel", 2.0, REAR_CENTER, axis=LEFT, spin=0.12, diametral=0.0603)
FRONT = g.Rotor("front_wheel", 3.0, FRONT_CENTER, axis=LEFT, spin=0.28, diametral=0.1405)

RIDE = g.Free("ride", FRAME)
STEER = g.Revolute("steer", FRAME, FORK, g.Line(STEER_POINT, STEER_AXIS))
REAR_HUB = g.Revolute("rear_hub", FRAME, REAR, g.Line(REAR_CENTER, LEFT))
FRONT_HUB = g.Revolute("front_hub", FORK, FRONT, g.Line(FRONT_CENTER, LEFT))

# -- the ground -----------------------------------------------------------------------------------

REAR_ROLLS = g.Rolling(
    "rear_rolls",
    g.Wheel(FRAME, REAR_CENTER, LEFT),
    g.Length("rear_radius", 0.3, "radius of the rear wheel"),
    REAR_HUB,
)
FRONT_ROLLS = g.Rolling(
    "front_rolls",
    g.Wheel(FORK, FRONT_CENTER, LEFT),
    g.Length("front_radius", 0.35, "radius of the front wheel"),
    FRONT_HUB,
)

MODEL = g.Formulation(
    name="bicycle",
    title="Benchmark bicycle",
    mechanism=g.Mechanism(
        name="bicycle",
        title="Bicycle",
        joints=(RIDE, STEER, REAR_HUB, FRONT_HUB),
        forces=(g.Weight(),),
        coordinates=(
            STEER.angle("steer_angle", "angle of the fork, positive to the left"),
            REAR_HUB.angle("rear_angle", "angle of the rear wheel"),
            FRONT_HUB.angle("front_angle", "angle of the front wheel"),
        ),
        constraints=(REAR_ROLLS, FRONT_ROLLS),
    ),
    independent=(RIDE, STEER, REAR_HUB, FRONT_HUB),
    eliminated=("frame_u", "frame_v", "frame_w", "frame_q", "frame_r", "front_angle_rate"),
)
