"""Speeds that constraints admit: the eliminated ones in terms of the others.

With the constraints ``A v + a = 0``, where a is due to prescribed motions, and v split into the
eliminated speeds d and the others i,

    v_d = P v_i + p,    v_d' = P v_i' + g,

by the normal equations of A_d, which need no choice of pivots: ``S = A_d^T A_d`` is positive
definite wherever the eliminated speeds follow from the others. Admissible motions are
``T = [1; P]``, and d'Alembert's principle leaves ``T^T M T v_i' = T^T (Q - B - M g)``, without
multipliers.

Source: T. R. Kane and D. A. Levinson, Dynamics: Theory and Applications, McGraw-Hill, 1985 (motion
constraints of nonholonomic systems).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..program.factors import solved
from ..program.floors import NORMAL, POSITIVE
from ..program.newton import dot
from .surroundings import Seen

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ..program.program import Program
    from .in_motion import InMotion

NONE = sp.Integer(0)

Rows = dict[str, dict[str, sp.Expr]]
"""By eliminated coordinate, then by coordinate."""


@dataclass(frozen=True)
class Admissible:
    """The admissible speeds."""

    program: Program
    independent: tuple[str, ...]
    shares: Rows  # P, by eliminated coordinate, then by independent coordinate
    leftover: Mapping[str, sp.Expr]  # g, by eliminated coordinate

    @classmethod
    def of(cls, moving: InMotion) -> Admissible | None:
        """Solve the constraints of a mechanism; None where there are none."""
        constraints = moving.mechanism.constraints
        if not constraints:
            return None
        program, coordinates = moving.program, moving.coordinates
        program.section("constraints on speeds")
        at = Seen(moving, {}, None)
        rows = [row for constraint in constraints for row in constraint.velocities(at)]
        eliminated, independent = coordinates.eliminated, coordinates.independent
        solver = _Normal.of(program, rows, eliminated)
        shares = {
            k: solver.solved(f"share_{k}", [row.get(k, NONE) for row in rows]) for k in independent
        }
        given = [k for k in coordinates.moving if k not in (*independent, *eliminated)]
        added = [
            sum((row[k] * coordinates.true_rate(k) for k in given if k in row), NONE)
            for row in rows
        ]
        offset = solver.solved("given_speed", added)
        for d in eliminated:
            terms = (-shares[k][d] * coordinates.true_rate(k) for k in independent)
            speed = sum(terms, -offset[d])
            coordinates.solved[d] = program.define(f"{coordinates.states.speed_of[d]}_now", speed)
        changing = _changes(moving, rows)
        for k in given:
            acceleration = coordinates.acceleration(k)
            changing = [
                c + row.get(k, NONE) * acceleration for c, row in zip(changing, rows, strict=True)
            ]
        leftover = solver.solved("leftover", changing)
        return cls(
            program,
            tuple(independent),
            {d: {k: -shares[k][d] for k in independent} for d in eliminated},
            {d: -leftover[d] for d in eliminated},
        )

    def reduced(self, matrix: Mapping[tuple[str, str], sp.Expr]) -> dict[tuple[str, str], sp.Expr]:
        """Return T^T M T of a symmetric matrix, by pairs of independent coordinates in order."""
        half = {
            (row, k): self.program.define(
                f"admissible_{row}_{k}",
                matrix[row, k] + sum((matrix[row, d] * p[k] for d, p in self.shares.items()), NONE),
            )
            for row in (*self.independent, *self.shares)
            for k in self.independent
        }
        return {
            (k, other): half[k, other]
            + sum((p[k] * half[d, other] for d, p in self.shares.items()), NONE)
            for i, k in enumerate(self.independent)
            for other in self.independent[i:]
        }

    def projected(self, values: Mapping[str, sp.Expr]) -> dict[str, sp.Expr]:
        """Return T^T of generalised forces on all coordinates."""
        return {
            k: values[k] + sum((p[k] * values[d] for d, p in self.shares.items()), NONE)
            for k in self.independent
        }

    def carried_along(self, matrix: Mapping[tuple[str, str], sp.Expr]) -> dict[str, sp.Expr]:
        """Return M g: the inertia forces of the eliminated speeds at constant independent ones."""
        return {
            row: sum((matrix[row, d] * g for d, g in self.leftover.items()), NONE)
            for row in (*self.independent, *self.shares)
        }

    def completed(self, accelerations: Mapping[str, sp.Expr]) -> dict[str, sp.Expr]:
        """Return the accelerations of all coordinates from the independent ones."""
        found = dict(accelerations)
        for d, p in self.shares.items():
            terms = (p[k] * accelerations[k] for k in self.independent)
            found[d] = self.program.define(f"{d}_acceleration", sum(terms, self.leftover[d]))
        return found


def _changes(moving: InMotion, rows: Sequence[Mapping[str, sp.Expr]]) -> list[sp.Expr]:
    """Return the rate of the constraints at constant speeds: ``A' v``."""
    coordinates, program = moving.coordinates, moving.program
    direction = {sp.Symbol(name): rate for name, rate in moving.rates().items()}
    direction |= {
        sp.Symbol(motion.inputs[0].name): sp.Symbol(motion.rates[0])
        for motion in coordinates.formulation.prescribed.values()
    }
    entries = [entry for row in rows for entry in row.values()]
    changes = iter(program.along(direction, entries, "changing"))
    found = []
    for row in rows:
        terms = [next(changes) * coordinates.true_rate(k) for k in row]
        found.append(sum(terms, NONE))
    return found


@dataclass(frozen=True)
class _Normal:
    """The normal equations of the eliminated speeds, factorised: S = L D L^T."""

    program: Program
    columns: dict[str, list[sp.Expr]]
    factors: dict[tuple[str, str], sp.Expr]

    @classmethod
    def of(
        cls, program: Program, rows: Sequence[Mapping[str, sp.Expr]], names: Sequence[str]
    ) -> _Normal:
        columns = {d: [row.get(d, NONE) for row in rows] for d in names}
        work = {
            (a, b): program.define(f"normal_{a}_{b}", dot(columns[a], columns[b]))
            for i, a in enumerate(names)
            for b in names[i:]
        }
        whole = dict(work)
        factors: dict[tuple[str, str], sp.Expr] = {}
        for i, k in enumerate(names):
            size = whole[k, k] if i else sp.Integer(1)
            pivot = program.guarded(
                f"admissible_pivot_{k}",
                work[k, k] / size,
                f"the constraints on speeds do not give {k}, which is eliminated",
                "1",
                NORMAL if i else POSITIVE,
            )
            inverse = program.define(f"admissible_inverse_{k}", 1 / (pivot * size))
            factors[k, k] = inverse
            for j, row in enumerate(names[i + 1 :], i + 1):
                factors[row, k] = program.define(
                    f"admissible_factor_{row}_{k}", work[k, row] * inverse
                )
                for column in names[j:]:
                    work[row, column] = program.define(
                        f"normal_{row}_{column}_{k}",
                        work[row, column] - factors[row, k] * work[k, column],
                    )
        return cls(program, columns, factors)

    def solved(self, label: str, right: Sequence[sp.Expr]) -> dict[str, sp.Expr]:
        """Return the solution of ``A_d x = right``, by the names of the eliminated coordinates."""
        left = {
            d: self.program.define(f"{label}_{d}", dot(column, right))
            for d, column in self.columns.items()
        }
        return solved(self.program, self.factors, left, label, f"{label}_of_{{}}")
