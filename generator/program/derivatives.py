"""Derivatives of single steps, of which those of a program are made."""

from __future__ import annotations

from operator import attrgetter
from typing import TYPE_CHECKING

import sympy as sp

from .symbols import symbols_of

if TYPE_CHECKING:
    from collections.abc import Container, Iterator, Mapping


def chain_rule(
    expression: sp.Expr, tangent: Mapping[sp.Symbol, sp.Expr], symbol: sp.Symbol | None = None
) -> sp.Expr:
    """Return the sum of partial derivatives times tangents; see `partials`.

    Parameters
    ----------
    expression
        What is differentiated.
    tangent
        The derivative of each symbol that moves.
    symbol
        The name of the expression.
    """
    return sp.Add(*(partial * tangent[s] for s, partial in partials(expression, tangent, symbol)))


def partials(
    expression: sp.Expr, moving: Container[sp.Symbol], symbol: sp.Symbol | None = None
) -> Iterator[tuple[sp.Symbol, sp.Expr]]:
    """Yield each moving symbol of an expression with the derivative by it.

    A root or a reciprocal that is a step of its own is differentiated in terms of its own symbol,
    so that it is not computed again.

    Parameters
    ----------
    expression
        What is differentiated.
    moving
        The symbols that move.
    symbol
        The name of the expression.
    """
    own = expression.is_Pow and expression.exp in (sp.Rational(1, 2), -1)
    if symbol is None or not own:
        yield from _partials(expression, moving)
        return
    factor = 1 / (2 * symbol) if expression.exp > 0 else -symbol * symbol
    for s, partial in _partials(expression.base, moving):
        yield s, partial * factor


def _partials(
    expression: sp.Expr, moving: Container[sp.Symbol]
) -> Iterator[tuple[sp.Symbol, sp.Expr]]:
    """Yield each moving symbol of an expression with the derivative by it.

    Of a sum, only the terms with the symbol are looked at: the equation of motion of a long chain
    is one sum over all of its bodies.
    """
    having: dict[sp.Symbol, list[sp.Expr]] = {}
    for term in sp.Add.make_args(expression):
        for s in symbols_of(term):
            if s in moving:
                having.setdefault(s, []).append(term)
    for s in sorted(having, key=attrgetter("name")):
        yield s, sp.Add(*(_partial(term, s) for term in having[s]))


def _partial(expression: sp.Expr, s: sp.Symbol) -> sp.Expr:
    """Return the derivative of an expression that has a symbol by that symbol.

    SymPy's ``diff`` gives the same, but differentiates what has no such symbol, too: it spends
    its time on products with zero.
    """
    if expression == s:
        return sp.Integer(1)
    if expression.is_Pow and expression.exp.is_Number:
        base, exponent = expression.args
        return expression * (_partial(base, s) * exponent / base)
    arguments = expression.args
    having = [(place, a) for place, a in enumerate(arguments) if s in symbols_of(a)]
    if expression.is_Add:
        return sp.Add(*(_partial(a, s) for _, a in having))
    if expression.is_Mul:
        return sp.Add(
            *(
                sp.Mul(*arguments[:place], _partial(a, s), *arguments[place + 1 :])
                for place, a in having
            )
        )
    return sp.Add(*(expression.fdiff(place + 1) * _partial(a, s) for place, a in having))
