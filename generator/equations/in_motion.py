"""A mechanism in motion: its parts that hang together through the ground alone.

Two sides of a machine are such parts: no closure equation has bodies of both. Each part is
solved by a `Kinematics` of its own, whose axes are chosen for it, so that it costs what it would
cost alone, and what is alike in the parts is one constant. Bodies whose motion is prescribed from
the ground on, like a rod that both sides share, are part of the ground here: every part places them
for itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import networkx as nx

from ..kinematics.coordinates import Coordinates
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
    """The bodies of a model in motion, part by part.

    Attributes
    ----------
    program
        Has the steps.
    coordinates
        Those that are driven.
    parts
        The kinematics of each part.
    placed, part_of
        Every body, and the part that it is in; of what all parts have in common, the first.
    """

    program: Program
    coordinates: Coordinates
    parts: tuple[Kinematics, ...]
    placed: dict[str, BodyMotion]
    part_of: dict[str, Kinematics]

    @classmethod
    def of(cls, program: Program, plan: Plan, held: Iterable[str] = ()) -> InMotion:
        """Carry out the steps of a plan.

        Parameters
        ----------
        held
            Prescribed joints that do not move in this variant.
        """
        coordinates = Coordinates(plan.formulation, held)
        common, groups = independent_groups(plan)
        parts = tuple(_moved(program, plan, common | group, coordinates) for group in groups)
        part_of: dict[str, Kinematics] = {}
        for part in parts:
            part_of |= {body: part for body in part.placed if body not in part_of}
        placed = {body: part.placed[body] for body, part in part_of.items()}
        return cls(program, coordinates, parts, placed, part_of)

    @property
    def formulation(self) -> Formulation:
        """Whose bodies they are."""
        return self.coordinates.formulation

    @property
    def mechanism(self) -> Mechanism:
        """Whose bodies they are."""
        return self.formulation.mechanism

    def part_with(self, *bodies: str) -> Kinematics | None:
        """Return the part that has some bodies, and their motion in equal axes, if there is one."""
        return next((part for part in self.parts if part.bodies.issuperset(bodies)), None)

    def relative_motion(self, first: tuple[str, Point], second: tuple[str, Point]) -> PointMotion:
        """Return the motion of a point of one body relative to one of another.

        It is in the work axes of their part, or in the axes of the ground between two parts.
        """
        ends = first, second
        part = self.part_with(*(body for body, _ in ends))
        if part is None:
            one, other = (_in_ground_axes(self.part_of[body], body, point) for body, point in ends)
        else:
            one, other = (part.point_motion(body, point) for body, point in ends)
        return other.minus(one)


def _moved(program: Program, plan: Plan, bodies: set[str], coordinates: Coordinates) -> Kinematics:
    """Carry out the steps of a plan that are about some bodies.

    What else takes part in them is of this part too, since nothing closes between two parts.
    """
    steps = [step for step in plan.steps if step.about in bodies]
    ground = plan.formulation.mechanism.ground
    origin = next((point for step in steps if (point := step.origin_on(ground))), None)
    kin = Kinematics(program, coordinates, plan.loops, bodies, origin)
    for step in steps:
        program.section(step.title)
        step.carry_out(kin)
    return kin


def _in_ground_axes(part: Kinematics, body: str, point: Point) -> PointMotion:
    motion = part.point_motion(body, point)
    return PointMotion(
        part.to_ground(motion.position) + part.work_origin,
        {k: part.to_ground(velocity) for k, velocity in motion.motion.items()},
        part.to_ground(motion.bias),
    )


def independent_groups(plan: Plan) -> tuple[set[str], list[set[str]]]:
    """Return the ground with what prescribed joints tie to it, and the groups of other bodies.

    Where all bodies are tied to it there is one group, of no others.
    """
    mechanism, graph = plan.formulation.mechanism, plan.topology.graph
    tied = nx.Graph([joint.bodies for joint in plan.formulation.prescribed])
    tied.add_node(mechanism.ground)
    common = nx.node_connected_component(tied, mechanism.ground)
    groups = nx.connected_components(graph.subgraph(set(graph) - common))
    numbers = {body.name: i for i, body in enumerate(mechanism.bodies)}
    in_order = sorted(groups, key=lambda group: min(numbers[body] for body in group))
    return common, in_order or [set()]
