"""Roll centre, roll stiffness and jacking of an axle: the formulas.

Each takes a `Pair` and returns an array over its positions, SI units, chassis axes. Forces of the
road are vertical and act on the wheels; unsprung weights are left out. The stiffness of both wheels
is a matrix K of two rows, the left wheel first: the derivative of the wheels' forces by their
travels. A roll of the body by phi (positive about the x axis: right side down) moves the wheels by
-y phi, with y where each stands, so that the stiffness in roll is y' K y.
"""

import numpy as np

from ...assembly import wheel
from ...assembly.line import inclination_rate
from ...assembly.pair import Pair
from ...suspension.axle.axle import LEFT, RIGHT
from ...suspension.corner import Array, Corner

_SENSE = {LEFT: 1.0, RIGHT: -1.0}
"""In which direction each side's angle twists the bar."""


# -- where the wheels stand -----------------------------------------------------------------------


def track(pair: Pair) -> Array:
    """Return the lateral distance of the contacts [m]."""
    left, right = _contacts(pair)
    return np.asarray(left[..., 1] - right[..., 1])


def track_change(pair: Pair) -> Array:
    """Return how much farther apart the contacts are than at design [m]."""
    return wheel.half_track_change(pair.corners[LEFT]) + wheel.half_track_change(
        pair.corners[RIGHT]
    )


def roll_angle(pair: Pair) -> Array:
    """Return the angle of the body to the line through the contacts, right side down [rad]."""
    left, right = _contacts(pair)
    across = left - right
    return -np.arctan2(across[..., 2], across[..., 1])


def inclination(pair: Pair, side: str) -> Array:
    """Return the camber to the line through the contacts [rad], positive top outboard."""
    return wheel.camber(pair.corners[side]) - _SENSE[side] * roll_angle(pair)


# -- roll centre ----------------------------------------------------------------------------------


def roll_center(pair: Pair) -> tuple[Array, Array]:
    """Return where the normals to the contacts' paths meet, seen from the front.

    Returns
    -------
    lateral, height : ndarray
        From the middle between the contacts, along the line through them to the left, and across it
        upward [m]; infinite where the normals are parallel.
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


def jacking(pair: Pair, side: str) -> Array:
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


# -- forces and rates -----------------------------------------------------------------------------


def wheel_force(pair: Pair, side: str) -> Array:
    """Return the vertical force that spring, stops and bar take at the wheel [N]."""
    force = wheel.wheel_force(pair.corners[side])
    if side in pair.halves:
        force = force + _SENSE[side] * pair.torque * pair.halves[side].slope
    return force


def link_force(pair: Pair, side: str) -> Array:
    """Return the tension of the drop link [N]."""
    # the bar turns the half back by the torque; the link pulls its top towards the foot
    return _SENSE[side] * pair.torque / -pair.halves[side].lever


def springs(pair: Pair) -> Array:
    """Return the stiffness of springs and stops at both wheels, (..., 2, 2) [N/m]."""
    return _diagonal(*(wheel.wheel_rate(pair.corners[side]) for side in (LEFT, RIGHT)))


def bar(pair: Pair) -> Array:
    """Return the stiffness of the anti-roll bar at both wheels, (..., 2, 2) [N/m]."""
    given = pair.axle.bar
    if given is None:
        return np.zeros((*pair.twist.shape, 2, 2))
    slopes = np.stack([_SENSE[side] * pair.halves[side].slope for side in (LEFT, RIGHT)], -1)
    bent = (_SENSE[side] * pair.torque * pair.halves[side].curvature for side in (LEFT, RIGHT))
    stiffness: Array = given.rate() * slopes[..., :, None] * slopes[..., None, :]
    return stiffness + _diagonal(*bent)


def with_tyres(pair: Pair, stiffness: Array) -> Array:
    """Return a stiffness of both wheels in series with the tyres [N/m]."""
    tyres = _diagonal(
        *(
            np.full_like(pair.twist, pair.corners[side].vehicle.tyre_rate or 0.0)
            for side in (LEFT, RIGHT)
        )
    )
    return np.asarray(tyres @ np.linalg.solve(tyres + stiffness, stiffness))


def in_roll(pair: Pair, stiffness: Array) -> Array:
    """Return the stiffness in roll of one of both wheels [N m/rad]."""
    levers = np.stack([at[..., 1] for at in _contacts(pair)], -1)
    by_roll: Array = np.einsum("...i,...ij,...j->...", levers, stiffness, levers)
    return by_roll


def bar_share(pair: Pair) -> Array:
    """Return the part of the anti-roll bar in the stiffness in roll [1]."""
    of_bar = in_roll(pair, bar(pair))
    with np.errstate(divide="ignore", invalid="ignore"):
        share: Array = of_bar / (of_bar + in_roll(pair, springs(pair)))
    return share


def moment(pair: Pair) -> Array:
    """Return the moment that the wheels' forces make against a roll of the body [N m]."""
    left, right = _contacts(pair)
    levers = {LEFT: left[..., 1], RIGHT: right[..., 1]}
    return -sum((levers[s] * wheel_force(pair, s) for s in levers), np.zeros_like(pair.twist))


def moment_gradient(pair: Pair) -> Array:
    """Return the derivative of the moment by the roll angle, wheels moving oppositely [N m/rad].

    By the product rule: forces change, and so do their levers.
    """
    left, right = (pair.corners[side] for side in (LEFT, RIGHT))
    line = left.center - right.center
    # of the roll angle by travel of the right wheel up and the left one down
    by_travel = inclination_rate(line, left.travel.velocity + right.travel.velocity)
    travels = np.stack([-np.ones_like(by_travel), np.ones_like(by_travel)], -1) / by_travel[:, None]
    levers = np.stack([at[..., 1] for at in _contacts(pair)], -1)
    moved = np.stack([wheel.contact_rate(one)[..., 1] for one in (left, right)], -1) * travels
    forces = np.stack([wheel_force(pair, side) for side in (LEFT, RIGHT)], -1)
    changes = np.einsum("...ij,...j->...i", springs(pair) + bar(pair), travels)
    gradient: Array = -(moved * forces + levers * changes).sum(-1)
    return gradient


def by_roll(pair: Pair, side: str, by_travel: Array) -> Array:
    """Return what changes by wheel travel as a change by roll, both wheels moving as in roll."""
    left, right = _contacts(pair)
    return -{LEFT: left, RIGHT: right}[side][..., 1] * by_travel


def _contacts(pair: Pair) -> tuple[Array, Array]:
    return wheel.contact(pair.corners[LEFT]), wheel.contact(pair.corners[RIGHT])


def _diagonal(left: Array, right: Array) -> Array:
    nothing = np.zeros_like(left)
    return np.stack([np.stack([left, nothing], -1), np.stack([nothing, right], -1)], -2)
