"""Roads and rack motions by formula, for `kintrafo.simulate`.

Each function returns something that ``simulate(..., inputs={"road_height": ...})`` takes; heights
are in metres, positive up. What was measured is read by `kintrafo.measurement`.
"""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .errors import InputError

Array = NDArray[np.float64]
Samples = tuple[Array, Array]


def step(height: float, *, at: float, end: float) -> Samples | float:
    """Return a road that rises at once.

    Parameters
    ----------
    height : float
        Height behind the step [m]; negative for a drop.
    at : float
        Time at which the tyre meets it [s].
    end : float
        Last time of the simulation [s].

    Returns
    -------
    tuple of ndarray, or float
        Samples with a jump; a number where the step is there from the start.

    Examples
    --------
    >>> times, heights = step(0.02, at=0.1, end=1.0)
    >>> times.tolist(), heights.tolist()
    ([0.0, 0.1, 0.1, 1.0], [0.0, 0.0, 0.02, 0.02])
    """
    _check_finite(height=height, at=at)
    if at <= 0.0:
        return height
    if at >= end:
        problem = f"at {at:g} s, but the simulation ends at {end:g} s. Let it end later."
        raise InputError([problem], "road step")
    return np.array([0.0, at, at, end]), np.array([0.0, 0.0, height, height])


def sine(amplitude: float, frequency: float) -> Callable[[float], float]:
    """Return a harmonic motion that starts in its middle, upward.

    Parameters
    ----------
    amplitude : float
        To either side [m].
    frequency : float
        [Hz]

    Returns
    -------
    callable
        Of time [s].

    Examples
    --------
    >>> round(sine(0.01, 0.5)(0.5), 12)
    0.01
    """
    _check_finite(amplitude=amplitude, frequency=frequency)
    if frequency <= 0.0:
        problem = f"frequency = {frequency:g} Hz: more than 0 Hz is needed."
        raise InputError([problem], "sine")
    rate = 2.0 * math.pi * frequency
    return lambda time: amplitude * math.sin(rate * time)


def _check_finite(**values: float) -> None:
    bad = [f"{name} = {value}: a finite number is needed." for name, value in values.items()]
    problems = [text for text, v in zip(bad, values.values(), strict=True) if not math.isfinite(v)]
    if problems:
        raise InputError(problems, "input")
