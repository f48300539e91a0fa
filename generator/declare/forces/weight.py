"""Weight."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, ClassVar

import sympy as sp

from ..declared import declared
from ..geometry import UP, Direction
from ..parameters import Gravity
from .force import Action, Description, Force

if TYPE_CHECKING:
    from ..surroundings import Surroundings


@declared
@dataclass(frozen=True)
class Weight(Force):
    """The weight of every body that carries mass.

    Parameters
    ----------
    gravity
        Acceleration of gravity [m/s^2].
    upward
        Direction opposite to that of gravity, fixed in the world, of any length.
    """

    gravity: Gravity = field(
        default_factory=lambda: Gravity("gravity", 9.81, "acceleration of gravity")
    )

    upward: Direction = UP

    in_common: ClassVar[bool] = True

    @property
    def identity(self) -> tuple[str, str]:
        """A constant: a mechanism has one."""
        return "weight", "Weight"

    def describe(self) -> Description:
        up = r"\mathbf{e}_z" if self.upward.name == "up" else r"\mathbf{d}"
        share = rf"$`-\sum_b m_b\,g\,\mathbf{{V}}_b^T\,{up}`$"
        return Description("weight", f"g = `{self.gravity.name}` on every body with mass", share)

    def act(self, at: Surroundings) -> Action:
        """Append the work of gravity on the momentum per unit rate."""
        gravity = self.gravity.symbol
        forces: dict[str, sp.Expr] = {}
        for body, k, momentum in at.momenta():
            up = at.line(body, self.upward, follows=False)
            forces[k] = forces.get(k, sp.Integer(0)) - gravity * up.dot(momentum)
        return Action(forces)
