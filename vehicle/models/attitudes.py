"""Attitudes of bodies along a path, which show whether neighbouring positions are on one branch.

Loops solved by iteration are followed on a straight path from the design position to each requested
position (`equations.following`). Two neighbours on another path, such as an arm that swings with
the rack displaced, have two straight paths, which may pass a point where two branches meet on
different sides: the neighbours may be on different branches. Closed forms choose their branch by
signs and need no such check.
"""

from types import ModuleType
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.named_types import Array
from ...systems.system import System


class Attitudes(NamedTuple):
    """Rotation matrices of bodies at some positions, and their derivatives along a coordinate."""

    # elements of all matrices, from design; none of equations in closed form, (..., places,
    # elements)
    turned: Array
    rate: Array  # derivatives along the coordinate, (..., places, elements)


def attitudes(
    model: System, states: Array, inputs: Array | None, closes: NDArray[np.bool_]
) -> Attitudes:
    """Return the attitudes of states whose rates are those along a coordinate.

    `closes` are the states whose loops close; the attitudes of others are NaN.
    """
    held = None if inputs is None else inputs[closes]
    closing = attitudes_at(model, states[closes], held)
    found = Attitudes(*(np.full((*closes.shape, own.shape[-1]), np.nan) for own in closing))
    for whole, part in zip(found, closing, strict=True):
        whole[closes] = part
    return found


def attitudes_at(model: System, states: Array, inputs: Array | None) -> Attitudes:
    """Return the attitudes of states in which all loops close."""
    count = len(model.equations.BODIES) if iterates(model.equations) else 0
    lead = states.shape[:-1]
    if not count or not states.size:
        return Attitudes(np.empty((*lead, 9 * count)), np.empty((*lead, 9 * count)))
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
    """Return whether the equations solve a loop by iteration."""
    return bool(equations.ITERATES)
