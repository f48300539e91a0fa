"""A force along the coordinate of a joint."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..declared import Name, declared
from ..known import unknown
from .force import Action, Force

if TYPE_CHECKING:
    from ..copying import Copying
    from ..surroundings import Surroundings
    from ..whole import Whole


@declared
@dataclass(frozen=True, kw_only=True)
class JointForce(Force):
    """A force (or moment) along an independent joint coordinate, given as an input."""

    joint: Name
    input: Name

    @property
    def identity(self) -> tuple[str, str]:
        """Joint and input: several may push along one joint."""
        return "JointForce along", f"{self.joint} by {self.input}"

    @property
    def along(self) -> str:
        """The joint."""
        return self.joint

    def act(self, at: Surroundings) -> Action:
        """Append the force; it does its work on the coordinate."""
        return Action({at.coordinate(self.joint): sp.Symbol(self.input)})

    def inputs(self, mechanism: Whole) -> list[str]:
        """Return the force."""
        del mechanism
        return [self.input]

    def problems(self, mechanism: Whole) -> list[str]:
        """Say which of its names are not declared."""
        joints = [j.name for j in mechanism.joints]
        problems = unknown("JointForce: joint", [self.joint], joints)
        return problems + unknown("JointForce: input", [self.input], mechanism.input_names)

    def copied(self, copy: Copying) -> JointForce:
        """Return the force along the copy's joint."""
        return JointForce(joint=copy.joint(self.joint), input=copy.input(self.input))
