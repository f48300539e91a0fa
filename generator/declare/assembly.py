"""The parts of a mechanism: all parts that its joints and forces refer to, by kind and by name."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeVar

from ...core.suggestions import suggestion
from .bodies import Body, Ground
from .constraints import SpeedConstraint
from .declared import DeclarationError, Name, declared, parts
from .forces import Force
from .forces.force_element import ForceElement
from .inputs import Input
from .internal_states import InternalState
from .joints import Cylindrical, Joint, RelativeCoordinate, Spherical, Universal
from .outputs import Output
from .parameters import Owner, Parameter

if TYPE_CHECKING:
    from collections.abc import Iterable

    from .geometry import Point

_ENDS = 2  # of a rod

Named = TypeVar("Named", Body, Joint, Input)


@declared
@dataclass(frozen=True)
class Parts:
    """The parts of a mechanism, before the checks that concern several of them.

    Bodies, inputs and parameters are those that joints, forces and other parts refer to, in the
    order in which they were written; the ground is the first body. `derived` are names that
    equations read like parameters, and that are expressions in parameters.
    """

    name: Name
    title: str
    joints: tuple[Joint, ...]
    forces: tuple[Force, ...] = ()
    coordinates: tuple[RelativeCoordinate, ...] = ()
    outputs: tuple[Output, ...] = ()
    constraints: tuple[SpeedConstraint, ...] = ()
    bodies: tuple[Body, ...] = field(init=False)
    inputs: tuple[Input, ...] = field(init=False)
    parameters: tuple[Parameter, ...] = field(init=False)
    derived: dict[str, Any] = field(init=False, compare=False)

    def __post_init__(self) -> None:
        bodies = sorted(self.every(Body), key=lambda b: (not isinstance(b, Ground), b.order))
        numbers = (p for owner in self.owners for p in owner.numbers)
        object.__setattr__(self, "bodies", tuple(dict.fromkeys(bodies)))
        object.__setattr__(self, "inputs", tuple(self.every(Input)))
        object.__setattr__(self, "parameters", tuple(dict.fromkeys(numbers)))
        owners: list[Owner] = self.every(Owner)
        derived = {name: value for owner in owners for name, value in owner.derived.items()}
        object.__setattr__(self, "derived", derived)

    def every(self, kind: type[Any] | tuple[type[Any], ...]) -> list[Any]:
        """Return all parts of a kind, each once."""
        return [part for part in self._parts if isinstance(part, kind)]

    @property
    def internal_states(self) -> tuple[InternalState, ...]:
        """The internal states of all forces."""
        return tuple(self.every(InternalState))

    @property
    def owners(self) -> tuple[Owner, ...]:
        """The owners of the parameters, in the order in which they were written."""
        roots = (owner.root for owner in self.every(Owner))
        return tuple(dict.fromkeys(sorted(roots, key=lambda owner: owner.order)))

    @cached_property
    def _parts(self) -> tuple[Any, ...]:
        found = tuple(
            parts((self.joints, self.forces, self.coordinates, self.outputs, self.constraints))
        )
        problems = [
            f"a {type(part).__name__} cannot be compared with others ({error}): make its class a "
            "dataclass(frozen=True), with tuples in the place of lists"
            for part in found
            if (error := _unhashable(part))
        ]
        if problems:
            raise DeclarationError(self.name, list(dict.fromkeys(problems)))
        return tuple(dict.fromkeys(found))

    @property
    def ground(self) -> str:
        """Name of the body that all motion is relative to: the one at rest, or the world."""
        return self.bodies[0].name

    @property
    def axes(self) -> str:
        """Name of the axes of positions and directions, for comments."""
        return f"{self.ground} axes"

    @property
    def moving(self) -> tuple[Body, ...]:
        """The bodies that can move."""
        return self.bodies[1:]

    @property
    def numbers(self) -> dict[str, int]:
        """The number of each body in the figure, by its name."""
        first = self.bodies[0].number if isinstance(self.bodies[0], Ground) else 0
        return {body.name: i for i, body in enumerate(self.bodies, first)}

    @property
    def input_names(self) -> list[str]:
        """Names of the inputs."""
        return [entry.name for entry in self.inputs]

    def body(self, name: str) -> Body:
        """Return a body by its name."""
        return _named(self.bodies, name)

    def joint(self, name: str) -> Joint:
        """Return a joint by its name."""
        return _named(self.joints, name)

    def input(self, name: str) -> Input:
        """Return an input by its name."""
        return _named(self.inputs, name)

    @property
    def elements(self) -> list[ForceElement]:
        """The springs, dampers and stops."""
        return [f for f in self.forces if isinstance(f, ForceElement)]

    def joints_of(self, body: str) -> list[Joint]:
        """Return the joints at a body."""
        return [j for j in self.joints if body in j.bodies]

    @property
    def geared(self) -> tuple[Joint, ...]:
        """The hinges and guides that follow others."""
        return tuple(joint for joint in self.joints if joint.gear)

    @property
    def passive_links(self) -> tuple[str, ...]:
        """Links that may turn about their line freely, between two joints.

        Both are ball joints, or one of them is that of a telescope. The turn moves nothing else,
        and is not a degree of freedom that is driven.
        """
        return tuple(
            body.name
            for body in self.moving
            if len(joints := self.joints_of(body.name)) == _ENDS
            and all(isinstance(joint, Spherical | Cylindrical) for joint in joints)
        )

    def universal_at(self, body: str, center: Point) -> Universal | None:
        """Return the universal joint that holds a shaft at a point, or None.

        Parameters
        ----------
        body, center
            Name of the shaft, and the point.
        """
        for joint in self.joints_of(body):
            if isinstance(joint, Universal) and joint.at == center and joint.second.name == body:
                return joint
        return None


def _unhashable(part: object) -> str:
    """Return the reason why a part has no hash; empty if it has one."""
    try:
        hash(part)
    except TypeError as error:
        return str(error)
    return ""


def _named(things: Iterable[Named], name: str) -> Named:
    """Return the thing of a name."""
    things = tuple(things)
    found = next((thing for thing in things if thing.name == name), None)
    if found is None:
        raise KeyError(f"there is no {name!r}. {suggestion(name, [t.name for t in things])}")
    return found
