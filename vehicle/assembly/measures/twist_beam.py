"""The measures of a twist-beam axle, and the formulas that only it has.

Each wheel has the measures of a single wheel, in parallel travel of both, and further measures in
roll, with the wheel centres moving oppositely.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ....core.named_types import Array
from ...corner.corner import CarrierMotion, RoadWheel
from ...models.sides import SENSE, SIDES
from .. import wheel
from ..whole_axle_kinematics import WholeAxleKinematics
from . import axle_rolling, pitching, rolling
from .corner import GROUND
from .measure import Measure, of_axle, of_corner, of_wheel
from .quantities import QUANTITIES
from .whole_axle import SPRINGS, dot

_JACKING = replace(
    QUANTITIES["jacking"],
    definition="lift of the body by an inboard force at the contact, over the force, by the path "
    "of the contact with the other wheel at its height",
    sign="positive when an inboard force lifts the body",
)


def roll_center_height(of: WholeAxleKinematics) -> Array:
    """Return the height of the roll centre above the line through the contacts [m].

    As the wheel centres move oppositely, the line through the contacts turns in front view about a
    point midway between them; a lateral force at this point does no work in roll.
    """
    left, right = (of.contact(side) for side in SIDES)
    line = (left - right)[:, 1:]
    length = np.linalg.norm(line, axis=-1, keepdims=True)
    line = line / length
    across = np.stack([-line[:, 1], line[:, 0]], -1)
    roll, heave = (
        np.stack([of.contact_in(side, how)[:, 1:] for side in SIDES]) for how in ("roll", "bump")
    )
    times = -dot(across, roll.mean(axis=0)) / dot(across, heave.mean(axis=0))
    moved = roll + times[:, None] * heave
    turning = dot(across, moved[0] - moved[1]) / length[:, 0]
    return dot(line, moved.mean(axis=0)) / turning


def jacking(of: WholeAxleKinematics, side: str) -> Array:
    """Return the lift of the body by an inboard force at a contact, over that force [1]."""
    velocity = of.carried_in(side, of.contact(side), side)
    with np.errstate(divide="ignore", invalid="ignore"):
        lift: Array = SENSE[side] * velocity[:, 1] / velocity[:, 2]
    return lift


def in_roll(of: WholeAxleKinematics, side: str, rate: Callable[..., Array]) -> Array:
    """Return the derivative of a quantity with respect to the roll of the body on the wheels.

    `rate` takes a wheel and the motion of its carrier, and returns the rate of the quantity.
    """
    # roll is positive with the right side of the body down, that is, with the right wheel up
    return -rate(of.corners[side], of.motion(side, "roll")) / of.inclination_rate


def _steer_rate(corner: RoadWheel, motion: CarrierMotion) -> Array:
    """Return the rate of the steer angle in a motion [rad per unit], positive to the left."""
    return -corner.vehicle.side * wheel.toe_rate(corner, motion)


ROLL_STEER = of_wheel(
    "roll_steer", lambda of, side: in_roll(of, side, _steer_rate),
    definition="derivative of the steer angle with respect to the roll angle, the wheel "
    "centres moving "
    "oppositely",
)  # fmt: skip
"""Of a wheel by the roll of the body."""

MEASURES = (
    of_corner("camber", wheel.camber),
    of_corner("toe", wheel.toe),
    of_corner("steer", wheel.steer),
    of_corner("camber_gradient", wheel.camber_gradient),
    of_corner("bump_steer", wheel.bump_steer),
    of_corner("half_track_change", wheel.half_track_change, GROUND),
    of_corner("wheelbase_change", wheel.wheelbase_change),
    of_corner("side_view_swing_arm_angle", wheel.side_view_swing_arm_angle, GROUND),
    of_corner("side_view_hub_angle", wheel.side_view_hub_angle),
    of_axle("track", rolling.track, GROUND),
    of_axle("track_change", axle_rolling.track_change, GROUND),
    of_wheel("inclination", axle_rolling.inclination, GROUND),
    of_axle(
        "roll_center_height", roll_center_height, GROUND,
        definition="point midway between the contacts about which the line through them turns as "
        "the wheel centres move oppositely",
    ),
    Measure(_JACKING, jacking, "wheel", GROUND),
    ROLL_STEER,
    of_wheel(
        "roll_camber", lambda of, side: in_roll(of, side, wheel.camber_rate),
        definition="derivative of camber, to the body, with respect to the roll angle, the wheel "
        "centres moving "
        "oppositely",
    ),
    *pitching.at_both_ends(of_wheel),
    *SPRINGS,
    of_axle("roll_stiffness_springs", rolling.of_springs, GROUND),
    of_axle("roll_stiffness_bar", rolling.of_bar, GROUND),
    of_axle("bar_share", rolling.bar_share, GROUND),
    of_axle(
        "roll_stiffness_with_tyres", rolling.with_tyres, (*GROUND, "tyre_rate"), rolling.has_tyres
    ),
    of_axle("bar_twist", lambda of: of.parts.twist),
    of_axle("bar_torque", lambda of: of.parts.torque),
)  # fmt: skip
"""All measures, the same over every motion."""
