"""What a mechanism consists of: bodies, joints, forces, parameters, and how to find them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import sympy as sp

from .declared import Name, Number, Numeral, declared
from .forces import Force
from .forces.force_element import ForceElement
from .geometry import Direction, Point
from .inputs import Input
from .joints import Cylindrical, Joint, Spherical, Universal
from .world import WORLD

_ENDS = 2  # of a rod


@declared
@dataclass(frozen=True)
class Parameter:
    """A number that a user of the generated code may change.

    Attributes
    ----------
    default
        Value in SI units.
    unit, meaning
        For the documentation of the generated code.
    least, most
        Bounds of its values, where its role has none or wider ones: masses, rates and lengths are
        not negative in any case.
    """

    name: Name
    default: Number
    unit: str
    meaning: str
    least: Number | None = None
    most: Number | None = None


@declared
@dataclass(frozen=True)
class Body:
    """A rigid body.

    Attributes
    ----------
    name, number
        The number is that of the paper's or the user's figure; every body has its own.
    center
        Centre of mass; its position at design is a parameter.
    rotor_axis
        For a body of revolution that spins about a bearing: the direction of its axis. Its inertia
        then has two parameters, about the axis and across it; other bodies have a full tensor.
    """

    name: Name
    number: Numeral
    center: Point
    rotor_axis: Direction | None = None


@declared
@dataclass(frozen=True)
class RelativeCoordinate:
    """A relative joint coordinate of the report, such as the paper's beta2."""

    name: Name
    joint: Name
    kind: Name
    unit: str
    meaning: str


@declared
@dataclass(frozen=True)
class Assembly:
    """The parts of a mechanism, before anything is checked that several of them must fulfil."""

    name: Name
    title: str
    bodies: tuple[Body, ...]
    joints: tuple[Joint, ...]
    forces: tuple[Force, ...]
    parameters: tuple[Parameter, ...]
    coordinates: tuple[RelativeCoordinate, ...]
    inputs: tuple[Input, ...] = ()
    derived: Mapping[Name, sp.Expr] = field(default_factory=dict)
    fixed: Name | None = None

    @property
    def ground(self) -> str:
        """Name of what all motion is relative to: the fixed body, or the world itself."""
        return self.fixed or WORLD

    @property
    def moving(self) -> tuple[Body, ...]:
        """The bodies that can move."""
        return tuple(body for body in self.bodies if body.name != self.fixed)

    @property
    def input_names(self) -> list[str]:
        """Names of the inputs."""
        return [entry.name for entry in self.inputs]

    def body(self, name: str) -> Body:
        """Return a body by its name."""
        return next(b for b in self.bodies if b.name == name)

    def joint(self, name: str) -> Joint:
        """Return a joint by its name."""
        return next(j for j in self.joints if j.name == name)

    def input(self, name: str) -> Input:
        """Return an input by its name."""
        return next(i for i in self.inputs if i.name == name)

    @property
    def elements(self) -> list[ForceElement]:
        """The springs, dampers and stops."""
        return [f for f in self.forces if isinstance(f, ForceElement)]

    def joints_of(self, body: str) -> list[Joint]:
        """Return the joints at a body."""
        return [j for j in self.joints if body in j.bodies]

    @property
    def idle_links(self) -> tuple[str, ...]:
        """Links that may turn about their line as they like, since only two joints hold them.

        Both are ball joints, or one of them is that of a telescope. The turn moves nothing else,
        and is none of the degrees of freedom that anybody drives.
        """
        return tuple(
            body.name
            for body in self.moving
            if len(joints := self.joints_of(body.name)) == _ENDS
            and all(isinstance(joint, Spherical | Cylindrical) for joint in joints)
        )

    def universal_at(self, body: str, center: Point) -> Universal | None:
        """Return the universal joint that holds a shaft at a point, if there is one."""
        for joint in self.joints_of(body):
            if isinstance(joint, Universal) and joint.at == center and joint.second == body:
                return joint
        return None
