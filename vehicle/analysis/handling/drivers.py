"""Drivers: what turns the steering wheel and works the pedals while a car is simulated.

A driver sees the car at equal times, the samples, and decides what the steering wheel and the
pedals do until the next one. Drivers are therefore reproducible to the last bit, and independent of
how the equations are integrated between two samples.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

import numpy as np

from .paths import Path
from .steering import SteeringCourse, SteeringMotion

# The gradient of speed by distance is that of the last sample; this keeps a driver from dividing
# by a speed of zero [m/s].
_SLOWEST = 0.1


class Observation(NamedTuple):
    """The motion of the car that a driver sees.

    Attributes
    ----------
    time : float
        [s]
    x, y : float
        Place of the reference point [m].
    yaw : float
        [rad]
    speed, lateral_velocity : float
        Along and across the heading [m/s].
    yaw_rate : float
        [rad/s]
    upright : float
        Cosine of the tilt of the body.
    """

    time: float
    x: float
    y: float
    yaw: float
    speed: float
    lateral_velocity: float
    yaw_rate: float
    upright: float


class Pedals(NamedTuple):
    """What the pedals ask for.

    Attributes
    ----------
    drive : float
        Torque of all driven wheels together, positive forward [N m].
    brake : float
        Part of the greatest torque of the brakes, 0 to 1.
    """

    drive: float
    brake: float


class Steers(Protocol):
    """What turns the steering wheel."""

    def decide(self, seen: Observation, step: float) -> SteeringMotion:
        """Return angle and rate now, and the acceleration until the next sample."""
        ...


class Pushes(Protocol):
    """What works the pedals."""

    def decide(self, seen: Observation, step: float) -> Pedals:
        """Return what the pedals ask for until the next sample."""
        ...


# -- steering -------------------------------------------------------------------------------------


@dataclass
class OpenLoop:
    """Turns the steering wheel as a course over time says.

    Parameters
    ----------
    course : SteeringCourse
    offset : float, optional
        Angle to which those of the course are added [rad].
    """

    course: SteeringCourse
    offset: float = 0.0
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
    """Holds the steering wheel.

    Parameters
    ----------
    angle : float, optional
        [rad]
    """

    angle: float = 0.0

    def decide(self, seen: Observation, step: float) -> SteeringMotion:
        """Return the angle at which it is held."""
        del seen, step
        return SteeringMotion(self.angle, 0.0, 0.0)


@dataclass
class PathFollower:
    """Steers along a path with preview.

    The driver knows that arms and car answer late, and begins with the place and the direction that
    the car will have then, if its course turns on by the yaw rate. From there he looks at the point
    of the path that is the preview time ahead, and asks for the circle that leads there, along the
    direction of the car. With the point at x_p ahead and y_p to the left, its curvature is
    ``2 y_p / (x_p^2 + y_p^2)``. The angle that a car needs for a curvature in steady state is known
    to the driver. The arms follow the wanted angle as a filter of second order, critically damped,
    whose acceleration is constant between samples: the rack's position and rate are continuous.

    Parameters
    ----------
    path : Path
    angle_by_curvature : callable
        Steering wheel angle by curvature, in steady state, over speed [rad m].
    preview : float
        [s]
    anticipation : float
        Delay of arms and car that the driver makes up for [s].
    bandwidth : float
        Natural frequency of the filter [Hz].
    largest : float
        Steering wheel angle that is not exceeded [rad].
    fastest : float
        Rate of the steering wheel that is not exceeded [rad/s].
    """

    path: Path
    angle_by_curvature: Callable[[float], float]
    preview: float
    anticipation: float
    bandwidth: float
    largest: float
    fastest: float
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
        """How far along the path the car was at the last sample [m]."""
        return self._along

    def _wanted(self, seen: Observation) -> float:
        speed = max(math.hypot(seen.speed, seen.lateral_velocity), _SLOWEST)
        turned = seen.yaw_rate * self.anticipation
        course = seen.yaw + math.atan2(seen.lateral_velocity, seen.speed)
        # where the car is when it does what is decided now, if it turns on as it does
        way, towards = speed * self.anticipation, course + 0.5 * turned
        here_x, here_y = seen.x + way * math.cos(towards), seen.y + way * math.sin(towards)
        self._along = self.path.nearest(here_x, here_y, self._along)
        x, y = self.path.at(self._along + speed * self.preview)
        dx, dy, course = x - here_x, y - here_y, course + turned
        left = math.cos(course) * dy - math.sin(course) * dx
        return self.angle_by_curvature(seen.speed) * 2.0 * left / (dx * dx + dy * dy)


# -- pedals ---------------------------------------------------------------------------------------


@dataclass
class HeldTorque:
    """Holds the torque of the drive from a time on.

    Parameters
    ----------
    before, after : float
        [N m]
    at : float
        When it begins to change [s].
    rise : float
        How long it takes to change, evenly [s].
    """

    before: float
    after: float
    at: float = 0.0
    rise: float = 0.0

    def decide(self, seen: Observation, step: float) -> Pedals:
        """Return the torque in the middle of the time until the next sample."""
        share = _risen(seen.time + 0.5 * step - self.at, self.rise)
        return Pedals(self.before + share * (self.after - self.before), 0.0)


@dataclass
class Braking:
    """Lets the drive go and pushes the brake.

    Parameters
    ----------
    before : float
        Torque of the drive until then [N m].
    brake : float
        Part of the greatest torque of the brakes.
    at : float
        When it begins [s].
    rise : float
        How long it takes, evenly [s].
    """

    before: float
    brake: float
    at: float
    rise: float

    def decide(self, seen: Observation, step: float) -> Pedals:
        """Return drive and brake in the middle of the time until the next sample."""
        share = _risen(seen.time + 0.5 * step - self.at, self.rise)
        return Pedals((1.0 - share) * self.before, share * self.brake)


@dataclass
class SpeedHeld:
    """Holds a speed by the torque of the drive, which may brake, too.

    A proportional and integral controller, with the torque of straight running to begin with.

    Parameters
    ----------
    speed : float
        [m/s]
    torque : float
        At the beginning [N m].
    gain : float
        Torque by speed [N m s/m].
    reset : float
        Time of the integral part [s].
    """

    speed: float
    torque: float
    gain: float
    reset: float
    _lost: float = field(default=0.0, init=False)

    def decide(self, seen: Observation, step: float) -> Pedals:
        """Return the torque of the drive."""
        missing = self.speed - seen.speed
        self._lost += missing * step
        return Pedals(self.torque + self.gain * (missing + self._lost / self.reset), 0.0)


def _risen(time: float, rise: float) -> float:
    """Return which part of an even change is done."""
    if rise <= 0.0:
        return 1.0 if time > 0.0 else 0.0
    return min(max(time / rise, 0.0), 1.0)
