"""A body that turns about a line fixed in a base: the arm of a suspension."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from ...program.vectors import ZERO, SymmetricTensor, Twist, Vector
from .flow import HALF, NONE, Flow, named, second_moments

if TYPE_CHECKING:
    import sympy as sp

    from ...kinematics.carried import Carried
    from ..inertia import SpatialInertia


@dataclass(frozen=True)
class Turning:
    """Turning rate of a body with a coordinate, or at all rates, and the flow of its mass."""

    rate: sp.Expr
    flow: Flow

    def __mul__(self, rate: sp.Expr) -> Turning:
        return Turning(self.rate * rate, self.flow * rate)


@dataclass(frozen=True)
class Slowed:
    """Its angular acceleration, and the inertia couple about O and force."""

    alpha: sp.Expr
    wrench: Twist


class Hinged:
    """A body on a hinge of a base; everything is in the axes of the base.

    With n the line, y0 and z0 across it, and x the angle, its axes are ``y = y0 cos x + z0 sin x``
    and ``z = z0 cos x - y0 sin x``. So all its sums are constants times sines and cosines, of x
    and, in the second moments, of 2 x. `inertia` is that about its origin on the line, in its axes;
    `first` and `second` are ``∫ r dm`` and ``∫ r r^T dm``.
    """

    def __init__(self, carried: Carried, inertia: SpatialInertia) -> None:
        self._placed, self._part = carried.relative, carried.part
        self._program = carried.part.program
        self._name = f"{self._placed.body}_on_{carried.base.body}"
        self._line, self._at, self._inertia = carried.axes[0], carried.arm, inertia
        self._seconds = second_moments(inertia.tensor)
        self._take_angle(carried)
        # no steps: the constants of all bodies are added to one
        along = self._at * self._inertia.mass + self._line * self._inertia.moment.x
        self.first = self._swing + self._vector("first_at_rest", along)
        (one, two), (three, four) = self._harmonics
        turning = one * self._cosine + two * self._sine
        turning += three * self._cosine_2 + four * self._sine_2
        self.second = self._second_at_rest + turning

    @staticmethod
    def fits(carried: Carried) -> bool:
        """Return whether the body's origin and the first of its axes are fixed in the base."""
        contains = carried.part.program.constants.contains
        return all(map(contains, (*carried.arm, *carried.axes[0])))

    def _vector(self, what: str, v: Vector) -> Vector:
        return self._program.vector(f"{self._name}_{what}", v)

    def _tensor(self, what: str, tensor: SymmetricTensor) -> SymmetricTensor:
        return named(self._program, f"{self._name}_{what}", tensor)

    def _take_angle(self, carried: Carried) -> None:
        """Define the angle, from where it is known or from where it is zero at design."""
        define, turn = self._program.define, self._placed.turn
        if turn is None:
            _, y0, z0 = (carried.part.to_ground(axis) for axis in self._placed.design_axes)
            cosine, sine = (carried.axes[1].dot(axis) for axis in (y0, z0))
        else:
            y0, z0 = (carried.part.to_ground(axis) for axis in turn.axes)
            cosine, sine = turn.cosine, turn.sine
        self._across = y0, z0
        self._cosine = c = define(f"{self._name}_cosine", cosine)
        self._sine = s = define(f"{self._name}_sine", sine)
        self._cosine_2 = define(f"{self._name}_cosine_2", c * c - s * s)
        self._sine_2 = define(f"{self._name}_sine_2", 2 * c * s)

    def _harmonic(self, what: str, y: sp.Expr, z: sp.Expr) -> tuple[Vector, Vector]:
        """Return u and v, so that ``y`` and ``z`` along its axes are ``u cos x + v sin x``."""
        y0, z0 = self._across
        return (
            self._vector(f"{what}_by_cosine", y0 * y + z0 * z),
            self._vector(f"{what}_by_sine", z0 * y - y0 * z),
        )

    @cached_property
    def _swings(self) -> tuple[Vector, Vector]:
        """Of the first moment across the line."""
        return self._harmonic("swing", self._inertia.moment.y, self._inertia.moment.z)

    @cached_property
    def _tilts(self) -> tuple[Vector, Vector]:
        """Of the second moments between the line and the directions across it."""
        return self._harmonic("tilt", self._seconds.xy, self._seconds.xz)

    @cached_property
    def _swing(self) -> Vector:
        """The first moment across the line."""
        u, v = self._swings
        return self._vector("swing", u * self._cosine + v * self._sine)

    @property
    def _second_at_rest(self) -> SymmetricTensor:
        pair, n, at = SymmetricTensor.of_pair, self._line, self._at
        mean = self._program.define(
            f"{self._name}_mean", HALF * self._seconds.yy + HALF * self._seconds.zz
        )
        own = pair(n, n) * (HALF * self._seconds.xx - HALF * mean)
        own += SymmetricTensor(mean, mean, mean, NONE, NONE, NONE)
        moved = pair(at, at) * (HALF * self._inertia.mass) + pair(at, n) * self._inertia.moment.x
        return self._tensor("second_at_rest", own + moved)

    @cached_property
    def _harmonics(self) -> tuple[tuple[SymmetricTensor, SymmetricTensor], ...]:
        """Of second moments: by cosine and sine of the angle, and of twice the angle."""
        pair, n, at = SymmetricTensor.of_pair, self._line, self._at
        once = (
            self._tensor(f"second_{i}", pair(at, swing) + pair(n, tilt))
            for i, swing, tilt in zip("12", self._swings, self._tilts, strict=True)
        )
        y0, z0 = self._across
        apart = HALF * self._seconds.yy - HALF * self._seconds.zz
        difference = pair(y0, y0) * HALF + pair(z0, z0) * -HALF
        product, mixed = pair(y0, z0), self._seconds.yz
        twice = (
            self._tensor("second_3", difference * apart + product * mixed),
            self._tensor("second_4", product * apart + difference * -mixed),
        )
        one, two = once
        return (one, two), twice

    @cached_property
    def _unit(self) -> Flow:
        """Flow of its mass per unit rate of its angle."""
        c, s = self._cosine, self._sine
        (one, two), (three, four) = self._harmonics
        rate = two * c + one * -s + four * 2 * self._cosine_2 + three * -2 * self._sine_2
        (u, v), (p, q) = self._swings, self._turns
        rest = self._vector("turn_at_rest", self._line * self._inertia.tensor.xx)
        return Flow(
            self._vector("flow", v * c - u * s),
            self._vector("angular", rest + p * c + q * s),
            self._tensor("rate", rate),
        )

    @cached_property
    def _turns(self) -> tuple[Vector, Vector]:
        """Of the angular momentum about O per unit rate of its angle."""
        (u, v), (p, q) = self._swings, self._tilts
        return (
            self._vector("turn_by_cosine", self._at.cross(v) - p),
            self._vector("turn_by_sine", -self._at.cross(u) - q),
        )

    def column(self, k: str | None) -> Turning:
        """Return its motion with a coordinate, or at all rates."""
        own = self._part.total(self._placed) if k is None else self._placed.motion[k]
        return Turning(own.angular.x, self._unit * own.angular.x)

    def taken(self, now: Turning) -> Slowed:
        """Return the inertia forces of its own motion, at all rates."""
        alpha = self._placed.bias().angular.x
        squared = self._program.define(f"{self._name}_rate_squared", now.rate * now.rate)
        p, q = self._turns
        change = self._vector("turn_change", q * self._cosine - p * self._sine)
        couple = change * squared + self._unit.angular * alpha
        return Slowed(alpha, Twist(couple, self._unit.momentum * alpha - self._swing * squared))

    def work(self, column: Turning, taken: Slowed) -> sp.Expr:
        """Return ``∫ r_k' . r'' dm``."""
        return self._inertia.tensor.xx * column.rate * taken.alpha

    def energy(self, one: Turning, other: Turning) -> sp.Expr:
        """Return ``∫ r_k' . r_l' dm``."""
        return self._inertia.tensor.xx * one.rate * other.rate

    @staticmethod
    def across(now: Turning, column: Turning) -> Vector:
        """Return ``∫ r' x r_k' dm``: zero, since both are about one line."""
        del now, column
        return ZERO
