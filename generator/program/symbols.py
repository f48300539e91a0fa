"""The symbols of expressions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from sympy.core.cache import cacheit

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
