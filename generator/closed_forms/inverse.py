"""Linear equations whose matrix an iteration has inverted, solved with exact derivatives.

Velocities and accelerations fulfil ``J x = b``. An inverse K of J that comes from an iteration has
no derivative; the equations are solved with it twice: ``x = x0 + K (b - J x0)``, where x0 = K b is
frozen. The derivative of that is the exact one, ``K (b' - J' x)``; no inverse is differentiated.

K may have more columns than rows: of equations that are more than the unknowns but contradict each
other nowhere, K = (J^T J)^-1 J^T gives the solution.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ...equations.following import ITERATIONS
from ..program.functions import Frozen, IsPositive
from ..program.newton import Matrix, times

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..kinematics.kinematics import Kinematics

# What the iteration may leave of g: the correction behind it makes about the square of that, 1e-12.
# Of what converges, less than 1e-13 is left, so that it does not show in the determinant.
_TOLERANCE = sp.Rational(1, 10**6)


@dataclass(frozen=True)
class Inverse:
    """The matrix K of a position that is found: the product of a matrix and a factor.

    Both come from the iteration, their derivatives are zero.
    """

    matrix: Matrix
    factor: sp.Expr

    def step(self, left: Sequence[sp.Expr]) -> list[sp.Expr]:
        """Return the correction for what is left of the equations."""
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


def guarded_factor(
    kin: Kinematics,
    name: str,
    found: sp.Expr,
    left: Sequence[sp.Expr],
    lost: sp.Expr,
    meaning: str,
) -> sp.Expr:
    """Append the reciprocal of a determinant, guarded.

    With e the square of what the iteration has left of g, over that of `_TOLERANCE`, and d the
    determinant with the sign that it has at the design position, the guard is
    ``(d - e) / (1 + e)``. It is not positive where a loop cannot close, where J is singular, and
    where the iteration has not come through from the design position: that counts to e. Else it is
    d to the last digit.

    Parameters
    ----------
    found
        The determinant, as the iteration returns it.
    left
        What the iteration has left of g.
    lost
        One where the iteration has not arrived, else zero.
    meaning
        What it means that the guard acts; how many iterations there were is said behind it.
    """
    program = kin.program
    squares = sum((g * g for g in left), sp.Integer(0))
    excess = program.define(f"{name}_excess", squares / _TOLERANCE**2 + lost / _TOLERANCE)
    arrived = program.guarded(
        f"{name}_closure",
        (found - excess) / (1 + excess),
        meaning.format(iterations=ITERATIONS),
        "1",
    )
    held_at_all = IsPositive(
        arrived.args[0]
    )  # else no correction: what was found last stays finite
    return program.define(f"{name}_arrived", Frozen(held_at_all / arrived))
