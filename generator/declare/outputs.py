"""Declared signals of a mechanism, beside those of its tyres and force elements.

An output makes one signal or three; vectors are in world axes, and their signals end with ``_x``,
``_y``, ``_z``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from .bodies import Body
from .declared import DeclarationError, Name, declared
from .forces.force_element import ForceElement
from .geometry import Direction, Point


@declared
@dataclass(frozen=True)
class Output:
    """A signal that is declared.

    Parameters
    ----------
    name
        Of the signal, or the beginning of the names of its components.
    """

    name: Name


@declared
@dataclass(frozen=True)
class OfPoint(Output):
    """A vector of a point that a body carries.

    Parameters
    ----------
    body, point
        The body, and the point at the design position.
    meaning
        Description of the point, for the documentation of the generated code.
    """

    body: Body
    point: Point
    meaning: str


@declared
@dataclass(frozen=True)
class PositionOf(OfPoint):
    """The position of a point of a body in the world: signals ``<name>_x``, ``_y``, ``_z`` [m].

    Parameters
    ----------
    name
        Prefix of the names of the three signals.
    body, point
        The body, and the point at the design position.
    meaning
        Description of the point in the documentation of the generated code.
    """


@declared
@dataclass(frozen=True)
class VelocityOf(OfPoint):
    """The velocity of a point in world axes: signals ``<name>_x``, ``_y``, ``_z`` [m/s].

    Parameters
    ----------
    name
        Prefix of the names of the three signals.
    body, point
        The body, and the point at the design position.
    meaning
        Description of the point.
    """


@declared
@dataclass(frozen=True)
class AccelerationOf(OfPoint):
    """The acceleration of a point in world axes: signals ``<name>_x``, ``_y``, ``_z`` [m/s^2].

    It follows from the forces by the equations of motion.

    Parameters
    ----------
    name
        Prefix of the names of the three signals.
    body, point
        The body, and the point at the design position.
    meaning
        Description of the point.
    """


@declared
@dataclass(frozen=True)
class DistanceBetween(Output):
    """The distance between two points [m], and its rate, ``<name>_rate`` [m/s].

    Parameters
    ----------
    name
        Name of the signal of the distance.
    first, second
        Body and point at either end.
    meaning
        Description in the documentation of the generated code.
    """

    first: tuple[Body, Point]
    second: tuple[Body, Point]
    meaning: str

    def __post_init__(self) -> None:
        (one, _), (other, _) = self.first, self.second
        if one == other:
            problem = f"both ends are on {one.name!r}, so it never changes; give two bodies"
            raise DeclarationError(f"DistanceBetween {self.name!r}", [problem])


@declared
@dataclass(frozen=True)
class AngleBetween(Output):
    """The angle from a direction of one body to a direction of another [rad], from -pi to pi.

    It is the angle between their projections on the plane perpendicular to an axis of the first
    body, right-handed about that axis.

    Parameters
    ----------
    name
        Name of the signal.
    first, second
        Body, and direction at the design position that is fixed in it.
    about
        The axis, fixed in the first body.
    meaning
        Description in the documentation of the generated code.
    """

    first: tuple[Body, Direction]
    second: tuple[Body, Direction]
    about: Direction
    meaning: str

    turns_about: ClassVar[tuple[str, ...]] = ("about",)


@declared
@dataclass(frozen=True)
class ForceOf(Output):
    """The force of an element: the sum of its laws, positive when it pushes its ends apart [N].

    For an element of an angle it is a moment, positive when it increases the angle [N m].

    Parameters
    ----------
    name
        Name of the signal.
    element
        The force element.
    meaning
        Description in the documentation of the generated code.
    """

    element: ForceElement
    meaning: str
