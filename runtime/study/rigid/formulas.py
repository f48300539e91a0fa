"""Characteristics of a rigid axle: the formulas.

Each takes a `Beam` and returns an array over its positions, SI units, chassis axes. Forces at the
wheels are vertical, through their centres, and do the same virtual work as springs, stops and bar:
with the heights z of both wheels and the coordinates q (heave, roll), ``F = -Q (dz/dq)^-1``.
Unsprung weight is left out.
"""

import numpy as np

from ...assembly.beam import SENSE, SIDES, Beam
from ...suspension.axle.axle import LEFT, RIGHT
from ...suspension.corner import Array
from ...suspension.rigid.model import HEAVE, ROLL

# -- guidance -------------------------------------------------------------------------------------


def roll_center_height(beam: Beam) -> Array:
    """Return the height of the roll centre above the line through the contacts [m].

    Of the points midway between the contacts, across the line through them as it is seen from the
    front, the one that does not move along this line when the axle rolls and the middle of the
    contacts does not move across it. A force there is along no motion of roll.
    """
    left, right = (beam.contact(side) for side in SIDES)
    middle, line = 0.5 * (left + right), (left - right)[:, 1:]
    line = line / np.linalg.norm(line, axis=-1, keepdims=True)
    across = np.stack([-line[:, 1], line[:, 0]], -1)
    roll, heave = (beam.velocity(middle, by)[:, 1:] for by in (ROLL, HEAVE))
    times = -_dot(across, roll) / _dot(across, heave)
    velocity = roll + times[:, None] * heave
    turning = beam.turning(ROLL)[:, 0] + times * beam.turning(HEAVE)[:, 0]
    height: Array = _dot(line, velocity) / turning
    return height


def jacking(beam: Beam) -> Array:
    """Return the lift of the body by a force on the tyres to the left, over that force [1].

    By virtual work the force pushes the axle up, so the body down, where the axle goes to the left
    as it rises.
    """
    middle = 0.5 * (beam.contact(LEFT) + beam.contact(RIGHT))
    velocity = beam.velocity(middle, HEAVE)
    lift: Array = -velocity[:, 1] / velocity[:, 2]
    return lift


def path(beam: Beam, torque_on: str) -> Array:
    """Return how far forward the axle goes per rise in heave, where a longitudinal force acts [1].

    That is the middle of the contacts if the axle holds the torque, the middle of the wheels if
    the body does.
    """
    places = [
        beam.wheel_center(side) if torque_on == "body" else beam.contact(side) for side in SIDES
    ]
    velocity = beam.velocity(0.5 * (places[0] + places[1]), HEAVE)
    slope: Array = velocity[:, 0] / velocity[:, 2]
    return slope


def pitching(beam: Beam, share: float, torque_on: str) -> Array:
    """Return the part of the change of load that a longitudinal force lifts by itself [1].

    ``b (L / h) v_x / v_z`` at a front axle, its negative at a rear one: share b of the force,
    wheelbase L, height h of the gravity centre.
    """
    vehicle = beam.axle.vehicle
    assert vehicle.wheelbase_mm is not None
    assert vehicle.center_of_gravity_height_mm is not None
    sense = 1.0 if beam.axle.rigid_axle == "front" else -1.0
    ratio = vehicle.wheelbase_mm / vehicle.center_of_gravity_height_mm
    return sense * share * ratio * path(beam, torque_on)


def braking(beam: Beam) -> Array:
    """Return anti-dive of a front axle, anti-lift of a rear axle, under braking [1]."""
    front = beam.axle.vehicle.front_brake_share
    assert front is not None
    share = front if beam.axle.rigid_axle == "front" else 1.0 - front
    return pitching(beam, share, beam.axle.brakes.torque_on)


def driving(beam: Beam) -> Array:
    """Return anti-lift of a front axle, anti-squat of a rear axle, under drive [1]."""
    assert beam.axle.drive is not None
    return pitching(beam, beam.axle.drive.share, beam.axle.drive.torque_on)


# -- springs --------------------------------------------------------------------------------------


def motion_ratio(beam: Beam, part: str, side: str) -> Array:
    """Return the compression of a spring or damper per travel of both wheels [1]."""
    return beam.compression(f"{side}_{part}", HEAVE)


def roll_motion_ratio(beam: Beam, part: str, side: str) -> Array:
    """Return the same per travel of the side's wheel, the other one moving oppositely [1]."""
    return SENSE[side] * beam.compression(f"{side}_{part}", ROLL) / beam.lever


def wheel_force(beam: Beam, side: str) -> Array:
    """Return the vertical force at a wheel that springs, stops and bar take [N]."""
    work = beam.of_springs[0] + beam.of_bar[0]
    return -0.5 * (work[:, 0] + SENSE[side] * work[:, 1] / beam.lever)


def stiffness(beam: Beam, work: tuple[Array, Array]) -> Array:
    """Return the derivatives of both wheels' forces by both travels, left first [N/m]."""
    forces, slopes = work
    lever, bend = beam.lever, -beam.axle.half_track * np.sin(beam.coordinate("roll"))
    signs = np.array([SENSE[side] for side in SIDES])
    # of -(Q_heave + s Q_roll / lever) / 2 by heave and roll
    by_roll = slopes[:, 1, :] / lever[:, None]
    by_roll[:, 1] -= forces[:, 1] * bend / lever**2
    by_coordinates = -0.5 * (slopes[:, None, 0, :] + signs[:, None] * by_roll[:, None, :])
    # heave is the mean of the travels; roll grows by half their difference over the lever
    heave, roll = by_coordinates[..., 0], by_coordinates[..., 1] / lever[:, None]
    return np.stack([0.5 * (heave + sign * roll) for sign in signs], -1)


def of_all(beam: Beam) -> Array:
    """Return the stiffness of springs, stops and bar at both wheels [N/m]."""
    return stiffness(beam, beam.of_springs) + stiffness(beam, beam.of_bar)


def wheel_rate(beam: Beam, side: str) -> Array:
    """Return the derivative of a wheel's force by the travel of both wheels [N/m]."""
    rates: Array = of_all(beam)[:, SIDES.index(side), :].sum(-1)
    return rates


def wheel_rate_alone(beam: Beam, side: str) -> Array:
    """Return the derivative of a wheel's force by its own travel, the other one at rest [N/m]."""
    place = SIDES.index(side)
    rates: Array = of_all(beam)[:, place, place]
    return rates


def in_roll(beam: Beam, rates: Array) -> Array:
    """Return the stiffness in roll of a stiffness of both wheels, at the contacts [N m/rad]."""
    levers = np.stack([beam.contact(side)[:, 1] for side in SIDES], -1)
    found: Array = np.einsum("ni,nij,nj->n", levers, rates, levers)
    return found


def with_tyres(beam: Beam) -> Array:
    """Return the stiffness of both wheels in series with the tyres [N/m]."""
    tyres, rates = beam.axle.tyre.rate_N_per_m * np.eye(2), of_all(beam)
    return np.asarray(tyres @ np.linalg.solve(tyres + rates, rates))


def roll_moment(beam: Beam) -> Array:
    """Return the moment that the wheels' forces make against a roll of the body [N m]."""
    moments = [beam.contact(side)[:, 1] * wheel_force(beam, side) for side in SIDES]
    return -(moments[0] + moments[1])


def roll_moment_gradient(beam: Beam) -> Array:
    """Return the derivative of this moment by the roll angle, heave held [N m/rad]."""
    senses = np.array([SENSE[side] for side in SIDES])
    changes = of_all(beam) @ senses * beam.lever[:, None]
    gradient = np.zeros_like(beam.lever)
    for place, side in enumerate(SIDES):
        moved = beam.contact_rate(side, ROLL)[:, 1]
        gradient += moved * wheel_force(beam, side) + beam.contact(side)[:, 1] * changes[:, place]
    # the body rolls by -roll
    return gradient


def _dot(one: Array, other: Array) -> Array:
    product: Array = (one * other).sum(-1)
    return product
