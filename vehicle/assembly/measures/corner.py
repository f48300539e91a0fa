"""The measures of a corner, most of which each wheel of an axle has, too."""

from .. import wheel
from . import ackermann
from .measure import of_axle, of_corner

GROUND = ("tyre_radius",)
"""The data that define a contact."""
PITCH = (*GROUND, "wheelbase", "center_of_gravity_height")
_STEERED, _WHEELBASE = ("steered",), ("wheelbase",)
_BRAKING = (*PITCH, "front_brake_share")

PLACE = (
    of_corner("camber", wheel.camber),
    of_corner("toe", wheel.toe),
    of_corner("steer", wheel.steer),
    of_corner("camber_gradient", wheel.camber_gradient),
    of_corner("bump_steer", wheel.bump_steer),
    of_corner("caster", wheel.caster, _STEERED),
    of_corner("caster_gradient", wheel.caster_gradient, _STEERED),
    of_corner("kingpin_inclination", wheel.kingpin_inclination, _STEERED),
    of_corner("trail", wheel.trail, (*_STEERED, *GROUND)),
    of_corner("steering_axis_offset", wheel.steering_axis_offset, (*_STEERED, *GROUND)),
    of_corner("scrub_radius", wheel.scrub_radius, (*_STEERED, *GROUND)),
    of_corner("hub_trail", wheel.hub_trail, _STEERED),
    of_corner("spindle_offset", wheel.spindle_offset, _STEERED),
    of_corner("half_track_change", wheel.half_track_change, GROUND),
    of_corner("wheelbase_change", wheel.wheelbase_change),
    of_corner("arm_rotation", lambda corner: corner.arm_rotation),
)
"""Position of the wheel, over wheel travel and over the rack."""

TRAVEL = (
    of_corner("spring_length", lambda corner: corner.spring.stroke.length),
    of_corner("damper_length", lambda corner: corner.damper.length),
    of_corner("motion_ratio", wheel.motion_ratio),
    of_corner("damper_motion_ratio", wheel.damper_motion_ratio),
    of_corner("wheel_rate", wheel.wheel_rate),
    of_corner("ride_rate", wheel.ride_rate, ("tyre_rate",)),
    of_corner("roll_center_height_kinematic", wheel.roll_center_height_kinematic, GROUND),
    of_corner("roll_center_height_geometric", wheel.roll_center_height_geometric, GROUND),
    of_corner("swing_arm_length_kinematic", wheel.swing_arm_length_kinematic, GROUND),
    of_corner("swing_arm_length_geometric", wheel.swing_arm_length_geometric, GROUND),
    of_corner("side_view_swing_arm_angle", wheel.side_view_swing_arm_angle, GROUND),
    of_corner("side_view_hub_angle", wheel.side_view_hub_angle),
    of_corner("anti_dive", wheel.anti_dive, (*_BRAKING, "front")),
    of_corner("anti_lift_braked", wheel.anti_lift_braked, (*_BRAKING, "rear")),
)
"""Derivatives of the motion over wheel travel."""

AT_STOPS = frozenset({"wheel_rate", "ride_rate"})
"""Names of measures that jump where a stop begins to act."""

STEERING = (of_corner("steer_gradient", wheel.steer_gradient),)
"""Derivatives of the motion of one wheel over the rack."""

COMPARED = (
    of_axle("ackermann_error", ackermann.error_of, _WHEELBASE),
    of_axle("ackermann", ackermann.percentage_of, _WHEELBASE),
    of_axle("turning_circle", ackermann.circle_of, _WHEELBASE),
    of_axle("steering_ratio", ackermann.ratio_of, (), lambda of: of.per_turn is not None),
)
"""Comparisons of two steered wheels."""

BOTH = (
    of_axle("steer_left", lambda of: wheel.steer(of.left)),
    of_axle("steer_right", lambda of: wheel.steer(of.right)),
    *COMPARED,
)
"""Steer angles of a wheel and its mirror image, and their comparisons."""

OVER_TRAVEL = (*PLACE, *TRAVEL)
OVER_RACK = (*PLACE, *STEERING, *BOTH)

OF_STEERING = frozenset(
    measure.name
    for measure in (*OVER_TRAVEL, *OVER_RACK)
    if "steered" in measure.needs or measure not in OVER_TRAVEL
)
"""Names of measures that only a steered wheel has."""
