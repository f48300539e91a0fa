"""Orientation of a shaft of known direction n, from the cross of its universal joint.

The second axis b of the cross is fixed in the shaft and perpendicular to n and to the first axis f.
Both ``f x n`` and its opposite fulfil that: two poses of the shaft, half a turn about its line
apart. Branch: b = unit(f x n) at the design position, and so everywhere, since the two could change
places only where f x n vanishes. Singular set: the shaft along the first axis.

The body axes are (n, b, n x b), in which f = (f . n, 0, |f x n|). That b stays perpendicular to f
gives the rate of the turn.

That the shaft is declared along the line of the rod, n, is one of the `assumptions`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import sympy as sp

from ..declare.joints import Joint, Universal
from ..kinematics.extent import require
from ..loops.forms import Follower
from ..program.floors import DIRECTION, LENGTH
from ..program.vectors import UNIT_Y, ZERO, Axes, Vector, from_axes
from .constraints import Perpendicular
from .solved_motion import ClosureCondition, TargetBody, TurnOnLine, add_turn, place_at

if TYPE_CHECKING:
    from typing import Self

    from ..kinematics.kinematics import Kinematics
    from ..kinematics.motion import BodyMotion, OnLine
    from ..loops.known import Known


@dataclass(frozen=True)
class PlaceByUniversalJoint(Follower):
    """A shaft of known direction is turned by the cross of its universal joint."""

    joint: Universal
    parent: str
    body: str

    rank: ClassVar[int] = 1

    @classmethod
    def follow(cls, known: Known, joint: Joint, parent: str, child: str) -> Self | None:
        if isinstance(joint, Universal) and child == joint.second.name and child in known.on_line:
            return cls(joint, parent, child)
        return None

    @property
    def title(self) -> str:
        return f"{self.body}: cross of the universal joint"

    def emit(self, kin: Kinematics) -> None:
        """Turn the shaft about its line."""
        turn_with(kin, self.body, self.parent, self.joint)


def turn_with(kin: Kinematics, body: str, on: str, joint: Universal) -> None:
    """Turn a shaft of known line with its universal joint on a placed body."""
    parent, first = kin.placed[on], joint.first_axis
    meaning = f"the shaft {body} lies along the first axis of universal joint {joint.name}"
    local, design = kin.local_direction(parent, first), kin.design_direction(first)
    turn_on_cross(kin, body, parent, local, design, meaning)


def turn_on_cross(
    kin: Kinematics,
    body: str,
    parent: BodyMotion,
    local_axis: Vector,
    at_design: Vector,
    meaning: str,
) -> None:
    """Record pose, velocities and bias of a shaft, given the first axis of its cross.

    The axis is given in the axes of the parent, the placed body at the other side, and at the
    design position; `meaning` is the message where the shaft lies along that axis.
    """
    program, record = kin.program, line_from_own_end(kin, body)
    axis = program.vector(f"{body}_first_axis", from_axes(parent.axes, local_axis))
    n = record.direction
    cross = program.vector(f"{body}_cross", axis.cross(n))
    squared = program.guarded(f"{body}_cross_squared", cross.dot(cross), meaning, "1", DIRECTION)
    lever = program.define(f"{body}_lever", sp.sqrt(squared))
    second = program.vector(f"{body}_second_axis", cross * (1 / lever))
    axes: Axes = (n, second, program.vector(f"{body}_third_axis", n.cross(second)))
    line = kin.unit(f"{body}_line_design", kin.design(record.end) - kin.design(record.anchor))
    b = second_of_cross(kin, body, at_design, line, meaning)
    design_axes = (line, b, program.vector(f"{body}_third_design", line.cross(b)))
    placed = place_at(kin, body, (record.anchor_body, record.anchor), axes, design_axes)
    first = Vector(program.define(f"{body}_tilt", axis.dot(n)), ZERO.y, lever)
    add_turn(
        kin,
        TurnOnLine(kin, placed, record.anchor_motion, record, record.inverse_length),
        ClosureCondition(Perpendicular(first, UNIT_Y), TargetBody(kin, placed, parent)),
    )


def line_from_own_end(kin: Kinematics, body: str) -> OnLine:
    """Return the line of a link, beginning at a point of the link."""
    record = kin.on_line[body]
    own = [joint.center for joint in kin.mechanism.joints_of(body)]
    return record if record.anchor in own else record.reversed()


def second_of_cross(
    kin: Kinematics, body: str, first: Vector, line: Vector, meaning: str
) -> Vector:
    """Return the axis of a cross in its second body at the design position.

    It is across the first axis and the line of the body; `meaning` is the message where these
    coincide.
    """
    across = kin.program.vector(f"{body}_cross_design", first.cross(line))
    require(
        kin,
        f"{body}_cross_design",
        sp.sqrt(across.dot(across)),
        LENGTH,
        "1",
        f"at the design position, {meaning}",
        "turn that axis, or move an end of the shaft",
    )
    return kin.unit(f"{body}_second_design", across)
