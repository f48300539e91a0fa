"""Attitudes and rotations of bodies along a way, by which two neighbours on it are on one branch.

Loops that are solved by iteration are followed straight from the design position to each position
that is asked for (`equations.following`). Two neighbours on another way, as those of an arm that
swings with the rack displaced, are reached by two straight ways of their own, and these may pass
on either side of a point at which two branches meet. So each is on a branch to which a way leads,
and they may be on different ones. Closed forms choose their branch by signs, and are not asked.
"""

from types import ModuleType
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...systems.system import System

Array = NDArray[np.float64]


class Attitudes(NamedTuple):
    """Rotation matrices of the bodies at some places, and how they change along a coordinate.

    Attributes
    ----------
    turned : ndarray, shape (..., places, elements)
        Elements of all matrices, from design; none of equations in closed form.
    rate : ndarray, shape (..., places, elements)
        Derivatives along the coordinate.
    """

    turned: Array
    rate: Array


def attitudes(
    model: System, states: Array, inputs: Array | None, closes: NDArray[np.bool_]
) -> Attitudes:
    """Return the attitudes of states whose rates are those along a coordinate.

    Parameters
    ----------
    model : System
    states : ndarray, shape (..., elements)
    inputs : ndarray, shape (..., inputs), or None
    closes : ndarray of bool, shape (...)
        Which states the equations have; of others there is NaN.
    """
    count = len(model.equations.BODIES) if iterates(model.equations) else 0
    found = Attitudes(*(np.full((*closes.shape, 9 * count), np.nan) for _ in range(2)))
    if count and closes.any():
        held = None if inputs is None else inputs[closes]
        for whole, part in zip(found, attitudes_at(model, states[closes], held), strict=True):
            whole[closes] = part
    return found


def attitudes_at(model: System, states: Array, inputs: Array | None) -> Attitudes:
    """Return the attitudes of states that all close."""
    count = len(model.equations.BODIES) if iterates(model.equations) else 0
    lead = states.shape[:-1]
    if not count:
        return Attitudes(np.empty((*lead, 0)), np.empty((*lead, 0)))
    poses = model.evaluate("poses", states, inputs)
    matrices, motions = (
        poses[..., first : first + width * count].reshape(*lead, count, width)
        for first, width in ((-15 * count + poses.shape[-1], 9), (-6 * count + poses.shape[-1], 6))
    )
    columns = np.swapaxes(matrices.reshape(*lead, count, 3, 3), -1, -2)
    rates = np.swapaxes(np.cross(motions[..., None, :3], columns), -1, -2)
    flat = (*lead, 9 * count)
    return Attitudes(matrices.reshape(flat), rates.reshape(flat))


def iterates(equations: ModuleType) -> bool:
    """Return whether some loop of these equations is solved by iteration."""
    return bool(equations.ITERATES)
