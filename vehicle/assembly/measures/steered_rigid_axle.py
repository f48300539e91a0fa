"""The measures of a steered rigid axle: those of a rigid axle, and of wheels on kingpins."""

from .. import wheel
from ..quantity import PITMAN_BALL
from . import axle_rolling, rolling
from .corner import COMPARED, GROUND, STEERING
from .measure import Measure, of_axle, of_corner
from .rigid_axle import MEASURES as OF_THE_BEAM
from .twist_beam import ROLL_STEER

_STEERED = ("steered",)
_NEITHER = ("roll_steer",)  # that of the axle, and here each wheel has its own

PLACE = (
    of_corner("caster", wheel.caster, _STEERED),
    of_corner("kingpin_inclination", wheel.kingpin_inclination, _STEERED),
    of_corner("trail", wheel.trail, (*_STEERED, *GROUND)),
    of_corner("steering_axis_offset", wheel.steering_axis_offset, (*_STEERED, *GROUND)),
    of_corner("scrub_radius", wheel.scrub_radius, (*_STEERED, *GROUND)),
    of_corner("hub_trail", wheel.hub_trail, _STEERED),
    of_corner("spindle_offset", wheel.spindle_offset, _STEERED),
)
"""The kingpins, over travel and over the steering."""

TRAVEL = (
    of_corner("bump_steer", wheel.bump_steer),
    of_corner("caster_gradient", wheel.caster_gradient, _STEERED),
    ROLL_STEER,
)
"""Steering of the wheels by travel and roll, with the Pitman arm held."""

MEASURES = (*(m for m in OF_THE_BEAM if m.name not in _NEITHER), *PLACE, *TRAVEL)

_ANGLES = ("camber", "toe", "steer")
OVER_RACK = (
    *(m for m in OF_THE_BEAM if m.name in _ANGLES),
    *PLACE,
    *STEERING,
    of_axle("track", rolling.track, GROUND),
    of_axle("track_change", axle_rolling.track_change, GROUND),
    *COMPARED,
)

OVER_STEERING = (
    *OVER_RACK,
    Measure(PITMAN_BALL, lambda of: of.rack, "axle", (), lambda of: of.per_turn is not None),
)
