"""Ride of a car: its rest, its modes, and its motion on a road.

`at_rest`    ride heights, corner weights and alignment at rest
`modes`      heave, pitch, roll, and hop and tramp of its axles, by the exact linearisation
`response`   frequency responses to the road under each wheel, and spectra on a rough road
`by_speed`   metrics of the ride over speed
`over`       a simulation over a road, and its metrics
`run`        the same with the states of the equations, for pictures of the motion
"""

from .by_speed import by_speed
from .linear import modes, response
from .rest import at_rest
from .simulated import over, run
from .weighting import weighted, weighting

__all__ = ["at_rest", "by_speed", "modes", "over", "response", "run", "weighted", "weighting"]
