"""Mass, first moment and inertia tensor of a body."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..program.floors import POSITIVE
from ..program.vectors import ELEMENTS, SymmetricTensor, Twist, Vector

if TYPE_CHECKING:
    from ..program.program import Program

NONE = sp.Integer(0)


@dataclass
class SpatialInertia:
    """Mass, first moment and inertia tensor about the body's origin, in body axes."""

    mass: sp.Expr
    moment: Vector
    tensor: SymmetricTensor

    @classmethod
    def none(cls) -> SpatialInertia:
        """Return the inertia of a massless body."""
        return cls(NONE, Vector.of(0, 0, 0), SymmetricTensor.zero())

    def __add__(self, other: SpatialInertia) -> SpatialInertia:
        return SpatialInertia(
            self.mass + other.mass, self.moment + other.moment, self.tensor + other.tensor
        )

    def add_point(self, mass: sp.Expr, at: Vector) -> None:
        """Add a point mass at a position relative to the origin."""
        self.mass += mass
        self.moment += at * mass
        self.tensor += SymmetricTensor.of_point_mass(mass, at)

    def linear_momentum(self, twist: Twist) -> Vector:
        """Return ``m v + omega x mc``."""
        return twist.linear * self.mass + twist.angular.cross(self.moment)

    @property
    def is_none(self) -> bool:
        """Whether there is no inertia at all."""
        return self.mass == 0 and self.moment.is_zero and all(e == 0 for e in self.tensor)

    def centred(self, program: Program, body: str) -> tuple[Vector, SymmetricTensor]:
        """Append the centre of mass and the tensor about it; the origin for a massless body."""
        # 1 / m, and zero where m is
        inverse = program.define(f"{body}_inverse_mass", self.mass / (self.mass**2 + POSITIVE))
        center = program.vector(f"{body}_center", self.moment * inverse, "123")
        moved = SymmetricTensor.of_point_mass(-self.mass, center)
        elements = zip(ELEMENTS, self.tensor + moved, strict=True)
        own = (program.define(f"{body}_own_inertia_{e}", v) for e, v in elements)
        return center, SymmetricTensor(*own)

    def spin_momentum(self, twist: Twist) -> Vector:
        """Return ``I omega + mc x v``."""
        return self.tensor @ twist.angular + self.moment.cross(twist.linear)
