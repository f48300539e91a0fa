"""Models: what of a mechanism is state, what is prescribed, what has mass."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from .declared import DeclarationError, Name, declared
from .inputs import Motion, motion_problems, position_of
from .joints import Cylindrical, Free, Joint, Prismatic, Revolute, Spherical, Universal
from .known import repeated, unknown
from .mechanism import Mechanism
from .names import unwritable

# what the right-hand side has beside its variants: rhs_jacobian, rhs_input_jacobian
_FUNCTIONS = ("jacobian", "input_jacobian")

DRIVABLE: dict[type[Joint], str] = {
    Cylindrical: "a guide and a hinge along its axis, with a link between them",
    Universal: "two hinges along the axes of the cross, with a link between them",
    Spherical: "three hinges through its centre, with two links between them",
    Free: "three guides and three hinges, with links between them",
}
"""What has the freedoms of a joint that cannot be driven, and can be."""


@declared
@dataclass(frozen=True)
class Model:
    """One set of equations derived from a mechanism.

    Attributes
    ----------
    independent
        Names of the joints whose coordinates are the state, in order.
    prescribed
        Joint name to the name of a motion: the coordinate is the input ``<motion>_position``,
        of which others are velocity and acceleration (`Input.derivative_of`).
    massive
        Bodies whose inertia enters the equations.
    held
        Variants of the right-hand side: name to the prescribed inputs that stand still in it.
    allow_iteration
        Whether a loop without a closed form may be solved by Newton's method, for that loop alone.
        Without it such a loop is refused.
    """

    name: Name
    title: str
    mechanism: Mechanism
    independent: tuple[Name, ...]
    massive: tuple[Name, ...]
    prescribed: Mapping[Name, Name] = field(default_factory=dict)
    held: Mapping[Name, tuple[Name, ...]] = field(default_factory=dict)
    allow_iteration: bool = False

    def __post_init__(self) -> None:
        _check(self)

    @property
    def motions(self) -> dict[str, Motion]:
        """The inputs of each prescribed motion, by its name."""
        inputs = self.mechanism.inputs
        return {name: Motion.of(name, inputs) for name in self.prescribed.values()}


def _check(model: Model) -> None:
    """Raise `DeclarationError` if a model contradicts its mechanism or itself."""
    problems = unwritable("title of the model", model.title)
    problems += [
        f"variant {name!r} would be the function rhs_{name}, which there is already; rename it"
        for name in model.held
        if name in _FUNCTIONS
    ]
    problems += _driven_problems(model)
    problems += _mass_problems(model)
    problems += _force_problems(model)
    problems += _idle_problems(model)
    if problems:
        raise DeclarationError(model.name, problems)


def _driven_problems(model: Model) -> list[str]:
    mechanism = model.mechanism
    joints = {j.name: j for j in mechanism.joints}
    problems = repeated("independent joint", model.independent)
    problems += unknown("independent joint", model.independent, joints)
    problems += unknown("prescribed joint", model.prescribed, joints)
    problems += [
        f"joint {name!r} is free, and nothing else says where {joint.second!r} is; make it "
        "independent"
        for name, joint in joints.items()
        if isinstance(joint, Free) and name not in (*model.independent, *model.prescribed)
    ]
    problems += repeated("input of prescribed joints", model.prescribed.values())
    for variant, held in model.held.items():
        problems += unknown(f"held joint of {variant!r}", held, model.prescribed)
    both = sorted(set(model.independent) & set(model.prescribed))
    problems += [f"joint {name!r} is both independent and prescribed" for name in both]
    motions = tuple(dict.fromkeys(model.prescribed.values()))
    positions = [position_of(motion) for motion in motions]
    problems += unknown("prescribed motion: input", positions, mechanism.input_names)
    problems += [p for motion in motions for p in motion_problems(motion, mechanism.inputs)]
    independent = {n: joints[n] for n in model.independent if n in joints}
    prescribed = {n: joints[n] for n in model.prescribed if n in joints}
    problems += [
        _undrivable("independent", j)
        for j in independent.values()
        if _has_many(j) and not isinstance(j, Free)
    ]
    problems += [_undrivable("prescribed", j) for j in prescribed.values() if _has_many(j)]
    reported = {c.joint for c in mechanism.coordinates}
    problems += [
        f"independent joint {name!r} has no reported coordinate; add a RelativeCoordinate for its "
        f"{joint.coordinates[0]} to the coordinates of the mechanism, which names the state"
        for name, joint in independent.items()
        if name not in reported and not _has_many(joint)
    ]
    return problems


def _has_many(joint: Joint) -> bool:
    return not isinstance(joint, Revolute | Prismatic)


def _undrivable(how: str, joint: Joint) -> str:
    return (
        f"{how} joint {joint.name!r} is {joint.kind}, with {joint.freedoms} coordinates; only "
        f"hinges and guides can be {how}. Declare {DRIVABLE[type(joint)]}"
    )


def _mass_problems(model: Model) -> list[str]:
    mechanism = model.mechanism
    problems = unknown("massive body", model.massive, [b.name for b in mechanism.bodies])
    problems += repeated("massive body", model.massive)
    if mechanism.ground in model.massive:
        problems.append(
            f"massive body {mechanism.ground!r} is the ground, which does not move; leave it out"
        )
    return problems


def _force_problems(model: Model) -> list[str]:
    """See that every force along a joint does work: there is none for a joint that follows."""
    driven = {*model.independent, *model.prescribed}
    return [
        f"{kind}: {joint!r} is neither independent nor prescribed, and a {kind} acts along such "
        "joints only. Make it independent, or let an Actuator in a ForceElement push between two "
        "points"
        for kind, joint in ((type(f).__name__, f.along) for f in model.mechanism.forces)
        if joint is not None and joint not in driven
    ]


def _idle_problems(model: Model) -> list[str]:
    """See that nothing with mass can spin about itself: nothing would determine its turn."""
    problems = []
    for body in model.mechanism.idle_links:
        if body in model.massive:
            first, second = (j.name for j in model.mechanism.joints_of(body))
            problems.append(
                f"massive body {body!r} may turn about the line through its joints {first!r} and "
                f"{second!r}, and nothing determines how. Make a cross of a ball joint, "
                f"Universal(..., second={body!r}, shaft=the line to the other end), or leave "
                f"{body!r} out of massive: its turn moves nothing else"
            )
    return problems
