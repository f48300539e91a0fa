"""What something of a mechanism is called in a copy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from .geometry import Direction, Point


class Copying(Protocol):
    """The names, and the mirrored directions, of one copy of a mechanism."""

    def named(self, name: str) -> str:
        """Return the name of a parameter, or of anything that each copy has for itself."""

    def body(self, name: str) -> str:
        """Return the name of a body, which copies may share."""

    def joint(self, name: str) -> str:
        """Return the name of a joint, which copies may share."""

    def input(self, name: str) -> str:
        """Return the name of an input, which copies may share."""

    def point(self, point: Point) -> Point:
        """Return a point, or its image."""

    def axis(self, direction: Direction) -> Direction:
        """Return an axis of rotation, or the opposite of its image."""
