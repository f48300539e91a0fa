"""Equations of equilibrium at many positions, and the positions in which they are singular."""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from ....core.elimination import Entries, eliminated
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
    found = _solution(matrix, _with_probes(applied if several else applied[..., None]))
    sound = _sound(np.abs(matrix).sum(-2).max(-1), found)
    return found[..., :-_PROBES] if several else found[..., 0], sound


def balanced_at_many(entries: Entries, applied: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Return the same as `balanced` for sparse equations at n positions.

    Non-zero entries of the matrix have the shape (n,), loads (n, m) or (n, m, cases).
    """
    several = applied.ndim == 3
    right = _with_probes(applied if several else applied[..., None])
    columns, accurate = eliminated(entries, np.ascontiguousarray(np.moveaxis(right, 0, -1)))
    found = np.moveaxis(columns, -1, 0)
    if not accurate.all():
        size = right.shape[-2]
        found[~accurate] = _solution(dense(entries, (size, size), ~accurate), right[~accurate])
    sums = np.zeros((right.shape[-2], len(right)))
    for (_, column), values in entries.items():
        sums[column] += np.abs(values)
    return found[..., :-_PROBES] if several else found[..., 0], _sound(sums.max(axis=0), found)


def dense(
    entries: Entries, shape: tuple[int, int], where: NDArray[np.bool_] | slice = slice(None)
) -> Array:
    """Return matrices, (positions, *shape), of their entries."""
    matrix = np.zeros((len(next(iter(entries.values()))[where]), *shape))
    for (row, column), values in entries.items():
        matrix[:, row, column] = values[where]
    return matrix


def _with_probes(applied: Array) -> Array:
    """Return right-hand sides, (..., m, cases), followed by the random ones."""
    probes = np.broadcast_to(_probes(applied.shape[-2]), (*applied.shape[:-1], _PROBES))
    return np.concatenate([-applied, probes], axis=-1)


def _sound(size: Array, found: Array) -> NDArray[np.bool_]:
    """Return where equations of some norm are sound; elsewhere solutions become NaN."""
    sound: NDArray[np.bool_] = size * np.abs(found[..., -_PROBES:]).max((-2, -1)) < _WORST_CONDITION
    found[~sound] = np.nan
    return sound


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
