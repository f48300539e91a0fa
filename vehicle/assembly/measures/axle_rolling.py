"""Formulas of roll centre, jacking and anti-roll bar of an axle of two corners.

Each takes an `AxleKinematics` and returns an array over its positions, SI units, chassis axes.

Sources: J. C. Dixon, Suspension Geometry and Computation, Wiley, 2009 (roll centres); W. F.
Milliken and D. L. Milliken, Race Car Vehicle Dynamics, SAE, 1995, chapter 17.
"""

import numpy as np

from ....core.named_types import Array
from ...corner.corner import Corner
from ...models.sides import LEFT, RIGHT, SENSE
from .. import wheel
from ..axle_kinematics import AxleKinematics


def track_change(pair: AxleKinematics) -> Array:
    """Return the change of the contacts' distance from design [m]."""
    return wheel.half_track_change(pair.corners[LEFT]) + wheel.half_track_change(
        pair.corners[RIGHT]
    )


def roll_angle(pair: AxleKinematics) -> Array:
    """Return the angle of the body to the line through the contacts, right side down [rad]."""
    left, right = _contacts(pair)
    across = left - right
    return -np.arctan2(across[..., 2], across[..., 1])


def inclination(pair: AxleKinematics, side: str) -> Array:
    """Return the camber to the line through the contacts [rad], positive top outboard."""
    return wheel.camber(pair.corners[side]) - SENSE[side] * roll_angle(pair)


def roll_center(pair: AxleKinematics) -> tuple[Array, Array]:
    """Return the intersection of the normals to the contacts' paths, in front view.

    It is measured from the middle between the contacts, along the line through them to the left,
    and perpendicular to it upward [m]; infinite if the normals are parallel.
    """
    left, right = _contacts(pair)
    (a, b, c), (d, e, f) = (
        _normal(pair.corners[side], at) for side, at in ((LEFT, left), (RIGHT, right))
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        y, z = (c * e - b * f) / (a * e - b * d), (a * f - c * d) / (a * e - b * d)
    middle, tilt = 0.5 * (left + right), -roll_angle(pair)
    y, z = y - middle[..., 1], z - middle[..., 2]
    return np.cos(tilt) * y + np.sin(tilt) * z, np.cos(tilt) * z - np.sin(tilt) * y


def jacking(pair: AxleKinematics, side: str) -> Array:
    """Return the lift of the body by an inboard force at the contact, over that force [1]."""
    corner = pair.corners[side]
    velocity = wheel.contact_velocity(corner)
    with np.errstate(divide="ignore", invalid="ignore"):
        return corner.vehicle.side * velocity[..., 1] / velocity[..., 2]


def _normal(corner: Corner, at: Array) -> tuple[Array, Array, Array]:
    """Return a, b, c of the line a y + b z = c across the path of the contact."""
    velocity = wheel.contact_velocity(corner)
    a, b = velocity[..., 1], velocity[..., 2]
    return a, b, a * at[..., 1] + b * at[..., 2]


def link_force(pair: AxleKinematics, side: str) -> Array:
    """Return the tension of the drop link [N]."""
    # the torque turns the half back; the link pulls its top towards the foot
    return SENSE[side] * pair.torque / -pair.halves[side].lever


def by_roll(pair: AxleKinematics, side: str, by_travel: Array) -> Array:
    """Return the derivative with respect to roll of a quantity from that to wheel travel."""
    return -pair.contact(side)[..., 1] * by_travel


def _contacts(pair: AxleKinematics) -> tuple[Array, Array]:
    return pair.contact(LEFT), pair.contact(RIGHT)
