"""Equations of motion ``M q'' + B = Q`` (Eq. 3 of the paper), as program steps.

Inertia stays in body axes, where it is constant, and goes to neighbours where it can
(`carried_inertia`). For a body moved by a single coordinate, ``twist . (twist x* momentum)``
vanishes identically.

The bodies on a base are summed, about its centre of mass and in its axes (`on_base`). So the mass
matrix of the base is the inertia of all bodies on it, each other coordinate couples with it by six
numbers, and the whole mass matrix is an arrow: parts that do not move each other couple in the rows
of the base alone, which are eliminated last.

Sources: sections 3 and 4.4 of the paper; mass matrices with zeros between branches, eliminated from
their ends: R. Featherstone, Rigid Body Dynamics Algorithms, Springer, 2008, chapter 6.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import sympy as sp

from ...equations.errors import HEAVIER, WEIGHTLESS
from ..program.conditions import Condition
from ..program.factors import solved
from ..program.floors import POSITIVE, SINGULAR
from ..program.functions import Frozen
from ..program.vectors import NO_TWIST, ZERO, Twist, Vector
from .admissible import Admissible
from .applied import Applied
from .carried_inertia import carried_inertia
from .inertia import NONE, SpatialInertia
from .on_base.loaded import Loaded
from .rotors import Rotors

if TYPE_CHECKING:
    from ..kinematics.motion import BodyMotion
    from .in_motion import InMotion
    from .rotors import ReducedRotor
    from .surroundings import Momenta

MANY = 4
"""Least number of coordinates of a body, without spins of rotors, for q'' to be differentiated
without derivatives of the mass matrix, whose elements are as many as pairs of coordinates.

That saves a twelfth of the operations of an open chain's Jacobian with four coordinates and a sixth
with six, and a quarter of those of a Stewart platform's; with two it takes more.
"""


class Dynamics:
    """Mass matrix, bias and generalised forces of a model, and its forward dynamics.

    `accelerations` are v' by coordinate name, `acting` the force elements.
    """

    def __init__(self, moving: InMotion) -> None:
        self.program, self.mechanism = moving.program, moving.mechanism
        self.moving, self.placed, self.part_of = moving, moving.placed, moving.part_of
        self.coordinates, self.names = moving.coordinates, moving.coordinates.unconstrained
        self.admissible = Admissible.of(moving)  # defines the eliminated speeds
        self._loaded = {base.body: Loaded(self.program, base, self.names) for base in moving.bases}
        self.program.section("inertia")
        self.inertia, rotors = carried_inertia(moving)
        self.rotors = Rotors(moving, self._loaded, rotors)
        self._matrix: dict[tuple[str, str], sp.Expr] = {}
        self._bias: dict[str, sp.Expr] = dict.fromkeys(self.names, NONE)
        self._wrenches: list[tuple[BodyMotion, SpatialInertia, Twist]] = []
        self._factors: dict[tuple[str, str], sp.Expr] = {}
        self.acting = Applied(moving, self._add_bodies())
        self._force = dict(self.acting.forces)
        self.accelerations = self._solve()

    # -- bodies ---------------------------------------------------------------------------------

    def _add_bodies(self) -> Momenta:
        """Add the terms of all bodies to M and B; return the momenta per unit rate."""
        momenta: Momenta = {}
        apart = {*self._loaded, *(rotor.body.name for rotor in self.rotors)}
        for name, placed in self.placed.items():
            if not placed.motion or name in apart:
                continue
            self.program.section(f"dynamics: {name}")
            carried = self.moving.carried.get(name)
            if carried is None:
                momenta |= self._add_body(placed, self.inertia[name])
            elif not self.inertia[name].is_none:
                self._loaded[carried.base.body].add(carried, self.inertia[name])
        for name, loaded in self._loaded.items():
            self.program.section(f"dynamics: {name}")
            loaded.complete(self.inertia[name])
            self._matrix |= loaded.matrix
            momenta |= {(name, k): momentum for k, momentum in loaded.momenta.items()}
        for rotor in self.rotors:
            self.program.section(f"dynamics: spin of {rotor.body.name}")
            self._add_rotor(rotor)
        for name, loaded in self._loaded.items():
            self.program.section(f"dynamics: {name}")
            self._bias |= loaded.taken("_left", {})
        return momenta

    def _add_body(self, placed: BodyMotion, inertia: SpatialInertia) -> Momenta:
        body = placed.body
        columns = self._own(placed)
        momenta: Momenta = {}
        angular: dict[str, Vector] = {}
        offset: dict[str, Vector] = {}
        for k in columns:
            twist = placed.motion[k]
            momenta[body, k] = self.program.vector(
                f"{body}_momentum_{k}", inertia.linear_momentum(twist), "123"
            )
            offset[k] = self.program.vector(
                f"{body}_offset_momentum_{k}", inertia.moment.cross(twist.linear), "123"
            )
            angular[k] = self.program.vector(
                f"{body}_spin_momentum_{k}", inertia.tensor @ twist.angular + offset[k], "123"
            )
        for i, k in enumerate(columns):
            for other in columns[i:]:
                # v . (omega x mc) of the one column is omega . (mc x v) of the other
                one, two = placed.motion[k], placed.motion[other]
                if k == other:
                    energy = one.angular.dot(angular[k] + offset[k])
                else:
                    energy = one.angular.dot(angular[other]) + two.angular.dot(offset[k])
                energy += inertia.mass * one.linear.dot(two.linear)
                self._matrix[k, other] = self._matrix.get((k, other), NONE) + energy
        if len(columns) == 1 and columns[0] in self.coordinates.single_coordinate:
            k = columns[0]
            self._add_single_bias(placed, k, Twist(angular[k], momenta[body, k]))
        else:
            self._add_full_bias(placed, inertia)
        return momenta

    def _own(self, placed: BodyMotion) -> list[str]:
        """Return the coordinates that move a body on its base; of a free body, its own."""
        return [k for k in self.names if k in placed.motion]

    def _project(self, placed: BodyMotion, wrench: Twist, total: dict[str, sp.Expr]) -> None:
        """Add the power of a wrench on a body per unit rate of every coordinate that moves it."""
        for k in self._own(placed):
            twist = placed.motion[k]
            total[k] += twist.angular.dot(wrench.angular) + twist.linear.dot(wrench.linear)

    def _add_single_bias(self, placed: BodyMotion, k: str, momentum: Twist) -> None:
        """Add B = momentum . (d twist/dq) q'^2; the convective part vanishes identically."""
        bias, twist = placed.bias(), placed.motion[k]
        linear = bias.linear - twist.angular.cross(twist.linear)
        self._bias[k] += momentum.angular.dot(bias.angular) + momentum.linear.dot(linear)

    def _add_full_bias(self, placed: BodyMotion, inertia: SpatialInertia) -> None:
        """Add Newton-Euler at the bias acceleration, projected on each column."""
        body, program = placed.body, self.program
        bias, omega = placed.bias(), self.part_of[placed.body].total(placed).angular
        whirl = program.vector(f"{body}_whirl_moment", omega.cross(inertia.moment), "123")
        spin = program.vector(f"{body}_spin_now", inertia.tensor @ omega, "123")
        force = program.vector(
            f"{body}_inertia_force",
            bias.linear * inertia.mass + bias.angular.cross(inertia.moment) + omega.cross(whirl),
            "123",
        )
        couple = program.vector(
            f"{body}_inertia_couple",
            inertia.tensor @ bias.angular + omega.cross(spin) + inertia.moment.cross(bias.linear),
            "123",
        )
        wrench = Twist(couple, force)
        self._wrenches.append((placed, inertia, wrench))
        self._project(placed, wrench, self._bias)

    def _add_rotor(self, rotor: ReducedRotor) -> None:
        """Add the gyroscopic part of a rotor on its carrier; the rest is in `_solve` and `full`."""
        gyroscopic = self.rotors.gyroscopic(rotor)
        if gyroscopic is None:
            return
        columns, couple = gyroscopic
        loaded = self.rotors.base_of(rotor)
        if loaded is not None:
            loaded.add_couple(columns, couple)
            return
        self._wrenches.append((rotor.carrier, SpatialInertia.none(), Twist(couple, ZERO)))
        for k, along in columns.items():
            self._bias[k] += along.dot(couple)

    def _scale(self, k: str) -> sp.Expr:
        """Return the factor whose square scales a bias: on a base it is one at the true rates."""
        on_base = any(k in loaded.coordinates for loaded in self._loaded.values())
        return sp.Integer(1) if on_base else self.coordinates.rate_scale(k)

    # -- equations ------------------------------------------------------------------------------

    def _carried_matrix(self, k: str, other: str) -> sp.Expr:
        pair = (k, other) if (k, other) in self._matrix else (other, k)
        return self._matrix.get(pair, NONE)

    def _solve(self) -> dict[str, sp.Expr]:
        """Solve the forward dynamics: rotors are eliminated first, the rest is a small system.

        The spin equation ``inertia (axis . omega' + spin') = torque`` leaves only the torque's
        reaction in the others: the contributions of a rotor to M and B there cancel when its
        coordinate is eliminated.
        """
        program = self.program
        if self.admissible is not None:
            return self._solve_admissible(self.admissible)
        program.section("equations of motion")
        rest = self._rest
        for k in rest:
            self._bias[k] = program.define(f"bias_of_{k}", self._bias[k])
            self._force[k] = program.define(f"force_of_{k}", self._force[k])
        matrix = {
            (k, other): program.define(f"mass_{k}_{other}", self._carried_matrix(k, other))
            for i, k in enumerate(rest)
            for other in rest[i:]
        }
        bias = {k: self._bias[k] * self._scale(k) ** 2 for k in rest}
        right = {k: program.define(f"net_{k}", self._net(k, bias[k])) for k in rest}
        return self._with_spins(self._cholesky(rest, matrix, right), "acceleration")

    def _solve_admissible(self, admissible: Admissible) -> dict[str, sp.Expr]:
        """Solve the forward dynamics of the admissible speeds, rotors like all other bodies."""
        program = self.program
        matrix = {
            (k, other): program.define(f"mass_{k}_{other}", element)
            for k, row in zip(self.names, self.full_mass_matrix(), strict=True)
            for other, element in zip(self.names, row, strict=True)
        }
        program.section("equations of motion")
        bias, force = (
            {
                k: program.define(f"{what}_of_{k}", v)
                for k, v in zip(self.names, values, strict=True)
            }
            for what, values in (("bias", self.full_bias()), ("force", self.full_forces()))
        )
        carried = admissible.carried_along(matrix)
        self._admissible_mass = {
            (k, other): program.define(f"admissible_mass_{k}_{other}", v)
            for (k, other), v in admissible.reduced(matrix).items()
        }
        self._admissible_bias = admissible.projected({k: bias[k] + carried[k] for k in self.names})
        self._admissible_force = admissible.projected(force)
        independent = self.coordinates.independent
        right = {
            k: program.define(f"net_{k}", self._admissible_force[k] - self._admissible_bias[k])
            for k in independent
        }
        return admissible.completed(self._cholesky(independent, self._admissible_mass, right))

    @property
    def _rest(self) -> list[str]:
        """All coordinates but spins of rotors, in the order of elimination: bases come last."""
        spins = {rotor.coordinate for rotor in self.rotors}
        rest = [k for k in self.names if k not in spins]
        bases = {k for base in self.moving.bases for k in base.coordinates}
        return sorted(rest, key=bases.__contains__)  # stable

    def _net(self, k: str, inertial: sp.Expr) -> sp.Expr:
        """Return force less inertia; a torque on a rotor's bearing acts back on its carrier."""
        return self._force[k] - inertial - self.rotors.reaction(k, self._force)

    def _with_spins(self, solution: dict[str, sp.Expr], label: str) -> dict[str, sp.Expr]:
        """Return accelerations in the order of the coordinates, those of rotors among them."""
        for rotor in self.rotors:
            k = rotor.coordinate
            spin = self._force[k] / rotor.inertia - self.rotors.bias(rotor, solution)
            solution[k] = self.program.define(f"{k}_{label}", spin)
        return {k: solution[k] for k in self.names}

    def _cholesky(
        self, names: list[str], matrix: dict[tuple[str, str], sp.Expr], right: dict[str, sp.Expr]
    ) -> dict[str, sp.Expr]:
        """Solve the symmetric system by L D L^T, unrolled."""
        program = self.program
        work, right = dict(matrix), dict(right)
        inverse: dict[str, sp.Expr] = {}
        for i, k in enumerate(names):
            pivot = self._pivot(k, work[k, k], matrix[k, k])
            self._factors[k, k] = inverse[k] = program.define(f"inverse_pivot_{k}", 1 / pivot)
            for j, row in enumerate(names[i + 1 :], i + 1):
                factor = program.define(f"factor_{row}_{k}", work[k, row] * inverse[k])
                self._factors[row, k] = factor
                for column in names[j:]:
                    work[row, column] = program.define(
                        f"reduced_{row}_{column}_{k}", work[row, column] - factor * work[k, column]
                    )
                right[row] = program.define(f"reduced_{row}_{k}", right[row] - factor * right[k])
        solution: dict[str, sp.Expr] = {}
        for i, k in reversed(list(enumerate(names))):
            known = sum((work[k, c] * solution[c] for c in names[i + 1 :]), NONE)
            solution[k] = program.define(f"{k}_acceleration", (right[k] - known) * inverse[k])
        return solution

    def _pivot(self, k: str, left: sp.Expr, whole: sp.Expr) -> sp.Expr:
        """Return the rest of a coordinate's mass after elimination of those before it.

        Where it alone moves no mass, rounding leaves a fraction of the whole, of any sign.
        """
        program, unit = self.program, "kg m^2 or kg"
        rounding = NONE
        if left != whole:
            rounding = program.define(f"rounding_of_mass_{k}", SINGULAR * whole)
        meaning = f"the mass matrix is not positive definite at {k}"
        free = program.guarded(f"pivot_{k}", left - rounding, meaning, unit, POSITIVE)
        if rounding != NONE and program.constants.contains(free):
            program.constants.conditions.setdefault(
                left, Condition(left, rounding, unit, WEIGHTLESS.format(k), HEAVIER)
            )
        return free + rounding

    # -- derivatives ----------------------------------------------------------------------------

    @cached_property
    def differentiated(self) -> dict[sp.Symbol, sp.Expr]:
        """Expressions to differentiate instead of the steps of q'', if any."""
        again = self.to_differentiate()
        pairs = ((self.accelerations[k], value) for k, value in again.items())
        return {step: value for step, value in pairs if step != value and step.is_Symbol}

    def to_differentiate(self) -> dict[str, sp.Expr]:
        """Return q'' in an expression with few operations of its derivatives.

        With a for the values of q'', ``q'' = a + M^-1 (Q - B - M a)``, in which a and M^-1 are
        frozen: the bracket vanishes, and by the implicit function theorem its derivative at a
        constant a is M times that of q''. ``B + M a`` is projected from the inertia forces of every
        body at these accelerations (d'Alembert), so that no element of M is differentiated.
        """
        rest = self._rest
        most = max((len(placed.motion.keys() & rest) for placed, *_ in self._wrenches), default=0)
        few = most < MANY or self.coordinates.single_coordinate
        if self.admissible or (few and not any(base.turns for base in self.moving.bases)):
            return {k: self.accelerations[k] for k in self.coordinates.independent}
        values = {k: self.program.define(f"{k}_value", Frozen(self.accelerations[k])) for k in rest}
        inertial = self._inertial(values)
        left = {k: self.program.define(f"{k}_imbalance", self._net(k, inertial[k])) for k in rest}
        factors = {
            (row, k): self.program.define(f"factor_{row}_{k}_value", Frozen(factor))
            for (row, k), factor in self._factors.items()
        }
        more = solved(self.program, factors, left, "imbalance", "{}_more")
        return self._with_spins({k: values[k] + more[k] for k in rest}, "acceleration_again")

    def _inertial(self, accelerations: dict[str, sp.Expr]) -> dict[str, sp.Expr]:
        """Return ``B + M a``: inertia forces of the bodies at accelerations a, on each column."""
        total = dict.fromkeys(self.names, NONE)
        for placed, inertia, wrench in self._wrenches:
            columns = [k for k in self.names if k in placed.motion]
            more = NO_TWIST
            for k in columns:
                more += placed.motion[k] * accelerations.get(k, NONE)
            angular = self.program.vector(f"{placed.body}_driven_alpha", more.angular, "123")
            linear = self.program.vector(f"{placed.body}_driven_acceleration", more.linear, "123")
            moved = Twist(angular, linear)
            couple = wrench.angular + inertia.spin_momentum(moved)
            force = wrench.linear + inertia.linear_momentum(moved)
            couple = self.program.vector(f"{placed.body}_couple", couple, "123")
            force = self.program.vector(f"{placed.body}_force", force, "123")
            self._project(placed, Twist(couple, force), total)
        for loaded in self._loaded.values():
            total |= loaded.taken("_driven", accelerations)
        return total

    # -- M, B and Q of the paper ----------------------------------------------------------------

    def mass_matrix(self) -> list[list[sp.Expr]]:
        """Return M of the independent coordinates."""
        if self.admissible is None:
            return self.full_mass_matrix()
        names, left = self.coordinates.independent, self._admissible_mass
        return [[left.get((a, b), left.get((b, a), NONE)) for b in names] for a in names]

    def bias(self) -> list[sp.Expr]:
        """Return B of the independent coordinates."""
        return self.full_bias() if self.admissible is None else list(self._admissible_bias.values())

    def applied(self) -> list[sp.Expr]:
        """Return Q of the independent coordinates."""
        return (
            self.full_forces() if self.admissible is None else list(self._admissible_force.values())
        )

    def directions(self) -> dict[str, dict[sp.Symbol, sp.Expr]]:
        """Return the rates of the positions per unit of each independent speed."""
        columns = self.moving.directions()
        if self.admissible is None:
            return columns
        found = {}
        for k in self.coordinates.independent:
            column = dict(columns[k])
            for d, shares in self.admissible.shares.items():
                for symbol, change in columns[d].items():
                    column[symbol] = column.get(symbol, NONE) + shares[k] * change
            found[k] = column
        return found

    def along(self, k: str) -> dict[str, sp.Expr]:
        """Return the rate of each coordinate per unit rate of an independent one."""
        if self.admissible is None:
            return {k: sp.Integer(1)}
        return {k: sp.Integer(1)} | {d: p[k] for d, p in self.admissible.shares.items()}

    def full_mass_matrix(self) -> list[list[sp.Expr]]:
        """Return M of all coordinates, rotors included, without the constraints on speeds."""
        self.program.section("mass matrix")
        matrix = [[self._carried_matrix(k, other) for other in self.names] for k in self.names]
        for rotor in self.rotors:
            share = self.rotors.row(rotor)
            for i, k in enumerate(self.names):
                for j, other in enumerate(self.names):
                    matrix[i][j] += rotor.inertia * share[k] * share[other]
        return matrix

    def full_bias(self) -> list[sp.Expr]:
        """Return B of all coordinates, rotors included."""
        bias = {k: self._bias[k] * self._scale(k) ** 2 for k in self.names}
        for rotor in self.rotors:
            rate = self.rotors.bias(rotor, {})
            for k, share in self.rotors.row(rotor).items():
                bias[k] += rotor.inertia * share * rate
        return [bias[k] for k in self.names]

    def full_forces(self) -> list[sp.Expr]:
        """Return Q of all coordinates."""
        return [self._force[k] for k in self.names]
