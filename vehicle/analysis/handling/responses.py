"""Crossings and peaks of curves, and responses of a car to a step and to a frequency."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....core.named_types import Array
from ....systems.linearisation import linearise
from .car import STEERED_INPUT, DrivingCar
from .steady import Steady

Complex = NDArray[np.complex128]
_IMAGINARY = 1e-30
# Steering wheel angle in the difference of the ratio [rad].
_SMALL = 1e-4


def first_crossing(time: Array, values: Array, level: float) -> float:
    """Return the time at which values first reach a level from below, by linear interpolation.

    It is NaN if they never do.
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

    They are those of a parabola through the greatest sample and its neighbours. The time is NaN if
    the greatest sample is the first or the last one.
    """
    i = int(np.argmax(values))
    if i in (0, values.size - 1):
        return np.nan, float(values[i])
    (t0, t1, t2), (y0, y1, y2) = time[i - 1 : i + 2], values[i - 1 : i + 2]
    slopes = (y1 - y0) / (t1 - t0), (y2 - y1) / (t2 - t1)
    bend = (slopes[1] - slopes[0]) / (t2 - t0)
    if bend == 0.0:
        return float(t1), float(y1)
    at = 0.5 * (t0 + t1) - 0.5 * slopes[0] / bend
    return float(at), float(y1 + (at - t1) * (slopes[0] + bend * (at - t0)))


class StepResponse(NamedTuple):
    """Metrics of a response to a step (ISO 7401)."""

    steady: float  # the value at the end
    change: float  # the steady value minus the first one
    # time from half of the step until 90 % of the change is first reached [s]; NaN if it is reached
    # before, as by a car at walking speed, whose lateral acceleration follows the steering rate
    response_time: float
    # time from half of the step until the greatest change [s]; NaN if it is at the end
    peak_time: float
    overshoot: float  # the greatest change minus the steady one, as a part of the latter
    drift: float  # change within the settled part, between its halves, as a part of `change`


def step_response(time: Array, values: Array, begun: float, settled: float) -> StepResponse:
    """Return the metrics of a response to a step, half of which is done at the time `begun` [s].

    The steady value is the mean of the values after the time `settled` [s].
    """
    last = values[time >= settled]
    steady, before = float(np.mean(last)), float(values[0])
    change = steady - before
    towards = (values - before) * np.sign(change)
    reached = first_crossing(time, towards, 0.9 * abs(change)) - begun
    when, greatest = peak(time, towards)
    halves = [float(np.mean(half)) for half in np.array_split(last, 2) if half.size]
    with np.errstate(divide="ignore", invalid="ignore"):  # of a car that does not respond
        overshoot, drift = np.array([greatest, halves[-1] - halves[0]]) / abs(change) - [1.0, 0.0]
    return StepResponse(
        steady, change, reached if reached >= 0.0 else np.nan, when - begun, float(overshoot),
        abs(float(drift)),
    )  # fmt: skip


def frequency_response(time: Array, cause: Array, effect: Array, frequency: Array) -> Complex:
    """Return the frequency response of an effect to a cause, by their Fourier integrals.

    Both must be at rest at the beginning and at the end. Frequencies are in Hz.
    """
    turning = np.exp(-2j * np.pi * np.multiply.outer(frequency, time))
    above, below = (
        np.asarray(np.trapezoid(turning * values, time, axis=-1), dtype=np.complex128)
        for values in (effect, cause)
    )
    return above / below


def steering_response(car: DrivingCar, steady: Steady, frequency: Array) -> dict[str, Complex]:
    """Return the frequency response of the body's motion to the steering wheel angle [SI / rad].

    It follows from the linearised equations in straight running, with a constant torque of the
    drive, at frequencies in Hz, by the names of `body_motion.QUANTITIES`.
    """
    model = car.model
    linear = linearise(model, steady.state, steady.inputs, outputs=[])
    size = len(model.state_names)
    # columns: a state alone, then its rate alone
    moved = steady.state + 1j * _IMAGINARY * np.concatenate([np.eye(size), np.zeros((size, size))])
    rates = linear.rate + 1j * _IMAGINARY * np.concatenate([np.zeros((size, size)), np.eye(size)])
    by_state = {name: np.imag(v) / _IMAGINARY for name, v in car.motion.of(moved, rates).items()}
    states = linear.state_response(frequency, STEERED_INPUT) * _slope(car, steady)
    s = 2j * np.pi * frequency[:, None]
    both = np.concatenate([states, s * states], axis=1)
    return {name: both @ row for name, row in by_state.items()}


def _slope(car: DrivingCar, steady: Steady) -> float:
    """Return the derivative of the steered input in the steering wheel angle."""
    place = car.model.input_names.index(STEERED_INPUT)
    angle = steady.unknowns["steering_wheel"]
    more, less = (car.inputs(angle + d, 0.0, 0.0, 0.0, 0.0)[place] for d in (_SMALL, -_SMALL))
    return float((more - less) / (2.0 * _SMALL))
