"""A body with any motion on a base."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...program.vectors import SymmetricTensor, Twist, Vector, from_axes
from .flow import HALF, Flow, angular_of, named, second_moments

if TYPE_CHECKING:
    import sympy as sp

    from ...kinematics.carried import Carried
    from ...program.program import Program
    from ...program.vectors import Axes
    from ..inertia import SpatialInertia


@dataclass(frozen=True)
class PartialMotion:
    """Motion of a body on its base with a coordinate, or at all rates."""

    # of its centre of mass, and its angular velocity
    velocity: Vector
    omega: Vector
    spin: Vector  # angular momentum about the centre of mass
    flow: Flow  # about O

    def __mul__(self, rate: sp.Expr) -> PartialMotion:
        velocity, omega = self.velocity * rate, self.omega * rate
        return PartialMotion(velocity, omega, self.spin * rate, self.flow * rate)


@dataclass(frozen=True)
class InertiaWrench:
    """Inertia forces of a body's own motion, without accelerations of the coordinates."""

    turn: Vector  # couple about its centre of mass that does work
    wrench: Twist  # couple about O, and force


class MovingBody:
    """A body on a base; everything is in the axes of the base, about the centre of mass.

    `inertia` is that about its origin, in its axes; `first` and `second` are ``∫ r dm`` and ``∫ r
    r^T dm``.
    """

    def __init__(self, carried: Carried, inertia: SpatialInertia) -> None:
        self._carried, self._placed, self._part = carried, carried.relative, carried.part
        self._program = carried.part.program
        self._name = f"{self._placed.body}_on_{carried.base.body}"
        self._axes, self._mass = carried.axes, inertia.mass
        program, body = self._program, self._placed.body
        center, tensor = inertia.centred(program, body)
        self._center = self._rotated("center", center)
        self._at = self._vector("place", carried.arm + self._center)
        self._own = turned(program, f"{self._name}_own", second_moments(tensor), self._axes)
        self.first = self._vector("first", self._at * self._mass)
        x, y, z = (self.first * r for r in self._at)
        around = SymmetricTensor(x.x, y.y, z.z, x.y, x.z, y.z)
        self.second = named(program, f"{self._name}_second", self._own + around)

    def _vector(self, what: str, v: Vector) -> Vector:
        return self._program.vector(f"{self._name}_{what}", v)

    def _rotated(self, what: str, v: Vector) -> Vector:
        """Return a vector in the axes of the body in those of the base."""
        return self._vector(what, from_axes(self._axes, v))

    def column(self, k: str | None) -> PartialMotion:
        """Return its motion with a coordinate, or at all rates."""
        label = "now" if k is None else k
        own = self._part.total(self._placed) if k is None else self._placed.motion[k]
        omega = self._rotated(f"omega_{label}", own.angular)
        linear = self._carried.of_origin(k) + omega.cross(self._center)
        velocity = self._vector(f"velocity_{label}", linear)
        momentum = self._vector(f"momentum_{label}", velocity * self._mass)
        # the columns of ∫ r' r^T dm, about the centre of mass and about O
        x, y, z = (
            self._vector(f"turning_{label}_{j}", omega.cross(column))
            for j, column in zip("xyz", self._own.columns, strict=True)
        )
        spin = self._vector(f"spin_{label}", angular_of((x, y, z)))
        x, y, z = (
            self._vector(f"flow_{label}_{j}", momentum * r + column)
            for j, r, column in zip("xyz", self._at, (x, y, z), strict=True)
        )
        rate = SymmetricTensor(2 * x.x, 2 * y.y, 2 * z.z, x.y + y.x, x.z + z.x, y.z + z.y)
        flow = Flow(momentum, angular_of((x, y, z)), rate)
        return PartialMotion(velocity, omega, spin, flow)

    def taken(self, now: PartialMotion) -> InertiaWrench:
        """Return the inertia forces of its own motion, at all rates."""
        own, origin, omega = self._placed.bias(), self._carried.bias_of_origin(), now.omega
        alpha = self._rotated("alpha", own.angular)
        inward = omega.cross(self._vector("swung", omega.cross(self._center)))
        linear = self._vector("acceleration", origin + alpha.cross(self._center) + inward)
        force = self._vector("own_force", linear * self._mass)
        slowed = self._vector("slowed", self._own.opposite @ alpha)
        turn = self._vector("own_turn", slowed + omega.cross(now.spin))
        wrench = Twist(self._at.cross(force) + turn, force)
        single = len(self._placed.motion) == 1  # a couple across omega does no work then
        return InertiaWrench(slowed if single else turn, wrench)

    def work(self, column: PartialMotion, taken: InertiaWrench) -> sp.Expr:
        """Return ``∫ r_k' . r'' dm``."""
        return column.velocity.dot(taken.wrench.linear) + column.omega.dot(taken.turn)

    def energy(self, one: PartialMotion, other: PartialMotion) -> sp.Expr:
        """Return ``∫ r_k' . r_l' dm``."""
        return one.velocity.dot(other.flow.momentum) + one.omega.dot(other.spin)

    def across(self, now: PartialMotion, column: PartialMotion) -> Vector:
        """Return ``∫ r' x r_k' dm``."""
        swept = self._vector("swept", now.omega.cross(column.omega))
        return now.velocity.cross(column.flow.momentum) + self._own @ swept


def turned(program: Program, name: str, tensor: SymmetricTensor, axes: Axes) -> SymmetricTensor:
    """Append the components of a tensor, given along some axes, in the axes of these.

    Since ``x x^T + y y^T + z z^T = 1``, the tensor is ``zz 1`` and two pairs of vectors.
    """
    x, y, z = axes
    half = HALF * tensor.zz
    one = x * (HALF * tensor.xx - half) + y * tensor.xy + z * tensor.xz
    two = y * (HALF * tensor.yy - half) + z * tensor.yz
    one, two = program.vector(f"{name}_along_1", one), program.vector(f"{name}_along_2", two)
    a, b, c = (
        program.define(f"{name}_half_{i}", u * v + w * t)
        for i, u, v, w, t in zip("123", x, one, y, two, strict=True)
    )
    across = SymmetricTensor.of_pair(x, one) + SymmetricTensor.of_pair(y, two)
    xx, yy, zz = (2 * e + tensor.zz for e in (a, b, c))
    return named(program, name, SymmetricTensor(xx, yy, zz, across.xy, across.xz, across.yz))
