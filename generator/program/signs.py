"""Signs moved from steps into the sums and products that read them, where they cost nothing.

``t = -a - b`` with ``r = c + t`` becomes ``minus_t = a + b`` with ``r = c - minus_t``: the same to
the last bit, since rounding does not depend on the sign, and one operation less. Where a value must
have its sign, as the argument of a function or as a result, it keeps its step.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

from .composing import composed
from .steps import Step, first_free
from .symbols import symbols_of, with_symbols

if TYPE_CHECKING:
    from collections.abc import Callable, Container, Iterable, Mapping

LOCAL = "shared_"
"""Beginning of the names of common subexpressions, which have no meaning."""


def take_out_signs(
    steps: Iterable[Step],
    results: Iterable[sp.Expr],
    kept: Container[sp.Symbol],
    has: Callable[[str], bool],
) -> tuple[list[Step], list[sp.Expr]]:
    """Return steps and results, without steps that only change a sign.

    Steps that nothing reads afterwards are left in them; the `kept` ones stay as they are. `has`
    returns whether a name is taken.
    """
    steps = list(steps)
    names = {s.name for step in steps for s in (step.symbol, *symbols_of(step.expression))}
    signs = _Signs(lambda name: name in names or has(name))
    written = [new for step in steps for new in signs.without(step, kept=step.symbol in kept)]
    values = [_absorbed(result, signs.opposite) for result in results]
    called = signs.called
    return [
        Step(called.get(s.symbol, s.symbol), with_symbols(s.expression, called), s.section)
        for s in written
    ], [with_symbols(value, called) for value in values]


class _Signs:
    """The signs of the steps so far.

    `opposite` has the negative of another expression, by the step that equals it, `called` better
    names of common subexpressions: those of steps that are their negatives.
    """

    def __init__(self, is_taken: Callable[[str], bool]) -> None:
        self._is_taken = is_taken
        self.opposite: dict[sp.Symbol, sp.Expr] = {}
        self.called: dict[sp.Symbol, sp.Symbol] = {}

    def without(self, step: Step, *, kept: bool) -> list[Step]:
        """Return the step itself, or a step of its opposite before it."""
        expression = _absorbed(step.expression, self.opposite)
        if kept or not _is_negative(expression):
            return [Step(step.symbol, expression, step.section)]
        value, says_nothing = -expression, step.symbol.name.startswith(LOCAL)
        if value.is_Symbol:
            self.opposite[step.symbol] = expression
            unnamed = value.name.startswith(LOCAL) and value not in self.called
            if unnamed and not says_nothing:
                self.called[value] = first_free(f"minus_{step.symbol}", self._is_taken)
            return [Step(step.symbol, expression, step.section)]
        name = f"{step.symbol}_minus" if says_nothing else f"minus_{step.symbol}"
        minus = first_free(name, self._is_taken)
        self.opposite[step.symbol] = -minus
        return [Step(minus, value, step.section), Step(step.symbol, -minus, step.section)]


def _is_negative(expression: sp.Expr) -> bool:
    """Return whether an expression is the negative of a simpler one."""
    if expression.is_Add:
        return all(map(_is_negative, expression.args))
    return bool(expression.is_Mul and expression.as_coeff_Mul()[0].is_negative)


def _absorbed(expression: sp.Expr, opposite: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    """Write terms and factors by their opposites, where they have one."""
    if opposite.keys().isdisjoint(symbols_of(expression)) or expression.is_Symbol:
        return expression
    takes_signs = expression.is_Add or expression.is_Mul or _is_whole_power(expression)
    arguments = [
        opposite.get(a, a) if takes_signs and a.is_Symbol else _absorbed(a, opposite)
        for a in expression.args
    ]
    if not (expression.is_Mul or _is_whole_power(expression)):
        return composed(expression.func, arguments)
    signs = [a.is_Add and _is_negative(a) for a in arguments]
    turned = (-a if sign else a for a, sign in zip(arguments, signs, strict=True))
    result = composed(expression.func, turned)
    odd = sum(signs) % 2 if expression.is_Mul else signs[0] and expression.exp % 2
    return sp.Mul(-1, result) if odd else result


def _is_whole_power(expression: sp.Expr) -> bool:
    return bool(expression.is_Pow and expression.exp.is_Integer)
