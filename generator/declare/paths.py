"""Paths of force elements: their length, and its rate.

The length is an angle for a `TwistOfHinges`, and the force a moment.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import sympy as sp
from typing_extensions import override

from ..program.floors import DIRECTION
from .bodies import Body
from .declared import DeclarationError, declared
from .geometry import Point
from .joints import Cylindrical, Prismatic, Revolute
from .parameters import Distance, Length
from .shown import Event, Range, words_of

if TYPE_CHECKING:
    from .surroundings import Surroundings


class PathLength(NamedTuple):
    """Length of a path at an instant, and its rate."""

    length: sp.Expr  # [m], or an angle [rad]
    motion: dict[str, sp.Expr]  # rate per unit rate of each coordinate that changes it
    # coordinate of a telescope, positive in compression [m]; None for other paths
    slide: sp.Expr | None = None


class Words(NamedTuple):
    """Names of the signals of an element on a path, with units and meanings."""

    # end of the name, unit, and meaning with `{}` for the element's name
    length: tuple[str, str, str]
    rate: tuple[str, str, str]
    # kind of the force, its unit, and the sense in which it is positive
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


_OF_A_HINGE = _OF_A_TWIST._replace(
    length=("angle", "rad", "angle of the {}"),
    rate=("angular_velocity", "rad/s", "rate of the {}'s angle"),
    sense="positive when it increases the angle",
)
_OF_A_GUIDE = _OF_A_LINE._replace(
    length=("slide", "m", "slide of the {}"),
    rate=("velocity", "m/s", "rate of the {}'s slide"),
    sense="positive when it increases the slide",
)


class AnyPath(ABC):
    """Base of the paths."""

    words: ClassVar[Words] = _OF_A_LINE
    has_slide: ClassVar[bool] = False
    of_either_sign: ClassVar[bool] = False
    """Whether its length may be negative: that of a guide."""

    def ranges_of_length(self, name: str) -> tuple[Range, ...]:
        """Return the valid lengths of an element of this name."""
        return ()

    def events_of_length(self, name: str) -> tuple[Event, ...]:
        """Return events at certain lengths of an element of this name."""
        return ()

    @abstractmethod
    def path_length(self, at: Surroundings, name: str) -> PathLength:
        """Append its length and its rate.

        Parameters
        ----------
        at
            Surroundings of the element.
        name
            Prefix of the names of the steps.
        """


@declared
@dataclass(frozen=True)
class AlongTelescope(AnyPath):
    """The line from one end of a telescope to the other; its length [m].

    Parameters
    ----------
    joint
        The telescope.
    longest
        The length at which the telescope comes apart [m]; None: not checked.
    """

    joint: Cylindrical
    longest: Length | Distance | None = None

    has_slide: ClassVar[bool] = True

    def ranges_of_length(self, name: str) -> tuple[Range, ...]:
        most = self.longest and self.longest.symbol
        below, above = (
            f"{words_of(name)} is {than} than it can be" for than in ("shorter", "longer")
        )
        return (Range(0.0, most, below, above),)

    def events_of_length(self, name: str) -> tuple[Event, ...]:
        """Return the event at which it comes apart."""
        if self.longest is None:
            return ()
        meaning = f"{words_of(name)} reaches its greatest length"
        level = self.longest.symbol
        return (
            Event(f"{name}_fully_extended", level, rising=True, meaning=meaning, terminal=True),
        )

    @override
    def path_length(self, at: Surroundings, name: str) -> PathLength:
        return PathLength(*at.telescope(self.joint.name))


@declared
@dataclass(frozen=True)
class AlongLine(AnyPath):
    """The straight line from a point of one body to a point of another; its length [m].

    Parameters
    ----------
    first, second
        Body and point at either end.
    """

    first: tuple[Body, Point]
    second: tuple[Body, Point]

    def __post_init__(self) -> None:
        (one, _), (other, _) = self.first, self.second
        if one == other:
            problem = f"both ends are on {one.name!r}, so its length never changes; give two bodies"
            raise DeclarationError("AlongLine", [problem])

    @property
    def ends(self) -> tuple[tuple[str, Point], tuple[str, Point]]:
        """Name of the body and point at either end."""
        (one, start), (other, end) = self.first, self.second
        return (one.name, start), (other.name, end)

    @override
    def path_length(self, at: Surroundings, name: str) -> PathLength:
        program = at.program
        way, rates = at.between(*self.ends)
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
        return PathLength(length, motion)

    def _extent_squared(self, at: Surroundings, name: str) -> sp.Expr:
        """Append the square of the extent of the two points at the design position."""
        places = (at.extent(*end) for end in self.ends)
        squared = sum((p.dot(p) for p in places), sp.Integer(0))
        return at.program.define(f"{name}_extent_squared", squared)


@declared
@dataclass(frozen=True)
class TwistOfHinges(AnyPath):
    """The difference of the angles of two hinges: the twist of a bar between them [rad].

    The twist is the angle of the second hinge minus that of the first. A moment [N m] acts with its
    sign on the second hinge and with the opposite sign on the first.

    Parameters
    ----------
    first, second
        The two hinges.
    """

    first: Revolute
    second: Revolute

    words: ClassVar[Words] = _OF_A_TWIST

    def __post_init__(self) -> None:
        if self.first == self.second:
            name = self.first.name
            problem = f"the angle of {name!r} less itself is always zero; give two hinges"
            raise DeclarationError("TwistOfHinges", [problem])

    @override
    def path_length(self, at: Surroundings, name: str) -> PathLength:
        twist, motion = sp.Integer(0), dict.fromkeys(at.coordinates, sp.Integer(0))
        for sense, hinge in ((-1, self.first), (1, self.second)):
            angle, rates = at.hinge(hinge.name)
            twist += sense * angle
            for k, rate in rates.items():
                motion[k] += sense * rate
        return PathLength(twist, {k: rate for k, rate in motion.items() if rate != 0})


@declared
@dataclass(frozen=True)
class AlongHinge(AnyPath):
    """The angle of a hinge [rad]: for a torsion spring, a rotary damper, a stop, a motor.

    A moment acts with its sign on the hinge's second body and against it on the first.

    Parameters
    ----------
    hinge
        The hinge.
    """

    hinge: Revolute

    words: ClassVar[Words] = _OF_A_HINGE

    @override
    def path_length(self, at: Surroundings, name: str) -> PathLength:
        return PathLength(*at.hinge(self.hinge.name))


@declared
@dataclass(frozen=True)
class AlongGuide(AnyPath):
    """The slide of a guide [m], zero at the design position and of either sign.

    A force acts with its sign on the guide's second body and against it on the first.

    Parameters
    ----------
    guide
        The guide.
    """

    guide: Prismatic

    words: ClassVar[Words] = _OF_A_GUIDE
    of_either_sign: ClassVar[bool] = True

    @override
    def path_length(self, at: Surroundings, name: str) -> PathLength:
        return PathLength(*at.guide(self.guide.name))


Path = AlongTelescope | AlongLine | AlongHinge | AlongGuide | TwistOfHinges
