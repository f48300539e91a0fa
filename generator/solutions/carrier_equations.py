"""The equations of a body that only rods hold, all together, and the iteration that solves them.

The pose of the body has n unknowns: three of its orientation, where it also hangs at a point of
known motion, or all six; and n rods hold it. With A_i where rod i starts, r_i the point of the body
where it ends, seen from the origin of the body axes, and gap_i the way from A_i to that point,

    g_i = (gap_i^2 - l_i^2) s_i / 2 = 0,    s_i = 1 / (l_i c),

l_i at the design position and c being lengths of the mechanism, so that g has no unit. Three such
equations lead to a polynomial of degree 8, six to one of degree 40.

In body axes a small turn theta of the body, and a small shift c sigma, change g_i by

    (r_i x gap_i) s_i . theta  +  gap_i c s_i . sigma:

these are the rows of J. The same matrix gives velocities and accelerations (`carrier`).

The attitude is given by Rodrigues' parameters u, relative to the design position and rational:
``R = 1 + 2 (u~ + u~ u~) / (1 + u^2)``. A turn theta in body axes is composed with it by
``(u + w + u x w) / (1 - u . w)``, where w = theta / 2 for the small ones of an iteration.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..iteration import CROSSED, SIDE, Block, adjugate, crossed, limited, named, times
from ..placement import Axes, from_axes, to_axes
from ..vectors import UNIT_X, UNIT_Y, UNIT_Z, ZERO, Vector

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ..program import Program


@dataclass(frozen=True)
class Pose:
    """Body axes, and how far their origin has come from the base, in work axes."""

    axes: Axes
    shift: Vector


@dataclass(frozen=True)
class RodEquation:
    """The equation of one rod.

    Attributes
    ----------
    anchor
        A_i, from the base: the known point or, without one, where the origin of the body axes is
        at the design position (work axes).
    end
        r_i (body axes).
    squared, scale
        l_i^2 and s_i.
    size
        c, where the body has no known point: the equation then has six unknowns.
    """

    anchor: Vector
    end: Vector
    squared: sp.Expr
    scale: sp.Expr
    size: sp.Expr | None

    @property
    def values(self) -> list[sp.Expr]:
        """What the iteration reads of it, in order."""
        return [*self.anchor, *self.end, self.squared, self.scale]

    def gap(self, pose: Pose) -> Vector:
        """Return the way from the start of the rod to its end, in body axes."""
        return self.end - to_axes(pose.axes, self.anchor - pose.shift)

    def misfit(self, gap: Vector) -> sp.Expr:
        """Return g_i."""
        return (gap.dot(gap) - self.squared) * (self.scale / 2)

    def row(self, gap: Vector) -> list[sp.Expr]:
        """Return the row of J."""
        turn = self.end.cross(gap) * self.scale
        return [*turn] if self.size is None else [*turn, *(gap * (self.scale * self.size))]


def rotation(program: Program, name: str, u: Vector) -> Axes:
    """Append the body axes of Rodrigues' parameters."""
    half = program.define(f"{name}_half", 2 / (1 + u.dot(u)))
    v = program.vector(f"{name}_scaled", u * half, "123")
    columns = (
        e + v.cross(e) + u * v.dot(e) - e * v.dot(u)  # v~ u~ e = u (v . e) - e (v . u)
        for e in (UNIT_X, UNIT_Y, UNIT_Z)
    )
    return program.axes((f"{name}_x", f"{name}_y", f"{name}_z"), columns)


def turned(axes: Axes, turn: Vector) -> Axes:
    """Return axes after a turn so small that its square vanishes; it is given along the axes."""
    x, y, z = axes
    return (
        x + y * turn.z - z * turn.y,
        y + z * turn.x - x * turn.z,
        z + x * turn.y - y * turn.x,
    )


def split(values: Sequence[sp.Expr]) -> tuple[Vector, Vector]:
    """Return turn and shift from three values or six."""
    return Vector(*values[:3]), Vector(*values[3:]) if values[3:] else ZERO


def block(body: str, rods: Sequence[str], *, pinned: bool) -> Block:
    """Return the iteration that finds the pose of a body held by some rods.

    Its results are the unknowns (u, and sigma where the body has no known point), `CROSSED`, the
    adjugate of J, row by row, and its determinant.
    """
    equations = [_formal(f"{i}", pinned=pinned) for i in range(1, len(rods) + 1)]
    unknowns = [sp.Symbol(f"u_{a}") for a in "xyz"]
    unknowns += [] if pinned else [sp.Symbol(f"shift_{a}") for a in "xyz"]

    def derive(
        program: Program,
    ) -> tuple[Mapping[str, sp.Expr], Sequence[sp.Expr], sp.Expr]:
        u, sigma = split(unknowns)
        program.section("pose of this iteration")
        axes = rotation(program, "body", u)
        pose = Pose(axes, program.vector("moved", sigma * (1 if pinned else _SIZE)))
        program.section("what the rods leave of their lengths, and how that changes with the pose")
        gaps = [program.vector(f"gap_{i}", e.gap(pose), "123") for i, e in enumerate(equations, 1)]
        left = [
            program.define(f"misfit_{i}", e.misfit(gap))
            for i, (e, gap) in enumerate(zip(equations, gaps, strict=True), 1)
        ]
        rows = [e.row(gap) for e, gap in zip(equations, gaps, strict=True)]
        inverse, scale = adjugate(program, named(program, "row", rows))
        program.section("next pose")
        step, change = limited(program, [-c / scale for c in times(inverse, left)])
        turn, way = split([program.define(f"step_{i}", s) for i, s in enumerate(step, 1)])
        following = [*_composed(program, u, turn)]
        following += [] if pinned else [*(sigma + from_axes(axes, way))]
        following.append(crossed(scale))
        results = {str(x): x for x in unknowns}
        results |= {str(CROSSED): CROSSED}
        results |= {
            f"adjugate_{i}{j}": entry
            for i, row in enumerate(inverse, 1)
            for j, entry in enumerate(row, 1)
        }
        return results | {"determinant": scale}, following, change

    return Block.of(
        f"pose_of_{body}",
        f"the pose of {body}, held by {', '.join(rods)}",
        [*(x for e in equations for x in e.values), *([] if pinned else [_SIZE]), SIDE],
        [*unknowns, CROSSED],
        derive,
    )


_SIZE = sp.Symbol("size")


def _formal(label: str, *, pinned: bool) -> RodEquation:
    """Return an equation in the names that the block has for its arguments."""

    def vector(name: str, suffixes: str) -> Vector:
        return Vector(*(sp.Symbol(f"{name}_{label}_{s}") for s in suffixes))

    return RodEquation(
        vector("anchor", "xyz"),
        vector("end", "123"),
        sp.Symbol(f"squared_{label}"),
        sp.Symbol(f"scale_{label}"),
        None if pinned else _SIZE,
    )


def _composed(program: Program, u: Vector, turn: Vector) -> Vector:
    """Return the parameters of a rotation, followed by a turn in its own axes."""
    w = program.vector("half_turn", turn * sp.Rational(1, 2), "123")
    below = program.define("composed", 1 / (1 - u.dot(w)))
    composed: Vector = (u + w + u.cross(w)) * below
    return composed
