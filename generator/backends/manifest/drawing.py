"""Data for drawing a mechanism: points that its bodies carry, at the design position."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import sympy as sp

from ...declare.geometry import Point
from ...declare.joints import Cylindrical, Free, Prismatic, Revolute
from ...declare.paths import AlongLine
from ...declare.wheel import Wheel

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...declare.joints import Joint
    from ...declare.mechanism import Mechanism

Place = list[str | float]
End = tuple[str, str]


def drawing(mechanism: Mechanism) -> dict[str, Any]:
    """Return the data for drawing a mechanism.

    Returns
    -------
    dict
        ``points``, the names and positions of the points of each body, the ground first: names of
        parameters, with a minus before them in mirror images, or numbers [m]; ``joints``, the names
        of the points of each; of ``guides`` and ``springs`` the two ends, each a body and a point
        of it; ``wheels``, the centre of each likewise.
    """
    points: dict[str, dict[str, Place]] = {body: {} for body in mechanism.numbers}

    def end(body: str, point: Point) -> End:
        points[body][point.name] = _coordinates(mechanism, point)
        return body, point.name

    joints = {j.name: [p.name for p in _points_of(j)] for j in mechanism.joints}
    for joint in mechanism.joints:
        for point in _points_of(joint):
            for body in joint.bodies:
                end(body, point)
    springs = [[end(*e) for e in line.ends] for line in mechanism.every(AlongLine)]
    wheels = [end(w.carrier.name, w.center) for w in mechanism.every(Wheel)]
    guides = [[end(*e) for e in pair] for pair in _telescopes(mechanism.joints)]
    guides += [
        [(body, next(iter(points[body]))) for body in joint.bodies]
        for joint in mechanism.joints
        if isinstance(joint, Prismatic) and all(points[body] for body in joint.bodies)
    ]
    return {
        "points": points,
        "joints": joints,
        "guides": [pair for pair in guides if mechanism.ground not in (e[0] for e in pair)],
        "springs": springs,
        "wheels": wheels,
    }


def _points_of(joint: Joint) -> list[Point]:
    """Return the points that both bodies of a joint carry; none for guides."""
    if isinstance(joint, Prismatic | Cylindrical | Free):
        return []
    if joint.center is not None:
        return [joint.center]
    if isinstance(joint, Revolute):
        return [p for p in (joint.axis.through, joint.axis.towards) if isinstance(p, Point)]
    return []


def _telescopes(joints: tuple[Joint, ...]) -> Iterator[tuple[tuple[str, Point], ...]]:
    """Yield the ends of telescopes: one point of a cylindrical joint's axis on either body."""
    for joint in joints:
        if isinstance(joint, Cylindrical) and isinstance(joint.axis.towards, Point):
            first, second = joint.bodies
            yield (first, joint.axis.towards), (second, joint.axis.through)


def _coordinates(mechanism: Mechanism, point: Point) -> Place:
    """Return a position by the names of its parameters; copies have those of the original."""
    found: Place = []
    for value in point.position:
        named = value.xreplace({s: mechanism.derived.get(s.name, s) for s in value.free_symbols})
        sign, root = sp.sympify(named).as_coeff_Mul()
        if root.is_Symbol:
            assert sign in (1, -1), value  # mirrors only turn round
            found.append(f"{'-' if sign < 0 else ''}{root.name}")
        else:
            found.append(float(named))
    return found
