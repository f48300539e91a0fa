"""Constraints on speeds: rolling without slip, gliding along an edge.

They are linear in the speeds and cannot be integrated to constraints on positions, as a rule. Each
lists velocities that vanish. The same number of speeds is eliminated (`Formulation.eliminated`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import sympy as sp

from .bodies import Body
from .declared import DeclarationError, Name, declared
from .geometry import Direction, Point
from .joints import Revolute
from .parameters import Length
from .shown import Shown
from .wheel import Wheel

if TYPE_CHECKING:
    from collections.abc import Iterator

    from .surroundings import Motion, Surroundings


@dataclass(frozen=True)
class SpeedConstraint(ABC):
    """Velocities that vanish."""

    name: Name

    count: ClassVar[int]
    """Number of these velocities."""

    @abstractmethod
    def velocities(self, at: Surroundings) -> list[Motion]:
        """Return the vanishing velocities, per unit rate of each coordinate that moves them."""

    def signals(self, at: Surroundings) -> Iterator[Shown]:
        """Yield signals of its deviation."""
        yield from ()


@declared
@dataclass(frozen=True)
class NoSlip(SpeedConstraint):
    """A constraint: a point of a body has no velocity along a direction, as of a skate or a keel.

    Parameters
    ----------
    name
        Name of the constraint.
    body, point
        The body, and the point at the design position.
    direction
        Direction along which the point does not move, of any length.
    follows
        Whether the direction turns with the body; else it is fixed in the world.
    """

    body: Body
    point: Point
    direction: Direction
    follows: bool = True

    count: ClassVar[int] = 1

    def velocities(self, at: Surroundings) -> list[Motion]:
        """Return the velocity along the direction."""
        body = self.body.name
        line, local = at.line(body, self.direction, self.follows), at.local(body, self.point)
        return [
            {
                k: at.program.define(
                    f"{self.name}_{k}", line.dot(twist.linear + twist.angular.cross(local))
                )
                for k, twist in at.twists(body).items()
            }
        ]


@declared
@dataclass(frozen=True)
class Rolling(SpeedConstraint):
    """A constraint: a thin disc rolls without slip on level ground.

    Its lowest point has no velocity, also none upward: the disc keeps the height at which a motion
    starts. The signal ``<name>_gap`` is the height of the lowest point above z = 0 [m].

    Parameters
    ----------
    name
        Name of the constraint.
    wheel
        Centre and axis of the disc, on its carrier.
    radius
        Radius of the disc [m].
    bearing
        The hinge about which it spins on its carrier, along its axis; None: it is the carrier.
    """

    wheel: Wheel
    radius: Length
    bearing: Revolute | None = None

    count: ClassVar[int] = 3

    def __post_init__(self) -> None:
        if self.bearing and (problems := self.wheel.bearing_problems(self.bearing)):
            raise DeclarationError(f"Rolling {self.name!r}", problems)

    def velocities(self, at: Surroundings) -> list[Motion]:
        """Return the velocity of the lowest point in the axes of the carrier."""
        body, program = self.wheel.carrier.name, at.program
        upright = self.wheel.upright(at, f"{self.name}_")
        shortening = -self.radius.symbol / sp.sqrt(upright.squared)
        arm = program.vector(f"{self.name}_arm", upright.pull * shortening, "123")
        local = at.local(body, self.wheel.center) + arm
        found = {k: t.linear + t.angular.cross(local) for k, t in at.twists(body).items()}
        if self.bearing is not None:
            found[at.coordinate(self.bearing.name)] = upright.axis.cross(arm)
        named = {k: program.vector(f"{self.name}_{k}", v, "123") for k, v in found.items()}
        return [{k: getattr(v, axis) for k, v in named.items()} for axis in "xyz"]

    def signals(self, at: Surroundings) -> Iterator[Shown]:
        """Yield the height of the lowest point."""
        body = self.wheel.carrier.name
        height = at.height(body, at.local(body, self.wheel.center))
        cosine = sp.sqrt(self.wheel.upright(at, f"{self.name}_").squared)
        meaning = f"height of the lowest point of {self.name} above the ground"
        yield Shown(f"{self.name}_gap", height - self.radius.symbol * cosine, "m", meaning)
