"""Crossings and peaks of curves over time, and their responses to a step and to a frequency."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....core.named_types import Array

Complex = NDArray[np.complex128]


def first_crossing(time: Array, values: Array, level: float) -> float:
    """Return the time at which values first reach a level from below, by linear interpolation.

    It is NaN if they never do.

    Parameters
    ----------
    time, values : ndarray, shape (n,)
    level : float
    """
    above = np.flatnonzero(values >= level)
    if not above.size:
        return np.nan
    i = int(above[0])
    if i == 0:
        return float(time[0])
    share = (level - values[i - 1]) / (values[i] - values[i - 1])
    return float(time[i - 1] + share * (time[i] - time[i - 1]))


def peak(time: Array, values: Array) -> tuple[float, float]:
    """Return the time of the greatest value, and this value.

    They are those of a parabola through the greatest sample and its neighbours.

    Parameters
    ----------
    time, values : ndarray, shape (n,)
    """
    i = int(np.argmax(values))
    if i in (0, values.size - 1):
        return float(time[i]), float(values[i])
    (t0, t1, t2), (y0, y1, y2) = time[i - 1 : i + 2], values[i - 1 : i + 2]
    slopes = (y1 - y0) / (t1 - t0), (y2 - y1) / (t2 - t1)
    bend = (slopes[1] - slopes[0]) / (t2 - t0)
    if bend == 0.0:
        return float(t1), float(y1)
    at = 0.5 * (t0 + t1) - 0.5 * slopes[0] / bend
    return float(at), float(y1 + (at - t1) * (slopes[0] + bend * (at - t0)))


class StepResponse(NamedTuple):
    """Metrics of a response to a step (ISO 7401).

    Attributes
    ----------
    steady : float
        The value at the end.
    response_time : float
        Time from half of the step until 90 % of the steady value is first reached [s].
    peak_time : float
        Time from half of the step until the greatest value [s].
    overshoot : float
        The greatest value minus the steady one, as a part of the latter.
    """

    steady: float
    response_time: float
    peak_time: float
    overshoot: float


def step_response(time: Array, values: Array, begun: float, settled: float) -> StepResponse:
    """Return the metrics of a response to a step.

    Parameters
    ----------
    time, values : ndarray, shape (n,)
    begun : float
        Time at half of the step [s].
    settled : float
        Time after which the mean of the values is the steady value [s].
    """
    steady = float(np.mean(values[time >= settled]))
    towards = values * np.sign(steady)
    reached = first_crossing(time, towards, 0.9 * abs(steady))
    when, greatest = peak(time, towards)
    return StepResponse(steady, reached - begun, when - begun, greatest / abs(steady) - 1.0)


def frequency_response(time: Array, cause: Array, effect: Array, frequency: Array) -> Complex:
    """Return the frequency response of an effect to a cause, by their Fourier integrals.

    Both must be at rest at the beginning and at the end.

    Parameters
    ----------
    time, cause, effect : ndarray, shape (n,)
    frequency : ndarray
        [Hz]
    """
    turning = np.exp(-2j * np.pi * np.multiply.outer(frequency, time))
    above, below = (
        np.asarray(np.trapezoid(turning * values, time, axis=-1), dtype=np.complex128)
        for values in (effect, cause)
    )
    return above / below
