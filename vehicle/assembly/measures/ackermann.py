"""Formulas of the characteristics of both wheels of a steered axle.

Steer angles are positive to the left [rad], as arrays over the positions of the rack. They are
relative to those with the rack in its middle position: static toe is left out.

Source: J. C. Dixon, Suspension Geometry and Computation, Wiley, 2009 (steering).
"""

import numpy as np

from ....core.named_types import Array
from ..two_wheels import SteerableWheels
from ..wheel import steer_gradient

# A smaller mean steer angle is straight ahead [rad].
_STRAIGHT = 1e-9
# The difference of both angles grows with their square, and is rounded by 1e-15 rad: at smaller
# angles the quotient of two differences has less than six digits [rad].
_STEERED = 1e-4


def error_of(of: SteerableWheels) -> Array:
    """Return the Ackermann error of two wheels [rad]; see `ackermann_error`."""
    left, right = of.turned
    return ackermann_error(left, right, of.wheelbase, of.design_track)


def percentage_of(of: SteerableWheels) -> Array:
    """Return the Ackermann percentage of two wheels [1]; see `ackermann`."""
    left, right = of.turned
    return ackermann(left, right, of.wheelbase, of.design_track)


def circle_of(of: SteerableWheels) -> Array:
    """Return the turning circle of two wheels [m]; see `turning_circle`."""
    left, right = of.turned
    return turning_circle(left, right, of.wheelbase)


def ratio_of(of: SteerableWheels) -> Array:
    """Return the steering ratio of two wheels [1]; see `steering_ratio`."""
    assert of.per_turn is not None
    gradients = steer_gradient(of.left), steer_gradient(of.right)
    return steering_ratio(*gradients, np.abs(of.per_turn))


def ackermann_error(left: Array, right: Array, wheelbase: float, track: float | Array) -> Array:
    """Return the outer steer angle less that for rolling without slip [rad].

    With angles positive towards the inside of the turn, the latter is ``atan(L / (L / tan inner +
    t))``, with the wheelbase L and the track t [m]. The error is zero for Ackermann steering, and
    positive towards parallel steering.
    """
    inner, outer = _inner_and_outer(left, right)
    return outer - _ideal_outer(inner, wheelbase, track)


def ackermann(left: Array, right: Array, wheelbase: float, track: float | Array) -> Array:
    """Return the Ackermann percentage as a fraction [1].

    It is the difference of the two steer angles over that for rolling without slip: one for wheels
    without slip, zero for parallel ones. NaN straight ahead, and with wheels steered to different
    sides.
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

    Gradients are derivatives of the steer angles with respect to rack travel [rad/m];
    `travel_per_turn` is the rack travel for one turn of the steering wheel [m]. The ratio has no
    sign, and is infinite if the rack does not steer.
    """
    mean = 0.5 * (left_gradient + right_gradient)
    with np.errstate(divide="ignore"):
        return 2.0 * np.pi / travel_per_turn / np.abs(mean)


def _inner_and_outer(left: Array, right: Array) -> tuple[Array, Array]:
    """Return the two angles, positive towards the inside of the turn."""
    to_left = left + right > 0.0
    return np.where(to_left, left, -right), np.where(to_left, right, -left)


def _ideal_outer(inner: Array, wheelbase: float, track: float | Array) -> Array:
    # atan(L / (L / tan d + t)) without its pole straight ahead
    across, along = np.sin(inner), np.cos(inner)
    return np.arctan2(wheelbase * across, wheelbase * along + track * across)
