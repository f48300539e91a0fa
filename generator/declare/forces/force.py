"""What a force says of itself: how it acts, what it shows."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, ClassVar

from ..bodies import Ground
from ..declared import DeclarationError

if TYPE_CHECKING:
    from collections.abc import Iterator

    import sympy as sp

    from ..bodies import Body
    from ..inputs import Input
    from ..joints import Joint
    from ..shown import Shown
    from ..surroundings import Surroundings


@dataclass(frozen=True)
class Action:
    """Generalised forces of a force at an instant.

    Attributes
    ----------
    forces
        Generalised force [N or N m] by the name of the coordinate. What is along a prescribed
        coordinate does no work on the others, and does not count.
    values
        What its signals will show, by name.
    total
        Of what pushes two ends apart: with how much [N or N m].
    rates
        Of each of its internal states the rate, by name.
    """

    forces: dict[str, sp.Expr]
    values: dict[str, sp.Expr] = field(default_factory=dict)
    total: sp.Expr | None = None
    rates: dict[str, sp.Expr] = field(default_factory=dict)


@dataclass(frozen=True)
class Description:
    """How a report speaks of a force.

    Attributes
    ----------
    name
        What it is called.
    acts
        What it does, with names of parameters and inputs.
    share
        Its share of Q, by the paper's Eqs. 23 and 24: words, or LaTeX between ``$`` and ``$``.
    """

    name: str
    acts: str
    share: str


class Force(ABC):
    """Something that acts on the bodies of a mechanism: a dataclass with a decorator, `declared`.

    Bodies, inputs and parameters in its fields are those of the mechanism. Copies are made field by
    field; `turns_about` names the fields that are axes of rotation. Derivatives need no formulas: a
    force writes steps of a program, which are differentiated.
    """

    turns_about: ClassVar[tuple[str, ...]] = ()
    in_common: ClassVar[bool] = False
    """Whether it acts on all bodies there are, so that copies of a mechanism have one of it."""

    @property
    @abstractmethod
    def identity(self) -> tuple[str, str]:
        """Kind and name, by which one of them is distinguished from another; each is there once."""

    @property
    def along(self) -> Joint | None:
        """The joint whose coordinate it acts along, so that this must be driven."""
        return None

    def describe(self) -> Description:
        """Return its description in reports."""
        does = (type(self).__doc__ or "").partition("\n")[0]
        return Description(" ".join(self.identity), does, "its power by the rate")

    @abstractmethod
    def act(self, at: Surroundings) -> Action:
        """Append its generalised forces."""

    def signals(self, at: Surroundings, action: Action) -> Iterator[Shown]:
        """Yield its signals, which may read the accelerations.

        Parameters
        ----------
        at
            What surrounds the force.
        action
            What it does.
        """
        del at, action
        yield from ()


def check_applied(kind: str, body: Body, given: Input, unit: str) -> None:
    """See that what acts from outside is in its unit, and on something that moves.

    Parameters
    ----------
    kind, body
        What acts, and on which body.
    given, unit
        The inputs, and the unit that they must have.
    """
    problems = []
    if given.unit != unit:
        problems.append(f"input {given.name!r} is in {given.unit}; {unit} is needed")
    if isinstance(body, Ground):
        problems.append(f"it acts on {body.name!r}, which rests; give a body that moves")
    if problems:
        raise DeclarationError(f"{kind} by {given.name!r}", problems)
