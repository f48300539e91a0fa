"""The measures of an axle of two corners."""

from dataclasses import replace

from .. import wheel
from ..axle_kinematics import AxleKinematics
from ..quantity import RACK
from . import axle_rolling, pitching, rolling
from .corner import COMPARED, GROUND, PLACE, STEERING, TRAVEL
from .measure import Measure, of_axle, of_wheel

# Measures of a single wheel that an axle defines by both wheels, and for front and rear.
_REPLACED = ("roll_center_height_kinematic", "anti_dive", "anti_lift_braked", "arm_rotation")


def _of_each(measures: tuple[Measure, ...]) -> tuple[Measure, ...]:
    """Return the measures that each wheel of an axle has as a corner has them."""
    return tuple(measure for measure in measures if measure.name not in _REPLACED)


def _has_bar(pair: AxleKinematics) -> bool:
    return pair.axle.bar is not None


PATH = (
    of_axle("track", rolling.track, GROUND),
    of_axle("track_change", axle_rolling.track_change, GROUND),
    of_wheel("inclination", axle_rolling.inclination, GROUND),
)
"""Positions of the wheels relative to each other."""

ROLL = (
    of_axle("roll_center_height", lambda pair: axle_rolling.roll_center(pair)[1], GROUND),
    of_axle("roll_center_lateral", lambda pair: axle_rolling.roll_center(pair)[0], GROUND),
    of_wheel("jacking", axle_rolling.jacking, GROUND),
    of_wheel(
        "roll_steer",
        lambda pair, side: axle_rolling.by_roll(
            pair, side, -pair.corners[side].vehicle.side * wheel.bump_steer(pair.corners[side])
        ),
        GROUND,
    ),
    of_wheel(
        "roll_camber",
        lambda pair, side: axle_rolling.by_roll(
            pair, side, wheel.camber_gradient(pair.corners[side])
        ),
        GROUND,
    ),
    of_wheel("wheel_force", lambda pair, side: pair.wheel_force(side)),
    of_axle("roll_moment", rolling.moment, GROUND),
    of_axle("roll_moment_gradient", rolling.moment_gradient, GROUND),
    of_axle("roll_stiffness", rolling.stiffness, GROUND),
    of_axle("roll_stiffness_springs", rolling.of_springs, GROUND, _has_bar),
    of_axle("roll_stiffness_bar", rolling.of_bar, GROUND, _has_bar),
    of_axle("bar_share", rolling.bar_share, GROUND, _has_bar),
    of_axle(
        "roll_stiffness_with_tyres", rolling.with_tyres, (*GROUND, "tyre_rate"), rolling.has_tyres
    ),
    of_axle("bar_twist", lambda pair: pair.twist, (), _has_bar),
    of_axle("bar_torque", lambda pair: pair.torque, (), _has_bar),
    of_wheel("link_force", axle_rolling.link_force, (), _has_bar),
)
"""Roll: its geometry, and the forces of springs and bar."""

PITCHING = pitching.at_both_ends(
    of_wheel, "contact with brakes on the carrier, wheel centre with inboard ones"
)
"""Effects of braking and driving forces, from the wheels' paths."""

_COMPARED = tuple(
    replace(measure, known_to=lambda pair: pair.end == "front")
    if measure.needs == ("wheelbase",)
    else measure
    for measure in COMPARED
)
_RACK = Measure(RACK, lambda pair: pair.rack, "axle", (), lambda pair: pair.per_turn is not None)

OVER_TRAVEL = (*_of_each(PLACE + TRAVEL), *PATH, *ROLL, *PITCHING)
"""Measures over travel and roll."""

_ON_A_RACK = (*_of_each(PLACE + STEERING), *PATH)

OVER_RACK = (*_ON_A_RACK, *_COMPARED)
"""Measures over the rack."""

OVER_STEERING = (*_ON_A_RACK, _RACK, *_COMPARED)
"""Measures over the steering wheel."""
