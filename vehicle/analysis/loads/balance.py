"""Equations of equilibrium at many positions, and the positions in which they are singular."""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from ....core.named_types import Array
from ....core.threads import in_one_thread

# At this condition the rounding of loads, 1e-16, becomes 1e-6 of the result; within the travel of
# cars the condition is some hundreds.
_WORST_CONDITION = 1e10
# Random right-hand sides, whose solutions estimate the condition.
_PROBES = 2

DEAD_POINT = "the linkage is at a dead point, where the loads on the joints have no bound."
"""The reason for a position without loads."""


def balanced(matrix: Array, applied: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return the unknowns that balance loads, NaN at dead points, and where they are sound.

    The columns of the matrix, (..., m, m), are the effects of units of the unknowns; loads have the
    shape (..., m) or (..., m, cases).
    """
    several = applied.ndim == matrix.ndim
    right = -(applied if several else applied[..., None])
    probes = np.broadcast_to(_probes(right.shape[-2]), (*right.shape[:-1], _PROBES))
    found = _solution(matrix, np.concatenate([right, probes], axis=-1))
    size, inverse = np.abs(matrix).sum(-2).max(-1), np.abs(found[..., -_PROBES:]).max((-2, -1))
    sound: NDArray[np.bool_] = size * inverse < _WORST_CONDITION
    found[~sound] = np.nan
    return found[..., :-_PROBES] if several else found[..., 0], sound


@cache
def _probes(size: int) -> Array:
    """Return random vectors of signs, the same in every run."""
    return np.random.default_rng(0).choice([-1.0, 1.0], (size, _PROBES))


@in_one_thread
def _solution(matrix: Array, right: Array) -> Array:
    """Return solutions; infinite ones of matrices that are exactly singular."""
    try:
        found: Array = np.linalg.solve(matrix, right).astype(float)
    except np.linalg.LinAlgError:  # raised for all because of one
        found = np.linalg.pinv(matrix, rcond=1e-15) @ right
        found[np.linalg.cond(matrix) >= _WORST_CONDITION] = np.inf
    return found
