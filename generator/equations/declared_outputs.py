"""The values of declared outputs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

from ..declare.outputs import (
    AccelerationOf,
    AngleBetween,
    DistanceBetween,
    ForceOf,
    PositionOf,
    VelocityOf,
)
from ..declare.shown import Shown
from ..program.floors import DIRECTION
from ..program.vectors import ZERO, from_axes

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..declare.bodies import Body
    from ..declare.geometry import Direction
    from ..declare.outputs import OfPoint, Output
    from ..program.vectors import Vector
    from .dynamics import Dynamics

NONE = sp.Integer(0)


def signals_of(dynamics: Dynamics, output: Output) -> Iterator[Shown]:
    """Yield the signals of a declared output."""
    if isinstance(output, PositionOf):
        part = dynamics.part_of[output.body.name]
        place = part.place_in_world(part.point_motion(output.body.name, output.point).position)
        yield from _components(output, place, "m", "position of the ")
    elif isinstance(output, VelocityOf):
        yield from _components(output, _velocity(dynamics, output), "m/s", "velocity of the ")
    elif isinstance(output, AccelerationOf):
        acceleration = _acceleration(dynamics, output)
        yield from _components(output, acceleration, "m/s^2", "acceleration of the ")
    elif isinstance(output, DistanceBetween):
        yield from _distance(dynamics, output)
    elif isinstance(output, AngleBetween):
        yield Shown(output.name, _angle(dynamics, output), "rad", output.meaning)
    elif isinstance(output, ForceOf):
        unit = "N m" if output.element.turns else "N"
        yield Shown(output.name, dynamics.acting.total(output.element), unit, output.meaning)


def _components(output: OfPoint, value: Vector, unit: str, what: str) -> Iterator[Shown]:
    for axis, component in zip("xyz", value, strict=True):
        yield Shown(f"{output.name}_{axis}", component, unit, f"{what}{output.meaning}, {axis}")


def _velocity(dynamics: Dynamics, output: OfPoint) -> Vector:
    part, driven = dynamics.part_of[output.body.name], dynamics.coordinates
    motion = dynamics.moving.point_motion(output.body.name, output.point).motion
    return part.in_world(_summed(motion, {k: driven.true_rate(k) for k in motion}))


def _acceleration(dynamics: Dynamics, output: OfPoint) -> Vector:
    part = dynamics.part_of[output.body.name]
    found = dynamics.moving.point_motion(output.body.name, output.point)
    rates = {k: dynamics.accelerations.get(k, NONE) for k in found.motion}
    rate_scale = dynamics.coordinates.rate_scale_of(dynamics.placed[output.body.name])
    return part.in_world(_summed(found.motion, rates) + found.bias * rate_scale**2)


def _summed(motion: dict[str, Vector], rates: dict[str, sp.Expr]) -> Vector:
    return sum((motion[k] * rate for k, rate in rates.items()), ZERO)


def _distance(dynamics: Dynamics, output: DistanceBetween) -> Iterator[Shown]:
    program, name = dynamics.program, output.name
    (one, start), (other, end) = output.first, output.second
    relative = dynamics.moving.relative_motion((one.name, start), (other.name, end))
    span = program.vector(f"{name}_span", relative.position)
    places = (dynamics.part_of[body.name].design(p) for body, p in (output.first, output.second))
    extent = program.define(f"{name}_extent_squared", sum((p.dot(p) for p in places), NONE))
    squared = program.guarded(
        f"{name}_squared", span.dot(span), f"the ends of {name} coincide", "m^2", DIRECTION * extent
    )
    length = program.define(f"{name}_now", sp.sqrt(squared))
    rates = {k: dynamics.coordinates.true_rate(k) for k in relative.motion}
    rate = span.dot(_summed(relative.motion, rates)) / length
    yield Shown(name, length, "m", output.meaning)
    yield Shown(f"{name}_rate", rate, "m/s", f"rate of {name}")


def _angle(dynamics: Dynamics, output: AngleBetween) -> sp.Expr:
    """Return the angle of the parts of two directions across an axis of the first body."""
    body, direction = output.first
    n, u = (_now(dynamics, body, d) for d in (output.about, direction))
    v = _now(dynamics, *output.second)
    return sp.atan2(n.dot(u.cross(v)), u.dot(v) - n.dot(u) * n.dot(v))


def _now(dynamics: Dynamics, body: Body, direction: Direction) -> Vector:
    """Return a unit direction that a body has carried from design, in the axes of the world."""
    part, placed = dynamics.part_of[body.name], dynamics.placed[body.name]
    work = from_axes(placed.axes, part.local_direction(placed, direction))
    return dynamics.program.vector(f"{body.name}_{direction.name}_now", part.in_world(work))
