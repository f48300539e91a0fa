"""Find mistakes in the declaration of a mechanism before anything is derived from it."""

from __future__ import annotations

import difflib
from collections import Counter
from typing import TYPE_CHECKING

from .default_values import value_problems
from .forces import AlongLine, AlongTelescope, ForceElement, JointForce, LinearTyre, Weight
from .joints import Revolute, Spherical
from .laws import Actuator, LinearSpring
from .names import name_problems, text_problems

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from .mechanism import Mechanism


class DeclarationError(ValueError):
    """A mechanism or model that contradicts itself, with everything that is wrong with it."""

    def __init__(self, name: str, problems: list[str]) -> None:
        self.problems = tuple(problems)
        super().__init__("\n".join([f"{name}:", *(f"  - {problem}" for problem in problems)]))


def check_mechanism(mechanism: Mechanism) -> None:
    """Raise `DeclarationError` if a mechanism has names or numbers that cannot be."""
    problems = [] if mechanism.bodies else ["there are no bodies; the first one is the ground"]
    for kind, names in (
        ("body", [b.name for b in mechanism.bodies]),
        ("joint", [j.name for j in mechanism.joints]),
        ("parameter", [p.name for p in mechanism.parameters]),
        ("coordinate", [c.name for c in mechanism.coordinates]),
        ("weight", ["Weight" for f in mechanism.forces if isinstance(f, Weight)]),
    ):
        problems += repeated(kind, names)
    problems += [
        f"joint {j.name!r} connects {j.first!r} with itself; name two bodies"
        for j in mechanism.joints
        if j.first == j.second
    ]
    joints = {j.name: j.coordinates for j in mechanism.joints}
    for coordinate in mechanism.coordinates:
        problems += unknown(f"coordinate {coordinate.name!r}: joint", [coordinate.joint], joints)
        problems += unknown(
            f"coordinate {coordinate.name!r}: kind",
            [coordinate.kind],
            joints.get(coordinate.joint, (coordinate.kind,)),
        )
    balls = {j.name for j in mechanism.joints if isinstance(j, Spherical)}
    problems += [
        f"coordinate {c.name!r}: the angles of the ball joint {c.joint!r} have no names to report; "
        "leave it out"
        for c in mechanism.coordinates
        if c.joint in balls
    ]
    problems += _force_problems(mechanism)
    problems += name_problems(mechanism)
    problems += text_problems(mechanism)
    problems += value_problems(mechanism)
    if problems:
        raise DeclarationError(mechanism.name, problems)


def _force_problems(mechanism: Mechanism) -> list[str]:
    joints = [j.name for j in mechanism.joints]
    bodies = [b.name for b in mechanism.bodies]
    problems = []
    for force in mechanism.forces:
        what = type(force).__name__
        if isinstance(force, JointForce):
            problems += unknown(f"{what}: joint", [force.joint], joints)
            problems += unknown(f"{what}: input", [force.input], mechanism.inputs)
        elif isinstance(force, LinearTyre):
            problems += unknown(f"{what}: body", [force.carrier], bodies)
            inputs = [i for i in (force.road, force.road_velocity) if i is not None]
            problems += unknown(f"{what}: input", inputs, mechanism.inputs)
            if (force.damper is None) != (force.road_velocity is None):
                problems.append(f"{what} {force.name!r}: give damper and road_velocity, or neither")
        elif isinstance(force, ForceElement):
            problems += _element_problems(mechanism, force)
    return problems


def _element_problems(mechanism: Mechanism, element: ForceElement) -> list[str]:
    what, path = f"ForceElement {element.name!r}", element.path
    telescopic = isinstance(path, AlongTelescope)
    if isinstance(path, AlongTelescope):
        problems = unknown(f"{what}: joint", [path.joint], [j.name for j in mechanism.joints])
    elif isinstance(path, AlongLine):
        bodies = [body for body, _ in (path.first, path.second)]
        problems = unknown(f"{what}: body", bodies, [b.name for b in mechanism.bodies])
    else:
        hinges = [j.name for j in mechanism.joints if isinstance(j, Revolute)]
        problems = unknown(f"{what}: revolute joint", [path.first, path.second], hinges)
    for law in element.laws:
        if isinstance(law, Actuator):
            problems += unknown(f"{what}: input", [law.input], mechanism.inputs)
        elif isinstance(law, LinearSpring):
            if (law.free_slide is None) == (law.free_length is None):
                problems.append(f"{what}: give its spring a free_slide or a free_length")
            elif law.free_slide is not None and not telescopic:
                problems.append(f"{what}: a free_slide needs a telescope; give a free_length")
    return problems


def check_symbols(name: str, used: Iterable[str], declared: Iterable[str]) -> None:
    """Raise `DeclarationError` if the equations use a parameter that is not declared."""
    problems = unknown("parameter", sorted(used), list(declared))
    if problems:
        raise DeclarationError(name, problems)


def repeated(what: str, names: Iterable[str]) -> list[str]:
    """Find what is named more than once."""
    return [f"{what} {n!r} is declared {c} times" for n, c in Counter(names).items() if c > 1]


def unknown(
    what: str, names: Iterable[str], known: Iterable[str] | Mapping[str, object]
) -> list[str]:
    """Find names that are not among the known ones, each with the one that was probably meant."""
    known = list(known)
    problems = []
    for name in names:
        if name not in known:
            near = difflib.get_close_matches(name, known, n=1)
            hint = (
                f"did you mean {near[0]!r}?" if near else f"there are {', '.join(known) or 'none'}"
            )
            problems.append(f"{what} {name!r} is not declared; {hint}")
    return problems
