"""Sums and products regrouped so that a common part is one operand of each."""

from __future__ import annotations

from collections import Counter
from itertools import chain
from typing import TYPE_CHECKING, Any

import sympy as sp
from sympy.core.numbers import NumberSymbol
from sympy.simplify.cse_main import Unevaluated

from .composing import composed
from .orders import first_term

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence


def regrouped(expressions: Iterable[sp.Expr]) -> dict[sp.Expr, Unevaluated]:
    """Return the result of SymPy's ``opt_cse``, in half of its time.

    SymPy builds the negative of each sum and product, to find the better one of both. Here the new
    operands of each sum, product and power that is regrouped are not yet combined.
    """
    parts = _Parts()
    for expression in expressions:
        parts.look_at(expression)
    _group(sp.Add, parts.sums, parts.regrouped)
    _group(sp.Mul, parts.products, parts.regrouped)
    return parts.regrouped


class _Parts:
    """The sums and products within expressions, in the order in which they are found.

    A class, since a function within a function that calls itself is a reference circle, which
    would keep all of them in memory.
    """

    def __init__(self) -> None:
        self.regrouped: dict[sp.Expr, Unevaluated] = {}
        # in their order, which decides which parts are found first
        self.sums: dict[sp.Expr, None] = {}
        self.products: dict[sp.Expr, None] = {}
        self._seen: set[sp.Expr] = set()

    def look_at(self, expression: sp.Expr) -> None:
        """Add the parts of an expression."""
        if expression.is_Atom or expression in self._seen:
            return
        self._seen.add(expression)
        for part in expression.args:
            self.look_at(part)
        if _is_better_negative(expression):
            opposite = _opposite(expression)
            if not opposite.is_Atom:
                self.regrouped[expression] = Unevaluated(sp.Mul, (sp.S.NegativeOne, opposite))
                self._seen.add(opposite)
                expression = opposite
        if expression.is_Mul:
            self.products[composed(sp.Mul, expression.args)] = None
        elif expression.is_Add:
            self.sums[expression] = None
        elif expression.is_Pow and expression.exp.could_extract_minus_sign():
            power = sp.Pow(expression.base, -expression.exp)
            self.regrouped[expression] = Unevaluated(sp.Pow, (power, -1))


def _group(
    kind: type[sp.Expr], expressions: Iterable[sp.Expr], found: dict[sp.Expr, Unevaluated]
) -> None:
    """Group operands that several sums, or several products, have in common.

    The result is that of SymPy's ``match_common_args``, whose ordered sets are slower.
    """
    operands = _Operands(sorted(expressions, key=lambda e: len(e.args)))
    for place, expression in enumerate(operands.expressions):
        operands.group(kind, place)
        if place in operands.changed:
            found[expression] = Unevaluated(kind, operands.values_of(operands.of[place]))


class _Operands:
    """The operands `of` expressions, by their numbers.

    `changed` are places of the expressions with a group as an operand.
    """

    def __init__(self, expressions: Sequence[sp.Expr]) -> None:
        self.expressions = expressions
        self.of: list[set[int]] = []
        self.changed: set[int] = set()
        self._numbers: dict[Any, int] = {}
        self._values: list[Any] = []
        self._readers: list[set[int]] = []
        for place, expression in enumerate(expressions):
            self.of.append(set(map(self._number, expression.args)))
            for operand in self.of[place]:
                self._readers[operand].add(place)

    def values_of(self, operands: Iterable[int]) -> list[Any]:
        """Return operands in the order of their numbers."""
        return [self._values[operand] for operand in sorted(operands)]

    def group(self, kind: type[sp.Expr], place: int) -> None:
        """Group operands of an expression with those behind it; forget it afterwards."""
        waiting = self._sharing(place)
        behind = set(waiting)
        for other in waiting:
            behind.discard(other)
            common = self.of[place] & self.of[other]
            if len(common) < 2:
                continue  # they are in a group by now
            whole = common == self.of[place]
            part = self.expressions[place] if whole else Unevaluated(kind, self.values_of(common))
            alike = behind.intersection(*[self._readers[operand] for operand in common])
            for changed in (*([] if whole else [place]), other, *alike):
                self._replace(changed, common, self._number(part))
        for operand in self.of[place]:
            self._readers[operand].remove(place)

    def _sharing(self, place: int) -> list[int]:
        """Return the expressions with two common operands or more, those with fewest first."""
        readers = [self._readers[operand] for operand in self.of[place]]
        most = max(readers, key=len)  # a sign is a factor of most products
        times = Counter(chain.from_iterable([r for r in readers if r is not most]))
        common = ((number + (other in most), other) for other, number in times.items())
        return [other for number, other in sorted(common) if number > 1 and other != place]

    def _number(self, value: Any) -> int:
        number = self._numbers.setdefault(value, len(self._values))
        if number == len(self._values):
            self._values.append(value)
            self._readers.append(set())
        return number

    def _replace(self, place: int, common: set[int], group: int) -> None:
        for operand in common:
            self._readers[operand].remove(place)
        self._readers[group].add(place)
        self.of[place] = (self.of[place] - common) | {group}
        self.changed.add(place)


def _opposite(expression: sp.Expr) -> sp.Expr:
    return composed(sp.Add, (-t for t in expression.args)) if expression.is_Add else -expression


def _is_better_negative(expression: sp.Expr) -> bool:
    """Return whether the negative of an expression has fewer signs, or as many and comes first.

    SymPy's ``could_extract_minus_sign`` returns the same.
    """
    if expression.is_Mul:
        return _is_negative(expression)
    if not expression.is_Add:
        return False
    excess = 2 * sum(map(_is_negative, expression.args)) - len(expression.args)
    if excess or any(isinstance(a, sp.Number | NumberSymbol) for a in expression.args):
        return excess > 0 or (not excess and bool(expression.could_extract_minus_sign()))
    # Both have the same terms, in the same order if no two of them are powers of the same symbols.
    # The keys by which SymPy compares them then differ in the coefficient of the first term only.
    first = first_term(expression)
    return bool(expression.could_extract_minus_sign()) if first is None else _is_negative(first)


def _is_negative(term: sp.Expr) -> bool:
    """Return whether a term has a negative number as its factor, which SymPy writes first."""
    factor = term.args[0] if term.is_Mul else term
    return bool(factor.is_Number and factor.is_negative)
