"""What happens to the characteristics where values of the input file change.

`cars`           the curves of many cars, each with values of its own
`sensitivity`    by how much each value moves each characteristic
`tolerance`      bands and yield of many cars that differ as drawings allow
`optimise`       values that bring characteristics to targets, within limits
`pareto`         values that no others beat in several objectives
`fit`            errors of the file that explain curves which were measured
`sweep`          the motion over a grid of values
`read`, `limits` a file of tolerances or of targets, and its limits
`goals`, `judge` its targets and limits, and which of them a suspension meets
"""

from .cars import cars
from .fit import Fit, Fitted, fit
from .goals import Verdict, goals, judge, limits, read
from .optimise import Optimum, optimise
from .pareto import Front, pareto
from .sensitivity import Effect, effects, sensitivity
from .sweep import sweep
from .tolerance import tolerance

__all__ = [
    "Effect",
    "Fit",
    "Fitted",
    "Front",
    "Optimum",
    "Verdict",
    "cars",
    "effects",
    "fit",
    "goals",
    "judge",
    "limits",
    "optimise",
    "pareto",
    "read",
    "sensitivity",
    "sweep",
    "tolerance",
]
