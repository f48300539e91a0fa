r"""Two links in a plane with a hinge of known angle between them, as a leg: a driven elbow.

A four-bar linkage that is driven at the pin of its coupler has one: crank and coupler keep the
crank's bearing and the rocker's pin at a distance that depends on their angle. The rocker then is a
body on a hinge that a leg of known variable length holds (`revolute`).

The *first link* is that of the first body of the known hinge, *u* leads from its own end E to the
hinge, and *v* from there to the end F of the second link. With q the angle from the design
position, R(q) the turn about the direction n of the hinges, and C = u . v and S = n . (v x u) from
the parts across n at the design position,

    l^2 = |u|^2 + |v|^2 + 2 (u_n v_n + C cos q + S sin q),
    l l' = (S cos q - C sin q) q',    (l l')' = (S cos q - C sin q) q'' - (C cos q + S sin q) q'^2.

There is one branch. Singular set: the two ends meet, l = 0 across n.

When the loop has closed, the first link follows: s = u + R v is known in its axes (n, t, n x t),
t along u, and so is F - E in space; with w the part of F - E across n,

    t = (s_2 w - s_3 n x w) / (s_2^2 + s_3^2).

That F meets the end of s along n x s gives the rate of the turn. The second link follows from the
first one by its hinge, whose angle is known.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import sympy as sp

from ..declare.joints import Revolute
from ..kinematics.extent import extent_squared, require
from ..kinematics.hinge_angles import HingeDesign, positive_axis_at_design
from ..loops.forms import PlannedStep
from ..program.floors import DIRECTION, LENGTH
from ..program.functions import SignOf
from ..program.vectors import ZERO, Axes, Vector, to_axes
from .constraints import Coincident, Moving
from .hinge import Hinge, place_on_hinge, report_angle
from .leg import Leg, RodLeg
from .solved_motion import ClosureCondition, TargetPoint, add_turn

if TYPE_CHECKING:
    from collections.abc import Iterable
    from typing import Self

    from ..declare.geometry import Point
    from ..kinematics.kinematics import Kinematics
    from ..loops.cut import CutLoop
    from ..loops.known import Coordinate, Known


@dataclass(frozen=True)
class TwoLinks:
    """The two links, from the end of the first one to that of the second one."""

    joint: Revolute  # hinge between them
    # of the end of the first link: the hinge, the body at the other side of it, and the point
    hinge: Revolute
    base: str
    start: Point
    # same of the second link
    far_hinge: Revolute
    target: str
    end: Point

    @property
    def first(self) -> str:
        """The first link."""
        return self.joint.first.name

    @property
    def middle(self) -> Point:
        """The point of the hinge between them."""
        return self.joint.axis.through


@dataclass(frozen=True)
class Elbow(Leg):
    """Two links with a hinge of known angle, as a leg."""

    pair: TwoLinks

    @classmethod
    def match(cls, known: Known, cut: CutLoop) -> Self | None:
        """Return the two links of one arc of a loop, if their hinge is driven."""
        if len(cut.joints) != 1 or known.placed.intersection(cut.bodies):
            return None
        joint, (near, far) = cut.joints[0], cut.bodies
        one = known.topology.joint_between(cut.others[0], near)
        other = known.topology.joint_between(cut.others[-1], far)
        if not (isinstance(joint, Revolute) and known.unknowns_of(joint) == 0):
            return None
        if not (isinstance(one, Revolute) and isinstance(other, Revolute)):
            return None
        at_anchor = one, cut.others[0], cut.anchor
        at_end = other, cut.others[-1], cut.end
        ends = (*at_anchor, *at_end) if joint.first.name == near else (*at_end, *at_anchor)
        pair = TwoLinks(joint, *ends)
        return cls(cut.others[-1], near, cut.end, cut.anchor, cut.others[0], pair)

    @property
    def links(self) -> tuple[str, ...]:
        joint = self.pair.joint
        return self.rod, joint.other(self.rod)

    @property
    def placing(self) -> PlannedStep:
        return PlaceElbow(self.pair)

    @property
    def measure(self) -> str:
        return f"{' and '.join(self.links)} at {self.pair.joint.name}.angle"

    def stretched(self, kin: Kinematics, design: Vector, extent: sp.Expr) -> RodLeg:
        """Append its length, for the known angle."""
        program, name = kin.program, self.rod
        bend = _Bend.of(kin, self.pair)
        reach = bend.u.dot(bend.v) - bend.u.dot(bend.axis) * bend.v.dot(bend.axis)
        along = design.dot(design) - 2 * reach
        near = program.define(f"{name}_bend", reach * bend.cosine + bend.skew * bend.sine)
        squared = program.guarded(
            f"{name}_length_squared",
            program.define(f"{name}_links_squared", along) + 2 * near,
            f"the ends {self.anchor.name} and {self.end.name} of {' and '.join(self.links)} meet",
            "m^2",
            DIRECTION * extent,
        )
        require(
            kin,
            f"{name}_length_design",
            sp.sqrt(design.dot(design)),
            LENGTH * sp.sqrt(extent),
            "m",
            f"at the design position, the ends {self.anchor.name} and {self.end.name} of "
            f"{' and '.join(self.links)} coincide",
            "move one of the two",
        )
        slope = program.define(f"{name}_stretch", bend.skew * bend.cosine - reach * bend.sine)
        length = program.define(f"{name}_length_now", sp.sqrt(squared))
        rod = RodLeg(f"pair of {' and '.join(self.links)}", design, length, squared)
        return rod.driven(kin.coordinates, self.pair.joint, slope, -near)


@dataclass(frozen=True)
class PlaceElbow(PlannedStep):
    """The first of two links with a hinge of known angle, both ends on placed bodies."""

    pair: TwoLinks

    @property
    def about(self) -> str:
        return self.pair.first

    @property
    def title(self) -> str:
        return f"{self.pair.first}: bent at {self.pair.joint.name}"

    def accept(self, known: Known) -> set[Coordinate]:
        """Record the link and the hinges at both ends; the second link follows by its own."""
        known.place(self.pair.first)
        known.guided[self.pair.far_hinge.name] = self  # known, but not to place the second link
        return known.add_all([self.pair.hinge, self.pair.far_hinge])

    def emit(self, kin: Kinematics) -> None:
        """Turn the first link until the end of the second one meets its target."""
        program, pair, body = kin.program, self.pair, self.pair.first
        extent = extent_squared(kin, self)
        hinge = Hinge.of(kin, body, pair.hinge, pair.base, pair.middle, extent)
        end, n = kin.point_motion(pair.target, pair.end), hinge.axis
        bend = _Bend.of(kin, pair)
        reach = _Reach.of(kin, bend, hinge)
        way = program.vector(f"{body}_way", end.position - hinge.origin.position)
        across = program.vector(f"{body}_way_across", way - n * way.dot(n))
        s = reach.end
        squared = program.guarded(
            f"{body}_reach_squared",
            s.y**2 + s.z**2,
            f"the ends {pair.start.name} and {pair.end.name} of {pair.first} and "
            f"{pair.joint.second.name} meet",
            "m^2",
            DIRECTION * extent,
        )
        inverse = program.define(f"{body}_reach_inverse", 1 / squared)
        t = program.vector(f"{body}_arm", (across * s.y - n.cross(across) * s.z) * inverse)
        axes: Axes = (n, t, program.vector(f"{body}_normal", n.cross(t)))
        unsolved = place_on_hinge(kin, hinge, axes)
        target = _BentEnd(kin, unsolved.placed, end, bend=pair.joint, reach=reach)
        meeting = Coincident(s, s, Vector(ZERO.x, -s.z, s.y))
        add_turn(kin, unsolved, ClosureCondition(meeting, target, s), -inverse)
        report_angle(kin, hinge, axes)


@dataclass(frozen=True)
class _Bend:
    """The bend of two links (work axes, constants but for sine and cosine)."""

    axis: Vector  # about which the known angle is positive, at design
    # from the end of the first link to the hinge, and from there to the end of the second one, at
    # design
    u: Vector
    v: Vector
    skew: sp.Expr  # S
    cosine: sp.Expr
    sine: sp.Expr

    @classmethod
    def of(cls, kin: Kinematics, pair: TwoLinks) -> _Bend:
        """Return the bend of a pair of links."""
        program, joint = kin.program, pair.joint
        n = positive_axis_at_design(kin, joint)
        u = program.vector(
            f"{joint.name}_first_way", kin.design(pair.middle) - kin.design(pair.start)
        )
        v = program.vector(
            f"{joint.name}_second_way", kin.design(pair.end) - kin.design(pair.middle)
        )
        angle = kin.given(joint)
        if joint.angle_to is not None:
            start = HingeDesign.of(kin, joint).angle(program, joint.name)
            angle = program.define(f"{joint.name}_bent", angle - start)
        return cls(
            n,
            u,
            v,
            program.define(f"{joint.name}_skew", n.dot(v.cross(u))),
            program.define(f"cos_{joint.name}_bend", sp.cos(angle)),
            program.define(f"sin_{joint.name}_bend", sp.sin(angle)),
        )


@dataclass(frozen=True)
class _Reach:
    """The end of the second link relative to the first one, in the axes of that."""

    end: Vector  # s
    # first and second derivative with respect to the angle: n x R v, and -R v across n
    swing: Vector
    curl: Vector

    @classmethod
    def of(cls, kin: Kinematics, bend: _Bend, hinge: Hinge) -> _Reach:
        """Append the reach of a bend."""
        program, body, axes = kin.program, hinge.body, hinge.arm.design_axes
        v = program.vector(f"{body}_second_link", to_axes(axes, bend.v), "123")
        sense = program.define(f"{body}_bend_sense", SignOf(bend.axis.dot(axes[0])))
        sine = program.define(f"{body}_bend_sine", sense * bend.sine)
        y, z = v.y * bend.cosine - v.z * sine, v.y * sine + v.z * bend.cosine
        y, z = program.define(f"{body}_bent_2", y), program.define(f"{body}_bent_3", z)
        end = Vector(hinge.arm.along + v.x, hinge.arm.radius + y, z)
        return cls(
            program.vector(f"{body}_end", end, "123"),
            program.vector(f"{body}_swing", Vector(ZERO.x, -sense * z, sense * y), "123"),
            Vector(ZERO.x, -y, -z),
        )


@dataclass(frozen=True, kw_only=True)
class _BentEnd(TargetPoint):
    """The target of the second link relative to the first one, without the motion of the bend.

    It is the target's motion if the second link did not turn on the first one.
    """

    bend: Revolute  # hinge between the links
    reach: _Reach

    @property
    def coordinates(self) -> Iterable[str]:
        """The coordinates that move the target, and that of the bend."""
        coordinates = self.kin.coordinates
        moves = coordinates.moves(self.bend)
        return [*super().coordinates, *([coordinates.of(self.bend)] if moves else ())]

    def rates(self, k: str) -> Moving:
        seen, coordinates = super().rates(k), self.kin.coordinates
        if k != coordinates.of(self.bend):
            return seen
        return replace(
            seen, velocity=seen.velocity - self.reach.swing * coordinates.ratio(self.bend)
        )

    def biases(self) -> Moving:
        """Return the acceleration less that of the bend and its Coriolis acceleration."""
        seen, coordinates = super().biases(), self.kin.coordinates
        omega, rate = self.kin.total(self.placed).angular, coordinates.speed(self.bend)
        bending = self.reach.swing * coordinates.given_acceleration(self.bend)
        bending += omega.cross(self.reach.swing * rate) * 2 + self.reach.curl * rate**2
        return replace(seen, acceleration=seen.acceleration - bending)
