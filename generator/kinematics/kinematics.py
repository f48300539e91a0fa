"""Carry out a plan: poses, velocities and bias accelerations of all bodies, as program steps."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import networkx as nx
import sympy as sp

from .. import closed_forms as solutions
from ..declare.evaluation import AtDefaults
from ..declare.geometry import FORWARD, UP, Direction, Point
from ..declare.joints import Joint, Prismatic, Revolute
from ..loops.actions import PlaceByJoint, Solution, SolveTelescope
from ..program.functions import SignOf
from ..program.vectors import NO_TWIST, UNIT_X, UNIT_Z, ZERO, Twist, Vector
from .hinge_angles import HingeDesign
from .motion import IDENTITY, Axes, OffLine, OnLine, Placed, PointMotion, from_axes, to_axes

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator

    from ..declare.assembly import Body, RelativeCoordinate
    from ..loops.actions import Action
    from ..loops.planner import Plan
    from ..program.program import Program


class Kinematics:
    """The bodies of a model in motion.

    Parameters
    ----------
    program
        Receives the steps.
    plan
        What to solve, in which order.
    held
        Prescribed joints that stand still in this variant.
    bodies
        Those to place, with the ground: all, or a part that can be solved by itself.

    Notes
    -----
    *Unit rate.* Bodies that hang together without the ground, and that a single coordinate moves
    (rotors apart), have their biases computed for a unit rate of that coordinate; they are scaled
    by the square of the true rate at the very end. `pace` is the true rate for such a coordinate,
    and one for all others, whose biases are computed at the true rates.

    *Work axes.* The ground-fixed axes in which positions are computed are chosen so that most
    components vanish: x along the hinge of the first ground-fixed revolute joint, z upward, origin
    at the ground-fixed point of the first transformer.
    """

    def __init__(
        self,
        program: Program,
        plan: Plan,
        held: Iterable[str] = (),
        bodies: Collection[str] | None = None,
    ) -> None:
        self.program = program
        self.plan = plan
        self.model = plan.model
        self.mechanism = plan.model.mechanism
        self._at_defaults = AtDefaults(self.mechanism)
        self.held = frozenset(held)
        self.bodies = frozenset(plan.topology.graph if bodies is None else bodies)
        self.coordinates = {
            self.coordinate_of(j): sp.Symbol(self._coordinate_symbol(j)) for j in self._driven
        }
        self.moving = [self.coordinate_of(j) for j in self._driven if j.name not in self.held]
        self.rotors = self._rotors()
        self.alone = frozenset(self._moving_alone())
        self.placed: dict[str, Placed] = {}
        self.on_line: dict[str, OnLine] = {}
        self.off_line: dict[str, OffLine] = {}
        self.telescopes: dict[str, OnLine] = {}
        self.slides: dict[str, sp.Expr] = {}
        self.angles: dict[str, sp.Expr] = {}
        self.rod_lengths: dict[str, sp.Expr] = {}
        self._points: dict[tuple[str, Point], PointMotion] = {}
        self._owners: dict[Point, str] = {}
        self._set_work_axes()
        self._run()

    # -- coordinates ----------------------------------------------------------------------------

    @property
    def _driven(self) -> list[Joint]:
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
        return f"{name}_position" if joint.name in self.model.prescribed else name

    def driven_coordinates(self) -> Iterator[tuple[sp.Symbol, sp.Expr, bool]]:
        """Yield symbol, value at design, and whether it is an angle, of each driven coordinate."""
        for joint in (j for j in self._driven if j.second in self.bodies):
            start = sp.Integer(0)
            if isinstance(joint, Revolute) and joint.angle_to is not None:
                start = HingeDesign.of(self, joint).angle(self.program, joint.name)
            symbol = self.coordinates[self.coordinate_of(joint)]
            yield symbol, start, isinstance(joint, Revolute)

    @property
    def independent(self) -> list[str]:
        """Names of the independent coordinates, in the order of the state."""
        return [self.coordinate_of(self.mechanism.joint(n)) for n in self.model.independent]

    def true_rate(self, coordinate: str) -> sp.Symbol:
        """Return the symbol of the rate of a coordinate."""
        prescribed = coordinate in self.model.prescribed.values()
        return sp.Symbol(f"{coordinate}_velocity" if prescribed else f"{coordinate}_rate")

    def rate(self, coordinate: str) -> sp.Expr:
        """Return the rate of a coordinate at which biases are computed."""
        return sp.Integer(1) if coordinate in self.alone else self.true_rate(coordinate)

    def pace(self, coordinate: str) -> sp.Expr:
        """Return by whose square the biases of what a coordinate moves are to be scaled."""
        return self.true_rate(coordinate) if coordinate in self.alone else sp.Integer(1)

    def pace_of(self, placed: Placed) -> sp.Expr:
        """Return by whose square the bias of a body is to be scaled."""
        alone = [k for k in placed.motion if k in self.alone]
        return self.pace(alone[0]) if alone else sp.Integer(1)

    def _moving_alone(self) -> Iterator[str]:
        """Yield the independent coordinates that alone move bodies that hang together."""
        moving = set(self.plan.topology.graph) - self._still()
        drives = {
            j.second: self.coordinate_of(j)
            for j in self._driven
            if self.coordinate_of(j) in self.moving and self.coordinate_of(j) not in self.rotors
        }
        for bodies in nx.connected_components(self.plan.topology.graph.subgraph(moving)):
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
        if coordinate in self.model.prescribed.values() and coordinate in self.moving:
            return sp.Symbol(f"{coordinate}_acceleration")
        return sp.Integer(0)

    def _rotors(self) -> dict[str, Body]:
        """Return the bodies of revolution at the end of a chain, by their spin coordinate."""
        rotors = {}
        for joint in self._driven:
            body = self.mechanism.body(joint.second)
            leaf = len(self.mechanism.joints_of(body.name)) == 1
            if isinstance(joint, Revolute) and leaf and body.rotor_axis is not None:
                rotors[self.coordinate_of(joint)] = body
        return rotors

    # -- design position ------------------------------------------------------------------------

    def _set_work_axes(self) -> None:
        self.program.section("work axes")
        self._hinge = next(
            (
                j
                for j in self._driven
                if isinstance(j, Revolute) and j.first == self.mechanism.ground and j.angle_to
                if j.second in self.bodies
            ),
            None,
        )
        self.work_origin = self._ground_anchor()
        self.work_axes = IDENTITY
        if self._hinge is not None:
            x, z = self._hinge_axes(self._hinge)
            y = self.program.vector("work_y", z.cross(x))
            if self._hinge.angle_from == UP:  # z leans from up towards x: y stays level
                y = Vector(y.x, y.y, sp.Integer(0))
            self.work_axes = (x, y, z)
        ground = self.mechanism.ground
        self.placed[ground] = Placed(ground)

    def _ground_anchor(self) -> Vector:
        for action in self._actions:
            if isinstance(action, SolveTelescope) and action.anchor_body == self.mechanism.ground:
                return action.anchor.position
        return ZERO

    def _hinge_axes(self, hinge: Revolute) -> tuple[Vector, Vector]:
        """Return the positive hinge axis and the reference of its angle, in chassis axes."""
        assert hinge.angle_to is not None
        axis = self.unit("hinge_axis", hinge.axis.vector)
        reference = hinge.angle_from.components
        z = self.unit("work_z", reference - axis * reference.dot(axis))
        arm = hinge.angle_to.position - hinge.axis.through.position
        sign = self.program.define("hinge_sense", SignOf(axis.dot(z.cross(arm))))
        return self.program.vector("work_x", axis * sign), z

    def loop_of(self, action: Solution) -> str:
        """Return the bodies of the loop that an action solves, for messages."""
        transformer = next(t for t in self.plan.transformers if t.action == action)
        return f"the loop {' - '.join(transformer.cycle.bodies)}"

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
        if direction == UP and self._hinge is not None and self._hinge.angle_from == UP:
            x, _, z = self.work_axes  # y is perpendicular to up by construction
            return Vector(x.z, sp.Integer(0), z.z)
        if direction.fixed is not None:
            vector = direction.components
        else:
            vector = self.unit(f"unit_{direction.name}", direction.components)
        return self.program.vector(f"work_{direction.name}", self.to_work(vector))

    def local(self, placed: Placed, point: Point) -> Vector:
        """Return the constant body coordinates of a point."""
        if point not in placed.local:
            arm = self.program.vector(
                f"{placed.body}_arm_{point.name}", self.design(point) - placed.design_origin
            )
            placed.local[point] = self.program.vector(
                f"{placed.body}_{point.name}", to_axes(placed.design_axes, arm), "123"
            )
        return placed.local[point]

    def local_direction(self, placed: Placed, direction: Direction) -> Vector:
        """Return the constant body components of a direction fixed in a body."""
        return self.program.vector(
            f"{placed.body}_{direction.name}",
            to_axes(placed.design_axes, self.design_direction(direction)),
            "123",
        )

    # -- motion ---------------------------------------------------------------------------------

    def position(self, placed: Placed, point: Point) -> Vector:
        """Return where a point of a placed body is, in work axes."""
        offset = from_axes(placed.axes, self.local(placed, point))
        return self.program.vector(f"at_{self._label(placed.body, point)}", placed.origin + offset)

    def _label(self, body: str, point: Point) -> str:
        """Return a name for a point's motion; the first body that carries it needs none in it."""
        owner = self._owners.setdefault(point, body)
        return point.name if owner == body else f"{point.name}_on_{body}"

    def total(self, placed: Placed) -> Twist:
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

    def point_bias(self, placed: Placed, local: Vector) -> Vector:
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

    # -- carrying out the plan ------------------------------------------------------------------

    @property
    def _actions(self) -> list[Action]:
        """The actions of the plan that are about bodies of this part.

        What else takes part in them is of this part too, since nothing closes between two parts.
        """
        return [action for action in self.plan.actions if action.body in self.bodies]

    @property
    def reported(self) -> list[RelativeCoordinate]:
        """The relative coordinates of the report at the joints of this part."""
        return [
            c
            for c in self.mechanism.coordinates
            if self.bodies.issuperset(self.mechanism.joint(c.joint).bodies)
        ]

    def _run(self) -> None:
        for action in self._actions:
            self.program.section(action.title)
            if isinstance(action, PlaceByJoint):
                self._place_by_joint(action)
            else:
                solutions.CATALOGUE[type(action)](self, action)

    def _place_by_joint(self, action: PlaceByJoint) -> None:
        if isinstance(action.joint, Revolute):
            self._place_revolute(action.joint, action.parent, action.child)
        else:
            self._place_prismatic(action.joint, action.parent, action.child)

    def _place_revolute(self, joint: Revolute, parent_name: str, child: str) -> None:
        parent = self.placed[parent_name]
        coordinate = self.coordinate_of(joint)
        angle = self.coordinates[coordinate]
        frame = self._revolute_frame(joint, parent, child)
        cosine = self.program.define(f"cos_{angle}", sp.cos(angle))
        sine = self.program.define(f"sin_{angle}", sp.sin(angle))

        def turn(v: Vector) -> Vector:
            """From the parent's body axes to the child's."""
            x, y, z = to_axes(frame.parent_axes, v)
            return Vector(x, cosine * y + sine * z, cosine * z - sine * y)

        x, y, z = (from_axes(parent.axes, axis) for axis in frame.parent_axes)
        axes = (x, y * cosine + z * sine, z * cosine - y * sine)
        placed = Placed(
            child,
            origin=self.program.vector(
                f"{child}_origin", parent.origin + from_axes(parent.axes, frame.origin)
            ),
            axes=self.program.axes((f"{child}_axis", f"{child}_side", f"{child}_top"), axes),
            design_origin=frame.design_origin,
            design_axes=frame.design_axes,
            local=frame.local,
            carrier=(parent_name, frame.origin),
        )
        for k, twist in parent.motion.items():
            velocity = twist.linear + twist.angular.cross(frame.origin)
            placed.motion[k] = self.define_twist(
                child, k, Twist(turn(twist.angular), turn(velocity))
            )
        if coordinate in self.moving:
            placed.motion[coordinate] = Twist(UNIT_X, ZERO)

        def bias() -> Twist:
            if coordinate in self.rotors and self.pace_of(parent) != 1:
                message = f"the bias of rotor {child!r} is not available at a unit rate"
                raise ValueError(message)
            carried = parent.bias()
            omega = turn(self.total(parent).angular)
            spin = UNIT_X * (self.rate(coordinate) if coordinate in self.moving else 0)
            angular = (
                turn(carried.angular) + omega.cross(spin) + UNIT_X * self.acceleration(coordinate)
            )
            linear = turn(self.point_bias(parent, frame.origin))
            return self.define_bias(child, Twist(angular, linear))

        placed.bias = bias
        self.placed[child] = placed

    def _revolute_frame(self, joint: Revolute, parent: Placed, child: str) -> _HingeFrame:
        """Return the axes of a hinge on both of its bodies."""
        through = self.design(joint.axis.through)
        if joint is self._hinge:
            assert joint.angle_to is not None
            point = self.design(joint.angle_to)
            axis, z_parent = UNIT_X, UNIT_Z
            origin = Vector(point.x, through.y, through.z)
            arm = self.program.vector(f"{child}_arm", point - origin)
            radius = self.program.define(f"{child}_radius", sp.sqrt(arm.y**2 + arm.z**2))
            z_child = self.program.vector(f"{child}_top_design", arm * (1 / radius))
            local = {joint.angle_to: Vector(ZERO.x, ZERO.y, radius)}
        elif joint.angle_to is not None:
            design = HingeDesign.of(self, joint)
            axis, z_parent, z_child = design.axis, design.zero, design.mark
            origin = self.program.vector(f"{child}_foot", through + axis * design.along)
            local = {joint.angle_to: Vector(ZERO.x, ZERO.y, design.radius)}
        else:
            axis = self.unit(f"{child}_axis_design", self.to_work(joint.axis.vector))
            z_parent = self._beside(joint, child, axis)
            origin, z_child = through, z_parent
            local = {joint.axis.through: ZERO}
        design_axes = (
            axis,
            self.program.vector(f"{child}_side_design", z_child.cross(axis)),
            z_child,
        )
        start = (axis, self.program.vector(f"{child}_side_zero", z_parent.cross(axis)), z_parent)
        parent_axes = self.program.axes(
            (f"{child}_axis_on_parent", f"{child}_side_on_parent", f"{child}_top_on_parent"),
            (to_axes(parent.design_axes, v) for v in start),
            "123",
        )
        on_parent = self.program.vector(
            f"{child}_origin_on_parent",
            to_axes(parent.design_axes, origin - parent.design_origin),
            "123",
        )
        return _HingeFrame(parent_axes, on_parent, origin, design_axes, local)

    def _beside(self, joint: Revolute, child: str, axis: Vector) -> Vector:
        """Return any unit vector across a hinge whose angle counts from the design position.

        A chassis axis where that makes the shortest equations; it is far enough from the hinge
        with the default parameters, and no more is asked of it. Otherwise one without a singular
        direction of the hinge.
        """
        n = [self._at_defaults(component) for component in joint.axis.vector]
        size = math.hypot(*n)
        if all(component.is_number for component in joint.axis.vector):
            reference = FORWARD if abs(n[0]) <= abs(n[2]) else UP
        elif abs(n[2]) < size / 2:
            reference = UP
        else:
            return self.across(child, axis)[1]
        v = self.design_direction(reference)
        return self.unit(f"{child}_top_design", v - axis * v.dot(axis))

    def _place_prismatic(self, joint: Prismatic, parent_name: str, child: str) -> None:
        parent = self.placed[parent_name]
        coordinate = self.coordinate_of(joint)
        slide = self.coordinates[coordinate]
        direction = self.local_direction(parent, joint.direction)
        start = parent.design_origin
        offset = direction * slide
        placed = Placed(
            child,
            origin=self.program.vector(
                f"{child}_origin", parent.origin + from_axes(parent.axes, offset)
            ),
            axes=parent.axes,
            design_origin=start,
            design_axes=parent.design_axes,
        )
        for k, twist in parent.motion.items():
            velocity = twist.linear + twist.angular.cross(offset)
            placed.motion[k] = self.define_twist(child, k, Twist(twist.angular, velocity))
        if coordinate in self.moving:  # that of a strut turns its first link as well
            carried = placed.motion.get(coordinate, NO_TWIST)
            placed.motion[coordinate] = carried + Twist(ZERO, direction)

        def bias() -> Twist:
            carried = parent.bias()
            omega = self.total(parent).angular
            speed = direction * (self.rate(coordinate) if coordinate in self.moving else 0)
            linear = (
                self.point_bias(parent, offset)
                + omega.cross(speed) * 2
                + direction * self.acceleration(coordinate)
            )
            return self.define_bias(child, Twist(carried.angular, linear))

        placed.bias = bias
        self.placed[child] = placed


class _HingeFrame:
    """Axes and origin of a hinge: on the parent at angle zero, and on the child at design."""

    def __init__(
        self,
        parent_axes: Axes,
        origin: Vector,
        design_origin: Vector,
        design_axes: Axes,
        local: dict[Point, Vector],
    ) -> None:
        self.parent_axes = parent_axes
        self.origin = origin
        self.design_origin = design_origin
        self.design_axes = design_axes
        self.local = local
