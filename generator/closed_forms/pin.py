"""A body on a hinge, pinned to a body that is placed already.

The body turns about its hinge until its point meets the placed pin. With O the hinge, n its axis
and ``radius`` the distance of the point from it, the direction to the point is t = (pin - O) across
n, divided by the radius. That the points meet along n x t gives the rate of the turn. There is one
branch and no singular set: the loop has closed before.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..kinematics.extent import extent_squared
from ..kinematics.motion import Meeting
from ..loops.forms import Placement
from ..program.vectors import UNIT_Z, Axes
from .constraints import Coincident
from .hinge import Hinge, place_on_hinge, report_angle
from .solved_motion import ClosureCondition, TargetPoint, add_turn

if TYPE_CHECKING:
    from ..declare.geometry import Point
    from ..declare.joints import Revolute
    from ..kinematics.kinematics import Kinematics


@dataclass(frozen=True)
class PlaceByPin(Placement):
    """A body on a hinge of a placed body meets another placed body at a pin: its angle follows."""

    body: str
    joint: Revolute
    parent: str
    pin: Point
    pin_body: str

    @property
    def title(self) -> str:
        return f"{self.body}: pinned to {self.pin_body}"

    def emit(self, kin: Kinematics) -> None:
        """Turn the body about its hinge until the points meet."""
        program, body = kin.program, self.body
        kin.meetings.setdefault(
            self.joint.name, Meeting(self.parent, body, self.pin, self.pin, self.pin_body)
        )
        hinge = Hinge.of(kin, body, self.joint, self.parent, self.pin, extent_squared(kin, self))
        pin = kin.point_motion(self.pin_body, self.pin)
        n = hinge.axis
        span = program.vector(f"{body}_span", pin.position - hinge.origin.position)
        inverse = program.define(f"{body}_radius_inverse", 1 / hinge.arm.radius)
        t = program.vector(f"{body}_arm", (span - n * hinge.arm.along) * inverse)
        axes: Axes = (n, t, program.vector(f"{body}_normal", n.cross(t)))
        unsolved = place_on_hinge(kin, hinge, axes)
        arm = hinge.arm.local
        target = TargetPoint(kin, unsolved.placed, pin)
        add_turn(kin, unsolved, ClosureCondition(Coincident(arm, arm, UNIT_Z), target, arm))
        report_angle(kin, hinge, axes)
