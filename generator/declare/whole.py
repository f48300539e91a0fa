"""Interface of a mechanism for its forces."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .joints import Joint


class Whole(Protocol):
    """A mechanism, as its forces see it."""

    @property
    def forces(self) -> Sequence[object]:
        """All forces."""

    @property
    def joints(self) -> Sequence[Joint]:
        """All joints."""

    @property
    def ground(self) -> str:
        """Name of the body that all motion is relative to."""
