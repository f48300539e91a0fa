"""What joints and rods demand of two bodies, as equations of their positions and motions.

Every joint that closes a loop gives what it leaves in common, every rod its length:

    Coincident      d . (p2 - p1) / c = 0                 hinge, cross, ball joint (in a plane too)
    Guided          d1 . (p2 - p1) / c = 0                guide: across it; d1 turns with the first
    Perpendicular   a1 . b2 = 0                           hinge, cross, guide: a right angle
    FixedDistance   (|p2 - p1|^2 - l^2) / (2 l c) = 0     rod

Both bodies are seen from the same axes, which may be any. The rate of an equation is linear in
the motions of its two bodies: with a unit rate of an unknown as that motion it is an element of the
Jacobian, with what else moves it is the right side. A factor like 1 / c is named ``scale``; it is
one where nothing is made free of units.
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
    """Velocities of a body, and accelerations where they are asked for."""

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
        """Return the velocity of what of the body is at a point."""
        return self.velocity + self.omega.cross(point - self.at)

    def acceleration_of(self, point: Vector) -> Vector:
        """Return the acceleration of what of the body is at a point."""
        arm = point - self.at
        centripetal = self.omega.cross(self.omega.cross(arm))
        return self.acceleration + self.alpha.cross(arm) + centripetal


STILL = Moving()


class Constraint(ABC):
    """An equation of two bodies, at some position of both."""

    @abstractmethod
    def residual(self) -> sp.Expr:
        """Return what the position leaves of the equation."""

    @abstractmethod
    def rate(self, one: Moving, two: Moving) -> sp.Expr:
        """Return how fast the residual changes with the motions of both bodies.

        Parameters
        ----------
        one, two
            Velocities of the first and the second body.
        """

    @abstractmethod
    def acceleration(self, one: Moving, two: Moving) -> sp.Expr:
        """Return the second derivative of the residual, where residual and rate are zero.

        Parameters
        ----------
        one, two
            Velocities and accelerations of the first and the second body.
        """


@dataclass(frozen=True)
class Coincident(Constraint):
    """Two points meet, along a direction."""

    p1: Vector
    p2: Vector
    along: Vector
    scale: sp.Expr = sp.S.One

    def residual(self) -> sp.Expr:
        """Return how far they are apart, along the direction."""
        return self.along.dot(self.p2 - self.p1) * self.scale

    def rate(self, one: Moving, two: Moving) -> sp.Expr:
        """Return the velocity of the second point as seen from the first, along the direction."""
        return self.along.dot(two.velocity_of(self.p2) - one.velocity_of(self.p1)) * self.scale

    def acceleration(self, one: Moving, two: Moving) -> sp.Expr:
        """Return the same of the accelerations."""
        pull = two.acceleration_of(self.p2) - one.acceleration_of(self.p1)
        return self.along.dot(pull) * self.scale


@dataclass(frozen=True)
class Guided(Coincident):
    """A point stays on the guide of another body, along a direction of that body across it.

    The direction turns with the first body, and the second one slides as that sees it.

    Attributes
    ----------
    guide
        The direction of the guide where that is one of the axes: the point slides along it alone,
        which the zeros of the others make a shorter formula.
    """

    guide: Vector | None = None

    def rate(self, one: Moving, two: Moving) -> sp.Expr:
        """Return how fast the point leaves the guide, along the direction."""
        return self.along.dot(self._slip(one, two)) * self.scale

    def acceleration(self, one: Moving, two: Moving) -> sp.Expr:
        """Return the same of its acceleration as the first body sees it."""
        pull = two.acceleration_of(self.p2) - one.acceleration_of(self.p2)
        slip = self._slip(one, two)
        if self.guide is not None:
            slip = self.guide * self.guide.dot(slip)
        return self.along.dot(pull - one.omega.cross(slip) * 2) * self.scale

    def _slip(self, one: Moving, two: Moving) -> Vector:
        """Return the velocity of the point as the first body sees it."""
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
        """Return the rate of that."""
        return (two.omega - one.omega).dot(self.b2.cross(self.a1))

    def acceleration(self, one: Moving, two: Moving) -> sp.Expr:
        """Return the second derivative of that."""
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
        """Return the rate of that."""
        return self.rod_vector.dot(self._rate(one, two)) * self.scale

    def acceleration(self, one: Moving, two: Moving) -> sp.Expr:
        """Return the second derivative of that."""
        rate = self._rate(one, two)
        pull = two.acceleration_of(self.p2) - one.acceleration_of(self.p1)
        return (self.rod_vector.dot(pull) + rate.dot(rate)) * self.scale

    def _rate(self, one: Moving, two: Moving) -> Vector:
        return two.velocity_of(self.p2) - one.velocity_of(self.p1)
