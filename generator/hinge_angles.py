"""Angles of hinges: from which direction they count, and from the poses of two placed bodies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from .arithmetic import SignOf
from .placement import Placed, from_axes, to_axes
from .vectors import ZERO, Vector

if TYPE_CHECKING:
    from .joints import Revolute
    from .kinematics import Kinematics


@dataclass(frozen=True)
class HingeDesign:
    """A hinge whose angle counts to a point, at the design position (constants, work axes).

    Attributes
    ----------
    axis
        Unit vector, in the sense in which the angle is positive.
    zero, mark
        Unit vectors across it, between which the angle is: on the first body and on the second.
    along, radius
        Where the point is, from the point of the hinge: along the axis, and across it.
    """

    axis: Vector
    zero: Vector
    mark: Vector
    along: sp.Expr
    radius: sp.Expr

    @classmethod
    def of(cls, kin: Kinematics, joint: Revolute) -> HingeDesign:
        """Describe a hinge that has an ``angle_to``."""
        assert joint.angle_to is not None
        program, name = kin.program, joint.name
        n = axis_at_design(kin, joint)
        reference = kin.design_direction(joint.angle_from)
        zero = kin.unit(f"{name}_zero_design", reference - n * reference.dot(n))
        arm = kin.design(joint.angle_to) - kin.design(joint.axis.through)
        arm = program.vector(f"{name}_arm_design", arm)
        sense = program.define(f"{name}_sense", SignOf(n.dot(zero.cross(arm))))
        axis = program.vector(f"{name}_axis_signed", n * sense)
        along = program.define(f"{name}_arm_along", arm.dot(axis))
        across = program.vector(f"{name}_arm_across", arm - axis * along)
        radius = program.define(f"{name}_arm_radius", sp.sqrt(across.dot(across)))
        mark = program.vector(f"{name}_mark_design", across * (1 / radius))
        return cls(axis, zero, mark, along, radius)


def axis_at_design(kin: Kinematics, joint: Revolute) -> Vector:
    """Return the unit vector along a hinge as declared, at design, in work axes."""
    return kin.unit(f"{joint.name}_axis_design", kin.to_work(joint.axis.vector))


def positive_axis_at_design(kin: Kinematics, joint: Revolute) -> Vector:
    """Return the unit vector about which the angle of a hinge is positive, at design."""
    return axis_at_design(kin, joint) if joint.angle_to is None else HingeDesign.of(kin, joint).axis


def turn_between(kin: Kinematics, joint: Revolute) -> tuple[sp.Expr, sp.Expr]:
    """Return sine and cosine of a hinge's angle from the poses of its two bodies.

    With ``angle_to``, from the two directions that the angle is declared between. Without, it is
    the turn from the design position: with a the axes of the second body as the first carries them
    on from there, and b as they are, ``2 sin = n . sum(a x b)`` and ``1 + 2 cos = sum(a . b)``.
    """
    first, second = kin.placed[joint.first], kin.placed[joint.second]
    n = _carried(kin, first, f"{joint.name}_axis", positive_axis_at_design(kin, joint))
    if joint.angle_to is not None:
        design = HingeDesign.of(kin, joint)
        zero = _carried(kin, first, f"{joint.name}_zero", design.zero)
        mark = _carried(kin, second, f"{joint.name}_mark", design.mark)
        return n.dot(zero.cross(mark)), zero.dot(mark)
    swept, agreement = ZERO, sp.Integer(-1)
    for i, (start, b) in enumerate(zip(second.design_axes, second.axes, strict=True), 1):
        a = _carried(kin, first, f"{joint.name}_start_{i}", start)
        swept += a.cross(b)
        agreement += a.dot(b)
    half = sp.Rational(1, 2)
    return n.dot(swept) * half, agreement * half


def _carried(kin: Kinematics, placed: Placed, name: str, design: Vector) -> Vector:
    """Return where a body has carried a direction from the design position."""
    local = kin.program.vector(f"{name}_on_{placed.body}", to_axes(placed.design_axes, design))
    return from_axes(placed.axes, local)
