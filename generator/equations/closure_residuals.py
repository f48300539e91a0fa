"""Closure equations of the loops in terms of given relative coordinates.

They follow the chains of joints with explicit rotations, as sections 4.1 and 4.2 of the paper do,
and so check what `closed_forms` solved.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

from ..declare.joints import Cylindrical, Free, Joint, Prismatic, Revolute, Universal
from ..kinematics.chain import reported
from ..kinematics.hinge_angles import turn_between
from ..program.vectors import UNIT_X, UNIT_Y, ZERO, Vector, from_axes, to_axes

if TYPE_CHECKING:
    from ..declare.geometry import Point
    from ..declare.joints import RelativeCoordinate
    from ..kinematics.motion import BodyMotion, RodEnds, TelescopeEnds
    from .relative import RelativeCoordinates

# Components of the closure at the end of an offset telescope, by the coordinate they determine.
_AXIS_OF_CLOSURE = {"azimuth": "x", "slide": "y", "elevation": "z"}


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


def closure_residuals(relative: RelativeCoordinates) -> dict[str, sp.Expr]:
    """Return g(beta, q): one residual for each relative coordinate (Eqs. 4 to 13), by its name.

    The coordinates are inputs of their own, named ``given_<coordinate>``.
    """
    relative.program.section("closure residuals")
    closure = _Closure(relative)
    return {c.name: closure.residual(c) for c in relative.kin.reported}


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
