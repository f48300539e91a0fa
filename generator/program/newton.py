"""Newton's method as a block of an otherwise straight-line program, for loops without closed form.

A *block* is a function of its own that follows a solution: from the design position, where it is
zero, to the coordinates of a call. Straight-line code, by the same printers as everything else,
computes one iteration: residuals g and their Jacobian J at one estimate, for one position of the
driven coordinates, with the poses of all bodies that are placed before the loops
(`IterationBlock.once`). One loop around it, shared by all blocks, has a bounded number of
iterations (``follow.c``, and `kintrafo.equations.following`).

The *path* leads straight from the coordinates of the design position to those of the call, in
stages. Where a hinge is further than a full turn from its design position, a turn alone is followed
first; if it leads back to the design position, whole turns are left out. So the result of a block
depends on its arguments only, is continuous where it exists, and is on the branch on which the
mechanism moves along this path.

A *stage* is accepted where Newton's method converges from the tangent (the path of the stage
before, continued), and where J has changed by less than half of itself since the stage before,
``|J0^-1 J - 1| <= 1/2`` (of more equations than unknowns: J0^-1 is the pseudoinverse). J cannot
become singular in between then, so that no other branch meets this one; and where J differs from
one matrix by less than that, g has one root, so that the iteration cannot reach another one. Both
are free of scales. The tangents ``-J^-1 g_v`` at both ends of a stage must agree with the change of
the unknowns: the error of the last tangent is at most twice that of the first one, which starts
Newton's method, or half of the change. A stage over a gap comes back from a dead point, and its
last tangent shows that. Closed forms before the loops must close along the whole stage, too
(`IterationDerivation._failing`). A stage that is not accepted is tried again, shorter. Where the
length of the stages goes to zero, the branch ends: a dead point.

After `ITERATIONS`, or where a branch ends, the block reports that it is lost (`LOST`) and returns
its last, finite estimate. Behind it, straight-line code evaluates the residuals again; its guard
refuses an estimate that does not fulfil them, and a lost one (`closed_forms.inverse`).

Derivatives: a block returns the adjugate and the determinant of its Jacobian J, too. Behind it, one
more correction ``x - J^-1 g(x, v)`` is written out, in which only g depends on the arguments v. It
changes nothing but the last digits, and its derivative is ``-J^-1 g_v``: that of the implicit
function theorem. So derivatives of the results of a block are zero by definition (`Iterated`).

Sources: E. L. Allgower and K. Georg, Introduction to Numerical Continuation Methods, SIAM, 2003;
bounds without scales: P. Deuflhard, Newton Methods for Nonlinear Problems, Springer, 2004.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import combinations
from typing import TYPE_CHECKING

import sympy as sp

from .function import Driven, Estimate, IterationBlock
from .functions import Frozen, Guarded, IsPositive, Positive
from .program import Program
from .steps import ancestors

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence


Matrix = list[list[sp.Expr]]


@dataclass(frozen=True)
class IterationResult:
    """Equations of one iteration at an estimate."""

    unknowns: Sequence[sp.Expr]  # estimate
    misfits: Sequence[sp.Expr]  # residuals of the equations
    rows: Matrix  # J
    apart: sp.Expr  # squared distance of the estimate from the design position, without whole turns
    # frozen quantities of the equations, and the derivatives of the misfits with respect to each
    given: Sequence[sp.Expr] = ()
    by_given: Matrix = field(default_factory=list)


class IterationDerivation:
    """The program of one iteration, with all bodies that are placed before the loops at that stage.

    `around` is the program that calls the block. `driven` has, of every coordinate that moves
    anything, the symbol, the value at design, the change that counts like a radian, and whether a
    full turn changes nothing.
    """

    def __init__(
        self, around: Program, driven: Iterable[tuple[sp.Symbol, sp.Expr, sp.Expr, bool]]
    ) -> None:
        self._around = around
        self.program = Program(around.constants)
        self._driven = {
            end: Driven(
                self._own(f"{end}_now"),
                self._own(f"{end}_way"),
                start,
                end,
                around.define(f"{end}_unit", unit),
                turns,
            )
            for end, start, unit, turns in driven
        }
        self._ways: dict[sp.Symbol, sp.Expr] = {d.now: d.way for d in self._driven.values()}
        self._copies: dict[sp.Symbol, sp.Expr] = {end: d.now for end, d in self._driven.items()}
        self._needed: set[sp.Symbol] = set()

    def _own(self, name: str) -> sp.Symbol:
        """Return a symbol that no constant has, or will have."""
        constants, symbol = self._around.constants, sp.Symbol(name)
        while constants.has(symbol.name):
            symbol = sp.Symbol(f"{symbol}_")
        constants.note(symbol.name)
        return symbol

    def repeated(self, values: Iterable[sp.Expr]) -> list[sp.Expr]:
        """Append copies of values of the calling program, at this stage of the path."""
        values, steps = list(values), self._around.steps
        needed = ancestors(steps, values) - self._needed
        for step in [s for s in steps.values() if s.symbol in needed]:
            copy = self.program.define(str(step.symbol), step.expression.xreplace(self._copies))
            if copy != step.symbol:
                self._copies[step.symbol] = copy
        self._needed |= needed
        return [value.xreplace(self._copies) for value in values]

    def block(
        self,
        name: str,
        doc: str,
        unknowns: Sequence[str],
        equations: int,
        derive: Callable[[Program, Estimate], IterationResult],
    ) -> IterationBlock:
        """Return the block of an iteration; `derive` writes its equations at an estimate."""
        program, count = self.program, len(unknowns)
        estimate = Estimate(
            tuple(self._own(f"{name}_from") for name in unknowns),
            tuple(self._own(f"{name}_step") for name in unknowns),
            tuple(
                tuple(self._own(f"held_{i}{j}") for j in range(1, equations + 1))
                for i in range(1, count + 1)
            ),
        )
        found = derive(program, estimate)
        program.section("Jacobian of the equations, and the correction")
        rows = named(program, "row", found.rows)
        inverse, scale = inverted(program, rows)
        correction = [-c / scale for c in times(inverse, found.misfits)]
        program.section("change of the Jacobian since the stage before")
        outputs = dict(zip(unknowns, found.unknowns, strict=True))
        places = [f"inverse_{i}{j}" for i in range(1, count + 1) for j in range(1, equations + 1)]
        outputs |= dict(zip(places, (e for line in inverse for e in line), strict=True))
        outputs |= {"determinant": scale, "apart": found.apart}
        outputs |= {f"correction_{u}": c for u, c in zip(unknowns, correction, strict=True)}
        count = len(found.misfits)
        slopes = program.along(self._ways, [*found.misfits, *found.given], "slope")
        by_given = times(found.by_given, slopes[count:]) if found.given else [0] * count
        slopes = [s + more for s, more in zip(slopes[:count], by_given, strict=True)]
        slopes = [program.define(f"misfit_{i}_slope", s) for i, s in enumerate(slopes, 1)]
        tangent = [-t / scale for t in times(inverse, slopes)]
        outputs |= {f"tangent_{u}": t for u, t in zip(unknowns, tangent, strict=True)}
        outputs["changed"] = self._changed(estimate.held, rows)
        once = program.function(name, doc, outputs)
        read = once.free_symbols
        constants = program.constants
        return IterationBlock(
            name,
            doc,
            tuple(unknowns),
            equations,
            tuple(s for s in (*constants.parameters, *constants.steps) if s in read),
            tuple(d for d in self._driven.values() if d.now in read),
            estimate,
            once,
        )

    def _changed(self, held: Sequence[Sequence[sp.Symbol]], rows: Matrix) -> sp.Expr:
        """Return ``|J0^-1 J - 1|^2``, increased where a closed form before the loops fails."""
        columns = [list(column) for column in zip(*rows, strict=True)]
        squares = []
        for i, line in enumerate(held):
            for j, column in enumerate(columns):
                kept = dot(line, column) - (1 if i == j else 0)
                squares.append(self.program.define(f"kept_{i + 1}{j + 1}", kept) ** 2)
        return sp.Add(*squares, *self._failing())

    def _failing(self) -> list[sp.Expr]:
        """Return a summand for each margin of the closed forms before: zero where it is positive.

        A closed form that moves much faster than its coordinate can cross a gap within a stage and
        look the same on both sides. So its margin must be positive back to the beginning of the
        stage, too: by its value and slope at the end, and by its curvature where that bends it
        down. Other iterations follow a path of their own.
        """
        steps = [step.expression for step in self.program.steps.values()]
        margins = [_margins(steps), _margins(e for e in steps if not isinstance(e, Frozen))]
        slopes = self.program.along(self._ways, margins[1], "slope")
        slopes = [self.program.define(f"margin_{i}_slope", s) for i, s in enumerate(slopes, 1)]
        bends = self.program.along(self._ways, slopes, "bend")
        back = [m - s - Positive(-b) / 2 for m, s, b in zip(margins[1], slopes, bends, strict=True)]
        return [1 - IsPositive(margin) for margin in dict.fromkeys([*margins[0], *back])]


def _margins(expressions: Iterable[sp.Expr]) -> list[sp.Expr]:
    """Return the guarded quantities less their floors."""
    guarded = {g for e in expressions for g in e.atoms(Guarded)}
    return sorted((g.args[0] - g.args[1] for g in guarded), key=str)


# -- linear equations -----------------------------------------------------------------------------


def inverted(program: Program, rows: Matrix) -> tuple[Matrix, sp.Expr]:
    """Append the adjugate and the determinant of J, or those of J^T J, the former times J^T."""
    if len(rows) == len(rows[0]):
        return adjugate(program, rows)
    columns = [list(column) for column in zip(*rows, strict=True)]
    normal = [[dot(a, b) for b in columns] for a in columns]
    inverse, scale = adjugate(program, named(program, "normal", normal))
    product = [[dot(line, row) for row in rows] for line in inverse]
    return named(program, "inverse", product), scale


def dot(one: Iterable[sp.Expr], two: Iterable[sp.Expr]) -> sp.Expr:
    """Return the scalar product of two rows of the same length."""
    return sum((a * b for a, b in zip(one, two, strict=True)), sp.Integer(0))


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
                # the rows below are in reversed order
                sign = _sign([*chosen, column, *others]) * _sign(range(len(others))[::-1])
                terms.append(sign * above[row][chosen] * below[size - 1 - row][others])
            cofactor = sp.Add(*terms)
            result[column][row] = program.define(f"adjugate_{column + 1}{row + 1}", cofactor)
    return result, program.define(
        "determinant", sum((matrix[0][c] * result[c][0] for c in columns), sp.Integer(0))
    )


def named(program: Program, name: str, matrix: Matrix) -> Matrix:
    """Append the elements of a matrix as steps; the name begins theirs."""
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


def times(matrix: Matrix, vector: Sequence[sp.Expr]) -> list[sp.Expr]:
    """Return the product of a matrix, by rows, and a vector."""
    return [dot(row, vector) for row in matrix]
