"""What a closed form, or anything else that places bodies, says to the planner."""

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
    """A step that says what it makes known."""

    @abstractmethod
    def accept(self, known: Known) -> set[Coordinate]:
        """Record what follows from the step; return the coordinates that were not known."""


class Placement(PlannedStep):
    """A step that places one body, whose joints are known: nothing else follows from it.

    Attributes
    ----------
    body
        The body.
    """

    body: str

    @property
    def about(self) -> str:
        """The body."""
        return self.body

    def accept(self, known: Known) -> set[Coordinate]:
        """Record the body."""
        known.place(self.about)
        return set()


class Closing(Protocol):
    """What closes a loop that is solved by iteration: a joint, or a rod."""

    @property
    def between(self) -> tuple[str, ...]:
        """The links of the rod; none where a joint closes the loop."""

    @property
    def closure(self) -> str:
        """The equation, for the report."""

    def closes(self, cycle: Cycle) -> bool:
        """Return whether it could close a loop."""


class Solution(PlannedStep):
    """A step that closes a loop, or several."""

    @abstractmethod
    def words(self, closing: Closing | None) -> tuple[str, str]:
        """Return the closure equation of a loop and its solution, for the report."""


class ClosedForm(Solution):
    """A solution of one loop in closed form.

    Attributes
    ----------
    rank
        Of several that fit, the one of the lowest rank is taken.
    equations
        For which numbers of remaining closure equations it is tried.
    """

    rank: ClassVar[int]
    equations: ClassVar[tuple[int, ...]] = (1,)

    @classmethod
    @abstractmethod
    def match(cls, known: Known, cut: CutLoop) -> Self | None:
        """Return the solution of a cut loop, if it is of this form and all that it reads is known.

        Parameters
        ----------
        cut
            The loop as two arcs from one joint of the characteristic pair to the other.
        """


class Follower(Placement):
    """A step that places a body beside a placed one, without a closure equation."""

    rank: ClassVar[int]

    @classmethod
    @abstractmethod
    def follow(cls, known: Known, joint: Joint, parent: str, child: str) -> Self | None:
        """Return the step that places a body by a joint of a placed one, if it can.

        Parameters
        ----------
        known
            The known motions.
        joint, parent, child
            The joint, the placed body, and the one to place.
        """


class Leftover(Placement):
    """A step that places a body which nothing else places, when all loops are closed."""

    @classmethod
    @abstractmethod
    def left(cls, known: Known, massive: Collection[str]) -> Iterator[Self]:
        """Yield the steps that place what is left.

        Parameters
        ----------
        known
            The known motions.
        massive
            The bodies with mass.
        """


class Iteration(Solution):
    """A solution of several loops by iteration."""

    rank: ClassVar[int]

    @property
    @abstractmethod
    def closing(self) -> Sequence[Closing]:
        """What closes the loops, one of each."""

    @classmethod
    @abstractmethod
    def attempt(
        cls, known: Known, driven: Collection[str], waiting: Sequence[Cycle]
    ) -> Attempt | None:
        """Return how some of the loops that wait can be solved, if they can or nearly can.

        Parameters
        ----------
        known
            The known motions.
        driven
            The joints whose coordinates are given, by their names.
        waiting
            The loops that nothing else closes.
        """


@dataclass(frozen=True)
class Attempt:
    """Loops that could be solved together.

    Attributes
    ----------
    problem
        Which equations they leave for what, for a person.
    obstacle
        Why they cannot be solved; empty: they can.
    """

    action: Iteration
    cycles: tuple[Cycle, ...]
    problem: str
    obstacle: str = ""


@dataclass(frozen=True)
class Catalogue:
    """All that the planner tries, each in its order."""

    closed: tuple[type[ClosedForm], ...]
    followers: tuple[type[Follower], ...]
    leftovers: tuple[type[Leftover], ...]
    iterations: tuple[type[Iteration], ...]
