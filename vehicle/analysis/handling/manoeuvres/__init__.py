"""Manoeuvres: one module each, with the keys of its file.

A further manoeuvre is a module with a class that has a key ``manoeuvre``, its line in `loading`,
and a packaged file.
"""

from .acceleration import Acceleration
from .braking import StraightBraking
from .braking_in_turn import BrakingInTurn
from .circle import Circle
from .coast_down import CoastDown
from .double_lane_change import DoubleLaneChange
from .loading import MANOEUVRES, load_manoeuvre
from .manoeuvre import Manoeuvre
from .parking import Parking
from .path_following import PathFollowing
from .sine_sweep import SineSweep
from .sine_with_dwell import SineWithDwell
from .slowly_increasing_steer import SlowlyIncreasingSteer
from .speed_range import SpeedRange
from .step_steer import StepSteer
from .straight import Straight

__all__ = [
    "MANOEUVRES", "Acceleration", "BrakingInTurn", "Circle", "CoastDown", "DoubleLaneChange",
    "Manoeuvre", "Parking", "PathFollowing", "SineSweep", "SineWithDwell", "SlowlyIncreasingSteer",
    "SpeedRange", "StepSteer", "Straight", "StraightBraking", "load_manoeuvre",
]  # fmt: skip
