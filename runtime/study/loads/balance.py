"""Equations of equilibrium, solved at many positions, and where they mean nothing."""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from ...core.threads import in_one_thread

Array = NDArray[np.float64]

# Rounding of loads, 1e-16, that equations so near to singular enlarge to 1e-6 of them; of cars
# within their travel it is some hundreds.
_WORST_CONDITION = 1e10
# Vectors that show how much equations enlarge what is random: of a condition nearly all of it.
_PROBES = 2

DEAD_POINT = (
    "the linkage is at a dead point, or what holds it has no leverage: the joints carry anything."
)
"""Why there are no loads."""


def balanced(matrix: Array, applied: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return what balances loads, and where that means something.

    Where it does not is a dead point: there they are no numbers.

    Parameters
    ----------
    matrix : ndarray, shape (..., m, m)
        What a unit of each unknown does, as columns.
    applied : ndarray, shape (..., m) or (..., m, cases)
        Loads.

    Returns
    -------
    unknowns : ndarray
        As many as `applied` has.
    sound : ndarray of bool, shape (...)
    """
    several = applied.ndim == matrix.ndim
    vectors = -applied if several else -applied[..., None]
    # what enlarges any of these enlarges rounding, too
    probes = np.broadcast_to(_probes(vectors.shape[-2]), (*vectors.shape[:-1], _PROBES))
    found = _solution(matrix, np.concatenate([vectors, probes], axis=-1))
    size = np.abs(matrix).sum(-2).max(-1)
    enlarged = size * np.abs(found[..., -_PROBES:]).max((-2, -1))
    sound: NDArray[np.bool_] = enlarged < _WORST_CONDITION
    found[~sound] = np.nan
    return found[..., :-_PROBES] if several else found[..., 0], sound


@cache
def _probes(size: int) -> Array:
    """Return vectors of signs, the same in every run."""
    return np.random.default_rng(0).choice([-1.0, 1.0], (size, _PROBES))


@in_one_thread
def _solution(matrix: Array, right: Array) -> Array:
    """Return solutions; of matrices that are singular to the last bit huge numbers."""
    try:
        found: Array = np.linalg.solve(matrix, right).astype(float)
    except np.linalg.LinAlgError:  # one spoils all
        found = np.linalg.pinv(matrix, rcond=1e-15) @ right
        found[np.linalg.cond(matrix) >= _WORST_CONDITION] = np.inf
    return found
