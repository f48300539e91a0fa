"""Checks of the declaration of a mechanism before anything is derived from it."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import sympy as sp

from ..program.vectors import IDENTITY
from .bodies import Body, Ground
from .declared import DeclarationError
from .default_values import value_problems
from .forces.weight import Weight
from .geometry import Direction
from .inputs import input_problems
from .joints import Free, Joint, Prismatic, Revolute, Weld
from .known import repeated
from .names import name_problems, text_problems
from .world import WORLD

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator

    from .assembly import Parts


def check_mechanism(mechanism: Parts) -> None:
    """Raise `DeclarationError` if names or numbers of a mechanism are impossible."""
    strange = _force_problems(mechanism)
    if strange:
        raise DeclarationError(mechanism.name, strange)
    problems = [
        *_ground_problems(mechanism),
        *_repeated_problems(mechanism),
        *_stranger_problems(mechanism),
        *_weld_problems(mechanism),
        *_weight_problems(mechanism),
        *input_problems(mechanism.inputs),
        *name_problems(mechanism),
        *text_problems(mechanism),
    ]
    # ranges and lines depend on parameters, which must have different names
    problems += [] if problems else value_problems(mechanism)
    if problems:
        raise DeclarationError(mechanism.name, problems)


def _force_problems(mechanism: Parts) -> list[str]:
    """Return problems of the identities and joints of forces, also of users' own."""
    problems = []
    for force in mechanism.forces:
        kind = type(force).__name__
        found: Any = force.identity  # anything, in a user's own class
        along: Any = force.along
        if not (isinstance(found, tuple) and [type(part) for part in found] == [str, str]):
            problems.append(f"identity of a {kind} is {found!r}; two texts are needed: kind, name")
        if along is not None and not isinstance(along, Joint):
            problems.append(f"along of a {kind} is {along!r}; a joint is needed, or None")
    return problems


def _ground_problems(mechanism: Parts) -> list[str]:
    """Return problems of the ground: one body is at rest, or the world itself is the ground."""
    grounds = [b.name for b in mechanism.bodies if isinstance(b, Ground)]
    fixed = [name for name in grounds if name != WORLD.name]
    free = [j.name for j in mechanism.joints if isinstance(j, Free)]
    if any(b.name == WORLD.name and b != WORLD for b in mechanism.bodies):
        return [f"body {WORLD.name!r} has the name of the world; choose another one"]
    if not grounds:
        problem = (
            "there is no ground, so its place in the world is unknown: declare a Ground "
            "and join the bodies to it, or let one move by a joint Free(name, body)"
        )
        return [problem]
    if free and fixed:
        return [
            f"joint {name!r} is free, and moves in the world, while {fixed[0]!r} is fixed there; "
            "leave one of the two out"
            for name in free
        ]
    if len(grounds) > 1:
        return [f"there are several grounds, {', '.join(map(repr, grounds))}; leave one of them"]
    return []


def _repeated_problems(mechanism: Parts) -> list[str]:
    """Return problems of names used more than once."""
    problems = []
    identities = [force.identity for force in mechanism.forces]
    kinds = dict.fromkeys(kind for kind, _ in identities)
    for several, names in (
        ("bodies", [b.name for b in mechanism.bodies]),
        ("joints", [j.name for j in dict.fromkeys(mechanism.joints)]),
        ("parameters", [p.name for p in mechanism.parameters]),
        ("inputs", mechanism.input_names),
        ("coordinates", [c.name for c in dict.fromkeys(mechanism.coordinates)]),
    ):
        problems += [
            f"{count} different {several} are named {name!r}; rename them, or declare one "
            "and refer to it"
            for name, count in Counter(names).items()
            if count > 1
        ]
    for kind, listed in (
        ("joint", [j.name for j in mechanism.joints if mechanism.joints.count(j) > 1]),
        ("coordinate", [c.name for c in mechanism.coordinates]),
        ("output", [o.name for o in mechanism.outputs]),
        ("constraint", [c.name for c in mechanism.constraints]),
        *((kind, [name for k, name in identities if k == kind]) for kind in kinds),
    ):
        problems += repeated(kind, listed)
    return problems


def _stranger_problems(mechanism: Parts) -> list[str]:
    """Return problems of joints and bodies that forces use, but that are not joined."""
    joined = {body for joint in mechanism.joints for body in (joint.first, joint.second)}
    problems = [
        f"joint {joint.name!r}, which a force or a coordinate refers to, is not one of its joints; "
        "add it"
        for joint in mechanism.every(Joint)
        if joint not in mechanism.joints
    ]
    problems += [
        f"body {body.name!r} has no joint; join it to another body"
        for body in mechanism.every(Body)
        if body not in joined
    ]
    return problems


def _weld_problems(mechanism: Parts) -> list[str]:
    """Return problems of bodies joined to a welded one instead of its first body."""
    welds = [joint for joint in mechanism.joints if isinstance(joint, Weld)]
    problems = [
        f"{joint.name!r} welds {joint.second.name!r} to the ground, so that it never moves; leave "
        "both out"
        for joint in welds
        if joint.first.name == mechanism.ground
    ]
    return problems + [
        f"{other.name!r} joins {joint.second.name!r}, which {joint.name!r} welds to "
        f"{joint.first.name!r}; declare it at {joint.first.name!r}"
        for joint in welds
        for other in mechanism.joints_of(joint.second.name)
        if other is not joint
    ]


def _weight_problems(mechanism: Parts) -> list[str]:
    """Return problems of gravity along the normal of a plane in which all bodies move."""
    return [
        f"Weight acts against {force.upward.name!r}, along the normal of the plane in which "
        "everything moves, and has no effect: give it a direction in the plane, such as "
        "Weight(upward=Direction('upward', fixed=(0, 1, 0))), make the points by "
        "flat(..., normal='y'), which moves them in the plane of x and z, or leave it out"
        for force in mechanism.forces
        if isinstance(force, Weight) and all(_is_across(j, force.upward) for j in mechanism.joints)
    ]


def _is_across(joint: Joint, normal: Direction) -> bool:
    """Return whether a joint moves across a direction only, for any parameters."""
    if isinstance(joint, Revolute):
        return joint.axis.vector.cross(normal.components).is_zero
    if isinstance(joint, Prismatic):
        return bool(sp.expand(joint.direction.components.dot(normal.components)) == 0)
    return isinstance(joint, Weld)


def check_symbols(
    name: str, used: Iterable[str], declared: Collection[str], mechanism: Parts
) -> None:
    """Raise `DeclarationError` if equations read undeclared symbols.

    `name` is that of the derivation, for the message.
    """
    unknown = [n for n in sorted(used) if n not in declared]
    problems = list(_leaving_problems(mechanism, unknown))
    problems = problems or [f"the equations read {n!r}, which is not declared" for n in unknown]
    if problems:
        raise DeclarationError(name, problems)


def _leaving_problems(mechanism: Parts, unknown: Collection[str]) -> Iterator[str]:
    """Yield planar bodies without a full inertia, and the joints by which they leave the plane."""
    for body in mechanism.moving:
        axis, read = body.center.flat, any(n.startswith(f"{body.name}_inertia_") for n in unknown)
        normal = _NORMALS.get(axis)
        if not read or normal is None:
            continue
        joints = ", ".join(repr(j.name) for j in mechanism.joints if not _is_across(j, normal))
        if joints:
            yield (
                f"body {body.name!r} is one of a plane across {axis}, with a single moment of "
                f"inertia, and may leave it by joint {joints}: give a guide a direction that "
                "stays in the plane, Direction(name, between=two points of it) or "
                "Direction(name, fixed=...), and a hinge one along its normal; or give the body "
                "a centre of three coordinates and three moments of inertia"
            )


_NORMALS = {
    axis: Direction(f"along_{axis}", fixed=unit) for axis, unit in zip("xyz", IDENTITY, strict=True)
}
