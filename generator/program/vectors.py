"""Vectors of three symbolic components.

A `Vector` does not contain the axes that its components refer to. By convention, positions are in
the *work axes* (ground-fixed, see `kinematics.Kinematics`), and twists are in the axes of the body
they belong to.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import sympy as sp

from .composing import composed

if TYPE_CHECKING:
    from collections.abc import Iterator


def product(a: Any, b: Any) -> Any:
    """Return a product of expressions or numbers; with zero it is zero.

    SymPy would first find out whether the other factor is finite, from all of its parts.
    """
    if a is sp.S.Zero or b is sp.S.Zero:
        return sp.S.Zero
    return composed(sp.Mul, (sp.sympify(a), sp.sympify(b)))


@dataclass(frozen=True)
class Vector:
    """Three components along some right-handed axes."""

    x: sp.Expr
    y: sp.Expr
    z: sp.Expr

    @classmethod
    def of(cls, x: Any, y: Any, z: Any) -> Vector:
        """Return a vector of numbers or expressions."""
        return cls(sp.sympify(x), sp.sympify(y), sp.sympify(z))

    def __iter__(self) -> Iterator[sp.Expr]:
        return iter((self.x, self.y, self.z))

    def __add__(self, other: Vector) -> Vector:
        return Vector(self.x + other.x, self.y + other.y, self.z + other.z)

    def __sub__(self, other: Vector) -> Vector:
        return Vector(self.x - other.x, self.y - other.y, self.z - other.z)

    def __neg__(self) -> Vector:
        return Vector(-self.x, -self.y, -self.z)

    def __mul__(self, factor: Any) -> Vector:
        return Vector(*(product(component, factor) for component in self))

    def dot(self, other: Vector) -> sp.Expr:
        """Return the scalar product."""
        return product(self.x, other.x) + product(self.y, other.y) + product(self.z, other.z)

    def cross(self, other: Vector) -> Vector:
        """Return the vector product ``self x other``."""
        return Vector(
            product(self.y, other.z) - product(self.z, other.y),
            product(self.z, other.x) - product(self.x, other.z),
            product(self.x, other.y) - product(self.y, other.x),
        )

    @property
    def is_zero(self) -> bool:
        """Return whether all components are literally zero."""
        return all(component == 0 for component in self)


ZERO = Vector.of(0, 0, 0)
UNIT_X = Vector.of(1, 0, 0)
UNIT_Y = Vector.of(0, 1, 0)
UNIT_Z = Vector.of(0, 0, 1)

Axes = tuple[Vector, Vector, Vector]
IDENTITY: Axes = (UNIT_X, UNIT_Y, UNIT_Z)


def to_axes(axes: Axes, v: Vector) -> Vector:
    """Return the components of a vector along three orthonormal axes."""
    return Vector(*(v.dot(axis) for axis in axes))


def from_axes(axes: Axes, v: Vector) -> Vector:
    """Return a vector from its components along three axes, in the axes that these are given in."""
    x, y, z = axes
    return x * v.x + y * v.y + z * v.z


@dataclass(frozen=True)
class Twist:
    """Angular velocity and velocity of the body's origin, both in body axes.

    The same pair also holds accelerations: angular acceleration and the *inertial* acceleration of
    the origin, also in body axes.
    """

    angular: Vector
    linear: Vector

    def __add__(self, other: Twist) -> Twist:
        return Twist(self.angular + other.angular, self.linear + other.linear)

    def __mul__(self, factor: Any) -> Twist:
        return Twist(self.angular * factor, self.linear * factor)

    def dot(self, other: Twist) -> sp.Expr:
        """Return the power of a wrench, or of a momentum, on the twist."""
        return self.angular.dot(other.angular) + self.linear.dot(other.linear)

    @property
    def is_zero(self) -> bool:
        """Return whether the body does not move at all."""
        return self.angular.is_zero and self.linear.is_zero


NO_TWIST = Twist(ZERO, ZERO)


# Elements of a symmetric tensor, in the order of `SymmetricTensor`.
ELEMENTS = ("xx", "yy", "zz", "xy", "xz", "yz")


@dataclass(frozen=True)
class SymmetricTensor:
    """A symmetric 3 x 3 tensor, such as an inertia, in some axes."""

    xx: sp.Expr
    yy: sp.Expr
    zz: sp.Expr
    xy: sp.Expr
    xz: sp.Expr
    yz: sp.Expr

    @classmethod
    def zero(cls) -> SymmetricTensor:
        """Return the null tensor."""
        return cls(*([sp.Integer(0)] * 6))

    @classmethod
    def of_point_mass(cls, mass: sp.Expr, at: Vector) -> SymmetricTensor:
        """Return ``mass (|at|^2 1 - at at^T)``, the inertia of a point mass about the origin."""
        x, y, z = at
        return cls(
            mass * (y * y + z * z),
            mass * (x * x + z * z),
            mass * (x * x + y * y),
            -mass * x * y,
            -mass * x * z,
            -mass * y * z,
        )

    @classmethod
    def of_pair(cls, a: Vector, b: Vector) -> SymmetricTensor:
        """Return ``a b^T + b a^T``."""
        return cls(
            2 * a.x * b.x,
            2 * a.y * b.y,
            2 * a.z * b.z,
            a.x * b.y + a.y * b.x,
            a.x * b.z + a.z * b.x,
            a.y * b.z + a.z * b.y,
        )

    @classmethod
    def transverse(cls, moment: sp.Expr, axis: Vector) -> SymmetricTensor:
        """Return ``moment (1 - axis axis^T)`` for a unit axis."""
        return cls.of_point_mass(moment, axis)

    def __iter__(self) -> Iterator[sp.Expr]:
        return iter((self.xx, self.yy, self.zz, self.xy, self.xz, self.yz))

    def __add__(self, other: SymmetricTensor) -> SymmetricTensor:
        return SymmetricTensor(*(a + b for a, b in zip(self, other, strict=True)))

    def __mul__(self, factor: Any) -> SymmetricTensor:
        return SymmetricTensor(*(product(element, factor) for element in self))

    @property
    def columns(self) -> tuple[Vector, Vector, Vector]:
        """Its columns, which are also its rows."""
        return (
            Vector(self.xx, self.xy, self.xz),
            Vector(self.xy, self.yy, self.yz),
            Vector(self.xz, self.yz, self.zz),
        )

    @property
    def opposite(self) -> SymmetricTensor:
        """The trace less the tensor: the inertia, of second moments."""
        xx, yy, zz, xy, xz, yz = self
        return SymmetricTensor(yy + zz, xx + zz, xx + yy, -xy, -xz, -yz)

    def __matmul__(self, v: Vector) -> Vector:
        return Vector(*(column.dot(v) for column in self.columns))

    def in_axes(self, axes: Axes) -> SymmetricTensor:
        """Return the components along other unit axes, given in the present ones."""
        x, y, z = axes
        along_x, along_y, along_z = (self @ axis for axis in axes)
        return SymmetricTensor(
            x.dot(along_x),
            y.dot(along_y),
            z.dot(along_z),
            x.dot(along_y),
            x.dot(along_z),
            y.dot(along_z),
        )
