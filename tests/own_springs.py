"""Mechanisms whose springs may have no length: on an arm, and on the second arm of two."""

from __future__ import annotations

from own_mechanisms import NORMAL, askew, declare, hinge

# The seat on the ground is on the circle of that on the arm, 1.2 rad from design.
ON_AN_ARM = declare(
    "spring_on_an_arm",
    {"arm": askew(0.2, 0.02)},
    (hinge("pin", "ground", "arm", "arm_pin", "normal"),),
    {
        "arm_pin": askew(0.0, 0.0),
        "ground_seat": askew(0.3 * 0.3623577544766736, 0.3 * 0.9320390859672263),
        "arm_seat": askew(0.3, 0.0),
    },
    {"normal": NORMAL},
    ("pin",),
    spring=("ground_seat", "arm_seat"),
)

# With two coordinates seats pass each other, at any distance.
ON_TWO_ARMS = declare(
    "spring_on_two_arms",
    {"arm": askew(0.15, 0.02), "hand": askew(0.4, 0.01)},
    (
        hinge("pin", "ground", "arm", "arm_pin", "normal"),
        hinge("elbow", "arm", "hand", "elbow_pin", "normal"),
    ),
    {
        "arm_pin": askew(0.0, 0.0),
        "elbow_pin": askew(0.3, 0.0),
        "ground_seat": askew(0.25, 0.2),
        "hand_seat": askew(0.5, 0.0),
    },
    {"normal": NORMAL},
    ("pin", "elbow"),
    spring=("ground_seat", "hand_seat"),
)

MODELS = (ON_AN_ARM, ON_TWO_ARMS)
