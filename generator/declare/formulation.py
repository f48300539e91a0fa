"""Formulations: the states, the prescribed motions and the massive bodies of a mechanism."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from .bodies import Body, Ground
from .declared import DeclarationError, Name, declared
from .inputs import Input, Motion, input_problems
from .joints import Cylindrical, Free, Joint, Prismatic, Revolute, Spherical, Universal, Weld
from .known import repeated, strangers
from .mechanism import Mechanism
from .names import file_name_problems, input_name_problems, unwritable
from .states import DeclaredStates

# further functions of the right-hand side: rhs_jacobian, rhs_input_jacobian
_FUNCTIONS = ("jacobian", "input_jacobian")

_ALL_THAT_MOVE: Any = None

DRIVABLE: dict[type[Joint], str] = {
    Cylindrical: "a guide and a hinge along its axis, with a link between them",
    Universal: "two hinges along the axes of the cross, with a link between them",
    Spherical: "three hinges through its centre, with two links between them",
    Free: "three guides and three hinges, with links between them",
    Weld: "a hinge or a guide instead",
}
"""Chains of hinges and guides instead of a joint that cannot be driven."""


@declared
@dataclass(frozen=True)
class Formulation:
    """A model: the choice of coordinates by which equations are derived from a mechanism.

    Attributes
    ----------
    name, title
        Name in the generated code, and title in reports.
    mechanism
        The mechanism.
    independent
        The joints whose coordinates and their rates are the state, in this order.
    prescribed
        The joints whose coordinates are given, with their motion.
    massive
        Bodies whose inertia enters the equations; by default all moving ones.
    eliminated
        Names of the speeds that the velocity constraints of the mechanism determine, one for each
        constraint: of a hinge or guide the rate of its coordinate, of a free body u, v, w, p, q or
        r. They are not states.
    held
        Variants of the right-hand side, by name: the prescribed joints that do not move in it.
    allow_iteration
        Whether a loop without a closed form is solved by Newton's method, that loop alone. By
        default such a loop is an error.
    cites
        Places in a publication, for comments in the generated code: of the results of a function,
        by the name of the function; of the motion of a body, by ``omega of <body>`` and ``position
        of <body>``; of a force, by its name.
    """

    name: Name
    title: str
    mechanism: Mechanism
    independent: tuple[Joint, ...]
    massive: tuple[Body, ...] = _ALL_THAT_MOVE
    prescribed: Mapping[Joint, Motion] = field(default_factory=dict)
    held: Mapping[Name, tuple[Joint, ...]] = field(default_factory=dict)
    eliminated: tuple[str, ...] = ()
    allow_iteration: bool = False
    cites: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.massive is _ALL_THAT_MOVE:
            object.__setattr__(self, "massive", self.mechanism.moving)
        _check(self)

    @property
    def driven(self) -> tuple[Joint, ...]:
        """The joints whose coordinates are independent or prescribed."""
        return (*self.independent, *self.prescribed)

    @property
    def given(self) -> tuple[Joint, ...]:
        """The driven joints, and those that follow them through gears."""
        return (*self.driven, *self.mechanism.geared)

    @property
    def states(self) -> DeclaredStates:
        """The layout of the state."""
        mechanism = self.mechanism
        return DeclaredStates.of(
            self.independent, mechanism.coordinates, mechanism.internal_states, self.eliminated
        )

    @property
    def motions(self) -> dict[str, Motion]:
        """The motion of each prescribed joint, by the joint's name."""
        return {joint.name: motion for joint, motion in self.prescribed.items()}

    @property
    def inputs(self) -> dict[str, Input]:
        """Inputs by name: prescribed motions, and forces from outside."""
        motions = (entry for motion in self.prescribed.values() for entry in motion.inputs)
        return {entry.name: entry for entry in (*motions, *self.mechanism.inputs)}

    def has_mass(self, body: str) -> bool:
        """Return whether the inertia of a body enters the equations."""
        return any(body == massive.name for massive in self.massive)


def _check(formulation: Formulation) -> None:
    """Raise `DeclarationError` if a model contradicts its mechanism or itself."""
    problems = file_name_problems(formulation.name)
    problems += unwritable("title of the model", formulation.title)
    problems += [
        p for name, text in formulation.cites.items() for p in unwritable(f"cites: {name}", text)
    ]
    problems += [
        f"variant {name!r} would be the function rhs_{name}, which exists already; rename it"
        for name in formulation.held
        if name in _FUNCTIONS
    ]
    problems += _driven_problems(formulation)
    problems += _input_problems(formulation)
    problems += _mass_problems(formulation)
    problems += _force_problems(formulation)
    problems += _passive_problems(formulation)
    problems += [] if problems else _eliminated_problems(formulation)
    if problems:
        raise DeclarationError(formulation.name, problems)


def _driven_problems(formulation: Formulation) -> list[str]:
    joints = formulation.mechanism.joints
    problems = repeated("independent joint", [j.name for j in formulation.independent])
    problems += strangers("independent joint", formulation.independent, joints)
    problems += strangers("prescribed joint", formulation.prescribed, joints)
    for variant, held in formulation.held.items():
        problems += [
            f"held joint {j.name!r} of {variant!r} is not prescribed; only a prescribed joint "
            f"can be at rest"
            for j in held
            if j not in formulation.prescribed
        ]
    both = [j.name for j in formulation.independent if j in formulation.prescribed]
    problems += [f"joint {name!r} is both independent and prescribed" for name in both]
    problems += [
        f"joint {joint.name!r} is free, and nothing else places {joint.second.name!r}; make it "
        "independent"
        for joint in joints
        if isinstance(joint, Free) and joint not in formulation.driven
    ]
    problems += [
        _undrivable("independent", j)
        for j in formulation.independent
        if _has_many(j) and not isinstance(j, Free)
    ]
    problems += [_undrivable("prescribed", j) for j in formulation.prescribed if _has_many(j)]
    problems += _gear_problems(formulation)
    reported = [c.joint for c in formulation.mechanism.coordinates]
    problems += [
        f"independent joint {joint.name!r} has no reported coordinate; add its "
        f"{joint.coordinates[0]}(name, meaning) to the coordinates of the mechanism: it names the "
        "state"
        for joint in formulation.independent
        if joint not in reported and not _has_many(joint)
    ]
    return problems


def _gear_problems(formulation: Formulation) -> list[str]:
    """Return problems of gears: all followers of a joint, direct or not, are moved by it alone."""
    problems = [
        f"joint {joint.name!r} follows {joint.gear.joint.name!r}, and nothing else can move it; "
        f"make {joint.first_followed.name!r} independent or prescribed instead"
        for joint in formulation.driven
        if joint.gear
    ]
    return problems + [
        f"joint {joint.name!r} follows {joint.first_followed.name!r}, which is neither independent "
        "nor prescribed: make it so, since gears follow a coordinate that is given"
        for joint in formulation.mechanism.geared
        if joint.first_followed not in formulation.driven
    ]


def _input_problems(formulation: Formulation) -> list[str]:
    """Return problems of motions: units of their joints, and names."""
    units = [
        f"motion {motion.name!r} is in {motion.unit}; {joint.unit} is needed for joint "
        f"{joint.name!r}, which is {joint.kind}"
        for joint, motion in formulation.prescribed.items()
        if isinstance(joint, Revolute | Prismatic) and motion.unit != joint.unit
    ]
    problems = units + repeated(
        "motion of prescribed joints", [motion.name for motion in formulation.prescribed.values()]
    )
    entries = [entry for motion in formulation.prescribed.values() for entry in motion.inputs]
    for entry in entries:
        same = [i for i in formulation.mechanism.inputs if i.name == entry.name and i != entry]
        problems += [f"{i.name!r} is an input of a force and of a motion; rename one" for i in same]
    problems += input_problems(dict.fromkeys((*entries, *formulation.mechanism.inputs)))
    return problems + input_name_problems(formulation.mechanism, entries)


def _eliminated_problems(formulation: Formulation) -> list[str]:
    """Return problems of eliminated speeds: there must be as many as constraints."""
    speeds = [entry.name for part in formulation.states.joints for entry in part.speeds]
    known, needed = ", ".join(speeds), sum(c.count for c in formulation.mechanism.constraints)
    problems = repeated("eliminated speed", formulation.eliminated)
    problems += [
        f"eliminated {name!r} is not a speed of the independent joints; these are {known}"
        for name in formulation.eliminated
        if name not in speeds
    ]
    if not problems and len(formulation.eliminated) != needed:
        given = len(formulation.eliminated)
        problems.append(
            f"the constraints make {needed} velocities vanish, and {given} speeds are "
            f"eliminated; name {needed} of {known} that follow from the others"
        )
    return problems


def _has_many(joint: Joint) -> bool:
    return not isinstance(joint, Revolute | Prismatic)


def _undrivable(how: str, joint: Joint) -> str:
    return (
        f"{how} joint {joint.name!r} is {joint.kind}, with {joint.freedoms} coordinates; only "
        f"hinges and guides can be {how}. Declare {DRIVABLE[type(joint)]}"
    )


def _mass_problems(formulation: Formulation) -> list[str]:
    problems = strangers("massive body", formulation.massive, formulation.mechanism.bodies)
    problems += repeated("massive body", [b.name for b in formulation.massive])
    problems += [
        f"massive body {body.name!r} is the ground, which does not move; leave it out"
        for body in formulation.massive
        if isinstance(body, Ground)
    ]
    return problems


def _force_problems(formulation: Formulation) -> list[str]:
    """Return problems of forces along joints that are not driven and do no work."""
    return [
        f"{kind}: {joint.name!r} is neither independent nor prescribed, and a {kind} acts along "
        "such joints only. Make it independent, or let an Actuator in a ForceElement push between "
        "two points"
        for kind, joint in ((type(f).__name__, f.along) for f in formulation.mechanism.forces)
        if joint is not None and joint not in formulation.driven
    ]


def _passive_problems(formulation: Formulation) -> list[str]:
    """Return problems of massive links that may turn about their line freely."""
    problems = []
    for body in formulation.mechanism.passive_links:
        if formulation.has_mass(body):
            first, second = (j.name for j in formulation.mechanism.joints_of(body))
            problems.append(
                f"massive body {body!r} may turn about the line through its joints {first!r} and "
                f"{second!r}, and nothing determines how. Make a cross of a ball joint, "
                f"Universal(..., second={body!r}, shaft=the line to the other end), or leave "
                f"{body!r} out of massive: its turn moves nothing else"
            )
    return problems
