"""The measures of a steered rigid axle: those of a rigid axle, and of wheels on kingpins."""

from ..quantity import PITMAN_BALL
from . import axle_rolling, rolling
from .corner import COMPARED, GROUND, STEERING
from .corner import PLACE as OF_A_CORNER
from .measure import Measure, of_axle
from .rigid_axle import MEASURES as OF_THE_BEAM
from .twist_beam import ROLL_STEER

_BY_TRAVEL = ("bump_steer", "caster_gradient")

PLACE = tuple(m for m in OF_A_CORNER if "steered" in m.needs and m.name not in _BY_TRAVEL)
"""The kingpins, over travel and over the steering."""

TRAVEL = (*(m for m in OF_A_CORNER if m.name in _BY_TRAVEL), ROLL_STEER)
"""Steering of the wheels by travel and roll, with the Pitman arm held."""

# each wheel has a roll steer of its own, instead of that of the beam
MEASURES = (*(m for m in OF_THE_BEAM if m.name != ROLL_STEER.name), *PLACE, *TRAVEL)

_ANGLES = ("camber", "toe", "steer")
OVER_RACK = (
    *(m for m in OF_THE_BEAM if m.name in _ANGLES),
    *PLACE,
    *STEERING,
    of_axle("track", rolling.track, GROUND),
    of_axle("track_change", axle_rolling.track_change, GROUND),
    *COMPARED,
)
"""Measures over displacements of the Pitman arm's ball."""

OVER_STEERING = (
    *OVER_RACK,
    Measure(PITMAN_BALL, lambda of: of.rack, "axle", (), lambda of: of.per_turn is not None),
)
"""Measures over the steering wheel."""
