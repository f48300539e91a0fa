r"""A shaft that telescopes between two crosses: how a steering column turns the pinion.

Two links on a guide along their common line are held by a cross each: one on a placed body, the
*driving* one, the other on a body that is *driven*, on a hinge through the centre of its cross. So
both centres are known, and with them the line n and the length. The cross on the driving body turns
the shaft about its line (`cross`), and both links alike, since the guide does not turn.

Let e be the axis of the hinge and f the first axis of the cross on the driven body, fixed in that,
``f = h e + r t`` with t across e; and b the second one, fixed in the shaft, across n. The cross
keeps ``b . f = 0``, which is ``a cos + b sin = c`` for the turn of t about e. With beta the part of
b across e,

    t = (k beta - w e x beta) / |beta|^2,    k = -(h / r) b . e,    w = s sqrt(|beta|^2 - k^2).

Branch: s is the sign of b . (e x t), which is w, at the design position. The first axis of a common
yoke is across its bearing: h = k = 0, and this is Hooke's ``tan x = cos(bend) tan y``. Valid while
``|beta|^2 > k^2``, which at h = 0 is lost only where shaft and hinge are at right angles; the other
singular set is the shaft along the first axis of the driving cross.

With c = f x b, ``(omega_driven - omega_shaft) . c = 0`` gives the rate of the turn, whose factor is
``e . c = r w``. The second derivative adds ``(omega_driven - omega_shaft) . c'``, where
``c' = (omega_driven x f) x b + f x (omega_shaft x b)``.

The phase of the two yokes is the angle between the second axes of both crosses about n, a constant
that follows from the two first axes at the design position.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import sympy as sp

from ..declare.joints import Revolute, Universal
from ..kinematics.extent import require
from ..kinematics.motion import Axes, BodyMotion, PointMotion, from_axes, to_axes
from ..loops.forms import ClosedForm
from ..program.conditions import Assumption
from ..program.floors import BRANCH, DIRECTION, LENGTH
from ..program.functions import SignOf
from ..program.vectors import NO_TWIST, UNIT_X, ZERO, Twist, Vector
from .cross import turn_on_cross
from .guided_pair import GuidedPair
from .lines import line_of_ends, once, projector

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Self

    from ..declare.geometry import Point
    from ..kinematics.kinematics import Kinematics
    from ..kinematics.motion import OnLine
    from ..kinematics.step import Ends
    from ..loops.cut import CutLoop
    from ..loops.forms import Closing
    from ..loops.known import Coordinate, Known


@dataclass(frozen=True)
class CardanShaft(ClosedForm):
    """A placed body turns another one on its hinge, through two crosses and a sliding shaft.

    Attributes
    ----------
    shaft
        Its two links, from the cross on the driving body to that on the driven one.
    driving, driven
        The two crosses; the shaft is the second body of each.
    hinge, parent
        That of the driven body, and the placed body at the other side of it.
    """

    shaft: GuidedPair
    driving: Universal
    driven: Universal
    hinge: Revolute
    parent: str

    rank: ClassVar[int] = 8
    equations: ClassVar[tuple[int, ...]] = (2,)
    """Cut at both crosses: the slide and the angle of the hinge remain."""

    @classmethod
    def match(cls, known: Known, cut: CutLoop) -> Self | None:
        """Return the shaft that one arc of a loop is; the other one ends with the driven body."""
        shaft = GuidedPair.match(cut)
        if shaft is None or not cut.other_joints or known.unknowns_of(shaft.joint) == 0:
            return None
        driving, driven = shaft.joints_at_ends(known.mechanism.joints)
        if not (isinstance(driving, Universal) and isinstance(driven, Universal)):
            return None
        hinge, body = cut.other_joints[-1], shaft.end_body
        if not isinstance(hinge, Revolute) or known.unknowns_of(hinge) == 0:
            return None
        held = (driving.second.name, driven.second.name) == (shaft.near, shaft.far)
        parent, done = hinge.other(body), {shaft.near, shaft.far, body} & known.bodies
        if not held or done or not {shaft.anchor_body, parent} <= known.placed:
            return None
        return cls(shaft, driving, driven, hinge, parent)

    @property
    def about(self) -> str:
        """The driven body."""
        return self.shaft.end_body

    @property
    def title(self) -> str:
        """What the derivation calls this step."""
        return f"transformer: {self.about} turned through the shaft of {self.shaft.links}"

    @property
    def points(self) -> tuple[Point, ...]:
        """The centres of both crosses."""
        return self.shaft.points

    def accept(self, known: Known) -> set[Coordinate]:
        """Record the shaft and the driven body, and their joints."""
        for body in (self.shaft.near, self.shaft.far, self.about):
            known.place(body)
        return known.add_all([self.driving, self.shaft.joint, self.driven, self.hinge])

    def lines(self) -> Iterator[Ends]:
        """Yield both links, along the line of the centres."""
        yield self.shaft.near, self.shaft.anchor, self.shaft.end
        yield self.shaft.far, self.shaft.end, self.shaft.anchor

    def assumptions(self) -> Iterator[Assumption]:
        """Yield what keeps the guide on the line of the crosses, and a cross on its hinge."""
        shaft, center, axis = self.shaft, self.driven.at, self.hinge.axis
        span = shaft.end.position - shaft.anchor.position
        way = shaft.joint.direction.components
        if not shaft.along_ends:
            yield Assumption(
                f"{shaft.joint.name}_askew",
                _norm(span.cross(way)) / (_norm(span) * _norm(way)),
                sp.Integer(1),
                "1",
                f"the guide {shaft.joint.name} of {shaft.links} must be along the line of the "
                "crosses at their ends",
                f"give it Direction.between {shaft.anchor.name} and {shaft.end.name}",
            )
        if not axis.contains(center):
            beside = (center.position - axis.through.position).cross(axis.vector)
            yield Assumption(
                f"{self.hinge.name}_beside_{center.name}",
                _norm(beside) / _norm(axis.vector),
                _norm(span),
                "m",
                f"the axis of hinge {self.hinge.name} must go through the centre {center.name} of "
                f"universal joint {self.driven.name}",
                f"declare that axis through {center.name}",
            )

    def words(self, closing: Closing | None) -> tuple[str, str]:
        """Return the closure equation and its solution."""
        del closing
        return (
            f"{self.shaft.line} = length of {self.shaft.links}; {self.driven.name} at right angles",
            f"a cos x + b sin x = c for the angle of {self.hinge.name}, branch as at design",
        )

    def carry_out(self, kin: Kinematics) -> None:
        """Place the shaft between the centres, and turn the driven body until its cross fits."""
        shaft = self.shaft
        ends = (shaft.anchor_body, shaft.anchor), (self.parent, shaft.end)
        line = line_of_ends(kin, self, shaft.near, ends, f"the shaft of {shaft.links}")
        kin.on_line |= {shaft.near: line, shaft.far: line.reversed()}
        self._slide(kin, line)
        driving = kin.placed[shaft.anchor_body]
        turn_on_cross(
            kin,
            shaft.near,
            driving,
            kin.local_direction(driving, self.driving.first_axis),
            kin.design_direction(self.driving.first_axis),
            f"the shaft {shaft.near} lies along the first axis of universal joint "
            f"{self.driving.name}",
        )
        self._place_far(kin, line.end_motion)
        _Yoke.of(kin, self).place(kin, self, line.end_motion)

    def _slide(self, kin: Kinematics, line: OnLine) -> None:
        """Record how far the shaft has been drawn out since the design position."""
        shaft, program = self.shaft, kin.program
        span = kin.design(shaft.end) - kin.design(shaft.anchor)
        span = program.vector(f"{shaft.near}_span_design", span)
        start = program.define(f"{shaft.near}_length_design", sp.sqrt(span.dot(span)))
        if shaft.along_ends:
            sense = sp.Integer(1 if shaft.forward else -1)
        else:
            along = span.dot(kin.design_direction(shaft.joint.direction))
            sense = program.define(f"{shaft.near}_sense", SignOf(along))
        slide = shaft.sense * sense * (line.length - start)
        kin.slides[shaft.joint.name] = program.define(f"slide_{shaft.joint.name}", slide)

    def _place_far(self, kin: Kinematics, end: PointMotion) -> None:
        """Place the link at the driven body; the second of its axes is that of its own cross."""
        near, far, program = kin.placed[self.shaft.near], self.shaft.far, kin.program
        n, second, third = near.design_axes
        b = _second_axis(kin, self, -n)
        c = program.define(f"{far}_phase_cosine", b.dot(second))
        s = program.define(f"{far}_phase_sine", b.dot(third))

        def axes_from(x: Vector, y: Vector, z: Vector) -> Axes:
            return -x, y * c + z * s, y * s - z * c

        def seen(v: Vector) -> Vector:
            return Vector(-v.x, v.y * c + v.z * s, v.y * s - v.z * c)

        parts = (f"{far}_line", f"{far}_second_axis", f"{far}_third_axis")
        placed = BodyMotion(
            far,
            origin=end.position,
            axes=program.axes(parts, axes_from(*near.axes)),
            design_origin=kin.design(self.shaft.end),
            design_axes=(-n, b, program.vector(f"{far}_third_design", b.cross(n))),
            local={self.shaft.end: ZERO},
            carrier=(self.parent, kin.local(kin.placed[self.parent], self.shaft.end)),
        )
        to_body = projector(kin, placed)
        for k in dict.fromkeys([*near.motion, *end.motion]):
            base = to_body(f"velocity_{k}", end.motion.get(k, ZERO))
            omega = seen(near.motion.get(k, NO_TWIST).angular)
            placed.motion[k] = kin.define_twist(far, k, Twist(omega, base))

        def bias() -> Twist:
            base = to_body("acceleration", end.bias)
            return kin.define_bias(far, Twist(seen(near.bias().angular), base))

        placed.bias = once(bias)
        kin.placed[far] = placed


@dataclass(frozen=True)
class _Yoke:
    """The driven body's side of its cross.

    Attributes
    ----------
    axes, design_axes
        Hinge e, t and e x t: now, and at the design position (work axes).
    first, second
        First and second axis of the cross in these axes, f and b.
    """

    axes: Axes
    design_axes: Axes
    first: Vector
    second: Vector

    @classmethod
    def of(cls, kin: Kinematics, step: CardanShaft) -> _Yoke:
        """Turn the driven body about its hinge until both axes are at right angles."""
        program, body = kin.program, step.about
        shaft, parent = kin.placed[step.shaft.far], kin.placed[step.parent]
        design_axes, first = _first_axis(kin, step)
        b = shaft.axes[1]
        hinge = program.vector(
            f"{body}_hinge_on_parent", to_axes(parent.design_axes, design_axes[0])
        )
        e = program.vector(f"{body}_hinge", from_axes(parent.axes, hinge))
        along = program.define(f"{body}_second_along", b.dot(e))
        beta = program.vector(f"{body}_second_across", b - e * along)
        slope = program.define(f"{body}_first_slope", first.x / first.y)
        k = program.define(f"{body}_second_needed", -slope * along)
        squared = program.define(f"{body}_second_across_squared", beta.dot(beta))
        room = program.guarded(
            f"{body}_closure",
            squared - k**2,
            f"{kin.loop_of(step)}: the shaft of {step.shaft.links} is bent too far at universal "
            f"joint {step.driven.name}, towards a right angle to hinge {step.hinge.name}: it no "
            f"longer turns {body}",
            "1",
            DIRECTION,
        )
        branch = _branch(kin, step, shaft.design_axes[1], design_axes)
        height = program.define(f"{body}_second_height", branch * sp.sqrt(room))
        inverse = program.define(f"{body}_second_inverse", 1 / (room + k**2))
        cosine = program.define(f"{body}_turn_cosine", k * inverse)
        sine = program.define(f"{body}_turn_sine", height * inverse)
        normal = program.vector(f"{body}_second_normal", e.cross(beta))
        axes = (
            e,
            program.vector(f"{body}_first_across", beta * cosine - normal * sine),
            program.vector(f"{body}_third_axis", normal * cosine + beta * sine),
        )
        return cls(axes, design_axes, first, Vector(along, k, height))

    def place(self, kin: Kinematics, step: CardanShaft, center: PointMotion) -> None:
        """Record pose, velocities and bias of the driven body."""
        program, body = kin.program, step.about
        shaft, parent = kin.placed[step.shaft.far], kin.placed[step.parent]
        first_axis = step.hinge.second.name == body and step.hinge.angle_to is None
        placed = BodyMotion(
            body,
            origin=center.position,
            axes=self.axes,
            design_origin=kin.design(step.driven.at),
            design_axes=self.design_axes,
            local={step.driven.at: ZERO},
            carrier=(step.parent, kin.local(parent, step.driven.at)),
            hinge=step.hinge.name if first_axis else None,
        )
        to_body = projector(kin, placed)

        def carried(label: str, other: BodyMotion, v: Vector) -> Vector:
            return to_body(label, from_axes(other.axes, v))

        c = program.vector(f"{body}_grip", self.first.cross(self.second), "123")
        inverse = program.define(f"{body}_grip_inverse", 1 / c.x)
        for k in dict.fromkeys([*center.motion, *parent.motion, *shaft.motion]):
            base = to_body(f"velocity_{k}", center.motion.get(k, ZERO))
            own = carried(f"carried_{k}", parent, parent.motion.get(k, NO_TWIST).angular)
            turned = carried(f"shaft_{k}", shaft, shaft.motion.get(k, NO_TWIST).angular)
            turn = program.define(f"{body}_turn_{k}", (turned - own).dot(c) * inverse)
            placed.motion[k] = kin.define_twist(body, k, Twist(own + UNIT_X * turn, base))

        def bias() -> Twist:
            omega = kin.total(placed).angular
            own = carried("carried_now", parent, kin.total(parent).angular)
            turned = carried("shaft_now", shaft, kin.total(shaft).angular)
            spin = Vector(omega.x - own.x, ZERO.y, ZERO.z)
            alpha = carried("carried_bias", parent, parent.bias().angular) + own.cross(spin)
            alpha = program.vector(f"{body}_alpha_carried", alpha, "123")
            left = carried("shaft_bias", shaft, shaft.bias().angular) - alpha
            rate = omega.cross(self.first).cross(self.second)
            rate += self.first.cross(turned.cross(self.second))
            rate = program.vector(f"{body}_grip_rate", rate, "123")
            fitted = left.dot(c) - (omega - turned).dot(rate)
            turn = program.define(f"{body}_turn_bias", fitted * inverse)
            base = to_body("acceleration", center.bias)
            return kin.define_bias(body, Twist(alpha + UNIT_X * turn, base))

        placed.bias = once(bias)
        kin.placed[body] = placed


def _first_axis(kin: Kinematics, step: CardanShaft) -> tuple[Axes, Vector]:
    """Return the axes of the driven body at the design position, and f in them (constants)."""
    program, body, joint = kin.program, step.about, step.driven
    e = kin.unit(f"{body}_hinge_design", kin.to_work(step.hinge.axis.vector))
    f = kin.design_direction(joint.first_axis)
    along = program.define(f"{body}_first_along", f.dot(e))
    across = program.vector(f"{body}_first_across_design", f - e * along)
    radius = program.define(f"{body}_first_radius", sp.sqrt(across.dot(across)))
    require(
        kin,
        f"{body}_first_radius",
        radius,
        LENGTH,
        "1",
        f"the first axis of universal joint {joint.name} is along hinge {step.hinge.name}, about "
        f"which {body} turns",
        "give the cross an axis across that hinge",
    )
    t = program.vector(f"{body}_first_unit", across * (1 / radius))
    normal = program.vector(f"{body}_normal_design", e.cross(t))
    return (e, t, normal), Vector(along, radius, ZERO.z)


def _second_axis(kin: Kinematics, step: CardanShaft, line: Vector) -> Vector:
    """Return b at the design position, across the line of the shaft."""
    joint, far = step.driven, step.shaft.far
    across = kin.design_direction(joint.first_axis).cross(line)
    across = kin.program.vector(f"{far}_cross_design", across)
    require(
        kin,
        f"{far}_cross_design",
        sp.sqrt(across.dot(across)),
        LENGTH,
        "1",
        f"at the design position, the shaft {far} lies along the first axis of universal joint "
        f"{joint.name}",
        "turn that axis, or move an end of the shaft",
    )
    return kin.unit(f"{far}_second_design", across)


def _branch(kin: Kinematics, step: CardanShaft, b: Vector, design_axes: Axes) -> sp.Expr:
    """Return on which side of the driven yoke the second axis is at the design position."""
    height = kin.program.define(f"{step.about}_second_height_design", b.dot(design_axes[2]))
    require(
        kin,
        f"{step.about}_second_height_design",
        height,
        BRANCH,
        "1",
        f"at the design position the shaft of {step.shaft.links} does not turn {step.about}: it is "
        f"at a right angle to hinge {step.hinge.name}",
        "choose a design position where the shaft is bent less",
    )
    return kin.program.define(f"{step.about}_branch", SignOf(height))


def _norm(v: Vector) -> sp.Expr:
    return sp.sqrt(v.dot(v))
