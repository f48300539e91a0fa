"""Bodies in motion: coordinates and axes, and poses, velocities and biases as program steps."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import networkx as nx
import sympy as sp

from ..declare.evaluation import AtDefaults
from ..declare.geometry import UP, Direction, Point
from ..declare.joints import Joint, Revolute
from ..program.functions import SignOf
from ..program.vectors import NO_TWIST, ZERO, Twist, Vector
from .motion import (
    IDENTITY,
    BodyMotion,
    Meeting,
    OffLine,
    OnLine,
    PointMotion,
    RodEnds,
    TelescopeEnds,
    from_axes,
    to_axes,
)

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from ..declare.assembly import Body, RelativeCoordinate
    from ..declare.model import Model
    from ..program.program import Program


@dataclass(frozen=True)
class Loop:
    """A loop that a step closes: its number, its bodies and its joints."""

    number: int
    bodies: tuple[str, ...]
    joints: tuple[Joint, ...]


class Kinematics:
    """The bodies of a model in motion.

    Parameters
    ----------
    program
        Receives the steps.
    model
        Whose bodies they are.
    loops
        The loop that a step closes, by the step.
    bodies
        Those to place, with the ground: all, or a part that can be solved by itself.
    origin
        A point of the ground at which positions are best counted; None: the origin of the chassis.
    held
        Prescribed joints that stand still in this variant.

    Notes
    -----
    *Unit rate.* Bodies that hang together without the ground, and that a single coordinate moves
    (rotors apart), have their biases computed for a unit rate of that coordinate; they are scaled
    by the square of the true rate at the very end. `pace` is the true rate for such a coordinate,
    and one for all others, whose biases are computed at the true rates.

    *Records.* `spans` and `turned` say which telescopes and rods placed a body, `meetings` what a
    hinge or guide was solved for, by the joint: the residuals are derived from them.

    *Work axes.* The ground-fixed axes in which positions are computed are chosen so that most
    components vanish: x along the hinge of the first ground-fixed revolute joint, z upward, origin
    at the ground-fixed point of the first transformer.
    """

    def __init__(
        self,
        program: Program,
        model: Model,
        loops: Mapping[object, Loop],
        bodies: Collection[str],
        origin: Point | None = None,
        held: Iterable[str] = (),
    ) -> None:
        self.program = program
        self.model = model
        self.mechanism = model.mechanism
        self._loops = loops
        self.at_defaults = AtDefaults(self.mechanism)
        self.held = frozenset(held)
        self.motions = model.motions
        self.bodies = frozenset(bodies)
        self._graph = nx.Graph([joint.bodies for joint in self.mechanism.joints])
        self.coordinates = {
            self.coordinate_of(j): sp.Symbol(self._coordinate_symbol(j)) for j in self.driven
        }
        self.moving = [self.coordinate_of(j) for j in self.driven if j.name not in self.held]
        self.rotors = self._rotors()
        self.alone = frozenset(self._moving_alone())
        self.placed: dict[str, BodyMotion] = {}
        self.on_line: dict[str, OnLine] = {}
        self.off_line: dict[str, OffLine] = {}
        self.telescopes: dict[str, OnLine] = {}
        self.spans: dict[str, TelescopeEnds] = {}
        self.turned: dict[str, RodEnds] = {}
        self.meetings: dict[str, Meeting] = {}
        self.slides: dict[str, sp.Expr] = {}
        self.angles: dict[str, sp.Expr] = {}
        self.rod_lengths: dict[str, sp.Expr] = {}
        self._points: dict[tuple[str, Point], PointMotion] = {}
        self._owners: dict[Point, str] = {}
        self._set_work_axes(origin)

    # -- coordinates ----------------------------------------------------------------------------

    @property
    def driven(self) -> list[Joint]:
        """The joints whose coordinates are independent or prescribed."""
        names = (*self.model.independent, *self.model.prescribed)
        return [self.mechanism.joint(n) for n in names]

    def coordinate_of(self, joint: Joint) -> str:
        """Return the key of a driven coordinate: a reported name, or that of the input."""
        if joint.name in self.model.prescribed:
            return self.model.prescribed[joint.name]
        return next(c.name for c in self.mechanism.coordinates if c.joint == joint.name)

    def is_driven(self, joint: Joint) -> bool:
        """Tell whether a joint's coordinate is independent or prescribed."""
        return joint.name in (*self.model.independent, *self.model.prescribed)

    def _coordinate_symbol(self, joint: Joint) -> str:
        name = self.coordinate_of(joint)
        return self.motions[name].position if name in self.motions else name

    @property
    def independent(self) -> list[str]:
        """Names of the independent coordinates, in the order of the state."""
        return [self.coordinate_of(self.mechanism.joint(n)) for n in self.model.independent]

    def true_rate(self, coordinate: str) -> sp.Symbol:
        """Return the symbol of the rate of a coordinate."""
        motion = self.motions.get(coordinate)
        return sp.Symbol(f"{coordinate}_rate" if motion is None else motion.velocity)

    def rate(self, coordinate: str) -> sp.Expr:
        """Return the rate of a coordinate at which biases are computed."""
        return sp.Integer(1) if coordinate in self.alone else self.true_rate(coordinate)

    def pace(self, coordinate: str) -> sp.Expr:
        """Return by whose square the biases of what a coordinate moves are to be scaled."""
        return self.true_rate(coordinate) if coordinate in self.alone else sp.Integer(1)

    def pace_of(self, placed: BodyMotion) -> sp.Expr:
        """Return by whose square the bias of a body is to be scaled."""
        alone = [k for k in placed.motion if k in self.alone]
        return self.pace(alone[0]) if alone else sp.Integer(1)

    def _moving_alone(self) -> Iterator[str]:
        """Yield the independent coordinates that alone move bodies that hang together."""
        moving = set(self._graph) - self._still()
        drives = {
            j.second: self.coordinate_of(j)
            for j in self.driven
            if self.coordinate_of(j) in self.moving and self.coordinate_of(j) not in self.rotors
        }
        for bodies in nx.connected_components(self._graph.subgraph(moving)):
            pacing = [k for body, k in drives.items() if body in bodies]
            if len(pacing) == 1 and pacing[0] in self.independent:
                yield pacing[0]

    def _still(self) -> set[str]:
        """Return the ground, and the bodies that held joints tie to it."""
        held = [self.mechanism.joint(name) for name in self.held]
        tied = nx.Graph([joint.bodies for joint in held])
        tied.add_node(self.mechanism.ground)
        return set(nx.node_connected_component(tied, self.mechanism.ground))

    def acceleration(self, coordinate: str) -> sp.Expr:
        """Return the part of a coordinate's acceleration that is given: that of an input."""
        if coordinate in self.motions and coordinate in self.moving:
            return sp.Symbol(self.motions[coordinate].acceleration)
        return sp.Integer(0)

    def _rotors(self) -> dict[str, Body]:
        """Return the bodies of revolution at the end of a chain, by their spin coordinate."""
        rotors = {}
        for joint in self.driven:
            body = self.mechanism.body(joint.second)
            leaf = len(self.mechanism.joints_of(body.name)) == 1
            if isinstance(joint, Revolute) and leaf and body.rotor_axis is not None:
                rotors[self.coordinate_of(joint)] = body
        return rotors

    # -- design position ------------------------------------------------------------------------

    def _set_work_axes(self, origin: Point | None) -> None:
        self.program.section("work axes")
        self.work_hinge = next(
            (
                j
                for j in self.driven
                if isinstance(j, Revolute) and j.first == self.mechanism.ground and j.angle_to
                if j.second in self.bodies
            ),
            None,
        )
        self.work_origin = ZERO if origin is None else origin.position
        self.work_axes = IDENTITY
        if self.work_hinge is not None:
            x, z = self._hinge_axes(self.work_hinge)
            y = self.program.vector("work_y", z.cross(x))
            if self.work_hinge.angle_from == UP:  # z leans from up towards x: y stays level
                y = Vector(y.x, y.y, sp.Integer(0))
            self.work_axes = (x, y, z)
        ground = self.mechanism.ground
        self.placed[ground] = BodyMotion(ground)

    def _hinge_axes(self, hinge: Revolute) -> tuple[Vector, Vector]:
        """Return the positive hinge axis and the reference of its angle, in chassis axes."""
        assert hinge.angle_to is not None
        axis = self.unit("hinge_axis", hinge.axis.vector)
        reference = hinge.angle_from.components
        z = self.unit("work_z", reference - axis * reference.dot(axis))
        arm = hinge.angle_to.position - hinge.axis.through.position
        sign = self.program.define("hinge_sense", SignOf(axis.dot(z.cross(arm))))
        return self.program.vector("work_x", axis * sign), z

    def closed_by(self, step: object) -> Loop | None:
        """Return the loop that a step closes; none where it closes none."""
        return self._loops.get(step)

    def loop_of(self, step: object) -> str:
        """Return the bodies of the loop that a step closes, for messages."""
        return f"the loop {' - '.join(self._loops[step].bodies)}"

    def unit(self, name: str, vector: Vector) -> Vector:
        """Append the unit vector along a constant vector."""
        v = self.program.vector(f"{name}_vector", vector)
        length = self.program.define(f"{name}_norm", sp.sqrt(v.dot(v)))
        return self.program.vector(name, v * (1 / length))

    def across(self, name: str, n: Vector) -> tuple[Vector, Vector]:
        """Append two unit vectors across a constant one, without a case for any direction.

        Duff et al., Building an Orthonormal Basis, Revisited, JCGT 6(1), 2017.
        """
        s = self.program.define(f"{name}_half_space", SignOf(n.z))
        a = self.program.define(f"{name}_slope", -1 / (s + n.z))
        b = self.program.define(f"{name}_skew", n.x * n.y * a)
        side = Vector(1 + s * n.x * n.x * a, s * b, -s * n.x)
        top = Vector(b, s + n.y * n.y * a, -n.y)
        return (
            self.program.vector(f"{name}_side_design", side),
            self.program.vector(f"{name}_top_design", top),
        )

    def design(self, point: Point) -> Vector:
        """Return the design position of a point in work axes."""
        offset = self.program.vector(f"offset_{point.name}", point.position - self.work_origin)
        return self.program.vector(f"design_{point.name}", self.to_work(offset))

    def to_work(self, chassis: Vector) -> Vector:
        """Return the work components of a vector in chassis axes."""
        return to_axes(self.work_axes, chassis)

    def to_chassis(self, work: Vector) -> Vector:
        """Return the chassis components of a vector in work axes."""
        return from_axes(self.work_axes, work)

    def design_direction(self, direction: Direction) -> Vector:
        """Return a unit direction in work axes at the design position."""
        if direction == UP and self.work_hinge is not None and self.work_hinge.angle_from == UP:
            x, _, z = self.work_axes  # y is perpendicular to up by construction
            return Vector(x.z, sp.Integer(0), z.z)
        if direction.fixed is not None:
            vector = direction.components
        else:
            vector = self.unit(f"unit_{direction.name}", direction.components)
        return self.program.vector(f"work_{direction.name}", self.to_work(vector))

    def local(self, placed: BodyMotion, point: Point) -> Vector:
        """Return the constant body coordinates of a point."""
        if point not in placed.local:
            arm = self.program.vector(
                f"{placed.body}_arm_{point.name}", self.design(point) - placed.design_origin
            )
            placed.local[point] = self.program.vector(
                f"{placed.body}_{point.name}", to_axes(placed.design_axes, arm), "123"
            )
        return placed.local[point]

    def local_direction(self, placed: BodyMotion, direction: Direction) -> Vector:
        """Return the constant body components of a direction fixed in a body."""
        return self.program.vector(
            f"{placed.body}_{direction.name}",
            to_axes(placed.design_axes, self.design_direction(direction)),
            "123",
        )

    # -- motion ---------------------------------------------------------------------------------

    def position(self, placed: BodyMotion, point: Point) -> Vector:
        """Return where a point of a placed body is, in work axes."""
        offset = from_axes(placed.axes, self.local(placed, point))
        return self.program.vector(f"at_{self._label(placed.body, point)}", placed.origin + offset)

    def _label(self, body: str, point: Point) -> str:
        """Return a name for a point's motion; the first body that carries it needs none in it."""
        owner = self._owners.setdefault(point, body)
        return point.name if owner == body else f"{point.name}_on_{body}"

    def total(self, placed: BodyMotion) -> Twist:
        """Return the twist at the rates at which biases are computed."""
        twist = NO_TWIST
        for coordinate, motion in placed.motion.items():
            twist += motion * self.rate(coordinate)
        return self.define_twist(placed.body, "now", twist)

    def define_twist(self, body: str, label: str, twist: Twist) -> Twist:
        """Append the components of a twist."""
        return Twist(
            self.program.vector(f"{body}_omega_{label}", twist.angular, "123"),
            self.program.vector(f"{body}_velocity_{label}", twist.linear, "123"),
        )

    def define_bias(self, body: str, twist: Twist) -> Twist:
        """Append the components of a bias acceleration."""
        return Twist(
            self.program.vector(f"{body}_alpha", twist.angular, "123"),
            self.program.vector(f"{body}_acceleration", twist.linear, "123"),
        )

    def point_bias(self, placed: BodyMotion, local: Vector) -> Vector:
        """Return the bias acceleration of a point of a body, in body axes."""
        bias, omega = placed.bias(), self.total(placed).angular
        return bias.linear + bias.angular.cross(local) + omega.cross(omega.cross(local))

    def point_motion(self, body: str, point: Point) -> PointMotion:
        """Return position, velocities and bias acceleration of a point, in work axes."""
        if (body, point) in self._points:
            return self._points[body, point]
        placed, label = self.placed[body], self._label(body, point)
        local = self.local(placed, point)
        motion = {}
        for coordinate, twist in placed.motion.items():
            velocity = from_axes(placed.axes, twist.linear + twist.angular.cross(local))
            motion[coordinate] = self.program.vector(f"d_{label}_{coordinate}", velocity)
        bias = self.program.vector(
            f"bias_{label}", from_axes(placed.axes, self.point_bias(placed, local))
        )
        self._points[body, point] = PointMotion(self.position(placed, point), motion, bias)
        return self._points[body, point]

    @property
    def reported(self) -> list[RelativeCoordinate]:
        """The relative coordinates of the report at the joints of this part."""
        return [
            c
            for c in self.mechanism.coordinates
            if self.bodies.issuperset(self.mechanism.joint(c.joint).bodies)
        ]
