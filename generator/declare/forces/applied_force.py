"""External forces at points of bodies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..bodies import Body
from ..declared import declared
from ..geometry import Direction, Point
from ..inputs import Input
from .force import Action, Description, Force, check_applied

if TYPE_CHECKING:
    from ..surroundings import Surroundings


@declared
@dataclass(frozen=True)
class AppliedForce(Force):
    """A force along a direction at a point of a body; its value is an input [N].

    Parameters
    ----------
    body, point
        Body, and point of action at the design position.
    direction
        Direction of a positive force, of any length.
    input
        The force [N].
    follows
        Whether the direction turns with the body; else it is fixed in the world.
    """

    body: Body
    point: Point
    direction: Direction
    input: Input
    follows: bool = False

    def __post_init__(self) -> None:
        check_applied("AppliedForce", self.body, self.input, "N")

    @property
    def identity(self) -> tuple[str, str]:
        """Body and input: a body may have several."""
        return "AppliedForce at", f"{self.body.name} by {self.input.name}"

    def describe(self) -> Description:
        name = self.input.name
        return Description(
            name,
            f"`{name}` on {self.body.name} at `{self.point.name}` along d",
            r"$`\left(\partial\mathbf{v}_P/\partial\dot{\mathbf{q}}\right)^T\mathbf{d}\,F`$",
        )

    def act(self, at: Surroundings) -> Action:
        """Append its power on the velocity of the point."""
        body, force = self.body.name, sp.Symbol(self.input.name)
        local, line = at.local(body, self.point), at.line(body, self.direction, self.follows)
        return Action(
            {
                k: force * line.dot(twist.linear + twist.angular.cross(local))
                for k, twist in at.twists(body).items()
            }
        )
