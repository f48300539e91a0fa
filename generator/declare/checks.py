"""Find mistakes in the declaration of a mechanism before anything is derived from it."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from .bodies import Body, Ground
from .declared import DeclarationError
from .default_values import value_problems
from .forces import ForceElement, JointForce, LinearTyre, Weight
from .joints import Joint
from .names import name_problems, text_problems

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

    from .assembly import Assembly


def check_mechanism(mechanism: Assembly) -> None:
    """Raise `DeclarationError` if a mechanism has names or numbers that cannot be."""
    problems = [
        *_ground_problems(mechanism),
        *_repeated_problems(mechanism),
        *_stranger_problems(mechanism),
        *name_problems(mechanism),
        *text_problems(mechanism),
    ]
    # ranges and lines are those of the parameters; of two of one name nobody knows which
    problems += [] if problems else value_problems(mechanism)
    if problems:
        raise DeclarationError(mechanism.name, problems)


def _ground_problems(mechanism: Assembly) -> list[str]:
    grounds = [b.name for b in mechanism.bodies if isinstance(b, Ground)]
    if len(grounds) == 1:
        return []
    if not grounds:
        return ["there is no ground; declare a Ground and join the bodies to it"]
    return [f"there are several grounds, {', '.join(map(repr, grounds))}; leave one of them"]


def _repeated_problems(mechanism: Assembly) -> list[str]:
    """Find different things of one name, and things that there must be once."""
    forces = mechanism.forces
    problems = []
    for kind, names in (
        ("body", [b.name for b in mechanism.bodies]),
        ("joint", [j.name for j in dict.fromkeys(mechanism.joints)]),
        ("parameter", [p.name for p in mechanism.parameters]),
        ("input", mechanism.input_names),
        ("coordinate", [c.name for c in dict.fromkeys(mechanism.coordinates)]),
    ):
        problems += [
            f"{count} different {_plural(kind)} are named {name!r}; rename them, or declare one "
            "and refer to it"
            for name, count in Counter(names).items()
            if count > 1
        ]
    for kind, listed in (
        ("joint", [j.name for j in mechanism.joints if mechanism.joints.count(j) > 1]),
        ("coordinate", [c.name for c in mechanism.coordinates]),
        ("output", [o.name for o in mechanism.outputs]),
        ("weight", ["Weight" for f in forces if isinstance(f, Weight)]),
        ("force", [f.name for f in forces if isinstance(f, ForceElement | LinearTyre)]),
        (
            "JointForce along",
            [f"{f.joint.name} by {f.input.name}" for f in forces if isinstance(f, JointForce)],
        ),
    ):
        problems += repeated(kind, listed)
    return problems


def _plural(kind: str) -> str:
    return "bodies" if kind == "body" else f"{kind}s"


def _stranger_problems(mechanism: Assembly) -> list[str]:
    """Find joints and bodies that forces and coordinates refer to, but that are not joined."""
    joined = {body for joint in mechanism.joints for body in (joint.first, joint.second)}
    problems = [
        f"joint {joint.name!r}, which a force or a coordinate refers to, is none of its joints; "
        "add it"
        for joint in mechanism.every(Joint)
        if joint not in mechanism.joints
    ]
    problems += [
        f"body {body.name!r} is held by no joint; join it to another body"
        for body in mechanism.every(Body)
        if body not in joined
    ]
    return problems


def repeated(what: str, names: Iterable[str]) -> list[str]:
    """Find what is named more than once."""
    counts = Counter(names).items()
    return [f"{what} {n!r} is declared {c} times; once is enough" for n, c in counts if c > 1]


def strangers(
    what: str, used: Iterable[Body | Joint], known: Collection[Body | Joint]
) -> list[str]:
    """Find what a model refers to and its mechanism does not have."""
    names = ", ".join(thing.name for thing in known) or "none"
    return [
        f"{what} {thing.name!r} is none of its mechanism; there are {names}"
        for thing in used
        if thing not in known
    ]


def check_symbols(name: str, used: Iterable[str], declared: Collection[str]) -> None:
    """Raise `DeclarationError` if equations read what nobody declares."""
    problems = [
        f"the equations read {n!r}, which is not declared"
        for n in sorted(used)
        if n not in declared
    ]
    if problems:
        raise DeclarationError(name, problems)
