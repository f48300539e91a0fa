"""Weight."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..declared import Amount, declared
from .force import Action, Force

if TYPE_CHECKING:
    from ..copying import Copying
    from ..surroundings import Surroundings


@declared
@dataclass(frozen=True, kw_only=True)
class Weight(Force):
    """The weight of every body that carries mass, downward in the world.

    Parameters
    ----------
    gravity
        Name of the parameter [m/s^2].
    """

    gravity: Amount

    @property
    def identity(self) -> tuple[str, str]:
        """There is one."""
        return "weight", "Weight"

    def act(self, at: Surroundings) -> Action:
        """Append the work of gravity on the momentum per unit rate."""
        gravity = sp.Symbol(self.gravity)
        forces: dict[str, sp.Expr] = {}
        for body, k, momentum in at.momenta():
            forces[k] = forces.get(k, sp.Integer(0)) - gravity * at.up(body).dot(momentum)
        return Action(forces)

    def copied(self, copy: Copying) -> Weight:
        """Return itself: gravity is that of the world."""
        del copy
        return self
