"""Steps of a plan, which place a body, or find its line."""

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
    """A step of the kinematics of a mechanism."""

    @property
    @abstractmethod
    def about(self) -> str:
        """The body that it places, or whose line it finds; one of several."""

    @property
    @abstractmethod
    def title(self) -> str:
        """Its title in the derivation."""

    @property
    def points(self) -> tuple[Point, ...]:
        """Its points, beside those of the joints of its loop."""
        return ()

    @abstractmethod
    def emit(self, kin: Kinematics) -> None:
        """Append poses, velocities and biases."""

    def origin_on(self, ground: str) -> Point | None:
        """Return the point of the ground that is the best origin of positions, if there is one."""
        return None

    def lines(self) -> Iterator[Ends]:
        """Yield the links whose line it finds, each with two points of the line."""
        yield from ()

    def assumptions(self) -> Iterator[Assumption]:
        """Yield quantities that it assumes to be zero, beside those of `lines` and of a plane."""
        yield from ()
