"""Find mistakes in the declaration of a mechanism before anything is derived from it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .declared import DeclarationError, parts
from .default_values import value_problems
from .geometry import Direction, Point
from .inputs import input_problems
from .joints import Free, Spherical
from .known import repeated, unknown
from .names import name_problems, text_problems
from .world import WORLD

if TYPE_CHECKING:
    from collections.abc import Iterable

    from .assembly import Assembly


def check_mechanism(mechanism: Assembly) -> None:
    """Raise `DeclarationError` if a mechanism has names or numbers that cannot be."""
    problems = [
        *_repeated_problems(mechanism),
        *_joint_problems(mechanism),
        *_coordinate_problems(mechanism),
        *(p for force in mechanism.forces for p in force.problems(mechanism)),
        *input_problems(mechanism.inputs),
        *_geometry_problems(mechanism),
        *name_problems(mechanism),
        *text_problems(mechanism),
        *value_problems(mechanism),
    ]
    if problems:
        raise DeclarationError(mechanism.name, problems)


def _repeated_problems(mechanism: Assembly) -> list[str]:
    """Find what there must be once: names of a kind, numbers of bodies, elements."""
    problems = [] if mechanism.bodies else ["there are no bodies; one of them is fixed, or free"]
    identities = [force.identity for force in mechanism.forces]
    kinds = dict.fromkeys(kind for kind, _ in identities)
    for kind, names in (
        ("body", [b.name for b in mechanism.bodies]),
        ("joint", [j.name for j in mechanism.joints]),
        ("parameter", [p.name for p in mechanism.parameters]),
        ("coordinate", [c.name for c in mechanism.coordinates]),
        ("input", mechanism.input_names),
        *((kind, [name for k, name in identities if k == kind]) for kind in kinds),
        ("number of bodies:", [str(b.number) for b in mechanism.bodies]),
    ):
        problems += repeated(kind, names)
    return problems


def _joint_problems(mechanism: Assembly) -> list[str]:
    bodies, problems = [b.name for b in mechanism.bodies], _reference_problems(mechanism)
    if mechanism.fixed is None:
        bodies.append(WORLD)
    for joint in mechanism.joints:
        problems += unknown(f"joint {joint.name!r}: body", joint.bodies, bodies)
        if joint.first == joint.second:
            problems.append(
                f"joint {joint.name!r} connects {joint.first!r} with itself; name two bodies"
            )
    return problems


def _reference_problems(mechanism: Assembly) -> list[str]:
    """See that the world is no body, and that the mechanism is somewhere in it."""
    names = [b.name for b in mechanism.bodies]
    free = [j.name for j in mechanism.joints if isinstance(j, Free)]
    if WORLD in names:
        return [f"body {WORLD!r} has the name of the world; choose another one"]
    if mechanism.fixed is not None:
        problems = unknown("fixed: body", [mechanism.fixed], names)
        return problems + [
            f"joint {name!r} is free, and moves in the world, while {mechanism.fixed!r} is fixed "
            "there; leave one of the two out"
            for name in free
        ]
    if free or not names:
        return []
    problem = (
        "nothing says where it is in the world: name the body that rests there, "
        f"fixed={names[0]!r}, or let one move by a joint Free(name=..., second={names[0]!r})"
    )
    return [problem]


def _coordinate_problems(mechanism: Assembly) -> list[str]:
    joints, problems = {j.name: j.coordinates for j in mechanism.joints}, []
    balls = {j.name for j in mechanism.joints if isinstance(j, Spherical)}
    for coordinate in mechanism.coordinates:
        what, joint = f"coordinate {coordinate.name!r}", coordinate.joint
        problems += unknown(f"{what}: joint", [joint], joints)
        kinds = joints.get(joint, (coordinate.kind,))
        problems += unknown(f"{what}: kind", [coordinate.kind], kinds)
        if joint in balls:
            problems.append(
                f"{what}: the angles of the ball joint {joint!r} have no names to report; leave it "
                "out"
            )
    return problems


def _geometry_problems(mechanism: Assembly) -> list[str]:
    """Find names that mean two things: a point is in a plane or not, and it is no direction."""
    meant: dict[str, set[str]] = {}
    for part in parts(mechanism):
        if isinstance(part, Point):
            where = f"in a plane across {part.flat}" if part.flat else "with x, y and z"
            meant.setdefault(part.name, set()).add(f"a point {where}")
        elif isinstance(part, Direction) and part.fixed is None and part.between is None:
            meant.setdefault(part.name, set()).add("a direction")
    return [
        f"{name!r} is {' and '.join(sorted(kinds))}; give each a name of its own, since its "
        "parameters are named after it"
        for name, kinds in meant.items()
        if len(kinds) > 1
    ]


def check_symbols(name: str, used: Iterable[str], declared: Iterable[str]) -> None:
    """Raise `DeclarationError` if the equations use a parameter that is not declared."""
    problems = unknown("parameter", sorted(used), list(declared))
    if problems:
        raise DeclarationError(name, problems)
