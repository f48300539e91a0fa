"""A base with all bodies that hang on it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...program.vectors import NO_TWIST, SymmetricTensor, Twist, Vector
from ..inertia import SpatialInertia
from .flow import NONE, Flow, named, squares_of
from .sums import Sums

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    import sympy as sp

    from ...kinematics.base import Base
    from ...kinematics.carried import Carried
    from ...program.program import Program


class Loaded:
    """A base with its bodies: mass matrix, and the generalised forces of a motion.

    `names` are the coordinates along which equations are needed. After `complete`, `inertia` is
    that of all bodies, about the centre of mass of the base and in its axes; `matrix` has the
    elements of the mass matrix, `momenta` the momentum per unit rate of each coordinate.
    """

    def __init__(self, program: Program, base: Base, names: Iterable[str]) -> None:
        self.base, self._program = base, program
        self._names = [k for k in names if k not in base.twists]
        self._sums: dict[tuple[int, sp.Expr], Sums] = {}
        self._couples: list[tuple[dict[str, Vector], Vector]] = []
        self.matrix: dict[tuple[str, str], sp.Expr] = {}
        self.momenta: dict[str, Vector] = {}

    @property
    def coordinates(self) -> list[str]:
        """The coordinates of the base, and those of the bodies on it."""
        return [*self.base.twists, *dict.fromkeys(k for s in self._sums.values() for k in s.flows)]

    def add(self, carried: Carried, inertia: SpatialInertia) -> None:
        """Add a body, with its inertia about its origin, in its axes."""
        scale = carried.part.coordinates.rate_scale_of(carried.relative)
        sums = self._sums.setdefault((id(carried.part), scale), Sums())
        sums.add(carried, inertia, self._names)

    def complete(self, own: SpatialInertia) -> None:
        """Sum the bodies and the inertia of the base itself."""
        program, body = self._program, self.base.body
        mass, first, second = own.mass, own.moment, SymmetricTensor.zero()
        for s in self._sums.values():
            mass += s.mass
            first += s.first
            second += s.second
        second = named(program, f"{body}_second_of_all", second)
        self.inertia = SpatialInertia(
            program.define(f"{body}_mass_of_all", mass),
            program.vector(f"{body}_first_moment_of_all", first),
            named(program, f"{body}_inertia_of_all", own.tensor + second.opposite),
        )
        self._add_own()
        now = Flow()
        self._own = NO_TWIST
        for i, ((_, scale), s) in enumerate(self._sums.items(), 1):
            label = f"{body}_part_{i}"
            for k, flow in s.flows.items():
                s.flows[k] = flow.named(program, f"{label}_{k}")
                self._couple(k, s.flows[k])
            s.now = s.now.named(program, f"{label}_now")
            now += s.now * scale
            squared = program.define(f"{label}_rate_squared", scale * scale)
            self._own += (
                Twist(
                    program.vector(f"{label}_own_couple", s.own.angular),
                    program.vector(f"{label}_own_force", s.own.linear),
                )
                * squared
            )
            for pair, element in s.matrix.items():
                self._add_element(pair, element)
        self._now = now.named(program, f"{body}_flow_of_all")

    def _add_own(self) -> None:
        """Add the mass matrix of the base."""
        twists, program, body = self.base.twists, self._program, self.base.body
        for i, (k, twist) in enumerate(twists.items()):
            momentum = Twist(
                program.vector(f"{body}_spin_by_{k}", self.inertia.spin_momentum(twist)),
                program.vector(f"{body}_momentum_by_{k}", self.inertia.linear_momentum(twist)),
            )
            self.momenta[k] = momentum.linear
            for other in list(twists)[: i + 1]:
                self.matrix[other, k] = twists[other].dot(momentum)

    def _couple(self, k: str, flow: Flow) -> None:
        """Add the elements of the mass matrix between a coordinate and those of the base."""
        known = self.momenta.get(k)
        self.momenta[k] = flow.momentum if known is None else known + flow.momentum
        for own, share in self.base.shares(flow.wrench).items():
            self._add_element((own, k), share)

    def _add_element(self, pair: tuple[str, str], element: sp.Expr) -> None:
        """Add to an element of the mass matrix; by gears a coordinate may move several parts."""
        known = pair[::-1] if pair[::-1] in self.matrix else pair
        self.matrix[known] = self.matrix.get(known, NONE) + element

    def add_couple(self, along: Mapping[str, Vector], couple: Vector) -> None:
        """Add a further inertia couple of a body's motion, as of a rotor, in axes of the base.

        `along` is the angular velocity of the body on the base per unit rate of each coordinate.
        """
        self._couples.append((dict(along), couple))

    def acceleration(self, label: str, accelerations: Mapping[str, sp.Expr]) -> Twist:
        """Return the acceleration of the base and of its centre of mass, in its own axes.

        The label ends the names of the steps; missing accelerations of coordinates are zero.
        """
        base = self.base
        total = Twist(base.bias.angular, base.bias.linear + base.omega.cross(base.velocity))
        for k, twist in base.twists.items():
            total += twist * accelerations.get(k, NONE)
        return Twist(
            self._program.vector(f"{base.body}_angular_acceleration{label}", total.angular),
            self._program.vector(f"{base.body}_acceleration{label}", total.linear),
        )

    def taken(self, label: str, accelerations: Mapping[str, sp.Expr]) -> dict[str, sp.Expr]:
        """Return the generalised force of a motion along each coordinate: ``B + M q''``.

        The label ends the names of the steps; missing accelerations of coordinates are zero.
        """
        base, program, inertia = self.base, self._program, self.inertia
        w, moved = base.omega, self.acceleration(label, accelerations)
        whirl = program.vector(f"{base.body}_whirl", w.cross(inertia.moment))
        spin = program.vector(f"{base.body}_spin", inertia.tensor @ w)
        coriolis = self._now.coriolis(w)
        couple = inertia.spin_momentum(moved) + w.cross(spin) + coriolis.angular + self._own.angular
        force = inertia.linear_momentum(moved) + w.cross(whirl) + coriolis.linear + self._own.linear
        squares = squares_of(program, base.body, w)
        found: dict[str, sp.Expr] = {}
        for (_, scale), s in self._sums.items():
            for k, flow in s.flows.items():
                along = flow.momentum.dot(moved.linear) + flow.angular.dot(moved.angular)
                along += flow.centrifugal(squares) + s.bias[k] * scale**2
                if k in s.across:
                    along += 2 * w.dot(s.across[k])
                acceleration = accelerations.get(k, NONE)
                couple += flow.angular * acceleration
                force += flow.momentum * acceleration
                for other in s.flows:
                    pair = (k, other) if (k, other) in s.matrix else (other, k)
                    along += s.matrix.get(pair, NONE) * accelerations.get(other, NONE)
                found[k] = found.get(k, NONE) + along
        for columns, more in self._couples:
            couple += more
            for k, omega in columns.items():
                found[k] = found.get(k, NONE) + omega.dot(more)
        wrench = Twist(
            program.vector(f"{base.body}_couple{label}", couple),
            program.vector(f"{base.body}_force{label}", force),
        )
        return base.shares(wrench) | found
