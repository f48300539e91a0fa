"""What happens to the characteristics where values of the input file change.

`sensitivity`    by how much each value moves each characteristic
`tolerance`      bands and yield of many cars that differ as drawings allow
`optimise`       values that bring characteristics to targets, within limits
`sweep`          the motion over a grid of values
`read`           a file of tolerances, or of targets
"""

from .goals import read
from .optimise import Optimum, optimise
from .sensitivity import effects, sensitivity
from .sweep import sweep
from .tolerance import tolerance

__all__ = ["Optimum", "effects", "optimise", "read", "sensitivity", "sweep", "tolerance"]
