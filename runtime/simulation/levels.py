"""Levels of signals, as a manifest gives them: a number, or a parameter with its sign."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

Values = float | NDArray[np.float64]
"""Of one system, or of each of many."""


def value_of(level: float | str, parameters: Mapping[str, Values]) -> Values:
    """Return the value of a level in SI units.

    Parameters
    ----------
    level : float or str
        A number, or the name of a parameter, with a minus before it or without.
    parameters : mapping
        By name, SI units.

    Examples
    --------
    >>> value_of("-strut_length_max", {"strut_length_max": 0.85})
    -0.85
    """
    if not isinstance(level, str):
        return level
    value = parameters[level.removeprefix("-")]
    return -value if level.startswith("-") else value
