"""Studies that change values of the input file.

`cars`           characteristics of many cars with different values
`sensitivity`    derivatives of characteristics with respect to values
`tolerance`      bands and yield of many cars with random values within tolerances
`optimise`       values that bring characteristics to targets, within limits
`pareto`         the Pareto front of several objectives
`fit`            errors of the file that explain measured curves
`sweep`          simulations over a grid of values
`read`, `limits` a file of tolerances, targets and limits, and its limits
`goals`, `judge` its targets and limits, and which of them a suspension meets
"""

from .cars import cars
from .fit import Fit, Fitted, fit
from .goals import Limit, Verdict, goals, judge, limits, read
from .optimise import Optimum, optimise
from .pareto import Front, pareto
from .sensitivity import Effect, effects, sensitivity
from .sweep import sweep
from .tolerance import tolerance

__all__ = [
    "Effect", "Fit", "Fitted", "Front", "Limit", "Optimum", "Verdict", "cars", "effects", "fit",
    "goals", "judge", "limits", "optimise", "pareto", "read", "sensitivity", "sweep", "tolerance",
]  # fmt: skip
