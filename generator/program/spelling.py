"""Formulas of users, in the operations that are emitted.

Emitted code has sums, products, quotients, square roots, sine, cosine, the inverses of both,
exponential function and logarithm, all with the same bits on every machine, and with exact
derivatives. Other functions are written by these where possible. A corner or a jump is written by
`Positive` and `IsPositive`, by which motions with derivatives find it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import sympy as sp
from sympy.logic.boolalg import BooleanFunction

from .functions import Component, Frozen, Guarded, IsPositive, Iterated, Positive, SignOf

if TYPE_CHECKING:
    from collections.abc import Callable

    Define = Callable[[str, sp.Expr], sp.Expr]

WRITTEN = (
    "sums, products, quotients, powers with whole and half exponents, sqrt, sin, cos, tan, sec, "
    "csc, cot, asin, acos, atan, atan2, exp, log, Abs, sign, Max, Min, Heaviside, Piecewise"
)
"""The functions that a formula may have."""

_EMITTED = (
    sp.sin, sp.cos, sp.asin, sp.atan2, sp.exp, sp.log,
    Guarded, SignOf, Positive, IsPositive, Iterated, Component, Frozen,
)  # fmt: skip
_LARGEST_POWER = 4  # to which a step is expanded
_LARGEST_BELOW = 2  # in a denominator
_EXACT = 2**53  # whole numbers up to there are doubles


class SpellingError(ValueError):
    """A formula contains a function without an emitted operation."""


def spelled(define: Define, formula: Any) -> sp.Expr:
    """Return a formula in operations that are emitted.

    `define` appends a step, by its name and expression, and returns its symbol: for large powers.
    The formula is an expression of SymPy in names of the program, or a number. Raises
    `SpellingError` if it is neither, or has an operation that cannot be written; the message names
    it.
    """
    try:
        expression = sp.sympify(formula, strict=True)
    except (sp.SympifyError, TypeError, ValueError):
        expression = None
    if not isinstance(expression, sp.Expr):
        message = f"{_shown(formula)} is not a formula: give an expression of SymPy or a number"
        raise SpellingError(message)
    return _Speller(define).spell(expression)


def _shown(value: Any) -> str:
    text = str(value) if isinstance(value, sp.Basic) else repr(value)
    return text if len(text) <= 60 else f"{text[:60]}..."


class _Speller:
    def __init__(self, define: Define) -> None:
        self._define = define

    def spell(self, e: sp.Expr) -> sp.Expr:
        if e.is_Symbol:
            return self._symbol(e)
        if e.is_Number or e.is_NumberSymbol or _is_computed(e):
            return _number(e)
        if e.is_Add or e.is_Mul or isinstance(e, _EMITTED):
            return e.func(*map(self.spell, e.args))
        if e.is_Pow:
            return self._power(e)
        if isinstance(e, sp.Piecewise):
            return self._piecewise(e)
        others = [kind for kind in _BY_OTHERS if isinstance(e, kind)]
        if others:
            return _BY_OTHERS[others[0]](*map(self.spell, e.args))
        message = f"{_shown(e)} cannot be written in C with exact derivatives. There are {WRITTEN}"
        raise SpellingError(message)

    @staticmethod
    def _symbol(symbol: sp.Symbol) -> sp.Symbol:
        """Return a symbol without assumptions: steps and states have none."""
        if symbol.name.startswith("given_"):
            message = f"{symbol} is not the name of a state, an input, a parameter or a step"
            raise SpellingError(message)
        return sp.Symbol(symbol.name)

    def _power(self, e: sp.Expr) -> sp.Expr:
        base, exponent = self.spell(e.base), e.exp
        twice = float(2 * exponent) if exponent.is_Number and exponent.is_finite else math.nan
        if not twice.is_integer():
            message = (
                f"{_shown(e)} cannot be written in C with exact derivatives: an exponent must be a "
                f"whole number or half of an odd one. There are {WRITTEN}"
            )
            raise SpellingError(message)
        whole, half = divmod(abs(int(twice)), 2)
        if whole > _LARGEST_POWER:
            power = self._whole(base, whole) * (sp.sqrt(base) if half else 1)
        else:
            power = base ** sp.Rational(2 * whole + half, 2)
        if exponent > 0:
            return power
        # a derivative has larger exponents below
        return 1 / (power if whole < _LARGEST_BELOW else self._define("power", power))

    def _whole(self, base: sp.Expr, count: int) -> sp.Expr:
        """Return a power by squares, of which each is a step."""
        if count <= _LARGEST_POWER:
            return base**count
        part = self._define("power", self._whole(base, count // 2))
        square = self._define("power", part * part)
        return square * base if count % 2 else square

    def _piecewise(self, e: sp.Piecewise) -> sp.Expr:
        """Return a choice as a sum; each piece counts where no condition before it holds."""
        if e.args[-1][1] != sp.true:
            message = (
                f"{_shown(e)} is not defined everywhere: give a last piece whose condition is True"
            )
            raise SpellingError(message)
        *pieces, (last, _) = e.args
        chosen = self.spell(last)
        for value, condition in reversed(pieces):
            holds = self._holds(condition)
            chosen = holds * self.spell(value) + (1 - holds) * chosen
        return chosen

    def _holds(self, condition: Any) -> sp.Expr:
        """Return one where a condition holds, zero elsewhere."""
        if isinstance(condition, sp.Not):
            return 1 - self._holds(condition.args[0])
        if isinstance(condition, sp.And):
            return sp.Mul(*map(self._holds, condition.args))
        if isinstance(condition, sp.Or):
            return 1 - sp.Mul(*(1 - self._holds(part) for part in condition.args))
        if isinstance(condition, sp.StrictGreaterThan | sp.StrictLessThan):
            return IsPositive(self.spell(condition.gts) - self.spell(condition.lts))
        if isinstance(condition, sp.GreaterThan | sp.LessThan):
            return 1 - IsPositive(self.spell(condition.lts) - self.spell(condition.gts))
        kind = "and, or, not" if isinstance(condition, BooleanFunction) else "<, <=, > and >="
        message = f"the condition {_shown(condition)} cannot be written in C: there are {kind}"
        raise SpellingError(message)


def _is_computed(e: sp.Expr) -> bool:
    """Return whether an expression is a number by functions that are not emitted, as exp(2)."""
    whole = e.is_Pow and (2 * e.exp).is_Integer
    written = e.is_Add or e.is_Mul or whole or isinstance(e, _EMITTED)
    return not written and not e.is_Symbol and bool(e.is_number and e.is_real)


def _number(number: sp.Expr) -> sp.Expr:
    """Return a finite number as C can represent it."""
    if number == sp.pi:
        return number
    try:
        value = float(number)
    except (TypeError, OverflowError):
        value = math.nan
    if not math.isfinite(value):
        message = f"{_shown(number)} is not a finite real number of double precision"
        raise SpellingError(message)
    exact = number.is_Rational and max(abs(number.p), number.q) <= _EXACT
    return number if exact else sp.Float(value)


def _maximum(first: sp.Expr, *others: sp.Expr) -> sp.Expr:
    for other in others:
        first = first + Positive(other - first)
    return first


def _minimum(first: sp.Expr, *others: sp.Expr) -> sp.Expr:
    for other in others:
        first = first - Positive(first - other)
    return first


_BY_OTHERS: dict[type, Callable[..., sp.Expr]] = {
    sp.tan: lambda x: sp.sin(x) / sp.cos(x),
    sp.cot: lambda x: sp.cos(x) / sp.sin(x),
    sp.sec: lambda x: 1 / sp.cos(x),
    sp.csc: lambda x: 1 / sp.sin(x),
    sp.acos: lambda x: sp.pi / 2 - sp.asin(x),
    sp.atan: lambda x: sp.atan2(x, 1),
    sp.Abs: lambda x: Positive(x) + Positive(-x),
    sp.sign: lambda x: IsPositive(x) - IsPositive(-x),
    sp.Max: _maximum,
    sp.Min: _minimum,
    sp.Heaviside: lambda x, zero: IsPositive(x) + zero * (1 - IsPositive(x) - IsPositive(-x)),
}
"""Functions that are written by other ones."""
