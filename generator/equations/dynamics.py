"""Equations of motion ``M q'' + B = Q`` (Eq. 3 of the paper), as program steps.

Inertia stays in body axes, where it is constant. Three rules shorten the equations without changing
the model:

* a point mass at the origin that a body shares with its neighbour is counted with the neighbour;
* the mass and the transverse inertia of a rotor are counted with its carrier, so that only the
  momentum about the spin axis remains;
* for a body moved by a single coordinate, ``twist . (twist x* momentum)`` vanishes identically.

The bodies on a base are summed, about its centre of mass and in its axes (`on_base`). So the mass
matrix of the base is the inertia of all bodies on it, each other coordinate couples with it by six
numbers, and the whole mass matrix is an arrow: parts that do not move each other couple in the rows
of the base alone, which are eliminated last.

Sources: sections 3 and 4.4 of the paper; mass matrices with zeros between branches, eliminated from
their ends: R. Featherstone, Rigid Body Dynamics Algorithms, Springer, 2008, chapter 6.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import sympy as sp

from ...equations.errors import HEAVIER, WEIGHTLESS
from ..declare.declared import DeclarationError
from ..declare.geometry import Direction
from ..declare.joints import Revolute
from ..kinematics.hinge_angles import positive_axis_at_design
from ..program.conditions import Condition
from ..program.factors import solved
from ..program.floors import POSITIVE, SINGULAR
from ..program.functions import Frozen
from ..program.vectors import (
    ELEMENTS,
    NO_TWIST,
    ZERO,
    SymmetricTensor,
    Twist,
    Vector,
    from_axes,
    to_axes,
)
from .acting import acted, shown_by
from .admissible import Admissible
from .inertia import SpatialInertia
from .on_base.loaded import Loaded
from .on_base.moving import MovingBody
from .on_base.sums import kind_of
from .surroundings import Seen

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..declare.bodies import Body
    from ..declare.forces.force import Action, Force
    from ..declare.shown import Shown
    from ..kinematics.motion import BodyMotion
    from .in_motion import InMotion
    from .surroundings import Momenta

NONE = sp.Integer(0)

MANY = 4
"""Least number of coordinates of a body, without spins of rotors, for q'' to be differentiated
without derivatives of the mass matrix, whose elements are as many as pairs of coordinates.

That saves a twelfth of the operations of an open chain's Jacobian with four coordinates and a sixth
with six, and a quarter of those of a Stewart platform's; with two it takes more.
"""


@dataclass(frozen=True)
class ReducedRotor:
    """The rest of a body of revolution without the inertia that its carrier has taken over."""

    coordinate: str
    body: Body
    carrier: BodyMotion
    axis: Vector
    inertia: sp.Expr


class Dynamics:
    """Mass matrix, bias and generalised forces of a model, and its forward dynamics.

    `accelerations` are v' by coordinate name.
    """

    def __init__(self, moving: InMotion) -> None:
        self.program, self.mechanism = moving.program, moving.mechanism
        self.moving, self.placed, self.part_of = moving, moving.placed, moving.part_of
        self.coordinates, self.names = moving.coordinates, moving.coordinates.unconstrained
        self.admissible = Admissible.of(moving)  # defines the eliminated speeds
        self._of_base = {k: base.body for base in moving.bases for k in base.coordinates}
        self.inertia: dict[str, SpatialInertia] = {}
        self.rotors: list[ReducedRotor] = []
        self.accelerations: dict[str, sp.Expr] = {}
        self._loaded = {base.body: Loaded(self.program, base, self.names) for base in moving.bases}
        self.program.section("inertia")
        self._gather_inertia()
        self._matrix: dict[tuple[str, str], sp.Expr] = {}
        self._bias: dict[str, sp.Expr] = dict.fromkeys(self.names, NONE)
        self._force: dict[str, sp.Expr] = dict.fromkeys(self.names, NONE)
        self._momentum: Momenta = {}
        self._wrenches: list[tuple[BodyMotion, SpatialInertia, Twist]] = []
        self._factors: dict[tuple[str, str], sp.Expr] = {}
        self._actions: list[Action] = []
        self._add_bodies()
        self._add_forces()
        self.accelerations = self._solve()

    # -- inertia --------------------------------------------------------------------------------

    def _gather_inertia(self) -> None:
        """Sum the inertia from the last body to the first, and move point masses to carriers."""
        for name in reversed(self.placed):
            self.inertia.setdefault(name, SpatialInertia.none())
        rotors = {body.name: k for k, body in self.coordinates.rotors.items()}
        for body in self.moving.formulation.massive:
            if body.name in rotors:
                self._fold_rotor(rotors[body.name], body)
            else:
                self._add_rigid(body)
        for name in reversed(self.placed):
            placed, inertia = self.placed[name], self.inertia[name]
            if placed.carrier is not None and inertia.mass != 0 and not self._is_centred(name):
                carrier, at = placed.carrier
                self.inertia[carrier].add_point(inertia.mass, at)
                inertia.mass = NONE
        self.inertia = {name: self._name_inertia(name, i) for name, i in self.inertia.items()}

    def _is_centred(self, body: str) -> bool:
        """Return whether the equations of a body on a base are about its centre of mass."""
        carried = self.moving.carried.get(body)
        return carried is not None and body not in self._loaded and kind_of(carried) is MovingBody

    def _add_rigid(self, body: Body) -> None:
        """Add a body given by mass, centre and tensor in ground axes at the design position."""
        placed = self.placed[body.name]
        mass = sp.Symbol(f"{body.name}_mass")
        com = self.part_of[placed.body].local(placed, body.center)
        own = self.inertia[body.name]
        own.add_point(mass, com)
        own.tensor += self._own_tensor(body).in_axes(self._ground_axes(placed))

    def _own_tensor(self, body: Body) -> SymmetricTensor:
        if body.rotor_axis is None:
            return SymmetricTensor(*(sp.Symbol(f"{body.name}_inertia_{e}") for e in ELEMENTS))
        spin, across = self._rotor_moments(body)
        part = self.part_of[body.name]
        axis = part.to_ground(part.design_direction(body.rotor_axis))
        axis = self.program.vector(f"{body.name}_rotor_axis", axis)
        tensor = SymmetricTensor.transverse(across, axis)
        x, y, z = axis
        spinning = SymmetricTensor(x * x, y * y, z * z, x * y, x * z, y * z)
        return tensor + SymmetricTensor(*(spin * element for element in spinning))

    @staticmethod
    def _rotor_moments(body: Body) -> tuple[sp.Symbol, sp.Symbol]:
        return (sp.Symbol(f"{body.name}_inertia_spin"), sp.Symbol(f"{body.name}_inertia_diametral"))

    def _ground_axes(self, placed: BodyMotion) -> tuple[Vector, Vector, Vector]:
        """Return the body axes at the design position, in ground axes."""
        names, part = ("first", "second", "third"), self.part_of[placed.body]
        x, y, z = (
            self.program.vector(f"{placed.body}_{name}_in_ground", part.to_ground(axis))
            for name, axis in zip(names, placed.design_axes, strict=True)
        )
        return x, y, z

    def _fold_rotor(self, coordinate: str, body: Body) -> None:
        """Add all of a rotor to its carrier but the momentum about its own axis."""
        joint = self.mechanism.joints_of(body.name)[0]
        carrier = self.placed[joint.other(body.name)]
        spin, across = self._rotor_moments(body)
        assert isinstance(joint, Revolute)
        axis = self._bearing_axis(joint, carrier)
        own = self.inertia[carrier.body]
        own.add_point(
            sp.Symbol(f"{body.name}_mass"), self.part_of[carrier.body].local(carrier, body.center)
        )
        own.tensor += SymmetricTensor.transverse(across, axis)
        self.rotors.append(ReducedRotor(coordinate, body, carrier, axis, spin))

    def _bearing_axis(self, joint: Revolute, carrier: BodyMotion) -> Vector:
        """Return the axis about which the angle of a rotor's hinge is positive, on its carrier.

        The axis of the rotor is the same line, but may point the other way.
        """
        if isinstance(joint.axis.towards, Direction) and joint.angle_to is None:
            return self.part_of[carrier.body].local_direction(carrier, joint.axis.towards)
        positive = positive_axis_at_design(self.part_of[carrier.body], joint)
        n = to_axes(carrier.design_axes, positive)
        return self.program.vector(f"{joint.name}_axis_on_{carrier.body}", n, "123")

    def _name_inertia(self, name: str, inertia: SpatialInertia) -> SpatialInertia:
        return SpatialInertia(
            self.program.define(f"{name}_carried_mass", inertia.mass),
            self.program.vector(f"{name}_first_moment", inertia.moment, "123"),
            SymmetricTensor(
                *(
                    self.program.define(f"{name}_carried_inertia_{e}", v)
                    for e, v in zip(ELEMENTS, inertia.tensor, strict=True)
                )
            ),
        )

    # -- bodies ---------------------------------------------------------------------------------

    def _add_bodies(self) -> None:
        apart = {*self._loaded, *(rotor.body.name for rotor in self.rotors)}
        for name, placed in self.placed.items():
            if not placed.motion or name in apart:
                continue
            self.program.section(f"dynamics: {name}")
            loaded = self._base_of(name)
            if loaded is None:
                self._add_body(placed, self.inertia[name])
            elif not self.inertia[name].is_none:
                loaded.add(self.moving.carried[name], self.inertia[name])
        for name, loaded in self._loaded.items():
            self.program.section(f"dynamics: {name}")
            loaded.complete(self.inertia[name])
            self._matrix |= loaded.matrix
            self._momentum |= {(name, k): momentum for k, momentum in loaded.momenta.items()}
        for rotor in self.rotors:
            self.program.section(f"dynamics: spin of {rotor.body.name}")
            self._add_rotor(rotor)
        for name, loaded in self._loaded.items():
            self.program.section(f"dynamics: {name}")
            self._bias |= loaded.taken("_left", {})

    def _add_body(self, placed: BodyMotion, inertia: SpatialInertia) -> None:
        body = placed.body
        columns = self._own(placed)
        angular: dict[str, Vector] = {}
        offset: dict[str, Vector] = {}
        for k in columns:
            twist = placed.motion[k]
            self._momentum[body, k] = self.program.vector(
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
            self._add_single_bias(placed, columns[0], angular[columns[0]])
        else:
            self._add_full_bias(placed, self.inertia[body])

    def _own(self, placed: BodyMotion) -> list[str]:
        """Return the coordinates that move a body on its base; of a free body, its own."""
        return [k for k in self.names if k in placed.motion]

    def _base_of(self, body: str) -> Loaded | None:
        """Return the base of a body with all bodies on it; None on the ground."""
        carried = self.moving.carried.get(body)
        return self._loaded[carried.base.body] if carried else None

    def _project(self, placed: BodyMotion, wrench: Twist, total: dict[str, sp.Expr]) -> None:
        """Add the power of a wrench on a body per unit rate of every coordinate that moves it."""
        for k in self._own(placed):
            twist = placed.motion[k]
            total[k] += twist.angular.dot(wrench.angular) + twist.linear.dot(wrench.linear)

    def _add_single_bias(self, placed: BodyMotion, k: str, angular: Vector) -> None:
        """Add B = momentum . (d twist/dq) q'^2; the convective part vanishes identically."""
        bias, twist = placed.bias(), placed.motion[k]
        linear = bias.linear - twist.angular.cross(twist.linear)
        self._bias[k] += angular.dot(bias.angular) + self._momentum[placed.body, k].dot(linear)

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
        if self.coordinates.rate_scale_of(self._relative(rotor)) != 1 and not self._is_turned(
            rotor
        ):
            return  # axis x omega is perpendicular to omega, the only direction of motion
        loaded = self._base_of(rotor.carrier.body)
        axis, columns, omega = self._seen(rotor)
        spin = self.coordinates.true_rate(rotor.coordinate) + axis.dot(omega)
        momentum = self.program.define(f"{rotor.body.name}_spin_momentum", rotor.inertia * spin)
        swing = omega.cross(axis)
        if self._is_turned(rotor):
            swing = self.program.vector(f"{rotor.body.name}_swing", swing)  # see `_spin_bias`
        couple = self.program.vector(f"{rotor.body.name}_gyroscopic", swing * momentum, "123")
        if loaded is not None:
            loaded.add_couple(columns, couple)
            return
        self._wrenches.append((rotor.carrier, SpatialInertia.none(), Twist(couple, ZERO)))
        for k, along in columns.items():
            self._bias[k] += along.dot(couple)

    def _seen(self, rotor: ReducedRotor) -> tuple[Vector, dict[str, Vector], Vector]:
        """Return the axis of a rotor, and its carrier's angular velocity: per rate, and in total.

        In the axes of its base, without the coordinates of that; in those of the carrier on the
        ground.
        """
        body, placed = rotor.carrier.body, self._relative(rotor)
        if not self._is_turned(rotor):
            columns = {k: placed.motion[k].angular for k in self.names if k in placed.motion}
            return rotor.axis, columns, self.part_of[body].total(placed).angular
        carried, program = self.moving.carried[body], self.program
        base = carried.base
        axis = program.vector(
            f"{rotor.body.name}_axis_on_{base.body}", from_axes(carried.axes, rotor.axis)
        )
        rates, omega, columns = self.coordinates.true_rate, base.omega, {}
        for k, twist in carried.relative.motion.items():
            name = f"{body}_on_{base.body}_omega_{k}"
            turning = program.vector(name, from_axes(carried.axes, twist.angular))
            omega += turning * rates(k)
            if k in self.names:
                columns[k] = turning
        return axis, columns, program.vector(f"{body}_on_{base.body}_turning", omega)

    def _relative(self, rotor: ReducedRotor) -> BodyMotion:
        """Return the motion of the carrier of a rotor on its base, or on the ground."""
        carried = self.moving.carried.get(rotor.carrier.body)
        return rotor.carrier if carried is None else carried.relative

    def _is_turned(self, rotor: ReducedRotor) -> bool:
        """Return whether the carrier of a rotor is on a base that turns."""
        loaded = self._base_of(rotor.carrier.body)
        return loaded is not None and loaded.base.turns

    def _carried(self, rotor: ReducedRotor) -> list[str]:
        return [k for k in self.names if k in rotor.carrier.motion]

    # -- forces ---------------------------------------------------------------------------------

    def _add_forces(self) -> None:
        at = Seen(self.moving, self._momentum, None)
        for force in self.mechanism.forces:
            self.program.section(f"forces: {type(force).__name__}")
            action = acted(force, at)
            self._actions.append(action)
            for k in self.names:
                if k in action.forces:
                    self._force[k] += action.forces[k]
        self.internal_rates = self._rates_of_internal()

    def _rates_of_internal(self) -> dict[str, sp.Expr]:
        """Return the rates of internal states in their order; each is that of one force."""
        names = [entry.name for entry in self.coordinates.states.internal]
        given = [
            (name, force)
            for force, a in zip(self.mechanism.forces, self._actions, strict=True)
            for name in a.rates
        ]
        problems = [
            f"{' '.join(force.identity)}: a rate of {name!r}, which is not an internal state of "
            "the mechanism; have an InternalState among the fields of the force"
            for name, force in given
            if name not in names
        ]
        for name in names:
            forces = [" ".join(force.identity) for known, force in given if known == name]
            if len(forces) != 1:
                found = f"rates by {' and '.join(forces)}" if forces else "no rate"
                problems.append(
                    f"internal state {name!r} has {found}; one force returns "
                    f"Action(..., rates={{{name!r}: ...}})"
                )
        if problems:
            raise DeclarationError(self.mechanism.name, problems)
        rates = {name: rate for action in self._actions for name, rate in action.rates.items()}
        return {name: self.program.define(f"{name}_rate", rates[name]) for name in names}

    def signals(self) -> Iterator[Shown]:
        """Yield the signals of all forces in their order, and then those of the constraints."""
        at = Seen(self.moving, self._momentum, self.accelerations)
        for force, action in zip(self.mechanism.forces, self._actions, strict=True):
            yield from shown_by(force, at, action)
        for constraint in self.mechanism.constraints:
            yield from constraint.signals(at)

    def total(self, force: Force) -> sp.Expr:
        """Return the force by which an element pushes two ends apart [N or N m]."""
        found = self._actions[self.mechanism.forces.index(force)].total
        if found is None:
            problem = (
                "its Action has no total, which an output shows: give it the force on the ends"
            )
            raise DeclarationError(" ".join(force.identity), [problem])
        return found

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
        return sorted(rest, key=self._of_base.__contains__)  # stable

    def _with_spins(self, solution: dict[str, sp.Expr], label: str) -> dict[str, sp.Expr]:
        """Return accelerations in the order of the coordinates, those of rotors among them."""
        for rotor in self.rotors:
            solution[rotor.coordinate] = self.program.define(
                f"{rotor.coordinate}_{label}",
                self._force[rotor.coordinate] / rotor.inertia - self._spin_bias(rotor, solution),
            )
        return {k: solution[k] for k in self.names}

    def _net(self, k: str, inertial: sp.Expr) -> sp.Expr:
        """Return force less inertia; a torque on a rotor's bearing acts back on its carrier."""
        return self._force[k] - inertial - self._back(k)

    def _back(self, k: str) -> sp.Expr:
        """Return the torques on bearings, reduced to a coordinate of their carriers."""
        rotors = [
            r for r in self.rotors if self._force[r.coordinate] != 0 and k in self._carried(r)
        ]
        if k not in self._of_base:
            return sum((self._rotor_share(r, k) * self._force[r.coordinate] for r in rotors), NONE)
        base = self._loaded[self._of_base[k]].base
        total = ZERO
        for rotor in rotors:
            total += self._seen(rotor)[0] * self._force[rotor.coordinate]
        total = self.program.vector(f"{base.body}_bearings", total)
        return base.twists[k].angular.dot(total)

    def _spin_bias(self, rotor: ReducedRotor, accelerations: dict[str, sp.Expr]) -> sp.Expr:
        """Return the rate of ``axis . omega`` of the carrier."""
        own = [k for k in self._carried(rotor) if k not in self._of_base]
        total = sum((self._rotor_share(rotor, k) * accelerations.get(k, NONE) for k in own), NONE)
        placed = self._relative(rotor)
        scale = self.coordinates.rate_scale_of(placed) ** 2
        total += rotor.axis.dot(placed.bias().angular) * scale
        loaded = self._base_of(rotor.carrier.body)
        if loaded is None or not self._is_turned(rotor):
            return total
        axis, _, omega = self._seen(rotor)
        base = loaded.acceleration("_of_all" if accelerations else "_left", accelerations)
        # a . (w x omega), where omega x a is a factor of the gyroscopic couple
        swing = self.program.vector(f"{rotor.body.name}_swing", omega.cross(axis))
        return total + axis.dot(base.angular) + loaded.base.omega.dot(swing)

    def _rotor_share(self, rotor: ReducedRotor, k: str) -> sp.Expr:
        axis, columns, _ = self._seen(rotor)
        base = self._of_base.get(k)
        along = columns[k] if base is None else self._loaded[base].base.twists[k].angular
        return self.program.define(f"{rotor.body.name}_share_{k}", axis.dot(along))

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
            share = self._rotor_row(rotor)
            for i, k in enumerate(self.names):
                for j, other in enumerate(self.names):
                    matrix[i][j] += rotor.inertia * share[k] * share[other]
        return matrix

    def _rotor_row(self, rotor: ReducedRotor) -> dict[str, sp.Expr]:
        share = {k: self._rotor_share(rotor, k) for k in self._carried(rotor)}
        share[rotor.coordinate] = sp.Integer(1)
        return {k: share.get(k, NONE) for k in self.names}

    def full_bias(self) -> list[sp.Expr]:
        """Return B of all coordinates, rotors included."""
        bias = {k: self._bias[k] * self._scale(k) ** 2 for k in self.names}
        for rotor in self.rotors:
            rate = self._spin_bias(rotor, {})
            for k, share in self._rotor_row(rotor).items():
                bias[k] += rotor.inertia * share * rate
        return [bias[k] for k in self.names]

    def full_forces(self) -> list[sp.Expr]:
        """Return Q of all coordinates."""
        return [self._force[k] for k in self.names]
