"""Parts of a mechanism that hang together through the ground alone, each in axes of its own.

Two suspensions of an axle are such parts: no closure equation has bodies of both. Each part is
solved by a `Kinematics` of its own, whose axes are chosen for it, so that it costs what it would
cost alone, and what is alike in the parts is one constant. Bodies whose motion is prescribed from
the ground on, like a rack, are part of the ground here: every part places them for itself.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import networkx as nx

from ..kinematics.kinematics import Kinematics
from ..kinematics.motion import BodyMotion, OnLine, PointMotion

if TYPE_CHECKING:
    from collections.abc import Iterable

    import sympy as sp

    from ..declare.geometry import Direction, Point
    from ..declare.joints import Joint
    from ..loops.planner import Plan
    from ..program.program import Program
    from ..program.vectors import Twist, Vector


class Parts:
    """The bodies of a model in motion, part by part.

    Parameters
    ----------
    program
        Receives the steps.
    plan
        What to solve, in which order.
    held
        Prescribed joints that stand still in this variant.

    Attributes
    ----------
    parts
        The kinematics of each part.
    placed, telescopes, slides
        Those of all parts.
    """

    def __init__(self, program: Program, plan: Plan, held: Iterable[str] = ()) -> None:
        held = tuple(held)
        common, groups = independent_groups(plan)
        self.parts = [_moved(program, plan, common | group, held) for group in groups]
        self._owners = {
            body: part for part, group in zip(self.parts, groups, strict=True) for body in group
        }
        first = self.parts[0]
        self.program, self.plan, self.model = program, plan, plan.model
        self.mechanism = plan.model.mechanism
        self.moving, self.independent, self.rotors = first.moving, first.independent, first.rotors
        self.alone, self.pace, self.pace_of = first.alone, first.pace, first.pace_of
        self.true_rate, self.coordinate_of = first.true_rate, first.coordinate_of
        self.placed: dict[str, BodyMotion] = {}
        self.telescopes: dict[str, OnLine] = {}
        self.slides: dict[str, sp.Expr] = {}
        for part in self.parts:
            self.placed |= {b: p for b, p in part.placed.items() if b not in self.placed}
            self.telescopes |= part.telescopes
            self.slides |= part.slides

    def of(self, body: str) -> Kinematics:
        """Return the part of a body; of what all parts have in common, the first one."""
        return self._owners.get(body, self.parts[0])

    def of_joint(self, joint: Joint) -> Kinematics:
        """Return the part of a joint."""
        return next((self._owners[b] for b in joint.bodies if b in self._owners), self.parts[0])

    def local(self, placed: BodyMotion, point: Point) -> Vector:
        """Return the constant body coordinates of a point."""
        return self.of(placed.body).local(placed, point)

    def local_direction(self, placed: BodyMotion, direction: Direction) -> Vector:
        """Return the constant body components of a direction fixed in a body."""
        return self.of(placed.body).local_direction(placed, direction)

    def total(self, placed: BodyMotion) -> Twist:
        """Return the twist at the rates at which biases are computed."""
        return self.of(placed.body).total(placed)

    def point_bias(self, placed: BodyMotion, local: Vector) -> Vector:
        """Return the bias acceleration of a point of a body, in body axes."""
        return self.of(placed.body).point_bias(placed, local)

    def relative_motion(self, first: tuple[str, Point], second: tuple[str, Point]) -> PointMotion:
        """Return the motion of a point of one body relative to one of another.

        It is in the work axes of their part, or in chassis axes between two parts.
        """
        ends = first, second
        owners = {self._owners[body] for body, _ in ends if body in self._owners}
        if len(owners) > 1:
            one, other = (_in_chassis_axes(self.of(body), body, point) for body, point in ends)
        else:
            part = next(iter(owners), self.parts[0])
            one, other = (part.point_motion(body, point) for body, point in ends)
        return other.minus(one)


def _moved(program: Program, plan: Plan, bodies: set[str], held: Iterable[str]) -> Kinematics:
    """Carry out the steps of a plan that are about some bodies.

    What else takes part in them is of this part too, since nothing closes between two parts.
    """
    steps = [step for step in plan.steps if step.about in bodies]
    ground = plan.model.mechanism.ground
    origin = next((point for step in steps if (point := step.origin_on(ground))), None)
    kin = Kinematics(program, plan.model, plan.loops, bodies, origin, held)
    for step in steps:
        program.section(step.title)
        step.carry_out(kin)
    return kin


def _in_chassis_axes(part: Kinematics, body: str, point: Point) -> PointMotion:
    motion = part.point_motion(body, point)
    return PointMotion(
        part.to_chassis(motion.position) + part.work_origin,
        {k: part.to_chassis(velocity) for k, velocity in motion.motion.items()},
        part.to_chassis(motion.bias),
    )


def independent_groups(plan: Plan) -> tuple[set[str], list[set[str]]]:
    """Return the ground with what prescribed joints tie to it, and the groups of other bodies."""
    mechanism, graph = plan.model.mechanism, plan.topology.graph
    tied = nx.Graph([joint.bodies for joint in plan.model.prescribed])
    tied.add_node(mechanism.ground)
    common = nx.node_connected_component(tied, mechanism.ground)
    groups = nx.connected_components(graph.subgraph(set(graph) - common))
    numbers = {body.name: i for i, body in enumerate(mechanism.bodies)}
    return common, sorted(groups, key=lambda group: min(numbers[body] for body in group))
