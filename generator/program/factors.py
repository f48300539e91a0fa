"""Solution of a symmetric system by its factors ``L D L^T``, unrolled.

Source: G. H. Golub and C. F. Van Loan, Matrix Computations, fourth edition, Johns Hopkins, 2013,
section 4.1.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

if TYPE_CHECKING:
    from collections.abc import Mapping

    from .program import Program


def solved(
    program: Program,
    factors: Mapping[tuple[str, str], sp.Expr],
    right: Mapping[str, sp.Expr],
    name: str,
    unknown: str,
) -> dict[str, sp.Expr]:
    """Return the solution x of ``L D L^T x = right``.

    `factors` are the elements of L below its diagonal by row and column, and on it the inverses of
    those of D; `right` is by row, in the order of elimination. `name` and `unknown` name the steps:
    the reduced right-hand side, and an unknown k, as ``{}_more``.
    """
    rows, left = list(right), dict(right)
    for i, k in enumerate(rows):
        for row in rows[i + 1 :]:
            left[row] = program.define(f"{name}_{row}_{k}", left[row] - factors[row, k] * left[k])
    found: dict[str, sp.Expr] = {}
    for i, k in reversed(list(enumerate(rows))):
        known = sum((factors[row, k] * found[row] for row in rows[i + 1 :]), sp.Integer(0))
        found[k] = program.define(unknown.format(k), left[k] * factors[k, k] - known)
    return found
