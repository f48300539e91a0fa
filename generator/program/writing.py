"""Write an expression as C (or NumPy) arithmetic, and count the operations of what was written.

Text and count come from the same traversal, so the count is that of the emitted code. There is no
``pow``: integer powers are products, half-integer ones are roots. Sums and products are put
together in the order in which their parts become known.
"""

from __future__ import annotations

import heapq
from collections import Counter
from dataclasses import dataclass
from itertools import count
from typing import TYPE_CHECKING, TypeVar

import sympy as sp

from .functions import Component, Frozen, Guarded, IsPositive, Iterated, Positive, SignOf

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

T = TypeVar("T", "Written", "tuple[Written, bool]")

OPERATIONS = ("add", "multiply", "divide", "root", "trigonometric")


# Comparisons, not arithmetic: they are not counted as operations.
_SELECTIONS = (Guarded, SignOf, Positive, IsPositive)


@dataclass(frozen=True)
class Dialect:
    """How a target language spells functions."""

    functions: Mapping[type, str]
    root: str
    component: str


C = Dialect(
    {
        sp.sin: "sin({})",
        sp.cos: "cos({})",
        sp.asin: "asin({})",
        sp.atan2: "atan2({}, {})",
        Guarded: "at_least({}, {})",
        SignOf: "copysign(1.0, {})",
        Positive: "at_least({}, 0.0)",
        IsPositive: "(double)({} > 0.0)",
    },
    root="sqrt({})",
    component="{}.at[{}]",
)
NUMPY = Dialect(
    {
        sp.sin: "np.sin({})",
        sp.cos: "np.cos({})",
        sp.asin: "np.arcsin({})",
        sp.atan2: "np.arctan2({}, {})",
        Guarded: "np.maximum({}, {})",
        SignOf: "np.copysign(1.0, {})",
        Positive: "np.maximum({}, 0.0)",
        IsPositive: "1.0*({} > 0.0)",
    },
    root="np.sqrt({})",
    component="{}[{}]",
)

# binding strength of a written expression, loosest first
_SUM, _NEGATIVE, _PRODUCT, _ATOM = range(4)

# About how many cycles the result of an operation is waited for on present processors. Only the
# order of operations follows from these numbers, never their count.
_LATENCY = {
    "sum": 4,
    "product": 4,
    "quotient": 14,
    "root": 18,
    "selection": 4,
    "function": 45,
    "iteration": 500,
}


@dataclass(frozen=True)
class Written:
    """An expression as text, with the operations in it.

    A sign in front counts as an addition; guards, limits and the choice of a branch are comparisons
    and do not count.

    Attributes
    ----------
    ready
        When the result is there, in cycles from the start of the function.
    """

    text: str
    strength: int
    operations: Counter[str]
    ready: int = 0

    def inside(self, strength: int) -> str:
        """Return the text, in parentheses where its surroundings bind more strongly."""
        return self.text if self.strength >= strength else f"({self.text})"


def write(
    expression: sp.Expr, dialect: Dialect = C, ready: Mapping[sp.Symbol, int] | None = None
) -> Written:
    """Write an expression and count its operations.

    Parameters
    ----------
    ready
        When each symbol is there, in cycles; zero for those that are left out. Of several terms or
        factors, those that are there first are put together first: a compiler must not change the
        order, and the longest chain of operations is what a call takes.
    """
    return _Writer(dialect, ready or {}).write(expression)


class _Writer:
    """Writes expressions in one dialect."""

    def __init__(self, dialect: Dialect, ready: Mapping[sp.Symbol, int]) -> None:
        self.dialect = dialect
        self.ready = ready

    def write(self, expression: sp.Expr) -> Written:
        if expression.is_Symbol:
            return Written(expression.name, _ATOM, Counter(), self.ready.get(expression, 0))
        if expression.is_Number or expression is sp.pi:
            return _write_number(expression)
        if expression.is_Add:
            return self._sum(expression)
        if expression.is_Mul:
            return self._product(expression)
        if expression.is_Pow:
            return self._power(expression)
        return self._function(expression)

    def _function(self, expression: sp.Expr) -> Written:
        if isinstance(expression, Frozen):
            return self.write(expression.args[0])
        if isinstance(expression, Component):
            return self._component(*expression.args)
        if isinstance(expression, Iterated):
            return self._iterated(*expression.args)
        spelling = self.dialect.functions.get(type(expression))
        if spelling is None:
            message = f"{expression} cannot be written: {type(expression).__name__} has no spelling"
            raise ValueError(message)
        arguments = [self.write(a) for a in expression.args]
        selection = isinstance(expression, _SELECTIONS)
        return Written(
            spelling.format(*(a.text for a in arguments)),
            _ATOM,
            _total(arguments, trigonometric=int(not selection)),
            _after(arguments, "selection" if selection else "function"),
        )

    def _component(self, results: sp.Symbol, place: sp.Integer) -> Written:
        text = self.dialect.component.format(results.name, int(place))
        return Written(text, _ATOM, Counter(), self.ready.get(results, 0))

    def _iterated(self, block: sp.Basic, *given: sp.Expr) -> Written:
        """Write the call of a block; who knows the block counts what is in it."""
        arguments = [self.write(a) for a in given]
        text = f"{block.name}({', '.join(a.text for a in arguments)})"
        return Written(text, _ATOM, _total(arguments), _after(arguments, "iteration"))

    def _sum(self, expression: sp.Expr) -> Written:
        """Add the terms that are there first, and subtract rather than put a sign in front."""
        terms = [
            (self.write(magnitude), negative) for negative, magnitude in _signed_terms(expression)
        ]
        if all(negative for _, negative in terms):  # the sign goes to what waits anyway
            first = min(range(len(terms)), key=lambda i: terms[i][0].ready)
            terms[first] = _negated(terms[first][0]), False
        total, _ = _join(terms, _add)
        return total

    def _product(self, expression: sp.Expr) -> Written:
        negative, magnitude = _signed(expression)
        if negative:
            return _negated(self.write(magnitude))
        coefficient, factors = magnitude.as_coeff_mul()
        above = [self.write(f) for f in factors if not _is_reciprocal(f)]
        below = [self.write(1 / f) for f in factors if _is_reciprocal(f)]
        if coefficient != 1:
            above.insert(0, self.write(coefficient))
        if not below:
            return _join(above, _multiply)
        numerator = _join(above, _multiply) if above else Written("1.0", _ATOM, Counter())
        return _divide(numerator, _join(below, _multiply))

    def _power(self, expression: sp.Expr) -> Written:
        base, exponent = expression.base, expression.exp
        if exponent.is_negative:
            return _divide(Written("1.0", _ATOM, Counter()), self.write(1 / expression))
        whole, half = divmod(exponent, 1)
        if half not in (0, sp.Rational(1, 2)) or whole > 4:
            message = f"the power {expression} has no product of roots and factors"
            raise ValueError(message)
        written = self.write(base)
        factors = [written] * int(whole)
        if half:
            text = self.dialect.root.format(written.text)
            operations = _total([written], root=1)
            factors.append(Written(text, _ATOM, operations, _after([written], "root")))
        return _join(factors, _multiply)


def _total(parts: Sequence[Written], **own: int) -> Counter[str]:
    total: Counter[str] = Counter()
    for counts in (own, *(part.operations for part in parts)):
        for name, number in counts.items():
            if number:
                total[name] += number
    return total


def _after(parts: Sequence[Written], operation: str) -> int:
    return max((part.ready for part in parts), default=0) + _LATENCY[operation]


def _join(parts: Sequence[T], together: Callable[[T, T], T]) -> T:
    """Put parts together, always the two that are there first; equals in their order."""
    waiting = [(_ready(part), place, part) for place, part in enumerate(parts)]
    heapq.heapify(waiting)
    places = count(len(waiting))
    while len(waiting) > 1:
        (_, _, first), (_, _, second) = heapq.heappop(waiting), heapq.heappop(waiting)
        joined = together(first, second)
        heapq.heappush(waiting, (_ready(joined), next(places), joined))
    return waiting[0][2]


def _ready(part: Written | tuple[Written, bool]) -> int:
    return part.ready if isinstance(part, Written) else part[0].ready


def _multiply(one: Written, two: Written) -> Written:
    if two.strength == _PRODUCT and one.strength != _PRODUCT:
        one, two = two, one
    text = f"{one.inside(_PRODUCT)}*{two.inside(_ATOM)}"
    return Written(text, _PRODUCT, _total([one, two], multiply=1), _after([one, two], "product"))


def _divide(above: Written, below: Written) -> Written:
    text = f"{above.inside(_PRODUCT)}/{below.inside(_ATOM)}"
    return Written(
        text, _PRODUCT, _total([above, below], divide=1), _after([above, below], "quotient")
    )


def _add(one: tuple[Written, bool], two: tuple[Written, bool]) -> tuple[Written, bool]:
    """Add two terms, each with whether it is negative; only a sum of two negatives stays so."""
    if one[1] and not two[1]:
        one, two = two, one
    (first, negative), (second, subtract) = one, two
    subtract = subtract and not negative
    if not subtract and second.strength < _PRODUCT <= first.strength:
        first, second = second, first
    sign = "-" if subtract else "+"
    text = f"{first.text} {sign} {second.inside(_PRODUCT)}"
    joined = Written(text, _SUM, _total([first, second], add=1), _after([first, second], "sum"))
    return joined, negative


def _negated(written: Written) -> Written:
    operations = _total([written], add=1)
    return Written(f"-{written.inside(_PRODUCT)}", _NEGATIVE, operations, _after([written], "sum"))


def _write_number(number: sp.Expr) -> Written:
    if number == sp.pi:
        return Written("3.14159265358979323846", _ATOM, Counter())
    value = sp.Rational(number)
    if value.q & (value.q - 1):  # not exact in binary: let the compiler divide
        return Written(f"({value.p}.0/{value.q}.0)", _ATOM, Counter())
    return Written(repr(float(value)), _ATOM if value >= 0 else _NEGATIVE, Counter())


def _signed_terms(expression: sp.Expr) -> list[tuple[bool, sp.Expr]]:
    """Return the terms of a sum as (is negative, magnitude), positive ones first."""
    return sorted((_signed(term) for term in expression.args), key=lambda term: term[0])


def _signed(term: sp.Expr) -> tuple[bool, sp.Expr]:
    """Split a term into (is negative, magnitude)."""
    negative = bool(term.as_coeff_Mul()[0].is_negative)
    return negative, -term if negative else term


def _is_reciprocal(factor: sp.Expr) -> bool:
    return bool(factor.is_Pow and factor.exp.is_negative)
