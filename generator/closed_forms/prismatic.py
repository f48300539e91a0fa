r"""A body on a guide, held by a leg: two ball joints and a guide; slider-crank.

Let d be the direction of the guide, D_0 the rod's joint at zero slide, E the other end of the
rod of length l, and w = E - D_0. Then ``|D_0 + x d - E| = l`` is a quadratic in the slide x:

    x = d . w + s sqrt(l^2 - |w - (d . w) d|^2),    s = +1 or -1.

Branch: s is the sign of d . (D - E) at the design position. Valid while the root is real; the
edge is the dead point where the rod is perpendicular to the guide. The rate follows from
``(D - E) . (v_D - v_E) = l l'``, whose factor is (D - E) . d = s sqrt(...) and whose right side
is zero but for a telescope of known slide (`leg`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import sympy as sp

from ..declare.joints import Prismatic
from ..kinematics.extent import extent_squared, require
from ..kinematics.motion import BodyMotion, from_axes, once
from ..program.floors import BRANCH, ROOT
from ..program.functions import SignOf
from ..program.vectors import ZERO, Twist
from .held import HeldOnJoint
from .lines import place_rod, projector

if TYPE_CHECKING:
    from ..kinematics.kinematics import Kinematics
    from .leg import Rod


@dataclass(frozen=True)
class PrismaticByLength(HeldOnJoint):
    """A body on a guide of a placed body is held by a leg: its slide follows."""

    joint: Prismatic

    rank: ClassVar[int] = 6
    kind = Prismatic

    @property
    def solution(self) -> str:
        """How the equation is solved, for the report."""
        return f"quadratic in the slide of {self.joint.name}, branch as at design"

    def carry_out(self, kin: Kinematics) -> None:
        """Move the body along its guide until the leg fits."""
        leg = self.leg
        self.meet(kin)
        program, body, joint = kin.program, leg.body, self.joint
        parent = kin.placed[self.parent]
        local = kin.local_direction(parent, joint.direction)
        d = program.vector(f"{body}_guide", from_axes(parent.axes, local))
        anchor = leg.anchor_motion(kin)
        rod = leg.rod_of(kin, self)
        extent = extent_squared(kin, self)
        branch = self._branch(kin, rod, extent)
        start = program.vector(
            f"{body}_start", parent.origin + from_axes(parent.axes, kin.local(parent, leg.end))
        )
        w = program.vector(f"{body}_reach", anchor.position - start)
        along = program.define(f"{body}_reach_along", w.dot(d))
        across = program.vector(f"{body}_reach_across", w - d * along)
        room = program.guarded(
            f"{body}_closure",
            rod.squared - across.dot(across),
            f"{kin.loop_of(self)} cannot close: the {rod.name} is too short to reach the guide "
            f"of {body}",
            "m^2",
            ROOT * extent,
        )
        root = program.define(f"{body}_closure_root", sp.sqrt(room))
        slide = program.define(f"{body}_slide", along + branch * root)
        sense = 1 if joint.second.name == body else -1
        kin.slides[joint.name] = sense * slide
        offset = local * slide
        placed = BodyMotion(
            body,
            origin=program.vector(f"{body}_origin", parent.origin + from_axes(parent.axes, offset)),
            axes=parent.axes,
            design_origin=parent.design_origin,
            design_axes=parent.design_axes,
        )
        kin.placed[body] = placed
        to_body = projector(kin, placed)
        arm = kin.local(placed, leg.end)
        rod_vector = program.vector(
            f"{body}_rod", to_body("rod_now", d * (branch * root) - across), "123"
        )
        inverse_lever = program.define(f"{body}_inverse_lever", -branch / root)
        rate = ZERO
        for k in dict.fromkeys([*parent.motion, *anchor.motion, *rod.stretch]):
            carried = parent.motion.get(k, Twist(ZERO, ZERO))
            base = carried.linear + carried.angular.cross(offset)
            target = to_body(f"target_{k}", anchor.motion.get(k, ZERO))
            relative_velocity = base - target + carried.angular.cross(arm)
            fitted = rod_vector.dot(relative_velocity) - rod.stretch.get(k, sp.Integer(0))
            speed = program.define(f"{body}_speed_{k}", fitted * inverse_lever)
            twist = kin.define_twist(body, k, Twist(carried.angular, base + local * speed))
            placed.motion[k] = twist
            rate += (twist.linear - target + carried.angular.cross(arm)) * kin.coordinates.rate(k)

        def bias() -> Twist:
            now = program.vector(f"{body}_rod_rate", rate, "123")
            carried, omega = parent.bias(), kin.total(parent).angular
            relative_velocity_now = kin.total(placed).linear - (
                kin.total(parent).linear + omega.cross(offset)
            )  # of the slide
            base = kin.point_bias(parent, offset) + omega.cross(relative_velocity_now) * 2
            target = to_body("target_bias", anchor.bias)
            pull = base - target + carried.angular.cross(arm) + omega.cross(omega.cross(arm))
            fitted = rod_vector.dot(pull) + now.dot(now) - rod.stretch_bias
            speed = program.define(f"{body}_speed_bias", fitted * inverse_lever)
            return kin.define_bias(body, Twist(carried.angular, base + local * speed))

        placed.bias = once(bias)
        if not leg.pinned:
            place_rod(kin, leg, anchor, rod.length)

    def _branch(self, kin: Kinematics, rod: Rod, extent: sp.Expr) -> sp.Expr:
        """Return on which side of its foot on the guide the leg is at the design position."""
        leg, body = self.leg, self.leg.body
        along = rod.design.dot(kin.design_direction(self.joint.direction))
        drawn = kin.program.define(f"{body}_rod_along_design", along)
        require(
            kin,
            f"{body}_rod_along_design",
            drawn,
            BRANCH * sp.sqrt(extent),
            "m",
            f"at the design position the {rod.name} is at its dead point: it is perpendicular "
            f"to the "
            f"guide of {body}",
            f"move {leg.anchor.name} or {leg.end.name} along the guide",
        )
        return kin.program.define(f"{body}_branch", SignOf(drawn))
