"""Anti-dive, anti-lift and anti-squat of an axle: the formulas, for one wheel.

Of the change of load by a longitudinal acceleration, m a h / L, they say which part the wheel's
path takes up without the springs. A force F along the road at a wheel whose point moves by
(v_x, v_z) lifts the body by F v_x / v_z. The point is the contact, fixed to the carrier, where the
torque is held there; the wheel centre, where a shaft leads it to the body.
"""

from collections.abc import Callable

import numpy as np

from ...assembly import wheel
from ...assembly.pair import Pair
from ...suspension.corner import Array

Formula = Callable[[Pair, str], Array]


def braking(pair: Pair, side: str) -> Array:
    """Return anti-dive of a front axle, anti-lift of a rear axle, under braking [1]."""
    front = pair.corners[side].vehicle.front_brake_share
    assert front is not None
    share = front if pair.axle.end == "front" else 1.0 - front
    return share * _path(pair, side, pair.axle.brakes.torque_on)


def driving(pair: Pair, side: str) -> Array:
    """Return anti-lift of a front axle, anti-squat of a rear axle, under drive [1]."""
    assert pair.axle.drive is not None
    return pair.axle.drive.share * _path(pair, side, pair.axle.drive.torque_on)


def _path(pair: Pair, side: str, torque_on: str) -> Array:
    """Return (L / h) v_x / v_z, positive where the axle's load falls as the force grows."""
    corner = pair.corners[side]
    vehicle = corner.vehicle
    assert vehicle.wheelbase is not None
    assert vehicle.center_of_gravity_height is not None
    velocity = corner.travel.velocity if torque_on == "body" else wheel.contact_velocity(corner)
    sense = 1.0 if pair.axle.end == "front" else -1.0
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = velocity[..., 0] / velocity[..., 2]
    part: Array = sense * vehicle.wheelbase / vehicle.center_of_gravity_height * slope
    return part
