"""Bodies in motion: coordinates and axes, and poses, velocities and biases as program steps."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..declare.evaluation import AtDefaults
from ..declare.geometry import UP, Direction, Point
from ..declare.joints import Joint, RelativeCoordinate, Revolute
from ..program.functions import SignOf
from ..program.vectors import IDENTITY, NO_TWIST, ZERO, Twist, Vector, from_axes, to_axes
from .motion import BodyMotion, Meeting, OffLine, OnLine, PointMotion, RodEnds, TelescopeEnds

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from ..declare.joints import RelativeCoordinate
    from ..program.program import Program
    from .base import Base
    from .coordinates import Coordinates


@dataclass(frozen=True)
class Loop:
    """A loop that a step closes: its number, its bodies and its joints."""

    number: int
    bodies: tuple[str, ...]
    joints: tuple[Joint, ...]


class Kinematics:
    """The bodies of a model in motion.

    `loops` has the loop that a step closes, by the step; `bodies` are those to place, with the
    ground: all, or a part that can be solved alone. `origin` is the point of the base that is the
    origin of positions; None: the origin of its axes. `free` is the moving body on which those
    bodies hang; None: they hang on the ground.

    Notes
    -----
    *Records.* `spans` and `turned` list the telescopes and rods that placed a body, `meetings` the
    points for which a hinge or guide was solved, by the joint: residuals are derived from them.

    *Base.* The ground or moving body on which the bodies hang is at rest here: motion is relative
    to it, and ground axes are those of the base at design. `Base` adds its own motion; `in_world`,
    `from_world` and `place_in_world` transform to and from the world.

    *Work axes.* The base-fixed axes in which positions are computed are chosen so that most
    components vanish: x along the hinge of the first revolute joint on the ground, z upward, origin
    at the point of the base at the first transformer. On a moving base they are its own axes,
    in which the contributions of all bodies on it are summed.
    """

    def __init__(
        self,
        program: Program,
        coordinates: Coordinates,
        loops: Mapping[object, Loop],
        bodies: Collection[str],
        origin: Point | None = None,
        free: Base | None = None,
    ) -> None:
        self.program = program
        self.coordinates = coordinates
        self.mechanism = coordinates.formulation.mechanism
        self.free = free
        self.base = self.mechanism.ground if free is None else free.body
        self._loops = loops
        self.at_defaults = AtDefaults(self.mechanism)
        self.bodies = frozenset(bodies)
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

    # -- design position ------------------------------------------------------------------------

    def _set_work_axes(self, origin: Point | None) -> None:
        self.program.section("work axes")
        self.work_hinge = next(
            (
                j
                for j in self.coordinates.driven
                if isinstance(j, Revolute) and j.first.name == self.base and j.angle_to
                if j.second.name in self.bodies and self.free is None
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
        self.placed[self.base] = BodyMotion(self.base)

    def _hinge_axes(self, hinge: Revolute) -> tuple[Vector, Vector]:
        """Return the positive hinge axis and the reference of its angle, in ground axes."""
        assert hinge.angle_to is not None
        axis = self.unit("hinge_axis", hinge.axis.vector)
        reference = hinge.angle_from.components
        z = self.unit("work_z", reference - axis * reference.dot(axis))
        arm = hinge.angle_to.position - hinge.axis.through.position
        sign = self.program.define("hinge_sense", SignOf(axis.dot(z.cross(arm))))
        return self.program.vector("work_x", axis * sign), z

    def closed_by(self, step: object) -> Loop | None:
        """Return the loop that a step closes; None where it closes none."""
        return self._loops.get(step)

    def loop_of(self, step: object) -> str:
        """Return the bodies of the loop that a step closes, for messages."""
        return f"the loop {' - '.join(self._loops[step].bodies)}"

    def unit(self, name: str, vector: Vector) -> Vector:
        """Append the unit vector along a constant vector; its name begins those of the steps."""
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

    def to_work(self, ground: Vector) -> Vector:
        """Return the work components of a vector in ground axes."""
        return to_axes(self.work_axes, ground)

    def to_ground(self, work: Vector) -> Vector:
        """Return the ground components of a vector in work axes."""
        return from_axes(self.work_axes, work)

    def in_world(self, work: Vector) -> Vector:
        """Return the components in the world of a vector in work axes."""
        v = self.to_ground(work)
        return v if self.free is None else self.free.to_world(v)

    def place_in_world(self, work: Vector) -> Vector:
        """Return the position in the world of a place in work axes."""
        place = self.to_ground(work) + self.work_origin
        return place if self.free is None else self.free.place(place)

    def from_world(self, direction: Direction) -> Vector:
        """Return a unit direction that is fixed in the world, in work axes."""
        design = self.design_direction(direction)
        if self.free is None:
            return design
        return self.to_work(self.free.from_world(self.to_ground(design)))

    @property
    def height_of_origin(self) -> sp.Expr:
        """Height of the origin of the work axes in the world [m]."""
        return self.work_origin.z if self.free is None else self.free.place(self.work_origin).z

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
        """Return the constant coordinates of a point in body axes."""
        if point not in placed.local:
            arm = self.program.vector(
                f"{placed.body}_arm_{point.name}", self.design(point) - placed.design_origin
            )
            placed.local[point] = self.program.vector(
                f"{placed.body}_{point.name}", to_axes(placed.design_axes, arm), "123"
            )
        return placed.local[point]

    def local_direction(self, placed: BodyMotion, direction: Direction) -> Vector:
        """Return the constant components in body axes of a direction fixed in a body."""
        return self.program.vector(
            f"{placed.body}_{direction.name}",
            to_axes(placed.design_axes, self.design_direction(direction)),
            "123",
        )

    # -- motion ---------------------------------------------------------------------------------

    def given(self, joint: Joint) -> sp.Expr:
        """Return the coordinate of a joint that is driven, or follows one that is."""
        symbol = self.coordinates.symbols[self.coordinates.of(joint)]
        if joint.gear is None:
            return symbol
        kind = joint.coordinates[0]
        return self.program.define(
            f"{joint.name}_{kind}_geared", self.coordinates.ratio(joint) * symbol
        )

    def position(self, placed: BodyMotion, point: Point) -> Vector:
        """Return the position of a point of a placed body, in work axes."""
        offset = from_axes(placed.axes, self.local(placed, point))
        return self.program.vector(f"at_{self._label(placed.body, point)}", placed.origin + offset)

    def _label(self, body: str, point: Point) -> str:
        """Return a name for a point's motion, without that of the first body that carries it."""
        owner = self._owners.setdefault(point, body)
        return point.name if owner == body else f"{point.name}_on_{body}"

    def total(self, placed: BodyMotion) -> Twist:
        """Return the twist at the rates at which biases are computed."""
        if placed.total is not None:
            return placed.total()
        twist = NO_TWIST
        for coordinate, motion in placed.motion.items():
            twist += motion * self.coordinates.rate(coordinate)
        return self.define_twist(placed.body, "now", twist)

    def define_twist(self, body: str, label: str, twist: Twist) -> Twist:
        """Append the components of a twist; the label is the coordinate or ``now``."""
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
        """Return the bias acceleration of a point of a body, given in body axes, in body axes."""
        bias, omega = placed.bias(), self.total(placed).angular
        return bias.linear + bias.angular.cross(local) + omega.cross(omega.cross(local))

    def point_motion(self, body: str, point: Point) -> PointMotion:
        """Return position, velocities and bias acceleration of a point, in work axes."""
        if (body, point) not in self._points:
            self._points[body, point] = self.motion_of(self.placed[body], point)
        return self._points[body, point]

    def motion_of(self, placed: BodyMotion, point: Point) -> PointMotion:
        """Append the motion of a point of a body."""
        label, local = self._label(placed.body, point), self.local(placed, point)
        motion = {}
        for coordinate, twist in placed.motion.items():
            velocity = from_axes(placed.axes, twist.linear + twist.angular.cross(local))
            motion[coordinate] = self.program.vector(f"d_{label}_{coordinate}", velocity)
        bias = self.program.vector(
            f"bias_{label}", from_axes(placed.axes, self.point_bias(placed, local))
        )
        return PointMotion(self.position(placed, point), motion, bias)

    @property
    def reported(self) -> list[RelativeCoordinate]:
        """The relative coordinates of the report at the joints of this part."""
        return [c for c in self.mechanism.coordinates if self.bodies.issuperset(c.joint.bodies)]
