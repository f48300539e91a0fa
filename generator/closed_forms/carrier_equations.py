"""Equations of a body that several rods hold together, and the iteration that solves them.

The pose of the body has n unknowns: three of its orientation, where it also hangs at a point of
known motion, or all six; and n rods hold it. With A_i the anchor of rod i, r_i the point of the
body where it ends, relative to the origin of the body axes, and gap_i the vector from A_i to that
point,

    g_i = (gap_i^2 - l_i^2) s_i / 2 = 0,    s_i = 1 / (l_i c),

l_i at the design position and c being lengths of the mechanism, so that g has no unit. Three such
equations lead to a polynomial of degree 8, six to one of degree 40.

In body axes a small turn theta of the body, and a small shift c sigma, change g_i by

    (r_i x gap_i) s_i . theta  +  gap_i c s_i . sigma:

these are the rows of J. The same matrix gives velocities and accelerations (`carrier`).

The attitude is given by Rodrigues' parameters u, relative to the design position and rational: ``R
= 1 + 2 (u~ + u~ u~) / (1 + u^2)``. A turn theta in body axes is composed with it by ``(u + w + u x
w) / (1 - u . w)``, where w = theta / 2 for the small ones of an iteration.

Sources: the degrees of both polynomials are those of M. Raghavan, The Stewart platform of general
geometry has 40 configurations, Journal of Mechanical Design 115 (1993), and of C. Innocenti and V.
Parenti-Castelli, Echelon form solution of direct kinematics for the general fully-parallel
spherical wrist, Mechanism and Machine Theory 28 (1993); Rodrigues' parameters are those of O.
Bottema and B. Roth, Theoretical Kinematics, North-Holland, 1979.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import sympy as sp

from ..program.newton import IterationDerivation, IterationResult
from ..program.vectors import IDENTITY, ZERO, Axes, Twist, Vector, from_axes, to_axes
from .constraints import STILL, FixedDistance, Moving

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from ..kinematics.hinge_angles import DrivenCoordinate
    from ..program.function import Estimate, IterationBlock
    from ..program.program import Program


@dataclass(frozen=True)
class Pose:
    """Body axes, and the displacement of their origin from the base, in work axes."""

    axes: Axes
    shift: Vector


@dataclass(frozen=True)
class RodEquation:
    """The equation of one rod."""

    # A_i, relative to the base: the known point or, without one, the origin of the body axes at the
    # design position (work axes)
    anchor: Vector
    end: Vector  # r_i (body axes)
    # l_i^2 and s_i
    squared: sp.Expr
    scale: sp.Expr
    size: sp.Expr | None  # c, where the body has no known point: the equation then has six unknowns

    @property
    def moving(self) -> list[sp.Expr]:
        """Its components that may vary."""
        return [*self.anchor, self.squared]

    def rod_vector(self, pose: Pose) -> Vector:
        """Return the vector from the anchor of the rod to its end, in body axes."""
        return self.end - to_axes(pose.axes, self.anchor - pose.shift)

    def length(self, rod_vector: Vector) -> FixedDistance:
        """Return the equation, for the vector along the rod."""
        start = self.end - rod_vector
        return FixedDistance(rod_vector, start, self.end, self.squared, self.scale)

    def row(self, rod_vector: Vector) -> list[sp.Expr]:
        """Return the row of J."""
        length = self.length(rod_vector)
        return [length.rate(STILL, Moving.of(screw)) for screw in screws(self.size)]


def screws(size: sp.Expr | None) -> list[Twist]:
    """Return the screw of each unknown: turns about the body's axes, and shifts along them."""
    shifts = [] if size is None else [Twist(ZERO, e * size) for e in IDENTITY]
    return [Twist(e, ZERO) for e in IDENTITY] + shifts


def rotation(program: Program, name: str, u: Vector) -> Axes:
    """Append the body axes of Rodrigues' parameters u; the name begins those of the steps."""
    half = program.define(f"{name}_half", 2 / (1 + u.dot(u)))
    v = program.vector(f"{name}_scaled", u * half, "123")
    columns = (
        e + v.cross(e) + u * v.dot(e) - e * v.dot(u)  # v~ u~ e = u (v . e) - e (v . u)
        for e in IDENTITY
    )
    return program.axes((f"{name}_x", f"{name}_y", f"{name}_z"), columns)


def turned(axes: Axes, turn: Vector) -> Axes:
    """Return axes after an infinitesimal rotation, a vector along the same axes [rad]."""
    x, y, z = axes
    return (x + y * turn.z - z * turn.y, y + z * turn.x - x * turn.z, z + x * turn.y - y * turn.x)


def split(values: Sequence[sp.Expr]) -> tuple[Vector, Vector]:
    """Return turn and shift from three values or six."""
    return Vector(*values[:3]), Vector(*values[3:]) if values[3:] else ZERO


def block(
    program: Program,
    body: str,
    rods: Mapping[str, RodEquation],
    size: sp.Expr,
    driven: Iterable[DrivenCoordinate],
) -> IterationBlock:
    """Return the iteration that finds the pose of a body held by rods (`IterationDerivation`).

    `program` is that of the caller, `size` the length c of the equations of the rods.
    """
    name = f"pose_of_{body}"
    if name in program.constants.blocks:
        return program.constants.blocks[name]
    along = ((d.symbol, d.start, d.unit(size), d.turns) for d in driven)
    derivation = IterationDerivation(program, along)
    pinned = all(rod.size is None for rod in rods.values())

    def derive(own: Program, estimate: Estimate) -> IterationResult:
        own.section("bodies placed before, at this stage")
        equations = [
            replace(
                rod,
                anchor=Vector(*derivation.repeated(rod.anchor)),
                squared=derivation.repeated([rod.squared])[0],
            )
            for rod in rods.values()
        ]
        own.section("pose of this iteration")
        (u, sigma), (turn, way) = split(estimate.base), split(estimate.step)
        before = rotation(own, "before", u)
        u = own.vector("turn", _composed(own, u, turn))
        axes = rotation(own, "body", u)
        sigma = own.vector("shift", sigma + from_axes(before, way))
        pose = Pose(axes, own.vector("moved", sigma * size))
        own.section("residuals of the rods' lengths")
        rod_vectors = [
            own.vector(f"rod_vector_{i}", e.rod_vector(pose), "123")
            for i, e in enumerate(equations, 1)
        ]
        left = [
            own.define(f"residual_{i}", e.length(rod_vector).residual())
            for i, (e, rod_vector) in enumerate(zip(equations, rod_vectors, strict=True), 1)
        ]
        rows = [e.row(rod_vector) for e, rod_vector in zip(equations, rod_vectors, strict=True)]
        return IterationResult(
            [*u, *([] if pinned else sigma)], left, rows, u.dot(u) + sigma.dot(sigma)
        )

    unknowns = [f"{kind}_{a}" for kind in ("turn", "shift")[: 1 if pinned else 2] for a in "xyz"]
    found = derivation.block(
        name, f"the pose of {body}, held by {', '.join(rods)}", unknowns, len(rods), derive
    )
    program.constants.blocks[name] = found
    return found


def _composed(program: Program, u: Vector, turn: Vector) -> Vector:
    """Return the parameters of a rotation, followed by a turn in its own axes."""
    w = program.vector("half_turn", turn * sp.Rational(1, 2), "123")
    below = program.define("composed", 1 / (1 - u.dot(w)))
    return (u + w + u.cross(w)) * below
