"""Internal states of forces, of first order: z' = f."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from ...core.si_units import problem_of
from .declared import DeclarationError, Name, declared


@declared
@dataclass(frozen=True)
class InternalState:
    """A state of a force or a law: zero at design, with a rate that its force returns.

    Examples are the force of a damper that lags behind its velocity, and the deflection of a tyre.
    Internal states come last in the state of a model.

    Attributes
    ----------
    unit
        Of SI, without a factor.
    meaning
        For the documentation of the generated code.
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
