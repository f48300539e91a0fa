"""Sparse linear equations at many positions, solved by one elimination for all of them.

An entry of the matrix is an array over the positions; entries that are zero everywhere are left
out. Pivots are chosen once: few entries fill in (Markowitz) and no pivot is much smaller than other
candidates. Each step is then a few operations on arrays. The residual of the equations shows the
positions at which the result is not accurate.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .named_types import Array

Flags = NDArray[np.bool_]

Entries = Mapping[tuple[int, int], Array]
"""Entries over the positions, by row and column."""

# A pivot is at least this part of the largest entry of its column (the usual threshold of Duff,
# Erisman & Reid).
_THRESHOLD = 0.1
# Largest residual, relative to the largest sum of magnitudes of the terms of an equation: some
# 1e-16 for each of some tens of unknowns, if the pivots are chosen for each position.
_LEFT = 1e-13


@dataclass(frozen=True)
class _Step:
    """A pivot, the rows from which it is eliminated, and the remaining columns of its own row."""

    row: int
    column: int
    below: list[int]
    across: list[int]


def eliminated(entries: Entries, right: Array) -> tuple[Array, Flags]:
    """Return the solutions of linear equations at n positions, and where they are accurate, (n,).

    `entries` are those of a square matrix that are not zero everywhere, (n,) each; `right` are k
    right sides, (m, k, n), as are the solutions. Where they do not fulfil the equations to
    rounding, for singular equations too, they are meaningless.

    Examples
    --------
    >>> ones = np.ones(3)
    >>> found, accurate = eliminated({(0, 1): 2.0 * ones, (1, 0): 4.0 * ones}, np.ones((2, 1, 3)))
    >>> found[:, 0, 0].tolist(), accurate.tolist()
    ([0.25, 0.5], [True, True, True])
    """
    size, _, positions = right.shape
    sample = np.zeros((size, size))
    for at, column in entries.items():
        sample[at] = column[positions // 2]
    work, left = dict(entries), right.copy()
    steps = _plan(sample, {*entries})
    found = np.full_like(right, np.nan)
    with np.errstate(all="ignore"):  # infinite results are not accurate
        for step in steps:
            _eliminate(step, work, left)
        for step in reversed(steps):
            for other in step.across:
                left[step.row] -= work[step.row, other] * found[other]
            found[step.column] = left[step.row]
        return found, _fulfilled(entries, right, found)


def _plan(sample: Array, there: set[tuple[int, int]]) -> list[_Step]:
    """Return the order of elimination for the matrix of one position; empty if it is singular."""
    size = len(sample)
    sample, held = sample.copy(), np.zeros((size, size), dtype=bool)
    held[tuple(np.transpose([*there]))] = True
    rest, steps = held.copy(), []
    for _ in range(size):
        entry = np.where(rest, np.abs(sample), 0.0)
        usable = rest & (entry >= _THRESHOLD * entry.max(axis=0)) & (entry > 0.0)
        if not usable.any():
            return []
        fill = np.multiply.outer(rest.sum(axis=1) - 1, rest.sum(axis=0) - 1)
        cost = np.where(usable, fill, np.inf)
        best = np.where(cost == cost.min(), entry, 0.0)  # of the cheapest the largest
        row, column = map(int, np.unravel_index(best.argmax(), best.shape))
        rest[row, column] = False
        below, across = np.flatnonzero(rest[:, column]), np.flatnonzero(rest[row])
        block = np.ix_(below, across)
        sample[block] -= np.outer(sample[below, column] / sample[row, column], sample[row, across])
        rest[block] = True
        rest[row], rest[:, column] = False, False
        steps.append(_Step(row, column, below.tolist(), across.tolist()))
    return steps


def _eliminate(step: _Step, work: dict[tuple[int, int], Array], left: Array) -> None:
    """Eliminate an unknown from the other equations, and divide its own by its pivot."""
    row, column = step.row, step.column
    inverse = 1.0 / work[row, column]
    left[row] *= inverse
    for other in step.across:
        work[row, other] = work[row, other] * inverse
    for below in step.below:
        factor = work[below, column]
        left[below] -= factor * left[row]
        for other in step.across:
            taken = factor * work[row, other]
            at = below, other
            work[at] = work[at] - taken if at in work else -taken


def _fulfilled(entries: Entries, right: Array, found: Array) -> Flags:
    """Return at which positions solutions fulfil their equations."""
    left, terms, term = -right, np.abs(right), np.empty_like(right[0])
    for (row, column), values in entries.items():
        np.multiply(values, found[column], out=term)
        left[row] += term
        terms[row] += np.abs(term, out=term)
    return (np.abs(left).max(axis=0) <= _LEFT * terms.max(axis=0)).all(axis=0)
