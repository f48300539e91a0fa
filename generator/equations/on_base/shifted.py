"""A body on a base that does not turn: as on the ground, in its own axes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...program.vectors import ZERO, SymmetricTensor, Twist, Vector, from_axes
from .flow import Flow

if TYPE_CHECKING:
    import sympy as sp

    from ...kinematics.carried import Carried
    from ..inertia import SpatialInertia


@dataclass(frozen=True)
class PartialTwist:
    """Motion of a body with a coordinate, or at all rates: its twist, and its momentum."""

    twist: Twist
    momentum: Twist
    flow: Flow

    def __mul__(self, rate: sp.Expr) -> PartialTwist:
        return PartialTwist(self.twist * rate, self.momentum * rate, self.flow * rate)


@dataclass(frozen=True)
class InertiaForce:
    """Couple and force on a body, in its axes; and the force on the base, in those of the base."""

    own: Twist
    wrench: Twist


class Shifted:
    """A body on a base that does not turn.

    If the base only slides, no couple and no second moment are needed. `inertia` is that about its
    origin, in its axes; `first` is ``∫ r dm``, and `second`, ``∫ r r^T dm``, is left out.
    """

    second = SymmetricTensor.zero()

    def __init__(self, carried: Carried, inertia: SpatialInertia) -> None:
        self._carried, self._inertia = carried, inertia
        self._placed, self._part = carried.relative, carried.part
        self._name, self._program = self._placed.body, carried.part.program
        self.first = ZERO

    @staticmethod
    def fits(carried: Carried) -> bool:
        """Return whether the base does not turn."""
        return not carried.base.turns

    def _momentum(self, what: str, twist: Twist) -> Twist:
        inertia = self._inertia
        return Twist(
            self._program.vector(f"{self._name}_spin_{what}", inertia.spin_momentum(twist), "123"),
            self._program.vector(
                f"{self._name}_momentum_{what}", inertia.linear_momentum(twist), "123"
            ),
        )

    def column(self, k: str | None) -> PartialTwist:
        """Return its motion with a coordinate, or at all rates."""
        own = self._part.total(self._placed) if k is None else self._placed.motion[k]
        momentum = self._momentum("now" if k is None else k, own)
        return PartialTwist(own, momentum, Flow(from_axes(self._carried.axes, momentum.linear)))

    def taken(self, now: PartialTwist) -> InertiaForce:
        """Return the inertia forces of its own motion, at all rates."""
        bias, inertia, omega = self._placed.bias(), self._inertia, now.twist.angular
        whirl = self._program.vector(f"{self._name}_whirl", omega.cross(inertia.moment), "123")
        force = inertia.linear_momentum(bias) + omega.cross(whirl)
        couple = inertia.spin_momentum(bias)
        if len(self._placed.motion) > 1:  # otherwise a couple across omega does no work
            spin = self._program.vector(f"{self._name}_turning", inertia.tensor @ omega, "123")
            couple += omega.cross(spin)
        own = Twist(
            self._program.vector(f"{self._name}_couple_own", couple, "123"),
            self._program.vector(f"{self._name}_force_own", force, "123"),
        )
        return InertiaForce(own, Twist(ZERO, from_axes(self._carried.axes, own.linear)))

    @staticmethod
    def work(column: PartialTwist, taken: InertiaForce) -> sp.Expr:
        """Return ``∫ r_k' . r'' dm``."""
        return column.twist.dot(taken.own)

    @staticmethod
    def energy(one: PartialTwist, other: PartialTwist) -> sp.Expr:
        """Return ``∫ r_k' . r_l' dm``."""
        return one.twist.dot(other.momentum)

    @staticmethod
    def across(now: PartialTwist, column: PartialTwist) -> Vector:
        """Return zero for ``∫ r' x r_k' dm``, which only a base that turns needs."""
        del now, column
        return ZERO
