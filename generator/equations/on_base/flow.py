"""Flow of mass on a base; tensors in its axes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import sympy as sp

from ...program.vectors import ELEMENTS, ZERO, SymmetricTensor, Twist, Vector

if TYPE_CHECKING:
    from ...program.program import Program

NONE = sp.Integer(0)
HALF = sp.Rational(1, 2)


@dataclass(frozen=True)
class Flow:
    """Flow of mass with a coordinate, or at all rates."""

    # `∫ r' dm` and `∫ r x r' dm`
    momentum: Vector = ZERO
    angular: Vector = ZERO
    second: SymmetricTensor = field(default_factory=SymmetricTensor.zero)  # rate of `∫ r r^T dm`

    def __add__(self, other: Flow) -> Flow:
        momentum, angular = self.momentum + other.momentum, self.angular + other.angular
        return Flow(momentum, angular, self.second + other.second)

    def __mul__(self, factor: sp.Expr) -> Flow:
        return Flow(self.momentum * factor, self.angular * factor, self.second * factor)

    def named(self, program: Program, name: str) -> Flow:
        """Append a step for each of its numbers; the name begins theirs."""
        return Flow(
            program.vector(f"{name}_momentum", self.momentum),
            program.vector(f"{name}_angular", self.angular),
            named(program, f"{name}_second", self.second),
        )

    @property
    def wrench(self) -> Twist:
        """Angular momentum, and momentum."""
        return Twist(self.angular, self.momentum)

    def coriolis(self, omega: Vector) -> Twist:
        """Return its Coriolis couple and force on a base that turns."""
        couple = self.second.opposite @ omega + omega.cross(self.angular)
        return Twist(couple, omega.cross(self.momentum) * 2)

    def centrifugal(self, squares: SymmetricTensor) -> sp.Expr:
        """Return its generalised force by `squares_of` the angular velocity of a turning base."""
        return sum((a * b for a, b in zip(self.second, squares, strict=True)), NONE)


def squares_of(program: Program, name: str, omega: Vector) -> SymmetricTensor:
    """Append ``w w^T - w^2 1`` of an angular velocity, with half of its diagonal."""
    x, y, z = (
        program.define(f"{name}_{e}_squared", w * w) for e, w in zip("xyz", omega, strict=True)
    )
    halves = (-HALF * y - HALF * z, -HALF * x - HALF * z, -HALF * x - HALF * y)
    across = (omega.x * omega.y, omega.x * omega.z, omega.y * omega.z)
    return named(program, f"{name}_squares", SymmetricTensor(*halves, *across))


def angular_of(columns: tuple[Vector, Vector, Vector]) -> Vector:
    """Return ``∫ r x r' dm`` from the columns of ``∫ r' r^T dm``."""
    x, y, z = columns
    return Vector(y.z - z.y, z.x - x.z, x.y - y.x)


def second_moments(inertia: SymmetricTensor) -> SymmetricTensor:
    """Return ``∫ r r^T dm`` of an inertia tensor: half of its trace less the tensor."""
    xx, yy, zz, xy, xz, yz = inertia
    x, y, z = HALF * xx, HALF * yy, HALF * zz
    return SymmetricTensor(y + z - x, x + z - y, x + y - z, -xy, -xz, -yz)


def named(program: Program, name: str, tensor: SymmetricTensor) -> SymmetricTensor:
    """Append a step for each element of a tensor; the name begins theirs."""
    return SymmetricTensor(
        *(program.define(f"{name}_{e}", v) for e, v in zip(ELEMENTS, tensor, strict=True))
    )
