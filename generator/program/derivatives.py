"""Partial derivatives of single steps; those of a program are composed of them."""

from __future__ import annotations

from operator import attrgetter
from typing import TYPE_CHECKING

import sympy as sp

from ..memory import remembered
from .composing import composed
from .symbols import symbols_of
from .vectors import product

if TYPE_CHECKING:
    from collections.abc import Container, Iterator, Mapping


def chain_rule(
    expression: sp.Expr, tangent: Mapping[sp.Symbol, sp.Expr], symbol: sp.Symbol | None = None
) -> sp.Expr:
    """Return the sum of partial derivatives times tangents.

    Expression and symbol are as in `partials`; `tangent` has the derivative of each symbol that
    varies.
    """
    found = partials(expression, tangent, symbol)
    return composed(sp.Add, (product(partial, tangent[s]) for s, partial in found))


def partials(
    expression: sp.Expr, moving: Container[sp.Symbol], symbol: sp.Symbol | None = None
) -> Iterator[tuple[sp.Symbol, sp.Expr]]:
    """Yield each moving symbol of an expression with the partial derivative with respect to it.

    The expression is in names of the program. `symbol` is the step that it defines: the derivative
    of a root or a reciprocal is written by it, and so without a second root.
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
    """Yield each moving symbol of an expression with the derivative with respect to it."""
    for s, terms in _terms_by_symbol(expression):
        if s in moving:
            yield s, _derivative(terms, s)


@remembered
def _terms_by_symbol(expression: sp.Expr) -> list[tuple[sp.Symbol, tuple[sp.Expr, ...]]]:
    """Return the symbols of an expression by name, each with the terms that have it.

    Of a sum, only the terms with a symbol are differentiated: the equation of motion of a long
    chain is one sum over all of its bodies.
    """
    having: dict[sp.Symbol, list[sp.Expr]] = {}
    for term in sp.Add.make_args(expression):
        for s in symbols_of(term):
            having.setdefault(s, []).append(term)
    return [(s, tuple(having[s])) for s in sorted(having, key=attrgetter("name"))]


@remembered
def _derivative(terms: tuple[sp.Expr, ...], s: sp.Symbol) -> sp.Expr:
    """Return the derivative of a sum, which is the same for all directions of a program."""
    return composed(sp.Add, (_partial(term, s) for term in terms))


def _partial(expression: sp.Expr, s: sp.Symbol) -> sp.Expr:
    """Return the derivative of an expression with respect to a symbol that it contains.

    SymPy's ``diff`` returns the same, but also differentiates arguments without the symbol, and
    spends most of its time on products with zero.
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
                composed(sp.Mul, (*arguments[:place], _partial(a, s), *arguments[place + 1 :]))
                for place, a in having
            )
        )
    return sp.Add(*(expression.fdiff(place + 1) * _partial(a, s) for place, a in having))
