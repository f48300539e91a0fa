"""Derivatives of single steps, of which those of a program are made."""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping


def chain_rule(
    expression: sp.Expr, tangent: Mapping[sp.Symbol, sp.Expr], symbol: sp.Symbol | None = None
) -> sp.Expr:
    """Return the sum of partial derivatives times tangents.

    A root or a reciprocal that is a step of its own is differentiated in terms of its own symbol,
    so that it is not computed again.
    """
    own = expression.is_Pow and expression.exp in (sp.Rational(1, 2), -1)
    if symbol is None or not own:
        return sp.Add(*(partial * tangent[s] for s, partial in _partials(expression, tangent)))
    factor = 1 / (2 * symbol) if expression.exp > 0 else -symbol * symbol
    inner = _partials(expression.base, tangent)
    return sp.Add(*(partial * factor * tangent[s] for s, partial in inner))


def _partials(
    expression: sp.Expr, moving: Mapping[sp.Symbol, sp.Expr]
) -> Iterator[tuple[sp.Symbol, sp.Expr]]:
    """Yield each moving symbol of an expression with the derivative by it.

    Of a sum, only the terms with the symbol are looked at: the equation of motion of a long chain
    is one sum over all of its bodies.
    """
    having: dict[sp.Symbol, list[sp.Expr]] = {}
    for term in sp.Add.make_args(expression):
        for s in term.free_symbols & moving.keys():
            having.setdefault(s, []).append(term)
    for s in sorted(having, key=str):
        yield s, sp.Add(*(term.diff(s) for term in having[s]))
