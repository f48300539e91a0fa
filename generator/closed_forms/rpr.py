r"""A telescope in a plane between two placed pins: barrel and piston rod of a cylinder.

Two links on a common guide are pinned to bodies that are placed, at A and at D; the dyad of hinge,
guide and hinge. With S the part of D - A across the hinges, n the direction of the hinges, d that
of the guide, e the constant offset of D from the guide through A, u the way along the guide, and h
the constant part of D - A along n,

    S = u d + e n x d,    d = (u S - e n x S) / |S|^2,    |S|^2 = u^2 + e^2.

Slide unknown: ``u = s sqrt(|S|^2 - e^2)``, s = +1 or -1, and the slide is u less its value at the
design position. Branch: s is the sign of u at the design position. Valid while ``|S| > |e|``; at
the edge the pins stand across the guide. Slide known: u is known, and the loop has closed before
(`rod`). That d is across n is one of the `assumptions`.

Both links have the body axes (n, d, n x d), in which D - A = (h, u, e). The third component of
``v_D - v_A`` has no part of u', so that it gives the turn: u omega1 = (v_D - v_A - omega_parent x
(D - A))_3, and once more for the accelerations, with the Coriolis term 2 u' omega1.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..kinematics.extent import extent_squared
from ..kinematics.motion import Axes, Placed, PointMotion, from_axes, to_axes
from ..program.floors import DIRECTION, ROOT
from ..program.functions import Positive
from ..program.vectors import UNIT_X, ZERO, Twist, Vector
from .lines import once, projector
from .rod import Guide

if TYPE_CHECKING:
    from ..kinematics.kinematics import Kinematics
    from ..loops.actions import PinnedTelescope, PlaceTelescope, SolveStroke


def solve_stroke(kin: Kinematics, action: SolveStroke) -> None:
    """Find slide and direction of a telescope between two placed pins."""
    program, near, joint = kin.program, action.near, action.joint
    pins = _Pins.of(kin, action)
    _, c, e = pins.guide.start
    extent = extent_squared(kin, action)
    squared = program.guarded(
        f"{near}_extension_squared",
        pins.across.dot(pins.across) - e**2,
        f"{kin.loop_of(action)} cannot close: the pins {action.anchor.name} and {action.end.name} "
        f"come nearer to each other than the guide of {action.links} allows",
        "m^2",
        # the square of the distance of the pins is more by e^2: their direction counts as well
        ROOT * extent + Positive(DIRECTION * extent - e**2),
    )
    extension = program.define(f"{near}_extension", pins.guide.branch * sp.sqrt(squared))
    kin.slides[joint.name] = program.define(f"slide_{joint.name}", action.sense * (extension - c))
    _place(kin, pins, extension)


def place_telescope(kin: Kinematics, action: PlaceTelescope) -> None:
    """Find the direction of a telescope of known slide between two placed pins."""
    pins = _Pins.of(kin, action)
    _place(kin, pins, pins.guide.known_extension(kin, extent_squared(kin, action)))


@dataclass(frozen=True)
class _Pins:
    """The pins of a telescope and what lies between them.

    Attributes
    ----------
    axis
        Direction of the hinges, in work axes.
    across
        From pin to pin, across the hinges.
    """

    telescope: PinnedTelescope
    guide: Guide
    anchor: PointMotion
    end: PointMotion
    axis: Vector
    across: Vector

    @classmethod
    def of(cls, kin: Kinematics, telescope: PinnedTelescope) -> _Pins:
        """Describe the pins of a telescope."""
        program, near = kin.program, telescope.near
        guide = Guide.of(kin, telescope, extent_squared(kin, telescope))
        parent = kin.placed[telescope.anchor_body]
        on_parent = to_axes(parent.design_axes, guide.axes[0])
        on_parent = program.vector(f"{near}_hinge_on_parent", on_parent, "123")
        axis = program.vector(f"{near}_hinge", from_axes(parent.axes, on_parent))
        anchor = kin.point_motion(telescope.anchor_body, telescope.anchor)
        end = kin.point_motion(telescope.end_body, telescope.end)
        span = end.position - anchor.position - axis * guide.start.x
        return cls(telescope, guide, anchor, end, axis, program.vector(f"{near}_span", span))


def _place(kin: Kinematics, pins: _Pins, extension: sp.Expr) -> None:
    """Place both links, given the way along the guide."""
    program, telescope, start = kin.program, pins.telescope, pins.guide.start
    near, arm = telescope.near, Vector(start.x, extension, start.z)
    axes = _axes(kin, pins, extension)
    parent, carrier = kin.placed[telescope.anchor_body], kin.placed[telescope.end_body]
    link = Placed(
        near,
        origin=pins.anchor.position,
        axes=axes,
        design_origin=kin.design(telescope.anchor),
        design_axes=pins.guide.axes,
        local={telescope.anchor: ZERO},
        carrier=(parent.body, kin.local(parent, telescope.anchor)),
    )
    other = Placed(
        telescope.far,
        origin=pins.end.position,
        axes=axes,
        design_origin=kin.design(telescope.end),
        design_axes=pins.guide.axes,
        local={telescope.end: ZERO},
        carrier=(carrier.body, kin.local(carrier, telescope.end)),
    )
    to_body = projector(kin, link)
    hold = program.define(f"{near}_hold", -1 / extension)
    growth = sp.Integer(0)  # of the extension

    def carried(label: str, v: Vector) -> Vector:
        return to_body(label, from_axes(parent.axes, v))

    for k in dict.fromkeys([*pins.anchor.motion, *parent.motion, *pins.end.motion]):
        base = to_body(f"velocity_{k}", pins.anchor.motion.get(k, ZERO))
        swing = carried(f"carried_{k}", parent.motion[k].angular) if k in parent.motion else ZERO
        target = to_body(f"target_{k}", pins.end.motion.get(k, ZERO))
        turn = program.define(f"{near}_turn_{k}", (base - target + swing.cross(arm)).z * hold)
        omega = program.vector(f"{near}_omega_{k}", swing + UNIT_X * turn, "123")
        link.motion[k], other.motion[k] = Twist(omega, base), Twist(omega, target)
        growth += (target - base - omega.cross(arm)).y * kin.rate(k)

    def bias() -> Twist:
        omega = kin.total(link).angular
        parent_omega = carried("carried_now", kin.total(parent).angular)
        base = to_body("acceleration", pins.anchor.bias)
        target = to_body("target_bias", pins.end.bias)
        spin = Vector(omega.x - parent_omega.x, ZERO.y, ZERO.z)
        alpha = carried("carried_bias", parent.bias().angular) + parent_omega.cross(spin)
        alpha = program.vector(f"{near}_alpha_carried", alpha, "123")
        whirl = program.vector(f"{near}_whirl", omega.cross(arm), "123")
        pull = base - target + omega.cross(whirl) + alpha.cross(arm)
        coriolis = 2 * omega.x * program.define(f"{near}_growth", growth)
        turn = program.define(f"{near}_turn_bias", (pull.z + coriolis) * hold)
        return kin.define_bias(near, Twist(alpha + UNIT_X * turn, base))

    link.bias = once(bias)
    other.bias = once(lambda: Twist(link.bias().angular, to_body("target_bias", pins.end.bias)))
    kin.placed[near], kin.placed[telescope.far] = link, other


def _axes(kin: Kinematics, pins: _Pins, extension: sp.Expr) -> Axes:
    """Return the axes of both links: hinge, guide, and across both."""
    program, near, offset = kin.program, pins.telescope.near, pins.guide.start.z
    if offset == 0:
        along = pins.across * program.define(f"{near}_extension_inverse", 1 / extension)
    else:
        inverse = program.define(f"{near}_span_inverse_squared", 1 / (extension**2 + offset**2))
        along = pins.across * extension - pins.axis.cross(pins.across) * offset
        along *= inverse
    d = program.vector(f"{near}_guide", along)
    return pins.axis, d, program.vector(f"{near}_side", pins.axis.cross(d))
