"""Assumptions of the equations about the geometry: quantities that must be zero.

A closed form may hold for a plane, or for a rod that lies along its shaft. Whether the geometry is
of that kind follows from parameters, which change at run time. So each such quantity is a constant
of the parameter set, and `prepare` refuses a set for which it is not zero. The equations themselves
do not read it. A quantity that is zero by declaration, as in a plane of flat points, is not
checked.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import sympy as sp

from ..declare.declared import DeclarationError
from ..declare.evaluation import AtDefaults
from ..declare.joints import Prismatic, Revolute, Universal
from ..program.conditions import Assumption
from ..program.floors import ROUNDING

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from ..declare.formulation import Formulation
    from ..declare.geometry import Line, Point
    from ..declare.mechanism import Mechanism
    from ..loops.graph import Cycle
    from ..loops.planner import Plan
    from ..program.program import Program
    from ..program.vectors import Vector


def find_assumptions(plan: Plan) -> list[Assumption]:
    """Return the quantities that must be zero and are not zero by declaration.

    Raises `DeclarationError` if one of them is not zero with the default parameters.
    """
    found = [a for a in _assumptions(plan) if a.quantity != 0]
    _check_defaults(plan.formulation, found)
    return found


def define_assumptions(program: Program, assumed: Iterable[Assumption]) -> tuple[Assumption, ...]:
    """Append assumed quantities as constants, and return the assumptions in their names."""
    program.section("quantities that must be zero")
    named: dict[sp.Expr, Assumption] = {}
    for assumption in assumed:
        quantity = program.define(assumption.name, assumption.quantity)
        if quantity.could_extract_minus_sign():  # defined before, with the other sign
            quantity = -quantity
        scale = program.define(f"{assumption.name}_scale", assumption.scale)
        named.setdefault(quantity, replace(assumption, quantity=quantity, scale=scale))
    return tuple(named.values())


def _check_defaults(formulation: Formulation, found: list[Assumption]) -> None:
    at_defaults = AtDefaults(formulation.mechanism)
    problems = []
    for assumption in found:
        value, scale = at_defaults(assumption.quantity), at_defaults(assumption.scale)
        # a comparison with NaN is false: missing parameters and coincident points have errors
        if abs(value) > float(ROUNDING) * scale:
            off = _amount(value, assumption.unit)
            problems.append(f"{assumption.meaning}: it is off by {off}; {assumption.remedy}")
    if problems:
        raise DeclarationError(formulation.name, problems)


def _amount(value: float, unit: str) -> str:
    """Return a deviation, for a message."""
    if unit == "m":
        return f"{1e3 * abs(value):.3g} mm"
    return f"{math.degrees(math.asin(min(abs(value), 1.0))):.3g} degrees"


def _assumptions(plan: Plan) -> Iterator[Assumption]:
    for transformer in plan.transformers:
        if transformer.cycle.planar:
            yield from _of_plane(transformer.cycle)
    lines = {link: ends for step in plan.steps for link, *ends in step.lines()}
    for joint in plan.topology.mechanism.joints:
        if isinstance(joint, Universal) and joint.second.name in lines:
            yield from _of_shaft(joint, lines[joint.second.name])
    for step in plan.steps:
        yield from step.assumptions()
    yield from _of_rotors(plan.formulation)


# -- loops in a plane -----------------------------------------------------------------------------


def _of_plane(cycle: Cycle) -> Iterator[Assumption]:
    """Yield the conditions of a planar loop: hinges along each other, guides across them."""
    hinge, *others = (j for j in cycle.joints if isinstance(j, Revolute))
    loop, n = " - ".join(cycle.bodies), hinge.axis.vector
    for other in others:
        if other.axis.towards != hinge.axis.towards:
            across = n.cross(other.axis.vector)
            yield Assumption(
                f"{other.name}_askew",
                _norm(across) / (_norm(n) * _norm(other.axis.vector)),
                sp.Integer(1),
                "1",
                f"the equations take the loop {loop} to move in a plane, but its hinges "
                f"{hinge.name} and {other.name} are not parallel",
                "make the directions of the two equal or opposite",
            )
    for guide in (j for j in cycle.joints if isinstance(j, Prismatic)):
        d = guide.direction.components
        yield Assumption(
            f"{guide.name}_out_of_plane",
            n.dot(d) / (_norm(n) * _norm(d)),
            sp.Integer(1),
            "1",
            f"the equations take the loop {loop} to move in a plane, but the guide {guide.name} is "
            f"not across the hinge {hinge.name}",
            _into_plane(guide),
        )


def _into_plane(guide: Prismatic) -> str:
    if guide.direction.between is None:
        return f"turn the direction {guide.direction.name} until it is across that hinge"
    first, second = (point.name for point in guide.direction.between)
    return (
        f"move {first} or {second} along the direction of that hinge until both are in one plane "
        "across it, or give the guide a direction of its own"
    )


# -- shafts ---------------------------------------------------------------------------------------


def _of_shaft(joint: Universal, ends: Sequence[Point]) -> Iterator[Assumption]:
    """Yield the conditions that the shaft of a universal joint is along the line of its rod."""
    first, second = ends
    length = _norm(second.position - first.position)
    start, end = sorted(ends, key=lambda point: point != joint.at)
    for point in (p for p in ends if not joint.shaft.contains(p)):
        yield Assumption(
            f"{joint.name}_shaft_beside_{point.name}",
            _distance(point, joint.shaft),
            length,
            "m",
            f"the shaft of universal joint {joint.name} must be the line of "
            f"{joint.second.name}, but "
            f"misses its end {point.name}",
            f"declare the shaft from {start.name} to {end.name}",
        )


# -- rotors ---------------------------------------------------------------------------------------


def _of_rotors(formulation: Formulation) -> Iterator[Assumption]:
    """Yield the conditions under which the inertia of a rotor does not change with its spin."""
    for joint in _bearings(formulation):
        body, axis = joint.second, joint.axis.vector
        assert body.rotor_axis is not None
        remedy = (
            "a body of revolution turns about its own axis; otherwise declare it without a "
            "rotor_axis and with a full inertia tensor"
        )
        own = body.rotor_axis.components
        yield Assumption(
            f"{body.name}_rotor_askew",
            _norm(axis.cross(own)) / (_norm(axis) * _norm(own)),
            sp.Integer(1),
            "1",
            f"the axis of rotor {body.name} is not along its bearing {joint.name}",
            remedy,
        )
        if not joint.axis.contains(body.center):
            # a distance that should vanish: its scale must not vanish with it
            scale = _norm(body.center.position) + _norm(joint.axis.through.position)
            yield Assumption(
                f"{body.name}_rotor_unbalance",
                _distance(body.center, joint.axis),
                scale,
                "m",
                f"the centre of mass of rotor {body.name} is beside its bearing {joint.name}",
                remedy,
            )


def _bearings(formulation: Formulation) -> Iterator[Revolute]:
    """Yield the hinges of known angle with a rotor at the end of the chain."""
    mechanism: Mechanism = formulation.mechanism
    for joint in formulation.driven:
        rotor = joint.second.rotor_axis is not None
        end = len(mechanism.joints_of(joint.second.name)) == 1
        if isinstance(joint, Revolute) and rotor and end:
            yield joint


# -- measures -------------------------------------------------------------------------------------


def _norm(v: Vector) -> sp.Expr:
    return sp.sqrt(v.dot(v))


def _distance(point: Point, line: Line) -> sp.Expr:
    """Return the distance of a point from a line."""
    way = point.position - line.through.position
    return _norm(way.cross(line.vector)) / _norm(line.vector)
