"""What a force asks of the mechanism that it is part of."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .inputs import Input
    from .joints import Joint


class Named(Protocol):
    """Something with a name."""

    @property
    def name(self) -> str:
        """The name."""


class Whole(Protocol):
    """A mechanism, as its parts see it."""

    @property
    def bodies(self) -> Sequence[Named]:
        """All bodies."""

    @property
    def joints(self) -> Sequence[Joint]:
        """All joints."""

    @property
    def forces(self) -> Sequence[object]:
        """All forces."""

    @property
    def inputs(self) -> Sequence[Input]:
        """All inputs."""

    @property
    def input_names(self) -> list[str]:
        """Names of the inputs."""
