"""Values of expressions in parameters with their defaults."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import sympy as sp

if TYPE_CHECKING:
    from .assembly import Parts


class AtDefaults:
    """Evaluation of expressions with the default parameters of a mechanism."""

    def __init__(self, mechanism: Parts) -> None:
        self._derived = {sp.Symbol(n): value for n, value in mechanism.derived.items()}
        self._defaults = {p.name: p.default for p in mechanism.parameters}

    def __call__(self, expression: sp.Expr) -> float:
        """Return the value; NaN if there is none, or if the expression reads no parameter."""
        value = expression.xreplace(self._derived)
        names = {str(symbol) for symbol in value.free_symbols} & self._defaults.keys()
        value = value.xreplace({sp.Symbol(n): sp.Float(self._defaults[n]) for n in names})
        return float(value) if value.is_real and value.is_number else math.nan
