"""Relative joint coordinates: their values and the absolute Jacobian.

These are quantities of sections 4.1 to 4.3 of the paper. They are derived from the joints, not from
the closed forms: `absolute_jacobian` follows the chain of joints, and so checks what `closed_forms`
solved.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..declare.geometry import Point
from ..declare.joints import Cylindrical, Joint, Prismatic, Revolute, Universal, Weld
from ..kinematics.chain import before_telescope, chain_to, reported
from ..kinematics.hinge_angles import angle_of, is_first_axis, positive_axis_at_design
from ..program.floors import DIRECTION
from ..program.vectors import (
    IDENTITY,
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
    from ..kinematics.motion import BodyMotion


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
