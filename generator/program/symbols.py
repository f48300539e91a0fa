"""The symbols and the guarded quantities of expressions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from sympy.core.cache import cacheit

from .functions import Guarded

if TYPE_CHECKING:
    import sympy as sp


@cacheit  # type: ignore[untyped-decorator]  # SymPy has no types
def symbols_of(expression: sp.Expr) -> frozenset[sp.Symbol]:
    """Return the symbols of an expression; those of each of its parts are collected once.

    A derivation asks some hundred times as often as there are expressions; SymPy's own
    ``free_symbols`` traverses the expression each time.
    """
    if expression.is_Symbol:
        return frozenset((expression,))
    return frozenset().union(*map(symbols_of, expression.args))


@cacheit  # type: ignore[untyped-decorator]  # SymPy has no types
def guarded_in(expression: sp.Expr) -> frozenset[sp.Expr]:
    """Return the quantities that are guarded in an expression, collected like its symbols."""
    own = (expression.args[0],) if isinstance(expression, Guarded) else ()
    return frozenset(own).union(*map(guarded_in, expression.args))
