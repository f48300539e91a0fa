"""Roads and rack motions by formula, for `kintrafo.simulate`.

Each function returns an argument of ``simulate(..., inputs={"road_height": ...})``; heights are
positive up [m]. `kintrafo.measurement` reads measured ones.
"""

import math

import numpy as np
from scipy.interpolate import CubicSpline

from ...core.errors import InputError
from ...core.named_types import Array
from ...core.validator import Validator

Samples = tuple[Array, Array]

# A cubic spline differs from its function by h^4 / 384 of the fourth derivative: 6e-11 for these.
_SAMPLES_OF_A_PERIOD = 512
_MOST_PERIODS = 5000
# Shortest motion over a sinusoidal road, whose slopes are finite [s].
_SHORTEST = 1e-9


def step(height: float, *, at: float, end: float) -> Samples | float:
    """Return the height of a road with a step, over time.

    Parameters
    ----------
    height : float
        Height of the road after the step [m]; negative for a drop. Before it the height is zero.
    at : float
        Time at which the tyre reaches the step [s].
    end : float
        Last time of the simulation [s].

    Returns
    -------
    tuple of ndarray, or float
        Times [s] and heights [m] with a jump, for `kintrafo.simulate`; the height alone if `at` is
        zero or below.

    Examples
    --------
    >>> from kintrafo import roads
    >>> times, heights = roads.step(0.02, at=0.1, end=1.0)
    >>> times.tolist(), heights.tolist()
    ([0.0, 0.1, 0.1, 1.0], [0.0, 0.0, 0.02, 0.02])
    """
    with Validator("road step") as given:
        height = given.number("height", height, "m")
        at = given.number("at", at, "s")
        end = given.number("end", end, "s", above=0.0)
    if at <= 0.0:
        return height
    if at >= end:
        problem = f"at {at:g} s, but the simulation ends at {end:g} s. Increase the end."
        raise InputError([problem], "road step")
    return np.array([0.0, at, at, end]), np.array([0.0, 0.0, height, height])


def sine(amplitude: float, frequency: float, *, end: float) -> CubicSpline:
    """Return the height of a sinusoidal road over time, which starts at zero and rises.

    Parameters
    ----------
    amplitude : float
        Amplitude, half the height from valley to crest [m].
    frequency : float
        Frequency, above zero [Hz].
    end : float
        Last time of the simulation [s].

    Returns
    -------
    scipy.interpolate.CubicSpline
        A function of time [s], from zero to `end`, NaN elsewhere; it differs from the sine by at
        most 1e-10 of the amplitude.

    Examples
    --------
    >>> from kintrafo import roads
    >>> round(float(roads.sine(0.01, 0.5, end=2.0)(0.5)), 11)
    0.01
    """
    with Validator("sine") as given:
        amplitude = given.number("amplitude", amplitude, "m")
        frequency = given.number("frequency", frequency, "Hz")
        end = given.number("end", end, "s", least=_SHORTEST)
    periods = frequency * end
    if not 0.0 < periods <= _MOST_PERIODS:
        problem = (
            f"frequency = {frequency:g} Hz: more than 0 Hz and at most {_MOST_PERIODS / end:g} Hz "
            f"({_MOST_PERIODS} periods in {end:g} s) are possible."
        )
        raise InputError([problem], "sine")
    times = np.linspace(0.0, end, 4 + math.ceil(_SAMPLES_OF_A_PERIOD * periods))
    heights = amplitude * np.sin(2.0 * math.pi * frequency * times)
    return CubicSpline(times, heights, extrapolate=False)
