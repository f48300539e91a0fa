"""Levels of signals in a manifest: a number, or a parameter with a sign."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

Values = float | NDArray[np.float64]
"""A number for one system, or an array of numbers for several."""


def value_of(level: float | str, parameters: Mapping[str, Values]) -> Values:
    """Return a level in SI units: a number, or a parameter by its name with or without a minus.

    Examples
    --------
    >>> value_of("-strut_length_max", {"strut_length_max": 0.85})
    -0.85
    """
    if not isinstance(level, str):
        return level
    value = parameters[level.removeprefix("-")]
    return -value if level.startswith("-") else value
