"""Angles of hinges: their reference, and their values from the poses of two placed bodies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..declare.joints import Free, Prismatic, Revolute
from ..program.functions import SignOf
from ..program.vectors import UNIT_X, ZERO, Vector, from_axes, to_axes

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..program.program import Program
    from .kinematics import Kinematics
    from .motion import BodyMotion


@dataclass(frozen=True)
class HingeDesign:
    """A hinge whose angle counts to a point, at the design position (constants, work axes)."""

    axis: Vector  # unit vector, in the sense in which the angle is positive
    # unit vectors across it that include the angle: on the first body and on the second
    zero: Vector
    mark: Vector
    # position of the point relative to that of the hinge: along the axis, and across it
    along: sp.Expr
    radius: sp.Expr

    @classmethod
    def of(cls, kin: Kinematics, joint: Revolute) -> HingeDesign:
        """Return the design of a hinge that has an ``angle_to``."""
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

    def angle(self, program: Program, name: str) -> sp.Expr:
        """Append the angle [rad], from 0 to pi; the name begins that of the step."""
        sine, cosine = self.axis.dot(self.zero.cross(self.mark)), self.zero.dot(self.mark)
        return program.define(f"{name}_angle_design", sp.atan2(sine, cosine))


def axis_at_design(kin: Kinematics, joint: Revolute) -> Vector:
    """Return the unit vector along a hinge as declared, at design, in work axes."""
    return kin.unit(f"{joint.name}_axis_design", kin.to_work(joint.axis.vector))


def positive_axis_at_design(kin: Kinematics, joint: Revolute) -> Vector:
    """Return the unit vector about which the angle of a hinge is positive, at design."""
    return axis_at_design(kin, joint) if joint.angle_to is None else HingeDesign.of(kin, joint).axis


def angle_of(kin: Kinematics, joint: Revolute) -> sp.Expr:
    """Return the angle of a hinge [rad]: given, solved, or from the poses of its two bodies."""
    if kin.coordinates.is_given(joint):
        return kin.given(joint)
    if joint.name in kin.angles and joint.angle_to is None:
        return kin.program.define(f"angle_{joint.name}", kin.angles[joint.name])
    sine, cosine = turn_between(kin, joint)
    return kin.program.define(f"angle_{joint.name}", sp.atan2(sine, cosine))


def turning_rates(kin: Kinematics, joint: Revolute) -> dict[str, sp.Expr]:
    """Return the rate of a hinge's angle per unit rate of each coordinate that turns it.

    The axis is fixed in both bodies: ``n . omega`` of the second less that of the first.
    """
    rates: dict[str, sp.Expr] = {}
    for sense, name in ((1, joint.second.name), (-1, joint.first.name)):
        placed = kin.placed[name]
        n = _axis_on(kin, joint, placed)
        for k, twist in placed.motion.items():
            share = kin.program.define(f"{joint.name}_turn_of_{name}_{k}", n.dot(twist.angular))
            rates[k] = rates.get(k, sp.Integer(0)) + sense * share
    return rates


def is_first_axis(kin: Kinematics, joint: Revolute) -> bool:
    """Return whether a hinge is the first of its second body's axes, which it placed."""
    return kin.placed[joint.second.name].hinge == joint.name


@dataclass(frozen=True)
class DrivenCoordinate:
    """A driven coordinate, along the path from the design position."""

    # value, and that at design
    symbol: sp.Symbol
    start: sp.Expr
    # whether it is an angle alone, of which a full turn changes nothing: not so where others follow
    # it through gears
    turns: bool
    # joints that it moves, its own first: displacement per unit of it, and whether they slide
    moves: tuple[tuple[sp.Expr, bool], ...]

    def unit(self, size: sp.Expr) -> sp.Expr:
        """Return the change of it that counts like a radian, for that size of a slide.

        For a wheel that a gear turns several times as fast, it is smaller by that ratio.
        """
        (_, slides), *others = self.moves
        if not others:
            return size if slides else sp.Integer(1)
        paces = (ratio / size if slides else ratio for ratio, slides in self.moves)
        return 1 / sp.sqrt(sp.Add(*(pace**2 for pace in paces)))


def driven_coordinates(kin: Kinematics) -> Iterator[DrivenCoordinate]:
    """Yield each driven coordinate that moves a body of a part."""
    # loops on a body that moves freely close in its axes, and do not depend on its position
    given = (j for j in kin.coordinates.given if not isinstance(j, Free))
    inside = [j for j in given if j.second.name in kin.bodies]
    for joint in dict.fromkeys(j.first_followed for j in inside):
        start = sp.Integer(0)
        if isinstance(joint, Revolute) and joint.angle_to is not None:
            start = HingeDesign.of(kin, joint).angle(kin.program, joint.name)
        others = [j for j in inside if j != joint and j.first_followed == joint]
        yield DrivenCoordinate(
            kin.given(joint),
            start,
            isinstance(joint, Revolute) and not others,
            tuple((kin.coordinates.ratio(j), isinstance(j, Prismatic)) for j in (joint, *others)),
        )


def _axis_on(kin: Kinematics, joint: Revolute, placed: BodyMotion) -> Vector:
    """Return the axis of a hinge in the axes of one of its bodies."""
    if placed.body == joint.second.name and is_first_axis(kin, joint):
        return UNIT_X
    n = to_axes(placed.design_axes, positive_axis_at_design(kin, joint))
    return kin.program.vector(f"{joint.name}_axis_on_{placed.body}", n, "123")


def turn_between(kin: Kinematics, joint: Revolute) -> tuple[sp.Expr, sp.Expr]:
    """Return sine and cosine of a hinge's angle from the poses of its two bodies.

    With ``angle_to``, from the two directions that the angle is declared between. Without, it is
    the turn from the design position: with a the axes of the second body as the first carries them
    from there, and b their present ones, ``2 sin = n . sum(a x b)`` and ``1 + 2 cos = sum(a . b)``.
    """
    first, second = kin.placed[joint.first.name], kin.placed[joint.second.name]
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


def _carried(kin: Kinematics, placed: BodyMotion, name: str, design: Vector) -> Vector:
    """Return a direction that a body has carried from the design position."""
    local = kin.program.vector(f"{name}_on_{placed.body}", to_axes(placed.design_axes, design))
    return from_axes(placed.axes, local)
