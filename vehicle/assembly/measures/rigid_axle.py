"""The measures of a rigid axle, with the formulas of its roll centre and of jacking.

Source: J. C. Dixon, Suspension Geometry and Computation, Wiley, 2009 (rigid axles).
"""

from dataclasses import replace

import numpy as np

from ....core.named_types import Array
from ...models.rigid_axle.model import HEAVE, ROLL
from ...models.rigid_axle.structure import BEAM
from ...models.sides import LEFT, RIGHT, SIDES
from ..whole_axle_kinematics import RigidAxleKinematics
from . import pitching, rolling
from .corner import GROUND
from .measure import Measure, of_axle, of_wheel
from .quantities import QUANTITIES
from .whole_axle import SPRINGS, dot, signal


def roll_center_height(beam: RigidAxleKinematics) -> Array:
    """Return the height of the roll centre above the line through the contacts [m].

    In front view it lies on the perpendicular bisector of the contacts: the point that does not
    move along the line through the contacts when the axle rolls and their middle does not move
    across this line. A force along the line at this point does no work in roll.
    """
    left, right = (beam.contact(side) for side in SIDES)
    middle, line = 0.5 * (left + right), (left - right)[:, 1:]
    line = line / np.linalg.norm(line, axis=-1, keepdims=True)
    across = np.stack([-line[:, 1], line[:, 0]], -1)
    roll, heave = (beam.velocity_of(BEAM, middle, by)[:, 1:] for by in (ROLL, HEAVE))
    times = -dot(across, roll) / dot(across, heave)
    velocity = roll + times[:, None] * heave
    turning = beam.turning_of(BEAM, ROLL)[:, 0] + times * beam.turning_of(BEAM, HEAVE)[:, 0]
    return dot(line, velocity) / turning


def jacking(beam: RigidAxleKinematics) -> Array:
    """Return the lift of the body by a force on the tyres to the left, over that force [1].

    By virtual work the force pushes the axle up, and the body down, if the axle moves to the left
    as it rises.
    """
    middle = 0.5 * (beam.contact(LEFT) + beam.contact(RIGHT))
    velocity = beam.velocity_of(BEAM, middle, HEAVE)
    return -velocity[:, 1] / velocity[:, 2]


_JACKING = replace(
    QUANTITIES["jacking"],
    long_name="jacking coefficient of the axle",
    definition="lift of the body by a lateral force at the contacts, over the force, -v_y / v_z in "
    "heave",
    sign="positive when a force to the left lifts the body",
)


GUIDANCE = (
    of_axle("axle_steer", lambda beam: beam.coordinate("yaw")),
    of_axle(
        "roll_steer", lambda beam: -beam.slope("yaw", ROLL),
        definition="derivative of the axle's steer angle with respect to the roll angle, the "
        "wheels moving "
        "oppositely",
    ),
    of_axle("heave_steer", lambda beam: beam.slope("yaw", HEAVE)),
    of_axle("axle_lateral", lambda beam: beam.coordinate("sway")),
    of_axle("axle_longitudinal", lambda beam: beam.coordinate("shift")),
    # the nose of the final drive points to the middle of the car
    of_axle(
        "pinion_angle",
        lambda beam: (1.0 if beam.end == "front" else -1.0) * beam.coordinate("pitch"),
    ),
    of_wheel("camber", signal("axle_camber")),
    of_wheel("toe", signal("axle_toe")),
    of_wheel("steer", signal("axle_steer")),
)  # fmt: skip
"""Steer angle, displacement and inclination of the axle."""

ON_THE_ROAD = (
    of_axle(
        "roll_center_height", roll_center_height, GROUND,
        definition="point midway between the contacts that does not move along the line through "
        "them as the axle rolls and the middle between the contacts stays on that line",
    ),
    Measure(_JACKING, jacking, "axle", GROUND),
    *pitching.at_both_ends(
        of_axle,
        "contacts with brakes on the axle, wheel centres with inboard ones",
        "contacts with the final drive in the axle, wheel centres with it on the body",
    ),
)  # fmt: skip
"""Effects of forces of the road, by the paths of the axle."""

OF_BAR = (
    of_axle(
        "roll_stiffness_bar", rolling.of_bar, GROUND,
        lambda beam: beam.axle.anti_roll_bar is not None,
    ),
    of_axle(
        "roll_stiffness_with_tyres", rolling.with_tyres, (*GROUND, "tyre_rate"), rolling.has_tyres
    ),
)  # fmt: skip
"""Roll stiffness of the anti-roll bar, and of the axle with its tyres."""

MEASURES = (*GUIDANCE, *ON_THE_ROAD, *SPRINGS, *OF_BAR)
"""All of them."""
