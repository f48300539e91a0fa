"""Constraints of joints and rods between two bodies, as equations of their positions and motions.

Every joint that closes a loop has the equations of its constraint, every rod that of its length:

    Coincident      d . (p2 - p1) / c = 0                 hinge, cross, ball joint (in a plane too)
    Guided          d1 . (p2 - p1) / c = 0                guide: across it; d1 turns with the first
    Perpendicular   a1 . b2 = 0                           hinge, cross, guide: a right angle
    FixedDistance   (|p2 - p1|^2 - l^2) / (2 l c) = 0     rod

Both bodies are described in the same axes, which may be any. The rate of an equation is linear in
the motions of its two bodies: with a unit rate of an unknown as that motion it is an element of the
Jacobian, with the other motions it is the right side. A factor like 1 / c is named ``scale``; it is
one where equations keep their units.

Source: the basic constraints of P. E. Nikravesh, Computer-Aided Analysis of Mechanical Systems,
Prentice Hall, 1988.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..program.vectors import ZERO, Twist, Vector

if TYPE_CHECKING:
    from typing import Self


@dataclass(frozen=True)
class Moving:
    """Velocities of a body, and accelerations where they are needed."""

    at: Vector = ZERO
    omega: Vector = ZERO
    velocity: Vector = ZERO
    alpha: Vector = ZERO
    acceleration: Vector = ZERO

    @classmethod
    def of(cls, twist: Twist) -> Self:
        """Return the motion of a body in axes at its origin."""
        return cls(ZERO, twist.angular, twist.linear)

    def velocity_of(self, point: Vector) -> Vector:
        """Return the velocity of the body at a point."""
        return self.velocity + self.omega.cross(point - self.at)

    def acceleration_of(self, point: Vector) -> Vector:
        """Return the acceleration of the body at a point."""
        arm = point - self.at
        centripetal = self.omega.cross(self.omega.cross(arm))
        return self.acceleration + self.alpha.cross(arm) + centripetal


STILL = Moving()


class Constraint(ABC):
    """An equation of two bodies, at some position of both."""

    @abstractmethod
    def residual(self) -> sp.Expr:
        """Return the residual at the position."""

    @abstractmethod
    def rate(self, one: Moving, two: Moving) -> sp.Expr:
        """Return the rate of the residual with the velocities of both bodies."""

    @abstractmethod
    def acceleration(self, one: Moving, two: Moving) -> sp.Expr:
        """Return the second derivative of the residual, where residual and rate are zero."""


@dataclass(frozen=True)
class Coincident(Constraint):
    """Two points coincide, along a direction."""

    p1: Vector
    p2: Vector
    along: Vector
    scale: sp.Expr = sp.S.One

    def residual(self) -> sp.Expr:
        return self.along.dot(self.p2 - self.p1) * self.scale

    def rate(self, one: Moving, two: Moving) -> sp.Expr:
        """Return the velocity of the second point relative to the first, along the direction."""
        return self.along.dot(two.velocity_of(self.p2) - one.velocity_of(self.p1)) * self.scale

    def acceleration(self, one: Moving, two: Moving) -> sp.Expr:
        """Return the relative acceleration, along the direction."""
        pull = two.acceleration_of(self.p2) - one.acceleration_of(self.p1)
        return self.along.dot(pull) * self.scale


@dataclass(frozen=True)
class Guided(Coincident):
    """A point stays on the guide of another body, along a direction of that body across it.

    The direction turns with the first body, relative to which the second one slides.
    """

    # direction of the guide where that is one of the axes: the formula is shorter by the zeros of
    # the others
    guide: Vector | None = None

    def rate(self, one: Moving, two: Moving) -> sp.Expr:
        """Return the velocity of the point relative to the guide, along the direction."""
        return self.along.dot(self._slip(one, two)) * self.scale

    def acceleration(self, one: Moving, two: Moving) -> sp.Expr:
        pull = two.acceleration_of(self.p2) - one.acceleration_of(self.p2)
        slip = self._slip(one, two)
        if self.guide is not None:
            slip = self.guide * self.guide.dot(slip)
        return self.along.dot(pull - one.omega.cross(slip) * 2) * self.scale

    def _slip(self, one: Moving, two: Moving) -> Vector:
        """Return the velocity of the point relative to the first body."""
        return two.velocity_of(self.p2) - one.velocity_of(self.p2)


@dataclass(frozen=True)
class Perpendicular(Constraint):
    """A direction of the first body stays at a right angle to one of the second."""

    a1: Vector
    b2: Vector

    def residual(self) -> sp.Expr:
        """Return the cosine of the angle between them."""
        return self.a1.dot(self.b2)

    def rate(self, one: Moving, two: Moving) -> sp.Expr:
        return (two.omega - one.omega).dot(self.b2.cross(self.a1))

    def acceleration(self, one: Moving, two: Moving) -> sp.Expr:
        a_rate, b_rate = one.omega.cross(self.a1), two.omega.cross(self.b2)
        changing = b_rate.cross(self.a1) + self.b2.cross(a_rate)
        relative = (two.omega - one.omega).dot(changing)
        return relative + (two.alpha - one.alpha).dot(self.b2.cross(self.a1))


@dataclass(frozen=True)
class FixedDistance(Constraint):
    """A rod from p1 to p2 keeps its length."""

    rod_vector: Vector
    p1: Vector
    p2: Vector
    squared: sp.Expr
    scale: sp.Expr = sp.S.One

    def residual(self) -> sp.Expr:
        """Return half the square of the distance, less that of the length."""
        return (self.rod_vector.dot(self.rod_vector) - self.squared) * (self.scale / 2)

    def rate(self, one: Moving, two: Moving) -> sp.Expr:
        return self.rod_vector.dot(self._rate(one, two)) * self.scale

    def acceleration(self, one: Moving, two: Moving) -> sp.Expr:
        rate = self._rate(one, two)
        pull = two.acceleration_of(self.p2) - one.acceleration_of(self.p1)
        return (self.rod_vector.dot(pull) + rate.dot(rate)) * self.scale

    def _rate(self, one: Moving, two: Moving) -> Vector:
        return two.velocity_of(self.p2) - one.velocity_of(self.p1)
