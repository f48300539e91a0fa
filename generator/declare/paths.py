"""Paths that a force element acts along: how long one is, and how fast that changes.

What is a length of most paths is an angle of a `TwistOfHinges`, and what is a force is a moment.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import sympy as sp

from ..program.floors import DIRECTION
from .declared import DeclarationError, Name, declared
from .geometry import Point
from .joints import Cylindrical, Joint, Revolute
from .known import unknown

if TYPE_CHECKING:
    from typing import Self

    from .copying import Copying
    from .surroundings import Surroundings
    from .whole import Whole


class Course(NamedTuple):
    """Where a path is at an instant.

    Attributes
    ----------
    length
        [m], or an angle [rad].
    motion
        Its rate per unit rate of each coordinate that changes it.
    slide
        Coordinate of a telescope, positive in compression [m]; None for other paths.
    """

    length: sp.Expr
    motion: dict[str, sp.Expr]
    slide: sp.Expr | None = None


class Words(NamedTuple):
    """What the signals of an element on a path are called, with units and meanings.

    Attributes
    ----------
    length, rate
        End of the name, unit, and meaning with ``{}`` for the element's name.
    force, unit, sense
        What acts, its unit, and when it is positive.
    """

    length: tuple[str, str, str]
    rate: tuple[str, str, str]
    force: str
    unit: str
    sense: str


_OF_A_LINE = Words(
    ("length", "m", "length of the {}"),
    ("velocity", "m/s", "rate of the {}'s length, positive in rebound"),
    "force",
    "N",
    "positive when it pushes the ends apart",
)
_OF_A_TWIST = Words(
    ("angle", "rad", "twist of the {}"),
    ("angular_velocity", "rad/s", "rate of the {}'s twist"),
    "moment",
    "N m",
    "positive when it increases the twist",
)


class AnyPath(ABC):
    """What the paths have in common."""

    words: ClassVar[Words] = _OF_A_LINE
    has_slide: ClassVar[bool] = False

    @abstractmethod
    def course(self, at: Surroundings, name: str) -> Course:
        """Append its length and the rate of that; `name` begins the names of the steps."""

    @abstractmethod
    def problems(self, mechanism: Whole, what: str) -> list[str]:
        """Say what it names that the mechanism has not."""

    @abstractmethod
    def copied(self, copy: Copying) -> Self:
        """Return the same path in a copy."""


@declared
@dataclass(frozen=True)
class AlongTelescope(AnyPath):
    """From one end of a telescope to the other.

    Parameters
    ----------
    joint
        Name of the cylindrical joint.
    """

    joint: Name

    has_slide: ClassVar[bool] = True

    def course(self, at: Surroundings, name: str) -> Course:
        """Return the length of the telescope."""
        del name
        return Course(*at.telescope(self.joint))

    def problems(self, mechanism: Whole, what: str) -> list[str]:
        """Say if the joint is no telescope."""
        return _of_kind(mechanism, what, [self.joint], Cylindrical)

    def copied(self, copy: Copying) -> AlongTelescope:
        """Return the same path in a copy."""
        return AlongTelescope(copy.joint(self.joint))


@declared
@dataclass(frozen=True)
class AlongLine(AnyPath):
    """From a point of one body to a point of another.

    Parameters
    ----------
    first, second
        Body and point at either end.
    """

    first: tuple[Name, Point]
    second: tuple[Name, Point]

    def __post_init__(self) -> None:
        if self.first[0] == self.second[0]:
            problem = (
                f"both ends are on {self.first[0]!r}, so its length never changes; name two bodies"
            )
            raise DeclarationError("AlongLine", [problem])

    def course(self, at: Surroundings, name: str) -> Course:
        """Append the distance of the two points."""
        program = at.program
        way, rates = at.between(self.first, self.second)
        span = program.vector(f"{name}_span", way)
        squared = program.guarded(
            f"{name}_length_squared",
            span.dot(span),
            f"the ends of {name} coincide",
            "m^2",
            DIRECTION * self._extent_squared(at, name),
        )
        length = program.define(f"{name}_length", sp.sqrt(squared))
        direction = program.vector(f"{name}_direction", span * (1 / length))
        motion = {
            k: program.define(f"d_{name}_length_{k}", direction.dot(v)) for k, v in rates.items()
        }
        return Course(length, motion)

    def _extent_squared(self, at: Surroundings, name: str) -> sp.Expr:
        """Append the square of the extent of the two points at the design position."""
        places = (at.extent(*end) for end in (self.first, self.second))
        squared = sum((p.dot(p) for p in places), sp.Integer(0))
        return at.program.define(f"{name}_extent_squared", squared)

    def problems(self, mechanism: Whole, what: str) -> list[str]:
        """Say which of the bodies is not declared."""
        bodies = [body for body, _ in (self.first, self.second)]
        return unknown(f"{what}: body", bodies, [b.name for b in mechanism.bodies])

    def copied(self, copy: Copying) -> AlongLine:
        """Return the same path in a copy."""
        ends = ((copy.body(body), copy.point(point)) for body, point in (self.first, self.second))
        return AlongLine(*ends)


@declared
@dataclass(frozen=True)
class TwistOfHinges(AnyPath):
    """The angle of one hinge less that of another: what twists a bar between them.

    What elsewhere is a length is an angle here [rad], and what is a force is a moment [N m]: it
    acts with its sign on the second hinge and against it on the first, so that its power is that
    of the moment at the rate of the twist.

    Parameters
    ----------
    first, second
        Names of the two revolute joints.
    """

    first: Name
    second: Name

    words: ClassVar[Words] = _OF_A_TWIST

    def __post_init__(self) -> None:
        if self.first == self.second:
            problem = f"the angle of {self.first!r} less itself is always zero; name two hinges"
            raise DeclarationError("TwistOfHinges", [problem])

    def course(self, at: Surroundings, name: str) -> Course:
        """Return the angle between the hinges."""
        del name
        twist, motion = sp.Integer(0), dict.fromkeys(at.coordinates, sp.Integer(0))
        for sense, hinge in ((-1, self.first), (1, self.second)):
            angle, rates = at.hinge(hinge)
            twist += sense * angle
            for k, rate in rates.items():
                motion[k] += sense * rate
        return Course(twist, {k: rate for k, rate in motion.items() if rate != 0})

    def problems(self, mechanism: Whole, what: str) -> list[str]:
        """Say which of the joints is no hinge."""
        return _of_kind(mechanism, what, [self.first, self.second], Revolute)

    def copied(self, copy: Copying) -> TwistOfHinges:
        """Return the same path in a copy."""
        return TwistOfHinges(copy.joint(self.first), copy.joint(self.second))


Path = AlongTelescope | AlongLine | TwistOfHinges


def _of_kind(mechanism: Whole, what: str, names: list[str], wanted: type[Joint]) -> list[str]:
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
