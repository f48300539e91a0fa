"""Find mistakes in the declaration of a mechanism before anything is derived from it."""

from __future__ import annotations

import difflib
from collections import Counter
from typing import TYPE_CHECKING

from .declared import DeclarationError, parts
from .default_values import value_problems
from .forces import AlongLine, AlongTelescope, ForceElement, JointForce, LinearTyre, Weight
from .geometry import Direction, Point
from .inputs import derivative, input_problems
from .joints import Cylindrical, Revolute, Spherical
from .laws import Actuator, LinearSpring
from .names import name_problems, text_problems

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from .assembly import Assembly
    from .joints import Joint


def check_mechanism(mechanism: Assembly) -> None:
    """Raise `DeclarationError` if a mechanism has names or numbers that cannot be."""
    problems = [
        *_repeated_problems(mechanism),
        *_joint_problems(mechanism),
        *_coordinate_problems(mechanism),
        *_force_problems(mechanism),
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
    problems = [] if mechanism.bodies else ["there are no bodies; the first one is the ground"]
    forces = mechanism.forces
    for kind, names in (
        ("body", [b.name for b in mechanism.bodies]),
        ("joint", [j.name for j in mechanism.joints]),
        ("parameter", [p.name for p in mechanism.parameters]),
        ("coordinate", [c.name for c in mechanism.coordinates]),
        ("input", mechanism.input_names),
        ("weight", ["Weight" for f in forces if isinstance(f, Weight)]),
        ("force", [f.name for f in forces if isinstance(f, ForceElement | LinearTyre)]),
        (
            "JointForce along",
            [f"{f.joint} by {f.input}" for f in forces if isinstance(f, JointForce)],
        ),
        ("number of bodies:", [str(b.number) for b in mechanism.bodies]),
    ):
        problems += repeated(kind, names)
    return problems


def _joint_problems(mechanism: Assembly) -> list[str]:
    bodies, problems = [b.name for b in mechanism.bodies], []
    for joint in mechanism.joints:
        problems += unknown(f"joint {joint.name!r}: body", joint.bodies, bodies)
        if joint.first == joint.second:
            problems.append(
                f"joint {joint.name!r} connects {joint.first!r} with itself; name two bodies"
            )
    return problems


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


def _force_problems(mechanism: Assembly) -> list[str]:
    joints = [j.name for j in mechanism.joints]
    bodies = [b.name for b in mechanism.bodies]
    problems = []
    for force in mechanism.forces:
        what = type(force).__name__
        if isinstance(force, JointForce):
            problems += unknown(f"{what}: joint", [force.joint], joints)
            problems += unknown(f"{what}: input", [force.input], mechanism.input_names)
        elif isinstance(force, LinearTyre):
            problems += unknown(f"{what}: body", [force.carrier], bodies)
            problems += unknown(f"{what}: input", [force.road], mechanism.input_names)
            if force.damper is not None and derivative(force.road, mechanism.inputs) is None:
                problems.append(
                    f"{what} {force.name!r}: its damper needs the rate of {force.road!r}; declare "
                    f"an Input with derivative_of={force.road!r}, or leave damper out"
                )
        elif isinstance(force, ForceElement):
            problems += _element_problems(mechanism, force)
    return problems


def _element_problems(mechanism: Assembly, element: ForceElement) -> list[str]:
    what, path = f"ForceElement {element.name!r}", element.path
    telescopic = isinstance(path, AlongTelescope)
    if isinstance(path, AlongTelescope):
        problems = _of_kind(mechanism, what, [path.joint], Cylindrical)
    elif isinstance(path, AlongLine):
        bodies = [body for body, _ in (path.first, path.second)]
        problems = unknown(f"{what}: body", bodies, [b.name for b in mechanism.bodies])
    else:
        problems = _of_kind(mechanism, what, [path.first, path.second], Revolute)
    problems += repeated(f"{what}: law", [repr(law) for law in element.laws])
    for law in element.laws:
        if isinstance(law, Actuator):
            problems += unknown(f"{what}: input", [law.input], mechanism.input_names)
        elif isinstance(law, LinearSpring):
            if (law.free_slide is None) == (law.free_length is None):
                problems.append(f"{what}: give its spring a free_slide or a free_length")
            elif law.free_slide is not None and not telescopic:
                problems.append(f"{what}: a free_slide needs a telescope; give a free_length")
    return problems


def _of_kind(
    mechanism: Assembly, what: str, names: Iterable[str], wanted: type[Joint]
) -> list[str]:
    """Find joints that an element cannot act along."""
    joints = {j.name: j for j in mechanism.joints}
    fitting = [j.name for j in joints.values() if isinstance(j, wanted)]
    problems = []
    for name in names:
        other = joints.get(name)
        if other is None or isinstance(other, wanted):
            problems += unknown(f"{what}: {wanted.kind} joint", [name], fitting)
        else:
            problems.append(
                f"{what}: joint {name!r} is {other.kind}, not {wanted.kind}; there are "
                f"{', '.join(fitting) or 'none of these'}. AlongTelescope is for cylindrical "
                "joints, TwistOfHinges for revolute ones, AlongLine for two points of any bodies"
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


def repeated(what: str, names: Iterable[str]) -> list[str]:
    """Find what is named more than once."""
    counts = Counter(names).items()
    return [f"{what} {n!r} is declared {c} times; once is enough" for n, c in counts if c > 1]


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
