"""Newton's method as a block of an otherwise straight-line program, for what has no closed form.

A *block* is a function of its own: from some values, and from zero as the first estimate, it finds
unknowns at which as many residuals vanish. What it repeats is straight-line code, written by the
same printers as everything else; around it are a loop with a fixed number of iterations, and one
comparison that ends it. The first estimate does not depend on any call before, so the function that
calls a block stays a pure function.

Safeguards: a correction is not longer than `LONGEST`; a change of sign of the determinant of J is
remembered (`CROSSED`); after `ITERATIONS`, or where J is singular, the block returns what it has,
which is finite. Whether that is a solution is not for the block to
say: the straight-line code behind it evaluates the residuals again, and its guard refuses what does
not fulfil them (`solutions.carrier`).

Derivatives: a block returns the adjugate and the determinant of its Jacobian J as well. Behind it,
one more correction ``x - J^-1 g(x, v)`` is written out, in which only g depends on the arguments v.
It changes nothing but the last digits, and its derivative is ``-J^-1 g_v``: that of the implicit
function theorem. So derivatives of the results of a block are zero by definition (`Iterated`).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import TYPE_CHECKING

import sympy as sp
from sympy.core.symbol import Str

from .arithmetic import Positive
from .program import ConstantStage, Program

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from .program import Function

ITERATIONS = 30
"""Most iterations of a block. Within the travel of a suspension it takes four to six."""

CONVERGED = "1.0e-13"
"""Length of a correction that ends a block: that of its rounding."""

LONGEST = sp.Rational(3, 10)
"""Longest correction of an iteration: longer ones jump to other branches of the solution."""

Matrix = list[list[sp.Expr]]


@dataclass(frozen=True)
class Block:
    """An iteration with a name.

    Attributes
    ----------
    name, doc
        Name of the function in C, and what it finds (behind a verb, without a full stop).
    arguments
        What it is given, in order; the names are its own.
    unknowns
        What it finds; zero at the start.
    results
        Names of what it returns, in order.
    once
        One iteration, as a function of arguments and unknowns. Its outputs are the results, the
        next estimate of every unknown, and the square of the length of the correction.
    """

    name: str
    doc: str
    arguments: tuple[sp.Symbol, ...]
    unknowns: tuple[sp.Symbol, ...]
    results: tuple[str, ...]
    once: Function

    @cached_property
    def symbol(self) -> sp.Basic:
        """The name, as an argument of `Iterated`."""
        return Str(self.name)

    @classmethod
    def of(
        cls,
        name: str,
        doc: str,
        arguments: Sequence[sp.Symbol],
        unknowns: Sequence[sp.Symbol],
        derive: Callable[[Program], tuple[Mapping[str, sp.Expr], Sequence[sp.Expr], sp.Expr]],
    ) -> Block:
        """Derive a block.

        Parameters
        ----------
        derive
            Writes one iteration into a program, and returns its results, the next estimates, and
            the square of the length of the correction.
        """
        own = frozenset(map(str, (*arguments, *unknowns)))
        program = Program(ConstantStage((), reserved=own))
        results, following, change = derive(program)
        outputs = dict(results)
        outputs |= {f"next {u}": new for u, new in zip(unknowns, following, strict=True)}
        once = program.function(name, doc, outputs | {"change": change})
        return cls(name, doc, tuple(arguments), tuple(unknowns), tuple(results), once)


def limited(program: Program, correction: Sequence[sp.Expr]) -> tuple[list[sp.Expr], sp.Expr]:
    """Return a correction that is at most `LONGEST`, and the square of its length before."""
    correction = [program.define(f"correction_{i}", c) for i, c in enumerate(correction, 1)]
    squared = program.define("change", sum((c * c for c in correction), sp.Integer(0)))
    most = LONGEST**2
    length = program.define("length", sp.sqrt(most + Positive(squared - most)))
    factor = program.define("factor", LONGEST / length)
    return [c * factor for c in correction], squared


SIDE = sp.Symbol("side")
"""Argument of a block: the sign of the determinant at the design position, plus or minus one."""

CROSSED = sp.Symbol("crossed")
"""Unknown of a block: by how much the determinant has been on the other side on the way."""


def crossed(determinant: sp.Expr) -> sp.Expr:
    """Return the next value of `CROSSED`.

    Where the determinant changes its sign, two branches of the solution meet; an iteration that has
    been beyond may come back on another one, with the same sign.
    """
    return CROSSED + Positive(-SIDE * determinant - CROSSED)


# -- linear equations -----------------------------------------------------------------------------


def determinant(program: Program, name: str, matrix: Matrix) -> sp.Expr:
    """Append the determinant of a matrix, by minors of its first rows."""
    size = len(matrix)
    minors = _minors(program, f"{name}_upper", matrix)
    return minors[size][tuple(range(size))]


def adjugate(program: Program, matrix: Matrix) -> tuple[Matrix, sp.Expr]:
    """Append the adjugate of a matrix and its determinant: no pivots, and no division.

    With the adjugate, a singular matrix needs no case of its own. A cofactor is a sum over products
    of a minor of the rows above and one of the rows below (Laplace): a thousand operations for six
    rows, some thirty for three.
    """
    size = len(matrix)
    columns = tuple(range(size))
    above = _minors(program, "upper", matrix)
    below = _minors(program, "lower", matrix[::-1])
    result: Matrix = [[sp.Integer(0)] * size for _ in columns]
    for row in range(size):
        for column in columns:
            rest = [c for c in columns if c != column]
            terms = []
            for chosen in combinations(rest, row):
                others = tuple(c for c in rest if c not in chosen)
                sign = _sign([*chosen, column, *others]) * _reversal(len(others))
                terms.append(sign * above[row][chosen] * below[size - 1 - row][others])
            cofactor = sp.Add(*terms)
            result[column][row] = program.define(f"adjugate_{column + 1}{row + 1}", cofactor)
    return result, program.define(
        "determinant", sum((matrix[0][c] * result[c][0] for c in columns), sp.Integer(0))
    )


def named(program: Program, name: str, matrix: Matrix) -> Matrix:
    """Append the elements of a matrix."""
    return [
        [program.define(f"{name}_{i}{j}", entry) for j, entry in enumerate(row, 1)]
        for i, row in enumerate(matrix, 1)
    ]


def _minors(program: Program, name: str, matrix: Matrix) -> list[dict[tuple[int, ...], sp.Expr]]:
    """Append all minors of the first rows of a matrix: by number of rows, then by columns."""
    size = len(matrix)
    minors: list[dict[tuple[int, ...], sp.Expr]] = [{(): sp.Integer(1)}]
    for count in range(1, size + 1):
        last, before = matrix[count - 1], minors[-1]
        minors.append({})
        for columns in combinations(range(size), count):
            terms = [
                (-1) ** (count - 1 - place)
                * last[column]
                * before[columns[:place] + columns[place + 1 :]]
                for place, column in enumerate(columns)
            ]
            label = "".join(str(c + 1) for c in columns)
            minors[-1][columns] = program.define(f"{name}_{label}", sp.Add(*terms))
    return minors


def _sign(order: Sequence[int]) -> int:
    """Return the sign of a permutation."""
    return -1 if sum(a > b for a, b in combinations(order, 2)) % 2 else 1


def _reversal(count: int) -> int:
    """Return the sign of turning round some rows."""
    return _sign(range(count)[::-1])


def times(matrix: Matrix, vector: Sequence[sp.Expr]) -> list[sp.Expr]:
    """Return the product of a matrix and a vector."""
    return [sum((a * b for a, b in zip(row, vector, strict=True)), sp.Integer(0)) for row in matrix]
