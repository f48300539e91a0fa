"""Responses of a car to its steering wheel, from the exact linearisation of a steady motion."""

import numpy as np
from numpy.typing import NDArray

from ....core.named_types import Array
from ....systems.linearisation import linearise
from .car import DrivingCar
from .steady import Steady

Complex = NDArray[np.complex128]

_IMAGINARY = 1e-30
# Steering wheel angle in the difference of the ratio [rad].
_SMALL = 1e-4


def steering_response(car: DrivingCar, steady: Steady, frequency: Array) -> dict[str, Complex]:
    """Return the frequency response of the body's motion to the steering wheel angle.

    It follows from the linearised equations; the torque of the drive is constant.

    Parameters
    ----------
    car : DrivingCar
    steady : Steady
        Straight running.
    frequency : ndarray
        [Hz]

    Returns
    -------
    dict of str to ndarray
        By the names of `body_motion.QUANTITIES`, per steering wheel angle [SI / rad].
    """
    model = car.model
    linear = linearise(model, steady.state, steady.inputs, outputs=[])
    size = len(model.state_names)
    # columns: a state alone, then its rate alone
    moved = steady.state + 1j * _IMAGINARY * np.concatenate([np.eye(size), np.zeros((size, size))])
    rates = linear.rate + 1j * _IMAGINARY * np.concatenate([np.zeros((size, size)), np.eye(size)])
    by_state = {name: np.imag(v) / _IMAGINARY for name, v in car.motion.of(moved, rates).items()}
    states = linear.state_response(frequency, car.steering_input) * _slope(car, steady)
    s = 2j * np.pi * frequency[:, None]
    both = np.concatenate([states, s * states], axis=1)
    return {name: both @ row for name, row in by_state.items()}


def _slope(car: DrivingCar, steady: Steady) -> float:
    """Return the derivative of the steered input in the steering wheel angle."""
    place = car.model.input_names.index(car.steering_input)
    angle = steady.unknowns["steering_wheel"]
    more, less = (car.inputs(angle + d, 0.0, 0.0, 0.0, 0.0)[place] for d in (_SMALL, -_SMALL))
    return float((more - less) / (2.0 * _SMALL))
