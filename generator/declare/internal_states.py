"""Internal states of forces, of first order: z' = f."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from ...core.si_units import problem_of
from .declared import DeclarationError, Name, declared


@declared
@dataclass(frozen=True)
class InternalState:
    """A state of a force or a law, beside positions and speeds; zero at the design position.

    Examples are the force of a damper that lags behind its velocity, and the deflection of a tyre.
    The force defines its time derivative. Internal states come last in the state of a model.

    Attributes
    ----------
    name
        Name of the element of the state.
    unit
        Unit of SI without a prefix, such as m, N or N m.
    meaning
        Description in the documentation of the generated code.
    """

    name: Name
    unit: str
    meaning: str

    def __post_init__(self) -> None:
        if problem := problem_of(self.unit):
            raise DeclarationError(f"InternalState {self.name!r}", [problem])

    @property
    def symbol(self) -> sp.Symbol:
        """The symbol in equations."""
        return sp.Symbol(self.name)
