"""Formulas of anti-dive, anti-lift and anti-squat.

They are the part of the load transfer by a longitudinal acceleration, m a h / L, that the path of a
wheel, or of a rigid axle, carries without the springs. A force F along the road at a point with
velocity (v_x, v_z) lifts the body by F v_x / v_z. The point is the contact, fixed to the carrier,
if the carrier reacts the torque; it is the wheel centre if a shaft leads the torque to the body.

Sources: W. F. Milliken and D. L. Milliken, Race Car Vehicle Dynamics, SAE, 1995, chapter 17; J. C.
Dixon, Suspension Geometry and Computation, Wiley, 2009 (pitch geometry).
"""

from ....core.named_types import Array
from ..two_wheels import TwoWheels


def braking(of: TwoWheels, side: str = "") -> Array:
    """Return anti-dive of a front axle, anti-lift of a rear axle, under braking [1].

    `side` is the wheel of an `AxleKinematics`.
    """
    front = of.vehicles[0].front_brake_share
    assert front is not None
    share = front if of.end == "front" else 1.0 - front
    return share * _path(of, side, of.axle.brakes.torque_on)


def driving(of: TwoWheels, side: str = "") -> Array:
    """Return anti-lift of a front axle, anti-squat of a rear axle, under drive [1]."""
    assert of.axle.drive is not None
    return of.axle.drive.share * _path(of, side, of.axle.drive.torque_on)


def _path(of: TwoWheels, side: str, torque_on: str) -> Array:
    """Return (L / h) v_x / v_z, positive if the axle's load falls as the force grows."""
    vehicle = of.vehicles[0]
    assert vehicle.wheelbase is not None
    assert vehicle.center_of_gravity_height is not None
    sense = 1.0 if of.end == "front" else -1.0
    ratio = vehicle.wheelbase / vehicle.center_of_gravity_height
    return sense * ratio * of.path_slope(torque_on, side)
