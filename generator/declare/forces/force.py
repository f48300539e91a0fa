"""What a force says of itself: how it acts, what it shows, what it reads."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Self

    import sympy as sp

    from ..copying import Copying
    from ..shown import Shown
    from ..surroundings import Surroundings
    from ..whole import Whole


@dataclass(frozen=True)
class Action:
    """What a force does at an instant.

    Attributes
    ----------
    forces
        Generalised force [N or N m] by the name of the coordinate. What is along a prescribed
        coordinate does no work on the others, and does not count.
    values
        What its signals will show, by name.
    """

    forces: dict[str, sp.Expr]
    values: dict[str, sp.Expr] = field(default_factory=dict)


class Force(ABC):
    """Something that acts on the bodies of a mechanism.

    Derivatives need no formulas: a force writes steps of a program, which are differentiated.
    """

    @property
    @abstractmethod
    def identity(self) -> tuple[str, str]:
        """Kind and name, by which one of them is told from another; each is there once."""

    @property
    def along(self) -> str | None:
        """The joint whose coordinate it acts along, so that this must be driven."""
        return None

    @property
    def turns(self) -> bool:
        """Whether it acts on an angle, by moments, so that what it names a length is none."""
        return False

    @abstractmethod
    def act(self, at: Surroundings) -> Action:
        """Append what it does."""

    def signals(self, at: Surroundings, action: Action) -> Iterator[Shown]:
        """Yield its signals, which may read the accelerations."""
        del at, action
        yield from ()

    def inputs(self, mechanism: Whole) -> list[str]:
        """Return the inputs that it reads."""
        del mechanism
        return []

    def problems(self, mechanism: Whole) -> list[str]:
        """Say what it names that the mechanism has not, or that cannot be."""
        del mechanism
        return []

    @abstractmethod
    def copied(self, copy: Copying) -> Self:
        """Return the same force on the bodies of a copy."""
