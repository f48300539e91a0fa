"""A shaft turned by its universal joint.

Orientation of a shaft of known direction n from the cross of its universal joint.

The second axis b of the cross is fixed in the shaft and perpendicular to n and to the first
axis f. Both ``f x n`` and its opposite are that: two poses of the shaft, half a turn about its
line apart. Branch: b = unit(f x n) at the design position, and so everywhere, since the two
could change places only where f x n vanishes. Singular set: the shaft along the first axis.

The body axes are (n, b, n x b). Since b stays perpendicular to f,
``(omega - omega_parent) . (b x f) = 0``, and in body axes b x f = (f . (n x b), 0, -f . n).

That the shaft is declared along the line of the rod, n, is one of the `assumptions`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import sympy as sp

from ..declare.joints import Joint, Universal
from ..kinematics.extent import require
from ..kinematics.motion import Axes, BodyMotion, OnLine, from_axes, once
from ..loops.forms import Follower
from ..program.floors import DIRECTION, LENGTH
from ..program.vectors import ZERO, Twist, Vector
from .lines import line_alpha, line_omega, projector

if TYPE_CHECKING:
    from typing import Self

    from ..kinematics.kinematics import Kinematics
    from ..loops.known import Coordinate, Known


@dataclass(frozen=True)
class PlaceByCross(Follower):
    """A shaft of known direction is turned by the cross of its universal joint."""

    joint: Universal
    parent: str
    child: str

    rank: ClassVar[int] = 1

    @classmethod
    def follow(cls, known: Known, joint: Joint, parent: str, child: str) -> Self | None:
        """Return the step for a shaft whose line is known."""
        if isinstance(joint, Universal) and child == joint.second.name and child in known.on_line:
            return cls(joint, parent, child)
        return None

    @property
    def about(self) -> str:
        """The shaft."""
        return self.child

    @property
    def title(self) -> str:
        """What the derivation calls this step."""
        return f"{self.child}: cross of the universal joint"

    def accept(self, known: Known) -> set[Coordinate]:
        """Record the shaft."""
        known.place(self.child)
        return set()

    def carry_out(self, kin: Kinematics) -> None:
        """Turn the shaft about its line."""
        joint, parent = self.joint, kin.placed[self.parent]
        turn_on_cross(
            kin,
            self.child,
            parent,
            kin.local_direction(parent, joint.first_axis),
            kin.design_direction(joint.first_axis),
            f"the shaft {self.child} lies along the first axis of universal joint {joint.name}",
        )


def turn_on_cross(
    kin: Kinematics,
    body: str,
    parent: BodyMotion,
    local_axis: Vector,
    at_design: Vector,
    meaning: str,
) -> None:
    """Record pose, velocities and bias of a shaft, given the first axis of its cross.

    Parameters
    ----------
    local_axis, at_design
        The first axis: in the axes of its body, and at the design position.
    meaning
        What it means that the shaft lies along that axis.
    """
    program, record = kin.program, line_from_own_end(kin, body)
    axis = program.vector(f"{body}_first_axis", from_axes(parent.axes, local_axis))
    n = record.direction
    cross = program.vector(f"{body}_cross", axis.cross(n))
    squared = program.guarded(f"{body}_cross_squared", cross.dot(cross), meaning, "1", DIRECTION)
    lever = program.define(f"{body}_lever", sp.sqrt(squared))
    second = program.vector(f"{body}_second_axis", cross * (1 / lever))
    axes: Axes = (n, second, program.vector(f"{body}_third_axis", n.cross(second)))
    placed = BodyMotion(
        body,
        origin=record.anchor_motion.position,
        axes=axes,
        design_origin=kin.design(record.anchor),
        design_axes=_cross_design_axes(kin, body, record, at_design, meaning),
        local={record.anchor: ZERO},
        carrier=(
            record.anchor_body,
            kin.local(kin.placed[record.anchor_body], record.anchor),
        ),
    )
    _cross_motion(kin, parent, record, placed, lever, program.define(f"{body}_tilt", axis.dot(n)))
    kin.placed[body] = placed


def line_from_own_end(kin: Kinematics, body: str) -> OnLine:
    """Return the line of a link, from a point of the link on."""
    record = kin.on_line[body]
    own = [joint.center for joint in kin.mechanism.joints_of(body)]
    return record if record.anchor in own else record.reversed()


def _cross_design_axes(
    kin: Kinematics, body: str, record: OnLine, axis: Vector, meaning: str
) -> Axes:
    program = kin.program
    n = kin.unit(f"{body}_line_design", kin.design(record.end) - kin.design(record.anchor))
    across = program.vector(f"{body}_cross_design", axis.cross(n))
    require(
        kin,
        f"{body}_cross_design",
        sp.sqrt(across.dot(across)),
        LENGTH,
        "1",
        f"at the design position, {meaning}",
        "turn that axis, or move an end of the shaft",
    )
    second = kin.unit(f"{body}_second_design", axis.cross(n))
    return n, second, kin.program.vector(f"{body}_third_design", n.cross(second))


def _cross_motion(
    kin: Kinematics,
    parent: BodyMotion,
    record: OnLine,
    placed: BodyMotion,
    lever: sp.Expr,
    tilt: sp.Expr,
) -> None:
    body, program = placed.body, kin.program
    to_body = projector(kin, placed)
    hinge = Vector(lever, ZERO.y, -tilt)  # b x f
    grip = program.define(f"{body}_grip", 1 / lever)

    def parent_omega(label: str, v: Vector) -> Vector:
        return to_body(label, from_axes(parent.axes, v))

    names = dict.fromkeys([*record.anchor_motion.motion, *record.relative.motion, *parent.motion])
    for k in names:
        base = to_body(f"velocity_{k}", record.anchor_motion.motion.get(k, ZERO))
        across = line_omega(record, to_body(f"swing_{k}", record.relative.motion.get(k, ZERO)))
        carried = parent_omega(
            f"carried_{k}", parent.motion[k].angular if k in parent.motion else ZERO
        )
        turn = (hinge.dot(carried) - hinge.dot(across)) * grip
        placed.motion[k] = kin.define_twist(body, k, Twist(Vector(turn, across.y, across.z), base))

    def bias() -> Twist:
        omega = kin.total(placed).angular
        alpha = line_alpha(kin, record, omega, to_body("swing_bias", record.relative.bias))
        alpha = program.vector(f"{body}_alpha", alpha, "123")
        carried = parent_omega("carried", kin.total(parent).angular)
        carried_bias = parent_omega("carried_bias", parent.bias().angular)
        b, f = Vector.of(0, 1, 0), Vector(tilt, ZERO.y, lever)
        hinge_rate = omega.cross(b).cross(f) + b.cross(carried.cross(f))
        turn = (
            hinge.dot(carried_bias) - hinge.dot(alpha) - (omega - carried).dot(hinge_rate)
        ) * grip
        base = to_body("acceleration", record.anchor_motion.bias)
        return kin.define_bias(body, Twist(Vector(turn, alpha.y, alpha.z), base))

    placed.bias = once(bias)
