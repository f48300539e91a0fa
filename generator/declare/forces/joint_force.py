"""A force along the coordinate of a joint."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..declared import DeclarationError, declared
from ..inputs import Input
from ..joints import Prismatic, Revolute
from .force import Action, Description, Force

if TYPE_CHECKING:
    from ..surroundings import Surroundings


@declared
@dataclass(frozen=True)
class JointForce(Force):
    """A force (or moment) along an independent joint coordinate, given as an input.

    Parameters
    ----------
    joint
        A guide or a hinge that is independent.
    input
        The force along a guide [N], or the moment about a hinge [N m].
    """

    joint: Revolute | Prismatic
    input: Input

    def __post_init__(self) -> None:
        unit = self.joint.force_unit
        if self.input.unit != unit:
            problem = (
                f"input {self.input.name!r} is in {self.input.unit}; {unit} is needed along joint "
                f"{self.joint.name!r}, which is {self.joint.kind}"
            )
            raise DeclarationError(f"JointForce by {self.input.name!r}", [problem])

    @property
    def identity(self) -> tuple[str, str]:
        """Joint and input: a joint may have several."""
        return "JointForce along", f"{self.joint.name} by {self.input.name}"

    @property
    def along(self) -> Revolute | Prismatic:
        return self.joint

    def describe(self) -> Description:
        name = self.input.name
        acts = f"`{name}` along the coordinate of joint {self.joint.name}, which is independent"
        return Description(name, acts, "itself, in the row of that coordinate")

    def act(self, at: Surroundings) -> Action:
        """Append the force along the coordinate."""
        return Action({at.coordinate(self.joint.name): sp.Symbol(self.input.name)})
