"""Linear equations whose matrix an iteration has inverted, solved with exact derivatives.

Velocities and accelerations fulfil ``J x = b``. An inverse K of J that comes from an iteration has
no derivative; the equations are solved with it twice: ``x = x0 + K (b - J x0)``, where x0 = K b is
frozen. The derivative of that is the exact one, ``K (b' - J' x)``; no inverse is differentiated. K
may have more columns than rows: of more equations than unknowns, without a contradiction, K = (J^T
J)^-1 J^T gives the solution.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ...equations.following import ITERATIONS
from ..program.function import LOST
from ..program.functions import Frozen, IsPositive
from ..program.newton import Matrix, times

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ..kinematics.kinematics import Kinematics

# Largest residual of the iteration: the correction behind it leaves about its square, 1e-12. A
# converged iteration leaves less than 1e-13, which does not change the determinant.
_TOLERANCE = sp.Rational(1, 10**6)


@dataclass(frozen=True)
class Inverse:
    """The matrix K of a solved position: the product of a matrix and a factor.

    Both come from the iteration; their derivatives are zero.
    """

    matrix: Matrix
    factor: sp.Expr

    @classmethod
    def found(
        cls,
        kin: Kinematics,
        name: str,
        results: Mapping[str, sp.Expr],
        left: Sequence[sp.Expr],
        meaning: str,
    ) -> Inverse:
        """Append the reciprocal of the determinant that an iteration has found, guarded.

        With e the square of the remaining g, `left`, over that of `_TOLERANCE`, and d the
        determinant with the sign that it has at the design position, the guard is ``(d - e) / (1 +
        e)``. It is not positive where a loop cannot close, where J is singular, and where the
        iteration has lost the solution on the path from the design position, which counts to e.
        Else it is d to the last digit. `name` begins the names of the steps; `meaning` is the cause
        of a guard that acts, with ``{iterations}`` for their largest number.
        """
        program, lost = kin.program, results[LOST]
        squares = sum((g * g for g in left), sp.Integer(0))
        excess = program.define(f"{name}_excess", squares / _TOLERANCE**2 + lost / _TOLERANCE)
        closure = (results["determinant"] - excess) / (1 + excess)
        meaning = meaning.format(iterations=ITERATIONS)
        arrived = program.guarded(f"{name}_closure", closure, meaning, "1")
        held = IsPositive(arrived.args[0])  # else no correction: the last estimate stays finite
        places = range(1, len(left) + 1)
        rows = [i for i in places if f"inverse_{i}1" in results]
        return cls(
            [[results[f"inverse_{i}{j}"] for j in places] for i in rows],
            program.define(f"{name}_arrived", Frozen(held / arrived)),
        )

    def step(self, left: Sequence[sp.Expr]) -> list[sp.Expr]:
        """Return the correction for remaining residuals."""
        return [-self.factor * value for value in times(self.matrix, left)]

    def solve(
        self, kin: Kinematics, name: str, rows: Matrix, b: Sequence[sp.Expr]
    ) -> list[sp.Expr]:
        """Append the solution of ``rows x = b``, with its exact derivative."""
        program = kin.program
        b = [program.define(f"{name}_given_{i}", value) for i, value in enumerate(b, 1)]
        first = [
            program.define(f"{name}_first_{i}", Frozen(value * self.factor))
            for i, value in enumerate(times(self.matrix, b), 1)
        ]
        left = [
            program.define(f"{name}_left_{i}", value - done)
            for i, (value, done) in enumerate(zip(b, times(rows, first), strict=True), 1)
        ]
        more = times(self.matrix, left)
        return [x + self.factor * dx for x, dx in zip(first, more, strict=True)]
