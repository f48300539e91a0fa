"""A strut in space: two links on a guide along the line of their ends, a cross and a ball joint."""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

from ..kinematics.motion import Placed, to_axes
from ..program.vectors import NO_TWIST, ZERO, Twist
from .lines import line_of_ends, once, projector

if TYPE_CHECKING:
    from ..kinematics.kinematics import Kinematics
    from ..loops.actions import PlaceByGuide, SolveStrut


def solve_strut(kin: Kinematics, action: SolveStrut) -> None:
    """Slide and line of a strut between two known points: universal, prismatic, spherical.

    Equation: ``|P_end - P_anchor| = l_0 + x``, l_0 being the distance at the design position and x
    the slide, or its negative where the strut shrinks with it. It is explicit. Branch: the positive
    length. Singular set: the two points coincide. The first link gets its turn about the line from
    its cross (`cross`), the second one from the first.
    """
    program, name = kin.program, action.joint.name
    record = line_of_ends(kin, action, f"the strut of {action.links}")
    kin.on_line[action.near] = record
    design = program.vector(
        f"span_{name}_design", kin.design(action.end) - kin.design(action.anchor)
    )
    start = program.define(f"length_{name}_design", sp.sqrt(design.dot(design)))
    kin.slides[name] = program.define(f"slide_{name}", action.sense * (record.length - start))


def place_by_guide(kin: Kinematics, action: PlaceByGuide) -> None:
    """Place the second link of a strut: it turns like the first, and its end is where it is."""
    strut = action.strut
    near, end = kin.placed[strut.near], kin.point_motion(strut.end_body, strut.end)
    placed = Placed(
        strut.far,
        origin=end.position,
        axes=near.axes,
        design_origin=kin.design(strut.end),
        design_axes=near.design_axes,
        local={strut.end: ZERO},
        carrier=(strut.end_body, kin.local(kin.placed[strut.end_body], strut.end)),
    )
    to_body = projector(kin, placed)
    for k in dict.fromkeys([*near.motion, *end.motion]):
        velocity = to_body(f"velocity_{k}", end.motion.get(k, ZERO))
        placed.motion[k] = Twist(near.motion.get(k, NO_TWIST).angular, velocity)

    def bias() -> Twist:
        return Twist(near.bias().angular, to_axes(placed.axes, end.bias))

    placed.bias = once(bias)
    kin.placed[strut.far] = placed
