"""Slides of guides and their rates, from the poses of two placed bodies."""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

from ..program.vectors import from_axes, to_axes

if TYPE_CHECKING:
    from ..declare.joints import Prismatic
    from .kinematics import Kinematics


def slide_of(kin: Kinematics, joint: Prismatic) -> sp.Expr:
    """Return the slide of a guide [m]: given or solved."""
    if kin.coordinates.is_given(joint):
        return kin.given(joint)
    return kin.program.define(f"slide_{joint.name}", kin.slides[joint.name])


def sliding_rates(kin: Kinematics, joint: Prismatic) -> dict[str, sp.Expr]:
    """Return the rate of a guide's slide per unit rate of each coordinate that changes it.

    The guide's direction d turns with the first body, and both bodies turn alike: ``d . v`` of the
    second body's origin, less that of the first body at the same point.
    """
    if kin.coordinates.is_given(joint):
        own = kin.coordinates.of(joint), kin.coordinates.ratio(joint)
        return dict([own]) if kin.coordinates.moves(joint) else {}
    first, second = kin.placed[joint.first.name], kin.placed[joint.second.name]
    local = kin.local_direction(first, joint.direction)
    way = to_axes(first.axes, second.origin - first.origin)
    rates: dict[str, sp.Expr] = {}
    for k, twist in second.motion.items():
        rates[k] = local.dot(to_axes(first.axes, from_axes(second.axes, twist.linear)))
    for k, twist in first.motion.items():
        carried = local.dot(twist.linear + twist.angular.cross(way))
        rates[k] = rates.get(k, sp.Integer(0)) - carried
    return {
        k: kin.program.define(f"slide_rate_{joint.name}_{k}", rate) for k, rate in rates.items()
    }
