"""A mechanism in motion: parts that are connected through their base alone.

A base is the ground, a body that moves freely, or one to which joints lead from the ground while
all other bodies hang on it, as a car's body. Two sides of a machine are parts: no closure equation
has bodies of both. Each part is solved by a `Kinematics` of its own, in axes chosen for it, so that
it costs the same as alone, and equal constants of the parts are one constant. Bodies whose motion
relative to the base is prescribed, like a rod that both sides share, are part of the base here:
every part places them. Each free body is a part of its own, too.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NoReturn

import networkx as nx
import sympy as sp

from ..declare.declared import DeclarationError
from ..declare.joints import Free
from ..kinematics.base import Base, FreeBase
from ..kinematics.carried import Carried
from ..kinematics.coordinates import Coordinates
from ..kinematics.jointed import jointed_base
from ..kinematics.jointed_base import JointedBase
from ..kinematics.kinematics import Kinematics
from ..kinematics.motion import BodyMotion, PointMotion

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ..declare.formulation import Formulation
    from ..declare.geometry import Point
    from ..declare.mechanism import Mechanism
    from ..loops.planner import Plan
    from ..program.program import Program


@dataclass(frozen=True)
class InMotion:
    """The bodies of a model in motion, part by part."""

    program: Program  # has the steps
    coordinates: Coordinates  # driven ones
    # bodies that move and carry others: those that move freely, and one on joints
    bases: tuple[Base, ...]
    parts: tuple[Kinematics, ...]  # kinematics of each part
    # every body with its motion in the world, and its part; for common bodies, the first part
    placed: dict[str, BodyMotion]
    part_of: dict[str, Kinematics]
    carried: dict[str, Carried]  # bodies on a moving base, and the base itself, by name

    @classmethod
    def of(cls, program: Program, plan: Plan, held: Iterable[str] = ()) -> InMotion:
        """Return the bodies in motion by the steps of a plan, with some held joints at rest."""
        coordinates = Coordinates(plan.formulation, held)
        joints = (part.joint for part in coordinates.states.free)
        bases: dict[str, Base] = {
            j.second.name: FreeBase.of(program, j, coordinates.true_rate)
            for j in joints
            if isinstance(j, Free)
        }
        roots = []
        if jointed := jointed_base(plan.formulation):
            links, body = jointed
            way = {plan.formulation.mechanism.ground, *links, body}
            roots = [
                _moved(program, plan, way, coordinates, plan.formulation.mechanism.ground, None)
            ]
            bases[body] = JointedBase.of(program, roots[0], body)
        groups = groups_of(plan, jointed)
        hung = tuple(
            _moved(program, plan, group.bodies, coordinates, group.base, bases.get(group.base))
            for group in groups
        )
        parts = (*hung, *roots)
        part_of: dict[str, Kinematics] = {}
        for part in parts:
            part_of |= {body: part for body in part.placed if body not in part_of}
        carried = {
            body: Carried(part.free, part, part.placed[body])
            for body, part in part_of.items()
            if part.free is not None
        }
        placed = {
            body: carried[body].motion if body in carried else part.placed[body]
            for body, part in part_of.items()
        }
        return cls(program, coordinates, tuple(bases.values()), parts, placed, part_of, carried)

    @property
    def free(self) -> tuple[FreeBase, ...]:
        """The bodies that move freely."""
        return tuple(base for base in self.bases if isinstance(base, FreeBase))

    @property
    def formulation(self) -> Formulation:
        """The model."""
        return self.coordinates.formulation

    @property
    def mechanism(self) -> Mechanism:
        """The mechanism."""
        return self.formulation.mechanism

    def part_with(self, *bodies: str) -> Kinematics | None:
        """Return the part with some bodies, whose motion it has in equal axes; None without one."""
        return next((part for part in self.parts if part.bodies.issuperset(bodies)), None)

    def directions(self) -> dict[str, dict[sp.Symbol, sp.Expr]]:
        """Return the columns of N(q) in q' = N(q) v, by the coordinates in their order."""
        found = {k: {sp.Symbol(k): sp.Integer(1)} for k in self.coordinates.unconstrained}
        for base in self.free:
            found |= base.directions()
        return found

    def rates(self) -> dict[str, sp.Expr]:
        """Return the rates of all positions of the state, by their names."""
        found = {k: self.coordinates.true_rate(k) for k in self.coordinates.unconstrained}
        for base in self.free:
            found |= base.rates()
        return {entry.name: found[entry.name] for entry in self.coordinates.states.positions}

    def point_motion(self, body: str, point: Point) -> PointMotion:
        """Return the motion of a point in the world, in the work axes of its part."""
        part = self.part_of[body]
        if part.free is None:
            return part.point_motion(body, point)
        return part.motion_of(self.placed[body], point)

    def relative_motion(self, first: tuple[str, Point], second: tuple[str, Point]) -> PointMotion:
        """Return the motion of a point of one body relative to one of another.

        It is in the work axes of their part, in the axes of their base between two parts of one, or
        in those of the world. The motion of a common base is left out: it changes no distance.
        """
        ends = first, second
        part = self.part_with(*(body for body, _ in ends))
        if part is None:
            parts = [self.part_of[body] for body, _ in ends]
            whole = parts[0].free is not parts[1].free
            one, other = (self._in_axes(body, point, whole) for body, point in ends)
        else:
            one, other = (part.point_motion(body, point) for body, point in ends)
        return other.minus(one)

    def _in_axes(self, body: str, point: Point, whole: bool) -> PointMotion:
        """Return the motion of a point relative to its base, or the whole motion in the world."""
        part = self.part_of[body]
        motion = self.point_motion(body, point) if whole else part.point_motion(body, point)
        turned = part.in_world if whole else part.to_ground
        place = part.to_ground(motion.position) + part.work_origin
        return PointMotion(
            part.place_in_world(motion.position) if whole else place,
            {k: turned(velocity) for k, velocity in motion.motion.items()},
            turned(motion.bias),
        )


def _moved(
    program: Program,
    plan: Plan,
    bodies: set[str],
    coordinates: Coordinates,
    base: str,
    free: Base | None,
) -> Kinematics:
    """Carry out the steps of a plan that place some bodies.

    Other bodies of these steps are of the same part, since no loop closes between two parts.
    """
    own = bodies if free is None else bodies - {base}
    steps = [step for step in plan.steps if step.about in own]
    center = None if free is None else free.point
    origin = next((point for step in steps if (point := step.origin_on(base))), center)
    kin = Kinematics(program, coordinates, plan.loops, bodies, origin, free)
    for step in steps:
        program.section(step.title)
        step.emit(kin)
    return kin


@dataclass(frozen=True)
class Group:
    """Bodies that are solved together, and their base."""

    base: str  # ground, or a moving body
    # bodies that prescribed joints tie to the base, itself included, and the others
    bodies: set[str]


def groups_of(plan: Plan, jointed: tuple[list[str], str] | None = None) -> list[Group]:
    """Return the parts in which a mechanism is solved, those on the ground first.

    A free body is one of its own. Where all bodies on a base are tied to it, they are one group,
    without others. Raises `DeclarationError` if a loop closes through two bases.
    """
    mechanism, graph = plan.formulation.mechanism, plan.topology.graph
    free = [part.joint.second.name for part in plan.formulation.states.free]
    links, on_joints = ([], []) if jointed is None else (jointed[0], [jointed[1]])
    free += on_joints
    # where joints lead from the ground to a base, nothing else hangs on the ground
    bases = free if on_joints else [mechanism.ground, *free]
    tied = nx.Graph([joint.bodies for joint in plan.formulation.prescribed])
    tied.add_nodes_from(bases)
    common = {base: nx.node_connected_component(tied, base) for base in bases}
    held = set().union(*common.values())
    numbers = {body.name: i for i, body in enumerate(mechanism.bodies)}
    held |= {mechanism.ground, *links}
    others = nx.connected_components(graph.subgraph(set(graph) - held))
    on_base: dict[str, list[set[str]]] = {base: [] for base in bases}
    for group in sorted(others, key=lambda group: min(numbers[body] for body in group)):
        touched = {b for b in bases if nx.node_boundary(graph, group, common[b])}
        if len(touched) > 1:
            _refuse_loop(plan, touched, group)
        on_base[touched.pop()].append(group)
    found = []
    for base in bases:
        alone = Group(base, {base})
        hung = [Group(base, common[base] | group) for group in on_base[base] or [set()]]
        found += [alone, *(group for group in hung if group != alone)] if base in free else hung
    return found


def _refuse_loop(plan: Plan, bases: set[str], group: set[str]) -> NoReturn:
    """Raise an error for bodies that hang on two bases: one of these is not free."""
    names, hung = (", ".join(map(repr, sorted(n))) for n in (bases, group))
    problem = (
        f"{hung} hang on several of the bodies {names}; one of these rests or moves freely, so "
        "the free one is not free. Leave out a joint of the loop through both, or let a "
        "ForceElement connect the two"
    )
    raise DeclarationError(plan.formulation.name, [problem])
