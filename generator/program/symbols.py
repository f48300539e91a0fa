"""The symbols and the guarded quantities of expressions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..memory import remembered
from .functions import Guarded

if TYPE_CHECKING:
    from collections.abc import Mapping

    import sympy as sp


@remembered
def symbols_of(expression: sp.Expr) -> frozenset[sp.Symbol]:
    """Return the symbols of an expression; those of each of its parts are collected once.

    A derivation asks some hundred times as often as there are expressions; SymPy's own
    ``free_symbols`` traverses the expression each time.
    """
    if expression.is_Symbol:
        return frozenset((expression,))
    return frozenset().union(*map(symbols_of, expression.args))


def with_symbols(expression: sp.Expr, others: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    """Return an expression with other expressions for some of its symbols."""
    if not others or others.keys().isdisjoint(symbols_of(expression)):
        return expression  # without the traversal of `xreplace`
    return expression.xreplace(others)


@remembered
def guarded_in(expression: sp.Expr) -> frozenset[sp.Expr]:
    """Return the quantities that are guarded in an expression, collected like its symbols."""
    own = (expression.args[0],) if isinstance(expression, Guarded) else ()
    return frozenset(own).union(*map(guarded_in, expression.args))
