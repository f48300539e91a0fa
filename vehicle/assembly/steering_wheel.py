"""The ratio of steering wheel and rack, and its sign."""

import numpy as np

from ...core.errors import InputError
from ...core.named_types import Array
from ..models.axle import Axle
from . import motions
from .axle_kinematics import AxleKinematics
from .wheel import steer_gradient


def rack_of(axle: Axle, angles: Array, sense: float | None = None) -> tuple[Array, Array]:
    """Return rack displacements at angles, and the signed rack travel per turn there [m].

    `angles` of the steering wheel are positive to the left [rad]; `sense` is the result of
    `sense_of_rack`, if known already.
    """
    sense = sense_of_rack(axle) if sense is None else sense
    if axle.steering is not None:
        rises = axle.steering.rack_mm[-1] > axle.steering.rack_mm[0]
        if (1.0 if rises else -1.0) * sense < 0.0:
            problem = (
                f"[steering] rack_mm {'rises' if rises else 'falls'} with the angle, and that "
                "steers to the right: angles of the steering wheel are positive to the left. "
                "Change the sign of angle_deg or of rack_mm."
            )
            raise InputError([problem], "axle")
        return axle.steering.rack(angles), axle.steering.travel_per_turn(angles)
    amount = motions.travel_per_turn(axle)
    assert amount is not None
    # files have it without sign: a steering wheel turned to the left steers to the left
    per_turn = amount * sense
    return angles * per_turn / (2.0 * np.pi), np.full_like(angles, per_turn)


def per_turn_at(axle: Axle, racks: Array) -> Array | None:
    """Return the signed rack travel per turn of the steering wheel at rack displacements [m].

    None if no file has it, and NaN beyond the points of a curve.
    """
    if axle.steering is not None:
        return axle.steering.travel_per_turn_at(racks)
    amount = motions.travel_per_turn(axle)
    return None if amount is None else np.full_like(racks, amount * sense_of_rack(axle))


def sense_of_rack(axle: Axle) -> float:
    """Return +1 if a positive displacement of the rack steers to the left, else -1."""
    design = AxleKinematics.at(axle, 0.0, 0.0, 0.0)
    return float(np.sign(sum(steer_gradient(corner) for corner in design.corners.values())))


def rack_motion(
    axle: Axle, angle: Array, rate: Array, acceleration: Array, sense: float | None = None
) -> tuple[Array, Array, Array]:
    """Return displacement, velocity and acceleration of the rack [m, m/s, m/s^2].

    Those of the steering wheel are positive to the left [rad, rad/s, rad/s^2]; `sense` is the
    result of `sense_of_rack`, if known already.
    """
    position, per_turn = rack_of(axle, angle, sense)
    slope = per_turn / (2.0 * np.pi)
    bend = np.zeros_like(slope) if axle.steering is None else axle.steering.bend(angle)
    return position, slope * rate, slope * acceleration + bend * rate * rate
