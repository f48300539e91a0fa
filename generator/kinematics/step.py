"""A step of a plan: it places a body, or finds its line."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..declare.geometry import Point
    from ..program.conditions import Assumption
    from .kinematics import Kinematics


Ends = tuple[str, "Point", "Point"]
"""A link with two points of its line."""


class KinematicStep(ABC):
    """What the kinematics of a mechanism is made of, in order."""

    @property
    @abstractmethod
    def about(self) -> str:
        """The body that it places, or whose line it finds; one of several."""

    @property
    @abstractmethod
    def title(self) -> str:
        """What the derivation calls it."""

    @property
    def points(self) -> tuple[Point, ...]:
        """The points between which it reaches, beside those of the joints of its loop."""
        return ()

    @abstractmethod
    def carry_out(self, kin: Kinematics) -> None:
        """Append poses, velocities and biases."""

    def origin_on(self, ground: str) -> Point | None:
        """Return the point of the ground at which positions are best counted, if there is one."""
        del ground
        return None

    def lines(self) -> Iterator[Ends]:
        """Yield the links whose line it finds, each with two points of the line."""
        yield from ()

    def assumptions(self) -> Iterator[Assumption]:
        """Yield what it takes to be zero, beside what `lines` and a plane ask for."""
        yield from ()
