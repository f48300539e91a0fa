"""Linear equations with few entries, at many positions: one elimination for all of them.

The entries of a matrix are columns over the positions, and what is zero is none. Pivots are chosen
once, so that few entries appear besides (Markowitz) and none is much smaller than others that could
be; each step is then a few operations on columns. Where that was not accurate for some position is
seen from what is left of its equations.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

Entries = Mapping[tuple[int, int], Array]
"""By row and column, over the positions."""

# A pivot has this part of the largest entry in its column (Duff, Erisman & Reid's usual threshold).
_THRESHOLD = 0.1
# What may be left of the equations, of the largest sum of the sizes of terms in one: with pivots of
# its own for each position some 1e-16 is left for each of some tens of unknowns.
_LEFT = 1e-13


@dataclass(frozen=True)
class _Step:
    """A pivot, the rows from which it goes, and the columns of its own row that are left."""

    row: int
    column: int
    below: list[int]
    across: list[int]


def eliminated(entries: Entries, right: Array) -> tuple[Array, Flags]:
    """Solve linear equations at many positions.

    Parameters
    ----------
    entries : mapping
        Those of a square matrix that are not zero everywhere, each of shape (n,).
    right : ndarray, shape (m, k, n)
        Right sides, of which there are k.

    Returns
    -------
    solutions : ndarray, shape (m, k, n)
    accurate : ndarray of bool, shape (n,)
        Whether they fulfil the equations to rounding. Where not, which includes equations that
        have no solution, they mean nothing.

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
    with np.errstate(all="ignore"):  # what becomes infinite is seen at the end
        for step in steps:
            _eliminate(step, work, left)
        for step in reversed(steps):
            for other in step.across:
                left[step.row] -= work[step.row, other] * found[other]
            found[step.column] = left[step.row]
        return found, _fulfilled(entries, right, found)


def _plan(sample: Array, there: set[tuple[int, int]]) -> list[_Step]:
    """Return the order of elimination, from one position; nothing where it is singular there."""
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
    """Take an unknown out of the equations that are left, and divide its own by its pivot."""
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
    """Return where solutions fulfil their equations."""
    left, terms, term = -right, np.abs(right), np.empty_like(right[0])
    for (row, column), values in entries.items():
        np.multiply(values, found[column], out=term)
        left[row] += term
        terms[row] += np.abs(term, out=term)
    fulfilled: Flags = (np.abs(left).max(axis=0) <= _LEFT * terms.max(axis=0)).all(axis=0)
    return fulfilled
