"""The functions that a generated model offers, and the arrays that they read and write."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import sympy as sp

from ..declare.checks import check_symbols
from ..declare.declared import DeclarationError, parts
from ..declare.inputs import Input
from ..declare.names import TIME
from ..declare.states import Entry
from ..memory import uncollected
from ..planning.plan import CataloguePlan
from ..program.constants import ConstantStage
from ..program.function import Stage
from ..program.narrow import function_of
from ..program.program import Program
from ..program.together import share_together
from ..program.vectors import IDENTITY, ZERO, from_axes
from ..progress import counted, silent
from .assumptions import define_assumptions, find_assumptions
from .closure_residuals import closure_residuals
from .declared_outputs import signals_of
from .design import design_state
from .dynamics import Dynamics
from .in_motion import InMotion
from .kinks import kinks_of
from .parameter_derivatives import ParameterDerivatives, derivatives_by_parameters
from .relative import RelativeCoordinates

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from ..declare.formulation import Formulation
    from ..declare.mechanism import Mechanism
    from ..declare.shown import Shown
    from ..declare.states import DeclaredStates
    from ..kinematics.motion import BodyMotion
    from ..program.conditions import Assumption, Condition
    from ..program.function import Function
    from ..program.steps import Guard
    from ..progress import Notify

AXES = ("x", "y", "z")

DERIVATIVES = "derivatives"
"""Part of the emitted code with derivatives with respect to state and inputs: half of it."""

BOUNDED = "bounded"
"""Function of the signals that have ranges."""


TOGETHER = {
    "dynamics": ("The parts of M q'' + B = Q.", ("mass_matrix", "bias", "forces")),
    "poses": (
        "Positions, orientations and velocities of the bodies, and relative coordinates.",
        ("relative_coordinates", "positions", "orientations", "velocities"),
    ),
    "jacobians": (
        "Relative, absolute and global Jacobians.",
        ("relative_jacobian", "absolute_jacobian", "global_jacobian"),
    ),
    "linearisation": (
        "Jacobians of rhs with respect to inputs, and of signals with respect to state and inputs.",
        ("rhs_input_jacobian", "signals_jacobian", "signals_input_jacobian"),
    ),
}
"""Functions that are computed together, where a model has them: name, docstring, functions."""


def staged(functions: dict[str, Function], cites: Mapping[str, str]) -> dict[str, Function | Stage]:
    """Return all that is emitted: single functions, and stages of those that share steps."""
    stages: dict[str, Function | Stage] = {}
    taken = set()
    for name, (doc, names) in TOGETHER.items():
        members = tuple(functions[n] for n in names if n in functions)
        if len(members) > 1:
            stages[name] = Stage(name, _cited(doc, cites.get(name)), members)
            taken |= {member.name for member in members}
    return {n: f for n, f in functions.items() if n not in taken} | stages


def _cited(doc: str, place: str | None) -> str:
    """Return the docstring of a function, with its place in a publication."""
    return f"{doc.removesuffix('.')} ({place})." if place else doc


@dataclass(eq=False)
class Derivation:
    """All inputs of the emitters."""

    formulation: Formulation
    plan: CataloguePlan
    # arguments of the functions, in order
    states: DeclaredStates
    inputs: tuple[Input, ...]
    parameters: tuple[Entry, ...]
    relative: tuple[Entry, ...]  # relative coordinates, in order
    # all functions by name; `prepare` computes the constants that the others read
    functions: dict[str, Function]
    emitted: dict[str, Function | Stage]  # compiled code: functions, and stages of several
    prepare: Function
    design: Function  # from the parameters to the state at the design position
    # all guards of the model; the bit of a guard in a status word is its position here
    guards: tuple[Guard, ...]
    # constants of a parameter set that must be zero, or must not
    assumptions: tuple[Assumption, ...]
    conditions: tuple[Condition, ...]
    # names in the order of the arrays of poses and of Jacobians
    moving_bodies: tuple[str, ...]
    massive_bodies: tuple[str, ...]
    signals: tuple[Shown, ...]  # elements of the `signals` function, with their ranges and events
    # by variants in which joints are held: their rates, which are zero in these
    held_inputs: dict[str, tuple[str, ...]] = field(default_factory=dict)
    # positions of all steps in the derivation, by their names
    order: dict[str, int] = field(default_factory=dict)
    # derivatives with respect to parameters, on request
    by_parameters: ParameterDerivatives = field(default_factory=ParameterDerivatives)

    @property
    def state(self) -> tuple[Entry, ...]:
        """The elements of the state."""
        return self.states.entries

    @property
    def bounded(self) -> Function | None:
        """The signals with ranges, which every motion is checked for; None without any.

        They take far fewer operations than all signals.
        """
        names = {shown.name for shown in self.signals if shown.ranges}
        if not names:
            return None
        of = self.functions["signals"]
        results = {n: r for n, r in zip(of.labels, of.results, strict=True) if n in names}
        doc = "Signals that have ranges."
        return function_of(BOUNDED, doc, results, of.steps, of.guards, of.blocks, part=of.part)


@uncollected()
def generate(
    formulation: Formulation,
    *,
    derivatives: bool = True,
    parameter_derivatives: bool = False,
    progress: Notify = silent,
) -> Derivation:
    """Derive a model and its functions.

    `derivatives` are also those of the right-hand side and of the signals with respect to state and
    inputs, which take half of the time. A linearisation needs them, and a solver of stiff
    equations; no simulation with an explicit method does. `parameter_derivatives` are also those
    with respect to parameters: along a direction, and of weighted sums. `progress` is called with a
    short description of the present step.
    """
    progress("finding the loops and how they close")
    derivation = _Builder(formulation, derivatives=derivatives, notify=progress).build()
    if parameter_derivatives:
        progress("differentiating all functions with respect to the parameters")
        return _with_parameter_derivatives(derivation)
    return derivation


def _with_parameter_derivatives(derivation: Derivation) -> Derivation:
    found = derivatives_by_parameters(
        derivation.functions,
        derivation.prepare,
        derivation.design,
        {
            "parameters": [entry.name for entry in derivation.parameters],
            "constants": list(derivation.prepare.labels),
            "state": [entry.name for entry in derivation.state],
            "inputs": [entry.name for entry in derivation.inputs],
        },
    )
    kinks = kinks_of(derivation.functions["rhs"], [entry.name for entry in derivation.state])
    more = (*found.functions, *([kinks] if kinks else []))
    functions = {function.name: function for function in more}
    stages = [s for s in derivation.emitted.values() if isinstance(s, Stage)]
    together = list(found.stages(stages))
    taken = {member.name for stage in together for member in stage.members}
    alone = (function for function in more if function.name not in taken)
    emitted: tuple[Function | Stage, ...] = (*alone, *together)
    return replace(
        derivation,
        functions=derivation.functions | functions,
        emitted=derivation.emitted | {made.name: made for made in emitted},
        by_parameters=found,
    )


class _Builder:
    """Collects the functions of one model from one program."""

    def __init__(self, formulation: Formulation, *, derivatives: bool, notify: Notify) -> None:
        self.formulation = formulation
        self._notify = notify
        self.derivatives = derivatives
        self.mechanism: Mechanism = formulation.mechanism
        self.states = formulation.states
        self.plan = CataloguePlan.of(formulation)
        self.assumed = find_assumptions(self.plan)
        self.constants = ConstantStage(
            tuple(sp.Symbol(p.name) for p in self.mechanism.parameters),
            self._varying_names(),
            derived={sp.Symbol(n): value for n, value in self.mechanism.derived.items()},
        )
        self.program = Program(self.constants)
        notify("deriving positions, velocities and accelerations")
        self.motion = InMotion.of(self.program, self.plan)
        self.moving = tuple(b.name for b in self.mechanism.moving)
        self.massive = tuple(b for b in self.moving if formulation.has_mass(b))
        self._check_masses()
        notify(f"deriving the equations of motion of {len(self.massive)} bodies")
        self.dynamics = Dynamics(self.motion)
        self.relative = {part: RelativeCoordinates(part) for part in self.motion.parts}
        self.functions: dict[str, Function] = {}
        self.variant_of: dict[str, str] = {}
        self.signals: list[Shown] = []

    def _check_masses(self) -> None:
        """Raise an error for an independent coordinate that moves no mass."""
        moved = {k for body in self.massive for k in self.motion.placed[body].motion}
        idle = [
            f"independent joint {part.joint.name!r} moves no body in massive; add one that it moves"
            for part in self.states.joints
            if moved.isdisjoint(part.coordinates)
        ]
        if idle:
            raise DeclarationError(self.formulation.name, idle)

    def build(self) -> Derivation:
        self._add_dynamics(self.dynamics)
        for variant, joints in self.formulation.held.items():
            names = [joint.name for joint in joints]
            self._notify(f"deriving the equations of motion with {variant.replace('_', ' ')}")
            held = Dynamics(InMotion.of(Program(self.constants), self.plan, names))
            self._add_right_hand_side(held, variant)
        self._notify("deriving relative coordinates, poses and Jacobians")
        self._add_relative()
        self._add_poses()
        self._add_signals()
        # variants have the same guards under the same names
        acting = {g.name for f in self.functions.values() for g in f.guards}
        guards = tuple(g for g in self.program.guards.values() if g.name in acting)
        margins = self.program.pruned(
            "margins",
            "Quantities that are positive where the model is valid; if one is not, those "
            "after it are meaningless.",
            {g.name: g.margin for g in guards},
        )
        self.functions["margins"] = replace(margins, guards=())  # it reports, without an error
        self._notify(f"finding common subexpressions of {len(self.program.steps):,} steps")
        order = self._share()
        assumed = define_assumptions(self.program, self.assumed)
        prepare = self.constants.function(self.functions.values(), assumed)
        self._check_symbols(prepare)
        return Derivation(
            formulation=self.formulation,
            plan=self.plan,
            states=self.states,
            inputs=tuple(self._inputs()),
            parameters=tuple(Entry(p.name, p.unit, p.meaning) for p in self.mechanism.parameters),
            relative=tuple(Entry(c.name, c.unit, c.meaning) for c in self.mechanism.coordinates),
            functions=self.functions,
            emitted=staged(self.functions, self.formulation.cites),
            prepare=prepare,
            design=design_state(self.formulation),
            guards=guards,
            assumptions=assumed,
            conditions=tuple(self.constants.conditions.values()),
            moving_bodies=self.moving,
            massive_bodies=self.massive,
            signals=tuple(self.signals),
            held_inputs={
                variant: tuple(n for j in joints for n in self.formulation.prescribed[j].rates)
                for variant, joints in self.formulation.held.items()
            },
            order={name: place for place, name in enumerate(order)},
        )

    def _share(self) -> list[str]:
        """Share the common subexpressions of the functions; return their steps in order."""
        variants: dict[str, list[Function]] = {name: [] for name in ("", *self.formulation.held)}
        for name, function in self.functions.items():
            variants[self.variant_of.get(name, "")].append(function)
        functions, order = share_together(variants, self.program.steps, self.constants.has)
        self.functions |= {function.name: function for function in functions}
        return order

    def _check_symbols(self, prepare: Function) -> None:
        """Raise an error if the equations read undeclared symbols."""
        check_symbols(
            self.mechanism.name,
            {s.name for s in prepare.free_symbols},
            [p.name for p in self.mechanism.parameters],
            self.mechanism,
        )
        given = {f"given_{c.name}" for c in self.mechanism.coordinates}
        # callers give the coordinates to this function only
        read = {n: {s.name for s in f.free_symbols} for n, f in self.functions.items()}
        read["residuals"] -= given
        varying = set[str]().union(*read.values()) - set(prepare.labels)
        states = {e.name for e in self.states.entries}
        check_symbols(
            self.formulation.name,
            varying - states - {e.name for e in self._inputs()},
            [p.name for p in self.mechanism.parameters],
            self.mechanism,
        )

    def _varying_names(self) -> frozenset[str]:
        """Return the names of states, inputs and given coordinates."""
        coordinates = self.mechanism.coordinates
        names = [c.name for c in coordinates if c.joint in self.formulation.independent]
        names += [entry.name for entry in self.states.entries]
        given = [f"given_{c.name}" for c in coordinates]
        return frozenset([*names, *given, *self.formulation.inputs])

    # -- arrays ---------------------------------------------------------------------------------

    def _inputs(self) -> Iterator[Input]:
        """Yield the inputs, without those of forces along prescribed joints, which do no work."""
        acting = tuple(
            f for f in self.mechanism.forces if f.along not in self.formulation.prescribed
        )
        read = {part.name for part in parts(acting) if isinstance(part, Input)}
        read |= {
            entry.name for motion in self.formulation.prescribed.values() for entry in motion.inputs
        }
        yield from (entry for name, entry in self.formulation.inputs.items() if name in read)

    def _add(
        self, name: str, doc: str, results: dict[str, sp.Expr], shape: tuple[int, ...] = ()
    ) -> None:
        doc = _cited(doc, self.formulation.cites.get(name))
        self.functions[name] = self.program.pruned(name, doc, results, shape or None)

    # -- dynamics -------------------------------------------------------------------------------

    def _add_dynamics(self, dynamics: Dynamics) -> None:
        self._add_right_hand_side(dynamics)
        names = self.motion.coordinates.independent
        n = len(names)
        matrix = dynamics.mass_matrix()
        self._add(
            "mass_matrix",
            "Mass matrix M(q), row-major.",
            {
                f"M[{k},{other}]": matrix[i][j]
                for i, k in enumerate(names)
                for j, other in enumerate(names)
            },
            (n, n),
        )
        self._add(
            "bias",
            "Vector B(q, q'): inertia terms without accelerations.",
            dict(zip((f"B[{k}]" for k in names), dynamics.bias(), strict=True)),
        )
        self._add(
            "forces",
            "Generalised applied forces Q(q, q').",
            dict(zip((f"Q[{k}]" for k in names), dynamics.applied(), strict=True)),
        )

    def _add_right_hand_side(self, dynamics: Dynamics, variant: str = "") -> None:
        program, speed_of = dynamics.program, self.states.speed_of
        rates = {f"d({name})/dt": rate for name, rate in dynamics.moving.rates().items()}
        accelerations = ((k, dynamics.accelerations[k]) for k in dynamics.coordinates.independent)
        rates |= {f"d({speed_of[k]})/dt": a for k, a in accelerations}
        rates |= {f"d({name})/dt": rate for name, rate in dynamics.acting.internal_rates.items()}
        what = f" with {variant.replace('_', ' ')}" if variant else ""
        rhs, jacobian = ("_".join(filter(None, (n, variant))) for n in ("rhs", "rhs_jacobian"))
        self.variant_of |= dict.fromkeys((rhs, jacobian), variant)
        self.functions[rhs] = program.pruned(rhs, f"Time derivative of the state{what}.", rates)
        if self.derivatives:
            self._add_derivatives_of_rates(dynamics, rhs, jacobian, list(rates))

    def _add_derivatives_of_rates(
        self, dynamics: Dynamics, rhs: str, jacobian: str, labels: Sequence[str]
    ) -> None:
        program = dynamics.program
        program.section(f"derivatives of {rhs}")
        values = [
            *dynamics.moving.rates().values(),
            *dynamics.to_differentiate().values(),
            *dynamics.acting.internal_rates.values(),
        ]
        self._add_derivatives(program, jacobian, f"of {rhs}", values, labels, "state")
        if rhs == "rhs":
            name = "rhs_input_jacobian"
            self._add_derivatives(program, name, "of rhs", values, labels, "inputs")

    def _add_derivatives(
        self,
        program: Program,
        name: str,
        what: str,
        values: Iterable[sp.Expr],
        labels: Sequence[str],
        by: str,
        instead: Mapping[sp.Symbol, sp.Expr] | None = None,
    ) -> None:
        """Add the exact derivatives of some results with respect to the state or the inputs."""
        if not self.derivatives:
            return
        program.section(f"derivatives {what}")
        values = list(values)
        read = self.states.entries if by == "state" else self._inputs()
        symbols = [sp.Symbol(entry.name) for entry in read]
        title = f"differentiating {what.removeprefix('of ')} with respect to the {by}"
        columns = {
            s: program.tangents(s, values, str(s), instead)
            for s in counted(self._notify, title, symbols)
        }
        entries = {
            f"{label} by {symbol}": column[row]
            for row, label in enumerate(labels)
            for symbol, column in columns.items()
        }
        doc = f"Exact derivative {what} with respect to the {by}, row-major."
        function = program.pruned(name, doc, entries, (len(values), len(symbols)))
        self.functions[name] = replace(function, part=DERIVATIVES)

    # -- relative kinematics ----------------------------------------------------------------------

    def _add_relative(self) -> None:
        values = self._in_order([self._free(), *(r.values for r in self.relative.values())])
        names = self.motion.coordinates.independent
        self.program.section("relative Jacobian")
        self._add("relative_coordinates", "Relative joint coordinates beta.", values)
        columns = [
            self.program.along(direction, values.values(), f"by_{k}")
            for k, direction in self.dynamics.directions().items()
        ]
        self._add(
            "relative_jacobian",
            "Relative Jacobian, d(beta)/dq at fixed inputs, row-major.",
            {
                f"{beta} by {k}": columns[j][i]
                for i, beta in enumerate(values)
                for j, k in enumerate(names)
            },
            (len(values), len(names)),
        )
        free = {name: sp.Symbol(f"given_{name}") - value for name, value in self._free().items()}
        residuals = self._in_order([free, *(closure_residuals(r) for r in self.relative.values())])
        self._add(
            "residuals",
            "Closure residuals g(beta, q) for given beta.",
            {f"g_{name}": left for name, left in residuals.items()},
        )
        in_one_part = len(self.motion.bases) == len(self.motion.free)
        if in_one_part and all(
            self.relative[self.motion.part_of[body]].reaches(body) for body in self.massive
        ):
            self._add_absolute(list(values))
        self._add_global()

    def _free(self) -> dict[str, sp.Expr]:
        """Return the relative coordinates of bodies that move freely."""
        bases = {base.joint: base for base in self.motion.free}
        return {
            c.name: self.program.define(f"{c.name}_now", bases[c.joint].reported(c.kind))
            for c in self.mechanism.coordinates
            if c.joint in bases
        }

    def _in_order(self, parts: Iterable[dict[str, sp.Expr]]) -> dict[str, sp.Expr]:
        """Return the values of all relative coordinates, in the order of the report."""
        found = {name: value for part in parts for name, value in part.items()}
        return {c.name: found[c.name] for c in self.mechanism.coordinates}

    def _add_absolute(self, betas: list[str]) -> None:
        results = {}
        for body in self.massive:
            columns = self.relative[self.motion.part_of[body]].absolute_jacobian(body)
            for row, label in enumerate(self._twist_labels(body)):
                for beta in betas:
                    angular, linear = columns.get(beta, (ZERO, ZERO))
                    results[f"{label} by {beta}"] = [*angular, *linear][row]
        self._add(
            "absolute_jacobian",
            "Absolute Jacobian, twists of the massive bodies per relative rate, row-major.",
            results,
            (6 * len(self.massive), len(betas)),
        )

    @staticmethod
    def _twist_labels(body: str) -> list[str]:
        return [f"{body} omega_{a}" for a in AXES] + [f"{body} velocity_{a}" for a in AXES]

    def _add_global(self) -> None:
        names = self.motion.coordinates.independent
        results = {}
        for body in self.massive:
            columns = {k: self._twist(body, self.dynamics.along(k)) for k in names}
            for row, label in enumerate(self._twist_labels(body)):
                for k in names:
                    results[f"{label} by {k}"] = columns[k][row]
        self._add(
            "global_jacobian",
            "Global Jacobian, twists of the massive bodies per rate of q, row-major.",
            results,
            (6 * len(self.massive), len(names)),
        )

    def _twist(self, body: str, rates: Mapping[str, sp.Expr]) -> list[sp.Expr]:
        """Return (omega, velocity of the centre of mass) at rates of coordinates."""
        total: list[sp.Expr] = [sp.Integer(0)] * 6
        for coordinate, rate in rates.items():
            column = self._ground_twist(body, coordinate)
            total = [t + rate * c for t, c in zip(total, column, strict=True)]
        return total

    def _ground_twist(self, body: str, coordinate: str) -> list[sp.Expr]:
        """Return (omega, velocity of the centre of mass) per unit rate, in ground axes."""
        placed = self.motion.placed[body]
        if coordinate not in placed.motion:
            return [sp.Integer(0)] * 6
        twist = placed.motion[coordinate]
        center = self.motion.part_of[placed.body].local(placed, self.mechanism.body(body).center)
        velocity = twist.linear + twist.angular.cross(center)
        parts = (from_axes(placed.axes, v) for v in (twist.angular, velocity))
        return [c for part in parts for c in self.motion.part_of[placed.body].in_world(part)]

    # -- poses ----------------------------------------------------------------------------------

    def _add_poses(self) -> None:
        self.program.section("poses")
        positions: dict[str, sp.Expr] = {}
        orientations: dict[str, sp.Expr] = {}
        velocities: dict[str, sp.Expr] = {}
        for body in self.moving:
            placed = self.motion.placed[body]
            part, point = self.motion.part_of[body], self.mechanism.body(body).center
            center = placed.origin + from_axes(placed.axes, part.local(placed, point))
            for axis, value in zip(AXES, part.place_in_world(center), strict=True):
                positions[f"{body} {axis}"] = value
            for label, value in self._orientation(placed).items():
                orientations[f"{body} {label}"] = value
            rates = {k: self.motion.coordinates.true_rate(k) for k in placed.motion}
            labels = self._twist_labels(body)
            velocities |= dict(zip(labels, self._twist(body, rates), strict=True))
        count, axes = len(self.moving), self.mechanism.axes
        self._add(
            "positions", f"Centres of mass of the moving bodies, {axes}.", positions, (count, 3)
        )
        self._add(
            "orientations",
            f"Rotation matrices of the moving bodies from their design orientation, {axes}.",
            orientations,
            (count, 3, 3),
        )
        self._add(
            "velocities",
            f"Angular velocity, then velocity of the centre of mass, of the moving bodies, {axes}.",
            velocities,
            (count, 6),
        )

    def _orientation(self, placed: BodyMotion) -> dict[str, sp.Expr]:
        part = self.motion.part_of[placed.body]
        if placed.axes is IDENTITY and part.free is None:
            return {f"R{a}{b}": sp.Integer(int(a == b)) for a in AXES for b in AXES}
        now = [part.in_world(axis) for axis in placed.axes]
        design = [part.to_ground(axis) for axis in placed.design_axes]
        return {
            f"R{a}{b}": sum(
                (getattr(n, a) * getattr(d, b) for n, d in zip(now, design, strict=True)),
                sp.Integer(0),
            )
            for a in AXES
            for b in AXES
        }

    # -- signals --------------------------------------------------------------------------------

    def _add_signals(self) -> None:
        self.program.section("signals")
        results: dict[str, sp.Expr] = {}
        declared = (s for o in self.mechanism.outputs for s in signals_of(self.dynamics, o))
        taken = {e.name: "an element of the state" for e in self.states.entries}
        taken |= {i.name: "an input" for i in self._inputs()} | {TIME: "the time"}
        for shown in (*self.dynamics.acting.signals(self.dynamics.accelerations), *declared):
            if shown.name in results:
                problem = f"two signals are named {shown.name!r}; give the output another name"
                raise DeclarationError(self.formulation.name, [problem])
            if shown.name in taken:
                owner = taken[shown.name]
                problem = f"{shown.name!r} is the name of {owner} and of a signal; rename one"
                raise DeclarationError(self.formulation.name, [problem])
            self.signals.append(shown)
            results[shown.name] = shown.value
        if not results:
            return
        self._add("signals", "Physical signals, see the enumeration of signals.", results)
        for by, name in (("state", "signals_jacobian"), ("inputs", "signals_input_jacobian")):
            self._add_derivatives(
                self.program,
                name,
                "of the signals",
                results.values(),
                list(results),
                by,
                self.dynamics.differentiated,
            )
