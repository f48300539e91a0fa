"""Characteristics of the two wheels of a steered axle: the formulas.

Steer angles are positive to the left [rad], as arrays over the positions of the rack. What
compares both wheels takes them from those with the rack in its middle: without static toe, which
steers no car.
"""

from typing import Protocol

import numpy as np

from ...corner.corner import Array, Corner
from ..wheel import steer_gradient

# Wheels that are steered less than this roll straight ahead [rad].
_STRAIGHT = 1e-9
# Differences of both angles grow with the square of them, and are rounded by 1e-15 rad: of wheels
# that are steered less than this the quotient of two differences has not six digits [rad].
_STEERED = 1e-4


class Steered(Protocol):
    """Two wheels on one rack: an `AxleKinematics`, or a `MirroredCorner` with its mirror image."""

    @property
    def left(self) -> Corner:
        """The left wheel."""

    @property
    def right(self) -> Corner:
        """The right wheel."""

    @property
    def turned(self) -> tuple[Array, Array]:
        """Steer angles of the left and the right wheel without static toe [rad]."""

    @property
    def wheelbase(self) -> float:
        """The wheelbase [m]."""

    @property
    def design_track(self) -> float | Array:
        """The distance of the wheel centres at design [m]."""

    @property
    def per_turn(self) -> float | Array | None:
        """Rack travel for one turn of the steering wheel [m]; None where nothing says it."""


def error_of(of: Steered) -> Array:
    """Return the Ackermann error of two wheels [rad]; see `ackermann_error`."""
    return ackermann_error(*of.turned, of.wheelbase, of.design_track)


def part_of(of: Steered) -> Array:
    """Return the Ackermann percentage of two wheels [1]; see `ackermann`."""
    return ackermann(*of.turned, of.wheelbase, of.design_track)


def circle_of(of: Steered) -> Array:
    """Return the turning circle of two wheels [m]; see `turning_circle`."""
    return turning_circle(*of.turned, of.wheelbase)


def ratio_of(of: Steered) -> Array:
    """Return the steering ratio of two wheels [1]; see `steering_ratio`."""
    assert of.per_turn is not None
    gradients = steer_gradient(of.left), steer_gradient(of.right)
    return steering_ratio(*gradients, np.abs(of.per_turn))


def ackermann_error(left: Array, right: Array, wheelbase: float, track: float | Array) -> Array:
    """Return how much more the outer wheel is steered than for rolling without slip [rad].

    With the angles counted towards the inside of the turn, the outer wheel would have to be at
    ``atan(L / (L / tan inner + t))``.

    Parameters
    ----------
    left, right : ndarray
        Steer angles [rad].
    wheelbase : float
        L [m].
    track : float or ndarray
        t [m].

    Returns
    -------
    ndarray
        [rad]; zero for Ackermann steering, positive towards parallel steering.
    """
    inner, outer = _inner_and_outer(left, right)
    return outer - _ideal_outer(inner, wheelbase, track)


def ackermann(left: Array, right: Array, wheelbase: float, track: float | Array) -> Array:
    """Return the Ackermann percentage as a part of one [1].

    One for wheels that roll without slip, zero for parallel ones: the difference of the two steer
    angles over what it has to be. Not defined (NaN) straight ahead, and where the wheels are
    steered to different sides.
    """
    inner, outer = _inner_and_outer(left, right)
    wanted = inner - _ideal_outer(inner, wheelbase, track)
    with np.errstate(divide="ignore", invalid="ignore"):
        part = (inner - outer) / wanted
    turning = (inner + outer > 2.0 * _STEERED) & (inner >= 0.0) & (outer >= 0.0)
    return np.where(turning, part, np.nan)


def turning_circle(left: Array, right: Array, wheelbase: float) -> Array:
    """Return the diameter of the circle of the outer front wheel's centre [m].

    The tyre's width and the body's overhang come in addition. Infinite straight ahead.
    """
    _, outer = _inner_and_outer(left, right)
    with np.errstate(divide="ignore"):
        diameter = 2.0 * wheelbase / np.abs(np.sin(outer))
    return np.where(np.abs(left + right) > 2.0 * _STRAIGHT, diameter, np.inf)


def steering_ratio(
    left_gradient: Array, right_gradient: Array, travel_per_turn: float | Array
) -> Array:
    """Return the derivative of the steering wheel's angle with respect to the mean steer angle [1].

    Parameters
    ----------
    left_gradient, right_gradient : ndarray
        Derivatives of the steer angles by rack travel [rad/m].
    travel_per_turn : float or ndarray
        Rack travel for one turn of the steering wheel [m].

    Returns
    -------
    ndarray
        Without sign; infinite where the rack does not steer.
    """
    mean = 0.5 * (left_gradient + right_gradient)
    with np.errstate(divide="ignore"):
        return 2.0 * np.pi / travel_per_turn / np.abs(mean)


def _inner_and_outer(left: Array, right: Array) -> tuple[Array, Array]:
    """Return the two angles, counted towards the inside of the turn."""
    to_left = left + right > 0.0
    return np.where(to_left, left, -right), np.where(to_left, right, -left)


def _ideal_outer(inner: Array, wheelbase: float, track: float | Array) -> Array:
    # atan(L / (L / tan d + t)) without its pole straight ahead
    across, along = np.sin(inner), np.cos(inner)
    outer: Array = np.arctan2(wheelbase * across, wheelbase * along + track * across)
    return outer
