r"""The side of a cross on a body that is turned through it, on a hinge through the centre.

Let e be the axis of the hinge and f the axis of the cross on the driven body, fixed in that,
``f = h e + r t`` with t across e; and b the other one, fixed in the driving body. The cross keeps
``b . f = 0``, which is ``a cos + b sin = c`` for the turn of t about e. With beta the part of b
across e,

    t = (k beta - w e x beta) / |beta|^2,    k = -(h / r) b . e,    w = s sqrt(|beta|^2 - k^2).

Branch: s is the sign of b . (e x t), which is w, at the design position. The first axis of a common
yoke is across its bearing: h = k = 0, and this is Hooke's ``tan x = cos(bend) tan y``. Valid while
``|beta|^2 > k^2``; at h = 0, everywhere but where the driving shaft is perpendicular to the hinge.

That b and f stay perpendicular gives the rate of the turn, whose factor is ``e . (f x b) = r w``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..kinematics.extent import require
from ..program.conditions import Assumption
from ..program.floors import BRANCH, DIRECTION, LENGTH
from ..program.functions import SignOf
from ..program.vectors import Axes, Vector, from_axes, to_axes
from .constraints import Perpendicular
from .lines import axes_about
from .solved_motion import ClosureCondition, TargetBody, TurnOnHinge, add_turn, place_at
from .universal_joint import second_of_cross

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..declare.joints import Revolute, Universal
    from ..kinematics.kinematics import Kinematics
    from ..kinematics.step import KinematicStep


@dataclass(frozen=True)
class DrivenYoke:
    """A body on a hinge that a cross turns."""

    # hinge goes through the centre of the cross
    cross: Universal
    hinge: Revolute
    parent: str  # placed body at the other side of the hinge
    driving: str  # placed body at the other side of the cross
    named: str  # driving part, for messages

    @property
    def body(self) -> str:
        """The driven body."""
        return self.hinge.other(self.parent)

    @property
    def solution(self) -> str:
        """Solution of the equation, for the report."""
        return f"a cos x + b sin x = c for the angle of {self.hinge.name}, branch as at design"


def through_center(hinge: Revolute, cross: Universal, scale: sp.Expr) -> Iterator[Assumption]:
    """Yield the condition that a hinge goes through the centre of a cross, for a length scale."""
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
    """The axis of a cross that is fixed in the driving body: now, and at the design position."""

    now: Vector
    design: Vector


def second_axis(kin: Kinematics, cross: Universal, line: Vector) -> Vector:
    """Return the axis of a cross in its second body at design, across the line of that body."""
    body, first = cross.second.name, kin.design_direction(cross.first_axis)
    meaning = f"the shaft {body} lies along the first axis of universal joint {cross.name}"
    return second_of_cross(kin, body, first, line, meaning)


def turn_through_cross(
    kin: Kinematics, step: KinematicStep, yoke: DrivenYoke, own: Vector, given: GivenAxis
) -> None:
    """Turn a body on its hinge until both axes of a cross are at right angles.

    The step closes the loop. The axes of the cross are that on the body, at the design position,
    and that on the driving one.
    """
    design_axes, f = _own_axis(kin, yoke, own)
    axes, b = _fitted(kin, step, yoke, design_axes, f, given)
    at, second = (yoke.parent, yoke.cross.at), yoke.hinge.second.name == yoke.body
    hinge = yoke.hinge.name if second and yoke.hinge.angle_to is None else None
    placed = place_at(kin, yoke.body, at, axes, design_axes, hinge=hinge)
    target = TargetBody(kin, placed, kin.placed[yoke.driving], "shaft")
    add_turn(kin, TurnOnHinge(kin, placed, *at), ClosureCondition(Perpendicular(b, f), target))


def _fitted(
    kin: Kinematics,
    step: KinematicStep,
    yoke: DrivenYoke,
    design_axes: Axes,
    f: Vector,
    given: GivenAxis,
) -> tuple[Axes, Vector]:
    """Return e, t and e x t, and b in these axes."""
    program, body, b = kin.program, yoke.body, given.now
    parent = kin.placed[yoke.parent]
    hinge = program.vector(f"{body}_hinge_on_parent", to_axes(parent.design_axes, design_axes[0]))
    e = program.vector(f"{body}_hinge", from_axes(parent.axes, hinge))
    along = program.define(f"{body}_second_along", b.dot(e))
    beta = program.vector(f"{body}_second_across", b - e * along)
    slope = program.define(f"{body}_first_slope", f.x / f.y)
    k = program.define(f"{body}_second_needed", -slope * along)
    squared = program.define(f"{body}_second_across_squared", beta.dot(beta))
    room = program.guarded(
        f"{body}_closure",
        squared - k**2,
        f"{kin.loop_of(step)}: {yoke.named} is bent too far at universal joint {yoke.cross.name}, "
        f"towards a right angle to hinge {yoke.hinge.name}: it no longer turns {body}",
        "1",
        DIRECTION,
    )
    branch = _branch(kin, yoke, given.design, design_axes)
    height = program.define(f"{body}_second_height", branch * sp.sqrt(room))
    inverse = program.define(f"{body}_second_inverse", 1 / (room + k**2))
    cosine = program.define(f"{body}_turn_cosine", k * inverse)
    sine = program.define(f"{body}_turn_sine", height * inverse)
    normal = program.vector(f"{body}_second_normal", e.cross(beta))
    t = program.vector(f"{body}_first_across", beta * cosine - normal * sine)
    third = program.vector(f"{body}_third_axis", normal * cosine + beta * sine)
    return (e, t, third), Vector(along, k, height)


def _own_axis(kin: Kinematics, yoke: DrivenYoke, f: Vector) -> tuple[Axes, Vector]:
    """Return the axes of the driven body at the design position, and f in them (constants)."""
    body = yoke.body
    e = kin.unit(f"{body}_hinge_design", kin.to_work(yoke.hinge.axis.vector))
    axes, own = axes_about(kin, f"{body}_first", e, f)
    require(
        kin,
        f"{body}_first_radius",
        own.y,
        LENGTH,
        "1",
        f"the first axis of universal joint {yoke.cross.name} is along hinge {yoke.hinge.name}, "
        f"about which {body} turns",
        "give the cross an axis across that hinge",
    )
    return axes, own


def _branch(kin: Kinematics, yoke: DrivenYoke, b: Vector, design_axes: Axes) -> sp.Expr:
    """Return the sign of the side of the driven yoke on which the other axis is at design."""
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
