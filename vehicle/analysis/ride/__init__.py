"""Ride of a car: its rest, its modes, and its motion on a road.

`at_rest`    ride heights, corner weights and alignment at rest
`modes`      heave, pitch, roll, and hop and tramp of its axles, by the exact linearisation
`response`   frequency responses to the road under each wheel, and spectra on a rough road
`by_speed`   metrics of the ride over speed
`over`       a simulation over a road, and its metrics
`check_times`  refuses times of a simulation before its equations are derived
`run`        the same with the states of the equations, for pictures of the motion
"""

from .by_speed import by_speed
from .linear import modes, response
from .rest import at_rest
from .simulated import check_times, over, run
from .weighting import weighted, weighting

__all__ = [
    "at_rest",
    "by_speed",
    "check_times",
    "modes",
    "over",
    "response",
    "run",
    "weighted",
    "weighting",
]
