"""External moments on bodies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import sympy as sp

from ..bodies import Body
from ..declared import declared
from ..geometry import Direction
from ..inputs import Input
from .force import Action, Description, Force, check_applied

if TYPE_CHECKING:
    from ..surroundings import Surroundings


@declared
@dataclass(frozen=True)
class AppliedMoment(Force):
    """A moment on a body about a direction; its value is an input [N m].

    Parameters
    ----------
    body
        Body on which it acts.
    direction
        Axis of a positive, right-handed moment, of any length.
    input
        The moment [N m].
    follows
        Whether the direction turns with the body; else it is fixed in the world.
    """

    body: Body
    direction: Direction
    input: Input
    follows: bool = False

    turns_about: ClassVar[tuple[str, ...]] = ("direction",)

    def __post_init__(self) -> None:
        check_applied("AppliedMoment", self.body, self.input, "N m")

    @property
    def identity(self) -> tuple[str, str]:
        """Body and input: a body may have several."""
        return "AppliedMoment on", f"{self.body.name} by {self.input.name}"

    def describe(self) -> Description:
        name = self.input.name
        share = r"$`\mathbf{W}_b^T\mathbf{d}\,F`$"
        return Description(name, f"`{name}` on {self.body.name} about d", share)

    def act(self, at: Surroundings) -> Action:
        """Append its power on the turning of the body."""
        body, moment = self.body.name, sp.Symbol(self.input.name)
        line = at.line(body, self.direction, self.follows)
        return Action({k: moment * line.dot(t.angular) for k, t in at.twists(body).items()})
