"""Drivers: models of steering and pedals in the simulation of a car.

A driver observes the car at equal times, the samples, and decides on steering wheel and pedals
until the next one. Drivers are therefore reproducible to the last bit, and independent of the
integration between two samples.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

import numpy as np

from .paths import Path
from .steering import SteeringCourse, SteeringMotion

# Least speed in the preview of a driver [m/s].
_SLOWEST = 0.1


class Observation(NamedTuple):
    """The motion of the car that a driver sees."""

    time: float  # [s]
    # position of the reference point [m]
    x: float
    y: float
    yaw: float  # [rad]
    # along and across the heading [m/s]
    speed: float
    lateral_velocity: float
    yaw_rate: float  # [rad/s]
    upright: float  # cosine of the tilt of the body


class Pedals(NamedTuple):
    """The action of the pedals."""

    drive: float  # torque of all driven wheels together, positive forward [N m]
    brake: float  # part of the greatest torque of the brakes, 0 to 1


class Steers(Protocol):
    """A driver's model of steering."""

    def decide(self, seen: Observation, step: float) -> SteeringMotion:
        """Return angle and rate now, and the acceleration until the next sample."""
        ...


class Pushes(Protocol):
    """A driver's model of the pedals."""

    def decide(self, seen: Observation, step: float) -> Pedals:
        """Return the action of the pedals until the next sample."""
        ...


@dataclass
class OpenLoop:
    """Steering by a course over time."""

    course: SteeringCourse
    offset: float = 0.0  # added to the angles of the course [rad]
    _next: tuple[float, SteeringMotion] | None = field(default=None, init=False)

    def decide(self, seen: Observation, step: float) -> SteeringMotion:
        """Return the motion of the course; the acceleration is its mean until the next sample."""
        known = self._next is not None and self._next[0] == seen.time
        now = self._next[1] if known and self._next is not None else self.course.at(seen.time)
        later = self.course.at(seen.time + step)
        self._next = seen.time + step, later
        mean = (float(later.rate) - float(now.rate)) / step
        return SteeringMotion(self.offset + now.angle, now.rate, mean)


@dataclass
class Fixed:
    """A held steering wheel."""

    angle: float = 0.0  # [rad]

    def decide(self, seen: Observation, step: float) -> SteeringMotion:
        """Return the constant angle."""
        return SteeringMotion(self.angle, 0.0, 0.0)


@dataclass
class PathFollower:
    """Steering along a path with preview.

    The driver anticipates the delay of arms and car: he starts from the position and direction that
    the car will have after it at its present yaw rate. From there he looks at the point of the path
    at the preview time ahead, and chooses the circle to it that is tangent to the direction of the
    car. With the point at x_p ahead and y_p to the left, its curvature is
    ``2 y_p / (x_p^2 + y_p^2)``. He knows the steering wheel angle for a curvature in steady state.
    The arms follow this angle as a critically damped filter of second order, whose acceleration is
    constant between samples: position and rate of the rack are continuous.

    Source: the pure pursuit of R. C. Coulter, Implementation of the Pure Pursuit Path Tracking
    Algorithm, CMU-RI-TR-92-01, Carnegie Mellon University, 1992; the delay is added.
    """

    path: Path
    # a function of speed: steering wheel angle by curvature in steady state [rad m]
    angle_by_curvature: Callable[[float], float]
    preview: float  # [s]
    anticipation: float  # delay of arms and car that the driver compensates [s]
    bandwidth: float  # natural frequency of the filter [Hz]
    largest: float  # limit of the steering wheel angle [rad]
    fastest: float  # limit of the rate of the steering wheel [rad/s]
    _along: float = field(default=0.0, init=False)
    _angle: float = field(default=0.0, init=False)
    _rate: float = field(default=0.0, init=False)

    def decide(self, seen: Observation, step: float) -> SteeringMotion:
        """Return angle and rate now, and the acceleration with which the arms follow."""
        angle, rate = self._angle, self._rate
        wanted = float(np.clip(self._wanted(seen), -self.largest, self.largest))
        omega = 2.0 * np.pi * self.bandwidth
        acceleration = omega * omega * (wanted - angle) - 2.0 * omega * rate
        following = float(np.clip(rate + step * acceleration, -self.fastest, self.fastest))
        acceleration = (following - rate) / step
        self._angle, self._rate = angle + step * (rate + 0.5 * step * acceleration), following
        return SteeringMotion(angle, rate, acceleration)

    @property
    def along(self) -> float:
        """Position of the car along the path at the last sample [m]."""
        return self._along

    def _wanted(self, seen: Observation) -> float:
        speed = max(math.hypot(seen.speed, seen.lateral_velocity), _SLOWEST)
        turned = seen.yaw_rate * self.anticipation
        course = seen.yaw + math.atan2(seen.lateral_velocity, seen.speed)
        # the position of the car after the delay, at its present yaw rate
        way, towards = speed * self.anticipation, course + 0.5 * turned
        here_x, here_y = seen.x + way * math.cos(towards), seen.y + way * math.sin(towards)
        self._along = self.path.nearest(here_x, here_y, self._along)
        x, y = self.path.at(self._along + speed * self.preview)
        dx, dy, course = x - here_x, y - here_y, course + turned
        left = math.cos(course) * dy - math.sin(course) * dx
        return self.angle_by_curvature(seen.speed) * 2.0 * left / (dx * dx + dy * dy)


@dataclass
class HeldTorque:
    """A torque of the drive with a ramp from one value to another."""

    before: float  # [N m]
    after: float  # [N m]
    at: float = 0.0  # start of the ramp [s]
    rise: float = 0.0  # duration of the ramp [s]

    def decide(self, seen: Observation, step: float) -> Pedals:
        """Return the torque halfway to the next sample."""
        share = _risen(seen.time + 0.5 * step - self.at, self.rise)
        return Pedals(self.before + share * (self.after - self.before), 0.0)


@dataclass
class Braking:
    """A change from drive to brakes."""

    before: float  # torque of the drive before it [N m]
    brake: float  # torque of the brakes after it, as a part of the greatest one
    at: float  # start of the change [s]
    rise: float  # duration of the change [s]

    def decide(self, seen: Observation, step: float) -> Pedals:
        """Return drive and brake halfway to the next sample."""
        share = _risen(seen.time + 0.5 * step - self.at, self.rise)
        return Pedals((1.0 - share) * self.before, share * self.brake)


@dataclass
class SpeedHeld:
    """A constant speed by a proportional and integral control of the drive, which may brake."""

    speed: float  # [m/s]
    torque: float  # torque at the beginning, that of straight running [N m]
    gain: float  # torque by difference of speed [N m s/m]
    reset: float  # time constant of the integral part [s]
    _lost: float = field(default=0.0, init=False)

    def decide(self, seen: Observation, step: float) -> Pedals:
        """Return the torque of the drive."""
        missing = self.speed - seen.speed
        self._lost += missing * step
        return Pedals(self.torque + self.gain * (missing + self._lost / self.reset), 0.0)


def _risen(time: float, rise: float) -> float:
    """Return the done part of a ramp."""
    if rise <= 0.0:
        return 1.0 if time > 0.0 else 0.0
    return min(max(time / rise, 0.0), 1.0)
