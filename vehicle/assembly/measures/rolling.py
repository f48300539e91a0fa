"""Formulas of track, ride rate, roll moment and roll stiffness of two wheels.

Each takes the kinematics of both wheels and returns an array over its positions, SI units, chassis
axes. Forces of the road are vertical and act on the wheels; unsprung weights are left out. The
stiffness of both wheels is a 2 x 2 matrix K, the left wheel first: the derivative of the wheels'
forces with respect to their travels. A roll of the body by phi (positive about the x axis: right
side down) moves the wheels by -y phi, with y the lateral position of each contact, so that the
stiffness in roll is y' K y.

Source: W. F. Milliken and D. L. Milliken, Race Car Vehicle Dynamics, SAE, 1995, chapter 16, for any
stiffness of the two wheels together.
"""

import numpy as np

from ....core.named_types import Array
from ...models.sides import LEFT, RIGHT, SIDES
from ..two_wheels import TwoWheels


def track(of: TwoWheels) -> Array:
    """Return the lateral distance of the contacts [m]."""
    return np.asarray(of.contact(LEFT)[..., 1] - of.contact(RIGHT)[..., 1])


def moment(of: TwoWheels) -> Array:
    """Return the moment of the wheels' forces against a roll of the body [N m]."""
    levers, forces = _levers(of), _forces(of)
    return -(levers * forces).sum(-1)


def moment_gradient(of: TwoWheels) -> Array:
    """Return the derivative of the moment with respect to opposite travel as a roll [N m/rad].

    By the product rule: both the forces and their levers change.
    """
    travels, moved = of.rolled
    changes = np.einsum("...ij,...j->...i", of.springs + of.bar, travels)
    return -(moved * _forces(of) + _levers(of) * changes).sum(-1)


def stiffness(of: TwoWheels) -> Array:
    """Return the roll stiffness, without tyres [N m/rad]."""
    return in_roll(of, of.springs + of.bar)


def of_springs(of: TwoWheels) -> Array:
    """Return the part of springs and stops in the roll stiffness [N m/rad]."""
    return in_roll(of, of.springs)


def of_bar(of: TwoWheels) -> Array:
    """Return the part of the anti-roll bar in the roll stiffness [N m/rad]."""
    return in_roll(of, of.bar)


def bar_share(of: TwoWheels) -> Array:
    """Return the part of the anti-roll bar in the roll stiffness [1]."""
    bar = of_bar(of)
    with np.errstate(divide="ignore", invalid="ignore"):
        share: Array = bar / (bar + of_springs(of))
    return share


def has_tyres(of: TwoWheels) -> bool:
    """Return whether the tyres of both wheels have a vertical rate."""
    return all((vehicle.tyre_rate or 0.0) > 0.0 for vehicle in of.vehicles)


def with_tyres(of: TwoWheels) -> Array:
    """Return the roll stiffness in series with the tyres [N m/rad]."""
    return in_roll(of, _on_tyres(of))


def ride_rate(of: TwoWheels, side: str) -> Array:
    """Return the derivative of a wheel's force with respect to the lift of both contacts [N/m].

    The contacts rise together, and the wheels as far as their tyres let them: where the sides
    differ, not by the same.
    """
    return np.asarray(_on_tyres(of)[..., SIDES.index(side), :].sum(-1))


def _on_tyres(of: TwoWheels) -> Array:
    """Return the stiffness of both wheels in series with their tyres, T (T + K)^-1 K."""
    rates = of.springs + of.bar
    tyres = np.diag([vehicle.tyre_rate or 0.0 for vehicle in of.vehicles])
    return np.asarray(tyres @ np.linalg.solve(tyres + rates, rates))


def in_roll(of: TwoWheels, rates: Array) -> Array:
    """Return the roll stiffness y' K y for a stiffness K of both wheels [N m/rad]."""
    levers = _levers(of)
    return np.einsum("...i,...ij,...j->...", levers, rates, levers)


def _levers(of: TwoWheels) -> Array:
    return np.stack([of.contact(side)[..., 1] for side in SIDES], -1)


def _forces(of: TwoWheels) -> Array:
    return np.stack([of.wheel_force(side) for side in SIDES], -1)
