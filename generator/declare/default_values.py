"""Impossible defaults: out of range, of no body, or without a direction."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...core.physical import inertia_of_no_body, out_of_range, rotors_of_no_body
from .evaluation import AtDefaults
from .geometry import Direction, Line, Point
from .joints import Revolute
from .paths import AlongLine
from .ranges import described

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..program.vectors import Vector
    from .assembly import Parts

# Bound below which a length or an angle counts as zero, relative to its scale.
_ROUNDING = 1e-9


def value_problems(mechanism: Parts) -> list[str]:
    """Return problems of defaults: ranges, impossible inertia, and lines without a direction."""
    values = {p.name: p.default for p in mechanism.parameters}
    problems = out_of_range(values, described(mechanism)) or [
        *inertia_of_no_body(values),
        *rotors_of_no_body(values),
    ]
    return problems + (list(_lost_directions(mechanism)) or _angle_problems(mechanism))


def _lost_directions(mechanism: Parts) -> Iterator[str]:
    """Yield problems of coincident points with a line between, and of directions of length zero."""
    value = AtDefaults(mechanism)
    named: set[str] = set()
    for part in mechanism.every((AlongLine, Line, Direction)):
        if isinstance(part, AlongLine):
            ends = [point for _, point in part.ends]
            what, vector = _between(*ends), ends[1].position - ends[0].position
            size = _size(value, *(end.position for end in ends))
        elif isinstance(part, Line) and isinstance(part.towards, Point):
            what, vector = _between(part.through, part.towards), part.vector
            size = _size(value, part.through.position, part.towards.position)
        elif isinstance(part, Direction):
            what, vector = f"direction {part.name!r} has no length", part.components
            size = (
                1.0 if part.between is None else _size(value, *(p.position for p in part.between))
            )
        else:
            continue
        if what not in named and np.linalg.norm(list(map(value, vector))) <= 1e-12 * size:
            named.add(what)
            yield f"{what} at the design position; check the defaults of its parameters"


def _between(one: Point, other: Point) -> str:
    return f"the points {one.name!r} and {other.name!r}, between which a line is declared, coincide"


def _size(value: AtDefaults, *places: Vector) -> float:
    """Return the greatest distance of places from the origin, the scale of their distances."""
    return max(float(np.linalg.norm(list(map(value, place)))) for place in places)


def _angle_problems(mechanism: Parts) -> list[str]:
    """Return problems of hinges with a reference of their angle along the hinge."""
    value, problems = AtDefaults(mechanism), []
    for joint in mechanism.joints:
        if not isinstance(joint, Revolute) or joint.angle_to is None:
            continue
        axis = np.array([value(c) for c in joint.axis.vector])
        to = joint.angle_to.position - joint.axis.through.position
        for what, name, along in (
            ("angle_from", joint.angle_from.name, joint.angle_from.components),
            ("angle_to", joint.angle_to.name, to),
        ):
            other = np.array([value(c) for c in along])
            if np.linalg.norm(np.cross(axis, other)) <= _ROUNDING * np.linalg.norm(axis):
                problems.append(
                    f"joint {joint.name!r}: {what}, which is {name}, lies along the hinge, so that "
                    "its angle has no beginning or no end; take one beside the hinge, or leave "
                    "angle_to out, and the angle counts from the design position"
                )
    return problems
