"""Steering wheel angles over time, with rate and acceleration.

A jump of the rate of a rack, whose position is prescribed, would need an infinite force. The angle
is therefore a function of an eased time, whose rate rises linearly from zero to one in a short time
at the beginning, and falls to zero at the end. Rate and acceleration of the angle are exact.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ....core.named_types import Array


class SteeringMotion(NamedTuple):
    """The motion of the steering wheel, positive to the left; numbers or arrays."""

    angle: Any  # [rad]
    rate: Any  # [rad/s]
    acceleration: Any  # [rad/s^2]


Shape = Callable[[Array], tuple[Array, Array, Array]]
"""An angle as a function of the eased time, with its first and second derivative."""


@dataclass(frozen=True)
class SteeringCourse:
    """A steering wheel angle over time."""

    shape: Shape  # the angle as a function of the eased time, with two derivatives
    length: float  # the eased time at its end [s]
    start: float = 0.0  # time of its beginning [s]
    ease: float = 0.02  # time in which the rate rises, and falls [s]; half of it is the delay

    @property
    def eased(self) -> float:
        """Time in which the rate rises, and falls, at most the length [s]."""
        return min(self.ease, self.length)

    @property
    def end(self) -> float:
        """Time of its end [s]."""
        return self.start + self.length + self.eased

    def at(self, time: ArrayLike) -> SteeringMotion:
        """Return the motion of the steering wheel at some times [s]."""
        ease, length = self.eased, self.length
        t = np.clip(np.asarray(time, dtype=float) - self.start, 0.0, length + ease)
        rising, falling = t < ease, t > length
        left = length + ease - t
        own = np.where(
            rising,
            0.5 * t * t / ease,
            np.where(falling, length - 0.5 * left * left / ease, t - 0.5 * ease),
        )
        rate = np.where(rising, t / ease, np.where(falling, left / ease, 1.0))
        moving = (t > 0.0) & (left > 0.0)
        change = np.where(moving & rising, 1.0, 0.0) - np.where(moving & falling, 1.0, 0.0)
        value, slope, bend = self.shape(own)
        return SteeringMotion(value, slope * rate, bend * rate * rate + slope * change / ease)


def ramp(
    amplitude: float, rate: float, *, start: float = 0.0, ease: float = 0.02
) -> SteeringCourse:
    """Return a steering wheel angle that rises at a rate [rad/s] to a constant value [rad]."""

    def shape(t: Array) -> tuple[Array, Array, Array]:
        slope = np.sign(amplitude) * rate * np.ones_like(t)
        return slope * t, slope, np.zeros_like(t)

    return SteeringCourse(shape, abs(amplitude) / rate, start, ease)


def sine_with_dwell(
    amplitude: float, frequency: float, dwell: float, *, start: float = 0.0, ease: float = 0.02
) -> SteeringCourse:
    """Return one period of a sine with a dwell [s] at its second peak (FMVSS 126, S7.9)."""
    omega, peak = 2.0 * np.pi * frequency, 0.75 / frequency

    def shape(t: Array) -> tuple[Array, Array, Array]:
        held = (t > peak) & (t < peak + dwell)
        phase = omega * np.where(t > peak, np.maximum(t - dwell, peak), t)
        s, c = np.sin(phase), np.where(held, 0.0, np.cos(phase))
        bend = np.where(held, 0.0, -s)
        return amplitude * s, amplitude * omega * c, amplitude * omega**2 * bend

    return SteeringCourse(shape, 1.0 / frequency + dwell, start, ease)


def sine_sweep(
    amplitude: float,
    frequencies: tuple[float, float],
    duration: float,
    *,
    start: float = 0.0,
    ease: float = 0.02,
) -> SteeringCourse:
    """Return a sine with an exponentially growing frequency, from the first to the last one [Hz].

    It ends with a complete period, and is therefore a little longer than the duration [s].
    """
    low, high = frequencies
    growth = np.log(high / low)
    periods = np.ceil(low * duration * np.expm1(growth) / growth)
    length = periods * growth / (low * np.expm1(growth))

    def shape(t: Array) -> tuple[Array, Array, Array]:
        omega = 2.0 * np.pi * low * np.exp(growth * t / length)
        phase = 2.0 * np.pi * low * length / growth * np.expm1(growth * t / length)
        s, c = np.sin(phase), np.cos(phase)
        return (
            amplitude * s,
            amplitude * omega * c,
            amplitude * (omega * growth / length * c - omega**2 * s),
        )

    return SteeringCourse(shape, float(length), start, ease)
