r"""The side of a cross on a body that is turned through it, on a hinge through the centre.

Let e be the axis of the hinge and f the axis of the cross on the driven body, fixed in that,
``f = h e + r t`` with t across e; and b the other one, fixed in what drives. The cross keeps
``b . f = 0``, which is ``a cos + b sin = c`` for the turn of t about e. With beta the part of b
across e,

    t = (k beta - w e x beta) / |beta|^2,    k = -(h / r) b . e,    w = s sqrt(|beta|^2 - k^2).

Branch: s is the sign of b . (e x t), which is w, at the design position. The first axis of a common
yoke is across its bearing: h = k = 0, and this is Hooke's ``tan x = cos(bend) tan y``. Valid while
``|beta|^2 > k^2``, which at h = 0 is lost only where what drives is at a right angle to the hinge.

With c = f x b, ``(omega_driven - omega_driving) . c = 0`` gives the rate of the turn, whose factor
is ``e . c = r w``. The second derivative adds ``(omega_driven - omega_driving) . c'``, where
``c' = (omega_driven x f) x b + f x (omega_driving x b)``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..kinematics.extent import require
from ..kinematics.motion import Axes, BodyMotion, PointMotion, from_axes, once, to_axes
from ..program.conditions import Assumption
from ..program.floors import BRANCH, DIRECTION, LENGTH
from ..program.functions import SignOf
from ..program.vectors import NO_TWIST, UNIT_X, ZERO, Twist, Vector
from .lines import projector

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..declare.joints import Revolute, Universal
    from ..kinematics.kinematics import Kinematics
    from ..kinematics.step import Step


@dataclass(frozen=True)
class DrivenYoke:
    """A body on a hinge that a cross turns.

    Attributes
    ----------
    cross, hinge
        The hinge goes through the centre of the cross.
    parent
        The placed body at the other side of the hinge.
    driving
        The placed body at the other side of the cross.
    named
        What drives, for messages.
    """

    cross: Universal
    hinge: Revolute
    parent: str
    driving: str
    named: str

    @property
    def body(self) -> str:
        """The driven body."""
        return self.hinge.other(self.parent)


def through_center(hinge: Revolute, cross: Universal, scale: sp.Expr) -> Iterator[Assumption]:
    """Yield what keeps a hinge in the centre of a cross."""
    center, axis = cross.at, hinge.axis
    if not axis.contains(center):
        beside = (center.position - axis.through.position).cross(axis.vector)
        yield Assumption(
            f"{hinge.name}_beside_{center.name}",
            norm(beside) / norm(axis.vector),
            scale,
            "m",
            f"the axis of hinge {hinge.name} must go through the centre {center.name} of universal "
            f"joint {cross.name}",
            f"declare that axis through {center.name}",
        )


@dataclass(frozen=True)
class GivenAxis:
    """The axis of a cross that is fixed in what drives: now, and at the design position."""

    now: Vector
    design: Vector


def second_axis(kin: Kinematics, cross: Universal, line: Vector) -> Vector:
    """Return the axis of a cross in its second body at the design position, across its line."""
    body = cross.second.name
    across = kin.design_direction(cross.first_axis).cross(line)
    across = kin.program.vector(f"{body}_cross_design", across)
    require(
        kin,
        f"{body}_cross_design",
        sp.sqrt(across.dot(across)),
        LENGTH,
        "1",
        f"at the design position, the shaft {body} lies along the first axis of universal joint "
        f"{cross.name}",
        "turn that axis, or move an end of the shaft",
    )
    return kin.unit(f"{body}_second_design", across)


def turn_through_cross(
    kin: Kinematics,
    step: Step,
    yoke: DrivenYoke,
    own: Vector,
    given: GivenAxis,
    center: PointMotion,
) -> None:
    """Turn a body on its hinge until both axes of a cross are at right angles.

    Parameters
    ----------
    step
        Which loop it closes.
    own
        The axis of the cross on the driven body, at the design position.
    center
        The motion of the centre.
    """
    _Turned.of(kin, step, yoke, own, given).place(kin, yoke, center)


@dataclass(frozen=True)
class _Turned:
    """The driven body's side of its cross.

    Attributes
    ----------
    axes, design_axes
        Hinge e, t and e x t: now, and at the design position (work axes).
    own, given
        The axes of the cross in these axes, f and b.
    """

    axes: Axes
    design_axes: Axes
    own: Vector
    given: Vector

    @classmethod
    def of(
        cls, kin: Kinematics, step: Step, yoke: DrivenYoke, own: Vector, given: GivenAxis
    ) -> _Turned:
        program, body = kin.program, yoke.body
        parent, b = kin.placed[yoke.parent], given.now
        design_axes, first = _own_axis(kin, yoke, own)
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
            f"{kin.loop_of(step)}: {yoke.named} is bent too far at universal joint "
            f"{yoke.cross.name}, towards a right angle to hinge {yoke.hinge.name}: it no longer "
            f"turns {body}",
            "1",
            DIRECTION,
        )
        branch = _branch(kin, yoke, given.design, design_axes)
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

    def place(self, kin: Kinematics, yoke: DrivenYoke, center: PointMotion) -> None:
        """Record pose, velocities and bias of the driven body."""
        program, body = kin.program, yoke.body
        driving, parent = kin.placed[yoke.driving], kin.placed[yoke.parent]
        first_axis = yoke.hinge.second.name == body and yoke.hinge.angle_to is None
        placed = BodyMotion(
            body,
            origin=center.position,
            axes=self.axes,
            design_origin=kin.design(yoke.cross.at),
            design_axes=self.design_axes,
            local={yoke.cross.at: ZERO},
            carrier=(yoke.parent, kin.local(parent, yoke.cross.at)),
            hinge=yoke.hinge.name if first_axis else None,
        )
        to_body = projector(kin, placed)

        def carried(label: str, other: BodyMotion, v: Vector) -> Vector:
            return to_body(label, from_axes(other.axes, v))

        c = program.vector(f"{body}_grip", self.own.cross(self.given), "123")
        inverse = program.define(f"{body}_grip_inverse", 1 / c.x)
        for k in dict.fromkeys([*center.motion, *parent.motion, *driving.motion]):
            base = to_body(f"velocity_{k}", center.motion.get(k, ZERO))
            own = carried(f"carried_{k}", parent, parent.motion.get(k, NO_TWIST).angular)
            turned = carried(f"shaft_{k}", driving, driving.motion.get(k, NO_TWIST).angular)
            turn = program.define(f"{body}_turn_{k}", (turned - own).dot(c) * inverse)
            placed.motion[k] = kin.define_twist(body, k, Twist(own + UNIT_X * turn, base))

        def bias() -> Twist:
            omega = kin.total(placed).angular
            own = carried("carried_now", parent, kin.total(parent).angular)
            turned = carried("shaft_now", driving, kin.total(driving).angular)
            spin = Vector(omega.x - own.x, ZERO.y, ZERO.z)
            alpha = carried("carried_bias", parent, parent.bias().angular) + own.cross(spin)
            alpha = program.vector(f"{body}_alpha_carried", alpha, "123")
            left = carried("shaft_bias", driving, driving.bias().angular) - alpha
            rate = omega.cross(self.own).cross(self.given)
            rate += self.own.cross(turned.cross(self.given))
            rate = program.vector(f"{body}_grip_rate", rate, "123")
            fitted = left.dot(c) - (omega - turned).dot(rate)
            turn = program.define(f"{body}_turn_bias", fitted * inverse)
            base = to_body("acceleration", center.bias)
            return kin.define_bias(body, Twist(alpha + UNIT_X * turn, base))

        placed.bias = once(bias)
        kin.placed[body] = placed


def _own_axis(kin: Kinematics, yoke: DrivenYoke, f: Vector) -> tuple[Axes, Vector]:
    """Return the axes of the driven body at the design position, and f in them (constants)."""
    program, body = kin.program, yoke.body
    e = kin.unit(f"{body}_hinge_design", kin.to_work(yoke.hinge.axis.vector))
    along = program.define(f"{body}_first_along", f.dot(e))
    across = program.vector(f"{body}_first_across_design", f - e * along)
    radius = program.define(f"{body}_first_radius", sp.sqrt(across.dot(across)))
    require(
        kin,
        f"{body}_first_radius",
        radius,
        LENGTH,
        "1",
        f"the first axis of universal joint {yoke.cross.name} is along hinge {yoke.hinge.name}, "
        f"about which {body} turns",
        "give the cross an axis across that hinge",
    )
    t = program.vector(f"{body}_first_unit", across * (1 / radius))
    normal = program.vector(f"{body}_normal_design", e.cross(t))
    return (e, t, normal), Vector(along, radius, ZERO.z)


def _branch(kin: Kinematics, yoke: DrivenYoke, b: Vector, design_axes: Axes) -> sp.Expr:
    """Return on which side of the driven yoke the other axis is at the design position."""
    height = kin.program.define(f"{yoke.body}_second_height_design", b.dot(design_axes[2]))
    require(
        kin,
        f"{yoke.body}_second_height_design",
        height,
        BRANCH,
        "1",
        f"at the design position {yoke.named} does not turn {yoke.body}: it is at a right angle "
        f"to hinge {yoke.hinge.name}",
        "choose a design position where it is bent less",
    )
    return kin.program.define(f"{yoke.body}_branch", SignOf(height))


def norm(v: Vector) -> sp.Expr:
    """Return the length of a vector."""
    return sp.sqrt(v.dot(v))
