"""Relative joint coordinates: their values, the closure residuals, the absolute Jacobian.

These are the quantities of sections 4.1 to 4.3 of the paper. They are derived from the joints, not
from the closed forms: `residuals` and `absolute_jacobian` follow the chain of joints with explicit
rotations, and so check what `closed_forms` solved.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..declare.geometry import Point
from ..declare.joints import Cylindrical, Free, Joint, Prismatic, Revolute, Universal, Weld
from ..kinematics.chain import before_telescope, chain_to, reported
from ..kinematics.hinge_angles import angle_of, is_first_axis, positive_axis_at_design, turn_between
from ..program.floors import DIRECTION
from ..program.vectors import (
    IDENTITY,
    UNIT_X,
    UNIT_Y,
    UNIT_Z,
    ZERO,
    Axes,
    Vector,
    from_axes,
    to_axes,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..declare.joints import RelativeCoordinate
    from ..kinematics.kinematics import Kinematics
    from ..kinematics.motion import BodyMotion, RodEnds, TelescopeEnds


@dataclass(frozen=True)
class _Shaft:
    """A shaft on its universal joint, in the z-x sequence: x' and z' beside the line."""

    elevation: sp.Expr
    azimuth: sp.Expr
    x: Vector
    z: Vector
    up: Vector


@dataclass(frozen=True)
class _Screw:
    """Motion of the rest of the chain per unit rate of one relative coordinate (work axes)."""

    coordinate: str
    angular: Vector
    through: Vector
    linear: Vector


def rotate_x(angle: sp.Expr, v: Vector) -> Vector:
    """Return a vector turned about x by a right-handed angle [rad]."""
    c, s = sp.cos(angle), sp.sin(angle)
    return Vector(v.x, c * v.y - s * v.z, s * v.y + c * v.z)


def rotate_y(angle: sp.Expr, v: Vector) -> Vector:
    """Return a vector turned about y by a right-handed angle [rad]."""
    c, s = sp.cos(angle), sp.sin(angle)
    return Vector(c * v.x + s * v.z, v.y, c * v.z - s * v.x)


def rotate_z(angle: sp.Expr, v: Vector) -> Vector:
    """Return a vector turned about z by a right-handed angle [rad]."""
    c, s = sp.cos(angle), sp.sin(angle)
    return Vector(c * v.x - s * v.y, s * v.x + c * v.y, v.z)


class RelativeCoordinates:
    """The relative coordinates that a mechanism reports.

    `values` are expressions by coordinate name, in the order of the report.
    """

    def __init__(self, kin: Kinematics) -> None:
        self.kin = kin
        self.program = kin.program
        self.mechanism = kin.mechanism
        self._shafts: dict[str, _Shaft] = {}
        self.program.section("relative coordinates")
        self.values = {c.name: self._value(c) for c in kin.reported}

    # -- values ---------------------------------------------------------------------------------

    def _value(self, coordinate: RelativeCoordinate) -> sp.Expr:
        joint = coordinate.joint
        if isinstance(joint, Revolute | Prismatic):
            return self._hinge_or_guide(joint)
        if isinstance(joint, Universal):
            shaft = self._shaft(joint)
            return shaft.elevation if coordinate.kind == "elevation" else shaft.azimuth
        if isinstance(joint, Cylindrical) and coordinate.kind == "slide":
            return self.kin.slides[joint.name]
        assert isinstance(joint, Cylindrical)
        return self._telescope_angle(joint)

    def _hinge_or_guide(self, joint: Revolute | Prismatic) -> sp.Expr:
        """Return the coordinate of a joint that is driven, solved, or between placed bodies."""
        if self.kin.coordinates.is_given(joint):
            return self.kin.given(joint)
        if isinstance(joint, Prismatic):
            return self.kin.slides[joint.name]
        return angle_of(self.kin, joint)

    def _shaft(self, joint: Universal) -> _Shaft:
        """Angles of a shaft relative to the first body of its universal joint."""
        if joint.name in self._shafts:
            return self._shafts[joint.name]
        program, name = self.program, joint.name
        parent = self.kin.placed[joint.first.name]
        n = self.shaft_direction(joint)
        squared = program.guarded(
            f"shaft_level_squared_{name}",
            n.x**2 + n.y**2,
            f"the shaft at universal joint {name} is vertical: its azimuth is undefined",
            "1",
            DIRECTION,
        )
        level = program.define(f"shaft_level_{name}", sp.sqrt(squared))
        x = Vector(n.y / level, -n.x / level, ZERO.z)
        self._shafts[name] = _Shaft(
            elevation=program.define(f"elevation_{name}", sp.atan2(n.z, level)),
            azimuth=program.define(f"azimuth_{name}", sp.atan2(-n.x, n.y)),
            x=self._from_first_body(parent, f"shaft_x_{name}", x),
            z=self._from_first_body(parent, f"shaft_z_{name}", x.cross(n)),
            up=self._from_first_body(parent, f"shaft_up_{name}", UNIT_Z),
        )
        return self._shafts[name]

    def shaft_direction(self, joint: Universal) -> Vector:
        """Return the unit vector of a shaft along the ground axes that the first body carries."""
        seen = self._in_first_body(self.kin.placed[joint.first.name], self._line(joint))
        return self.program.vector(f"shaft_{joint.name}", seen)

    def _line(self, joint: Universal) -> Vector:
        """Return the unit vector along a shaft: that of its ends, or one that its body carries."""
        body = joint.second.name
        if body in self.kin.on_line:
            return self.kin.on_line[body].direction
        placed = self.kin.placed[body]
        design = self.kin.unit(f"{joint.name}_line", self.kin.to_work(joint.shaft.vector))
        local = to_axes(placed.design_axes, design)
        carried = from_axes(placed.axes, self.program.vector(f"{joint.name}_line_on", local, "123"))
        return self.program.vector(f"{joint.name}_line_now", carried)

    def _in_first_body(self, parent: BodyMotion, work: Vector) -> Vector:
        """Return components along the ground axes as the first body carries them with it."""
        if parent.axes is IDENTITY:
            return self.kin.to_ground(work)
        return from_axes(self._ground_axes(parent), to_axes(parent.axes, work))

    def _ground_axes(self, placed: BodyMotion) -> Axes:
        """Return the body axes at the design position, in ground axes."""
        x, y, z = (self.kin.to_ground(axis) for axis in placed.design_axes)
        return x, y, z

    def _from_first_body(self, parent: BodyMotion, name: str, v: Vector) -> Vector:
        if parent.axes is not IDENTITY:
            v = from_axes(parent.axes, to_axes(self._ground_axes(parent), v))
            return self.program.vector(name, v)
        return self.program.vector(name, self.kin.to_work(v))

    def _telescope_angle(self, joint: Cylindrical) -> sp.Expr:
        """Rotation of the second body about the axis, from the z' axis of the shaft."""
        shaft = self._shaft(self.holder(joint))
        placed = self.kin.placed[joint.second.name]
        local = self.from_axis(placed, joint, joint.angle_to)
        marker = self.program.vector(f"marker_{joint.name}", from_axes(placed.axes, local))
        return self.program.define(
            f"angle_{joint.name}", sp.atan2(-marker.dot(shaft.x), marker.dot(shaft.z))
        )

    def from_axis(self, placed: BodyMotion, joint: Cylindrical, point: Point) -> Vector:
        """Return a point of a telescope's second body, relative to the axis point of that."""
        assert isinstance(joint.axis.through, Point)
        return self.kin.local(placed, point) - self.kin.local(placed, joint.axis.through)

    def holder(self, joint: Cylindrical) -> Universal:
        """Return the universal joint that carries the first body of a telescope."""
        center = joint.axis.towards
        universal = (
            self.mechanism.universal_at(joint.first.name, center)
            if isinstance(center, Point)
            else None
        )
        if universal is None:
            message = (
                f"the angle of joint {joint.name!r} is reported from the frame of a universal "
                f"joint at {joint.first.name!r}, which has none"
            )
            raise ValueError(message)
        return universal

    # -- absolute Jacobian ------------------------------------------------------------------------

    def absolute_jacobian(self, body: str) -> dict[str, tuple[Vector, Vector]]:
        """Return angular velocity and velocity of the centre of mass per relative rate.

        They are in ground axes, by coordinate name. Where the report has several copies of a
        coordinate, the first one is used.
        """
        placed = self.kin.placed[body]
        center = self.kin.position(placed, self.mechanism.body(body).center)
        columns = {}
        joints = chain_to(self.mechanism, body)
        assert joints is not None, body
        for screw in (s for joint in joints for s in self._screws_in(joints, joint)):
            linear = screw.linear + screw.angular.cross(center - screw.through)
            columns[screw.coordinate] = (
                self.kin.to_ground(screw.angular),
                self.kin.to_ground(linear),
            )
        return columns

    def reaches(self, body: str) -> bool:
        """Return whether joints with reported coordinates lead from the ground to a body."""
        return chain_to(self.mechanism, body) is not None

    def _screws_in(self, chain: Sequence[Joint], joint: Joint) -> list[_Screw]:
        """Return the screws of a joint of a chain; the cross of a shaft determines its turn.

        The angle of a telescope behind it counts from the z-x sequence.
        """
        screws = self._screws(joint)
        if isinstance(joint, Universal) and not before_telescope(chain, joint):
            return [self._on_cross(joint, screw) for screw in screws]
        return screws

    def _screws(self, joint: Joint) -> list[_Screw]:
        names = {c: reported(self.mechanism, joint.name, c) or "" for c in joint.coordinates}
        if isinstance(joint, Weld):
            return []
        if isinstance(joint, Revolute):
            return [self._screw_of_hinge(joint, names["angle"])]
        if isinstance(joint, Prismatic):
            parent = self.kin.placed[joint.first.name]
            direction = from_axes(parent.axes, self.kin.local_direction(parent, joint.direction))
            return [_Screw(names["slide"], ZERO, ZERO, direction)]
        if isinstance(joint, Universal):
            shaft = self._shaft(joint)
            center = self.kin.point_motion(joint.first.name, joint.at).position
            return [
                _Screw(names["azimuth"], shaft.up, center, ZERO),
                _Screw(names["elevation"], shaft.x, center, ZERO),
            ]
        assert isinstance(joint, Cylindrical)
        line = self.kin.telescopes[joint.name]
        through = line.anchor_motion.position
        return [
            _Screw(names["slide"], ZERO, ZERO, -line.direction),
            _Screw(names["angle"], -line.direction, through, ZERO),
        ]

    def _screw_of_hinge(self, joint: Revolute, name: str) -> _Screw:
        """Return the screw of a hinge; a body that it placed has its axis as the first one."""
        kin = self.kin
        first, second = (kin.placed[body] for body in joint.bodies)
        if is_first_axis(kin, joint):
            return _Screw(name, second.axes[0], second.origin, ZERO)
        n = positive_axis_at_design(kin, joint)
        axis = from_axes(first.axes, to_axes(first.design_axes, n))
        return _Screw(name, axis, kin.position(first, joint.axis.through), ZERO)

    def _on_cross(self, joint: Universal, screw: _Screw) -> _Screw:
        """Return a screw of a shaft with the turn by its cross, instead of the z-x sequence."""
        n, second, third = self._cross_axes(joint)
        parent = self.kin.placed[joint.first.name]
        axis = from_axes(parent.axes, self.kin.local_direction(parent, joint.first_axis))
        hinge = second.cross(axis)
        across = screw.angular - n * screw.angular.dot(n)
        turn = -across.dot(hinge) / axis.dot(third)
        return _Screw(screw.coordinate, across + n * turn, screw.through, screw.linear)

    def _cross_axes(self, joint: Universal) -> Axes:
        """Return line and second axis of a shaft, and the axis across both."""
        placed, line = self.kin.placed[joint.second.name], self._line(joint)
        if placed.axes[0] == line:  # the cross placed the shaft: its axes are these
            return placed.axes
        design = self.kin.unit(f"{joint.name}_line", self.kin.to_work(joint.shaft.vector))
        second = self.kin.unit(
            f"{joint.name}_second", self.kin.design_direction(joint.first_axis).cross(design)
        )
        local = self.program.vector(
            f"{joint.name}_second_on", to_axes(placed.design_axes, second), "123"
        )
        now = self.program.vector(f"{joint.name}_second_now", from_axes(placed.axes, local))
        return line, now, line.cross(now)

    # -- residuals --------------------------------------------------------------------------------

    def residuals(self) -> dict[str, sp.Expr]:
        """Return g(beta, q): one residual for each relative coordinate (Eqs. 4 to 13), by its name.

        The coordinates are inputs of their own, named ``given_<coordinate>``.
        """
        self.program.section("closure residuals")
        closure = _Closure(self)
        return {c.name: closure.residual(c) for c in self.kin.reported}


# Components of the closure at the end of an offset telescope, by the coordinate they determine.
_AXIS_OF_CLOSURE = {"azimuth": "x", "slide": "y", "elevation": "z"}


class _Closure:
    """The closure equations in terms of given relative coordinates."""

    def __init__(self, relative: RelativeCoordinates) -> None:
        self.relative = relative
        self.kin = relative.kin
        self.program = relative.program
        self.mechanism = relative.mechanism

    def residual(self, coordinate: RelativeCoordinate) -> sp.Expr:
        """Return the residual of the equation of a given coordinate."""
        first = reported(self.mechanism, coordinate.joint.name, coordinate.kind)
        given = self._given(coordinate.name)
        if first is not None and first != coordinate.name:
            return given - self._given(first)
        joint = coordinate.joint
        if isinstance(joint, Revolute | Prismatic):
            return self._solved_residual(joint, given)
        offset = self._offset_telescope(joint)
        if offset is not None and coordinate.kind in _AXIS_OF_CLOSURE:
            opening = self._opening_at_end(offset)
            return dict(zip("xyz", opening, strict=True))[_AXIS_OF_CLOSURE[coordinate.kind]]
        if isinstance(joint, Universal):
            return self._shaft_residual(joint, coordinate.kind, given)
        assert isinstance(joint, Cylindrical)
        if coordinate.kind == "slide":
            span = self._telescope_span(joint)
            length = sp.sqrt(span.dot(span))
            return length - (joint.length_at_zero_slide.symbol - given)
        return self._rod_residual(joint)

    def _solved_residual(self, joint: Revolute | Prismatic, given: sp.Symbol) -> sp.Expr:
        """Return the closure that a hinge or guide was solved for, at a given coordinate.

        It is the length of a rod that holds the body, or the meeting at the pin for a rod's own
        hinge.
        """
        if self.kin.coordinates.is_given(joint):
            return given - self.kin.given(joint)
        meeting = self.kin.meetings.get(joint.name)
        if meeting is None or (isinstance(joint, Revolute) and joint.angle_to is not None):
            return self._placed_residual(joint, given)
        parent, sense = (
            self.kin.placed[meeting.parent],
            1 if joint.second.name == meeting.body else -1,
        )
        target = self.kin.point_motion(meeting.target_body, meeting.target).position
        local = self.kin.local(parent, meeting.point)
        moved = self._moved(joint, parent, local, sense * given)
        opening = parent.origin + from_axes(parent.axes, moved) - target
        opening = self.program.vector(f"given_opening_{joint.name}", opening)
        if meeting.rod is None:
            return opening.dot(self.kin.placed[meeting.body].axes[2])
        return sp.sqrt(opening.dot(opening)) - self.kin.rod_lengths[meeting.rod]

    def _placed_residual(self, joint: Revolute | Prismatic, given: sp.Symbol) -> sp.Expr:
        """Return a given coordinate less that of the poses; of an angle, the sine."""
        if isinstance(joint, Prismatic):
            return given - self._slide_between(joint)
        sine, cosine = turn_between(self.kin, joint)
        return cosine * sp.sin(given) - sine * sp.cos(given)

    def _slide_between(self, joint: Prismatic) -> sp.Expr:
        """Return the displacement of a guide's second body along it, relative to the first one."""
        first, second = (self.kin.placed[body] for body in joint.bodies)
        start = to_axes(first.design_axes, second.design_origin - first.design_origin)
        start = self.program.vector(f"{joint.name}_start", start, "123")
        way = to_axes(first.axes, second.origin - first.origin) - start
        return self.kin.local_direction(first, joint.direction).dot(way)

    def _moved(
        self, joint: Revolute | Prismatic, parent: BodyMotion, local: Vector, given: sp.Expr
    ) -> Vector:
        """Return the position of a point that a joint's coordinate moves, in parent axes."""
        if isinstance(joint, Prismatic):
            return local + self.kin.local_direction(parent, joint.direction) * given
        through = self.kin.local(parent, joint.axis.through)
        axis = self.kin.unit(f"{joint.name}_axis_design", self.kin.to_work(joint.axis.vector))
        n = to_axes(parent.design_axes, axis)
        arm = local - through
        along = n * n.dot(arm)
        across = (arm - along) * sp.cos(given) + n.cross(arm) * sp.sin(given)
        return through + along + across

    def _shaft_residual(self, joint: Universal, kind: str, given: sp.Symbol) -> sp.Expr:
        """Return Eqs. 7 and 8: the angles of a shaft against its direction."""
        n = self._shaft_direction(joint)
        if kind == "elevation":
            return sp.sin(given) - n.z
        level = self.program.define(f"given_level_{joint.name}", sp.sqrt(n.x**2 + n.y**2))
        return n.x / level + sp.sin(given)

    def _given(self, name: str) -> sp.Symbol:
        return sp.Symbol(f"given_{name}")

    def _copies(self, joint: str, kind: str) -> list[sp.Symbol]:
        """Return the copies of a coordinate: first that of the transformer that solves it."""
        entries = self.mechanism.coordinates
        return [self._given(c.name) for c in entries if (c.joint.name, c.kind) == (joint, kind)]

    def _driven(self) -> dict[sp.Symbol, sp.Expr]:
        """Return the given copies of the driven coordinates, to replace these."""
        replaced = {}
        for coordinate in self.mechanism.coordinates:
            # bodies on a free one depend on no coordinate of it
            if isinstance(coordinate.joint, Free):
                continue
            if coordinate.joint in self.kin.coordinates.driven:
                replaced[self.kin.given(coordinate.joint)] = self._given(coordinate.name)
        return replaced

    def _from_driven(self, name: str, work: Vector) -> Vector:
        """Return a work vector as a function of the given coordinates, in ground axes."""
        given = Vector(*self.program.substitute(self._driven(), work, "given"))
        return self.program.vector(name, self.kin.to_ground(given))

    def _telescope_span(self, joint: Cylindrical) -> Vector:
        line = self.kin.telescopes[joint.name]
        return self._from_driven(f"given_span_{joint.name}", line.relative.position)

    def _shaft_direction(self, joint: Universal) -> Vector:
        """Return the unit vector of a shaft, from the position of its far end.

        A chain with a telescope gives it in terms of given coordinates; without one, the poses do.
        """
        rod = joint.second.name
        turn = next((ends for ends in self.kin.turned.values() if ends.rod == rod), None)
        others = self.mechanism.joints_of(rod)
        telescope = next((j for j in others if isinstance(j, Cylindrical)), None)
        if turn is not None and any(t.end_link == turn.body for t in self.kin.spans.values()):
            span = self._rod_span(turn)
        elif telescope is not None:
            span = self._telescope_span(telescope)
        else:
            return self.relative.shaft_direction(joint)
        length = self.program.define(f"given_length_{joint.name}", sp.sqrt(span.dot(span)))
        return self.program.vector(f"given_shaft_{joint.name}", span * (1 / length))

    def _rod_residual(self, joint: Cylindrical) -> sp.Expr:
        """Return Eq. 13: the distance of the rod's ends by the chain, less the rod's length."""
        turn = self.kin.turned[joint.second.name]
        span = self._rod_span(turn)
        return sp.sqrt(span.dot(span)) - self.kin.rod_lengths[turn.rod]

    def _rod_span(self, turn: RodEnds) -> Vector:
        """Return the vector from the rod's anchor to its end, by explicit rotations (Eq. 17)."""
        telescope = next(t for t in self.kin.spans.values() if t.end_link == turn.body)
        end = self._by_chain(telescope, turn.end, -1)
        anchor = self._from_driven(
            f"given_{turn.anchor.name}",
            self.kin.point_motion(turn.anchor_body, turn.anchor).position,
        )
        return self.program.vector(f"given_{turn.rod}", end - anchor)

    def _by_chain(self, telescope: TelescopeEnds, point: Point, copy: int) -> Vector:
        """Return the position of a point of a telescope's second body, by copies of the chain."""
        joint = telescope.joint
        holder = self.relative.holder(joint)
        length = joint.length_at_zero_slide.symbol - self._copies(joint.name, "slide")[copy]
        local = self._in_marker_axes(joint, point)
        swung = rotate_y(-self._copies(joint.name, "angle")[copy], local) + UNIT_Y * length
        swung = self.program.vector(f"given_{point.name}_in_shaft", swung)
        lifted = rotate_x(self._copies(holder.name, "elevation")[copy], swung)
        lifted = self.program.vector(f"given_{point.name}_lifted", lifted)
        from_center = rotate_z(self._copies(holder.name, "azimuth")[copy], lifted)
        center = self._from_driven(
            f"given_{holder.at.name}", self.kin.point_motion(holder.first.name, holder.at).position
        )
        return center + from_center

    def _offset_telescope(self, joint: Joint) -> TelescopeEnds | None:
        """Return the telescope whose axis misses its end, if the joint is part of it."""
        for ends in self.kin.spans.values():
            if ends.misses_end and joint in (ends.joint, self.relative.holder(ends.joint)):
                return ends
        return None

    def _opening_at_end(self, telescope: TelescopeEnds) -> Vector:
        """Return the vector from a telescope's target to the end of its chain."""
        end = self._from_driven(
            f"given_{telescope.end.name}",
            self.kin.point_motion(telescope.end_body, telescope.end).position,
        )
        opening = self._by_chain(telescope, telescope.end, 0) - end
        return self.program.vector(f"given_opening_{telescope.end.name}", opening)

    def _in_marker_axes(self, joint: Cylindrical, point: Point) -> Vector:
        """Return a point's body coordinates along (x'', line, marker): those of zero angle."""
        placed = self.kin.placed[joint.second.name]
        local = self.relative.from_axis(placed, joint, point)
        mark = self.relative.from_axis(placed, joint, joint.angle_to)
        across = self.program.define(f"{placed.body}_marker", sp.sqrt(mark.y**2 + mark.z**2))
        z = Vector(ZERO.x, mark.y / across, mark.z / across)
        return self.program.vector(
            f"{placed.body}_{point.name}_by_marker",
            Vector(local.dot(UNIT_X.cross(z)), local.x, local.dot(z)),
        )
