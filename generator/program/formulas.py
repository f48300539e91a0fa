"""Formulas of `kintrafo.formulas` as steps of a program."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import sympy as sp

from .functions import IsPositive, Positive

if TYPE_CHECKING:
    from .program import Program


@dataclass(frozen=True)
class Steps:
    """Functions of symbols for formulas; definitions become steps with a prefix."""

    program: Program
    prefix: str

    sqrt = staticmethod(sp.sqrt)
    sin = staticmethod(sp.sin)
    cos = staticmethod(sp.cos)
    exp = staticmethod(sp.exp)
    log = staticmethod(sp.log)

    def define(self, name: str, value: Any) -> sp.Expr:
        """Append a step, and return its symbol."""
        return self.program.define(f"{self.prefix}{name}", value)

    def atan(self, x: Any) -> sp.Expr:
        """Return the arc tangent."""
        return sp.atan2(x, sp.Integer(1))

    def positive(self, x: Any) -> sp.Expr:
        """Return the number where it is positive, and zero elsewhere."""
        x = sp.sympify(x)
        return sp.Max(x, 0) if x.is_number else Positive(x)

    def sign(self, x: Any) -> sp.Expr:
        """Return minus one, zero or one."""
        x = sp.sympify(x)
        return sp.sign(x) if x.is_number else IsPositive(x) - IsPositive(-x)
