"""Interface of the planner: closed forms, and other steps that place bodies."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Protocol

from ..kinematics.step import KinematicStep

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence
    from typing import Self

    from ..declare.joints import Joint
    from .cut import CutLoop
    from .graph import Cycle
    from .known import Coordinate, Known


class PlannedStep(KinematicStep):
    """A step whose results the planner records."""

    @abstractmethod
    def accept(self, known: Known) -> set[Coordinate]:
        """Record the results of the step; return the coordinates that were not known."""


class Placement(PlannedStep):
    """A step that places one body, whose joints are known, without further results."""

    body: str

    @property
    def about(self) -> str:
        return self.body

    def accept(self, known: Known) -> set[Coordinate]:
        known.place(self.about)
        return set()


class Closing(Protocol):
    """The joint or rod at which a loop is closed by iteration."""

    @property
    def between(self) -> tuple[str, ...]:
        """The links of the rod; none where a joint closes the loop."""

    @property
    def closure(self) -> str:
        """The equation, for the report."""

    def closes(self, cycle: Cycle) -> bool:
        """Return whether it can close a loop."""


class Solution(PlannedStep):
    """A step that closes a loop, or several."""

    @abstractmethod
    def words(self, closing: Closing | None) -> tuple[str, str]:
        """Return the closure equation of a loop and its solution, for the report."""


class ClosedForm(Solution):
    """A solution of one loop in closed form."""

    rank: ClassVar[int]  # form of the lowest rank is taken among those that fit
    # numbers of remaining closure equations with which it is tried
    equations: ClassVar[tuple[int, ...]] = (1,)

    @classmethod
    @abstractmethod
    def match(cls, known: Known, cut: CutLoop) -> Self | None:
        """Return the solution of a cut loop if it has this form and all its inputs are known."""


class Follower(Placement):
    """A step that places a body beside a placed one, without a closure equation."""

    rank: ClassVar[int]

    @classmethod
    @abstractmethod
    def follow(cls, known: Known, joint: Joint, parent: str, child: str) -> Self | None:
        """Return the step that places a child by a joint of a placed parent, if it can."""


class Leftover(Placement):
    """A step for a body that no other step places, after all loops are closed."""

    @classmethod
    @abstractmethod
    def left(cls, known: Known, massive: Collection[str]) -> Iterator[Self]:
        """Yield the steps that place the remaining bodies; some are massive."""


class Iteration(Solution):
    """A solution of several loops by iteration."""

    rank: ClassVar[int]

    @property
    @abstractmethod
    def closing(self) -> Sequence[Closing]:
        """The joints or rods that close the loops, one each."""

    @classmethod
    @abstractmethod
    def attempt(
        cls, known: Known, driven: Collection[str], waiting: Sequence[Cycle]
    ) -> Attempt | None:
        """Return the solution of some of the waiting loops, or the nearest attempt.

        `known` are the known motions, `driven` the names of the joints whose coordinates are given;
        nothing else closes the loops in `waiting`.
        """


@dataclass(frozen=True)
class Attempt:
    """Loops that could be solved together."""

    action: Iteration
    cycles: tuple[Cycle, ...]
    problem: str  # numbers of equations and unknowns, in words
    obstacle: str = ""  # reason against a solution; empty: there is none


@dataclass(frozen=True)
class Catalogue:
    """All forms that the planner tries, each kind in order."""

    closed: tuple[type[ClosedForm], ...]
    followers: tuple[type[Follower], ...]
    leftovers: tuple[type[Leftover], ...]
    iterations: tuple[type[Iteration], ...]
