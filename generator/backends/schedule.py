"""The operations of an expression in the order of their execution.

An expression of SymPy has no order: a sum is a set of terms. Here it becomes a tree of operations
of one or two operands, which all back ends write and which is counted. Sums and products are
evaluated in the order in which their parts become known, since a compiler must not change it. There
is no ``pow``: integer powers are products, half-integer ones are roots.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass, field
from itertools import count
from operator import itemgetter
from typing import TYPE_CHECKING, Any, TypeVar
from weakref import WeakKeyDictionary

import sympy as sp

from ..program.functions import Component, Frozen, Guarded, IsPositive, Iterated, Positive, SignOf
from ..program.symbols import symbols_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from ..program.function import Function
    from ..program.steps import Step

T = TypeVar("T", "Operation", "tuple[Operation, bool]")

SELECTIONS = (Guarded, SignOf, Positive, IsPositive)
"""Comparisons, not arithmetic."""

# Approximate latency of the operations on present processors, in cycles. Only the order of
# operations follows from these numbers, never their count.
_LATENCY = {
    "add": 4, "subtract": 4, "negate": 4, "multiply": 4, "divide": 14, "root": 18, "selection": 4,
    "function": 45, "iterate": 500,
}  # fmt: skip


# Compilers accept 256 nested brackets or more, and Python some 300 calls. A sum of which each term
# depends on the one before is as deep as it is long.
_DEEPEST = 64


# not frozen: there are millions, which are then built in half of the time
@dataclass(eq=False, slots=True)
class Operation:
    """An operation and its operands."""

    # `add`, `subtract`, `negate`, `multiply`, `divide`, `root`; `function` and `selection` (a
    # call); `iterate` (the call of a block) and `component` (one of its results); `symbol` and
    # `number`
    kind: str
    operands: tuple[Operation, ...] = ()
    # specification of the kind: the symbol, the number, the class of the function, the name of the
    # block, the index of the component
    of: Any = None
    ready: int = 0  # time at which the result is known, in cycles from the start of the function
    depth: int = 0  # number of nested operations


@dataclass(frozen=True, slots=True)
class Assignment:
    """A value with a name, and its section of the derivation."""

    name: str
    value: Operation
    section: str
    within: str = ""  # step whose value this is a part of; empty for a step itself


@dataclass(frozen=True)
class Schedule:
    """The operations of the steps of a function, and of each of its results."""

    steps: tuple[Assignment, ...]
    results: tuple[Operation, ...]


_orders: WeakKeyDictionary[Function, Schedule] = WeakKeyDictionary()
# of steps, which functions have in common: times at which their symbols are known, and the value
_values: WeakKeyDictionary[Step, tuple[list[int], Operation]] = WeakKeyDictionary()


def ordered(function: Function) -> Schedule:
    """Return the operations of a function, in an order that is found once."""
    if function not in _orders:
        _orders[function] = _ordered(function)
    return _orders[function]


def _ordered(function: Function) -> Schedule:
    ready: dict[sp.Symbol, int] = {}
    steps: list[Assignment] = []
    taken = {s.name for s in (*function.free_symbols, *(step.symbol for step in function.steps))}

    def value_of(expression: sp.Expr, name: str, section: str) -> Operation:
        """Return a value; parts that are nested too deeply become steps before it."""
        names = (n for i in count(1) if (n := f"{name}_part_{i}") not in taken)
        scheduler = _Scheduler(ready, names)
        value = scheduler.operation(expression)
        taken.update(part for part, _ in scheduler.parts)
        steps.extend(Assignment(part, of, section, name) for part, of in scheduler.parts)
        return value

    for step in function.steps:
        name = step.symbol.name
        known = [ready.get(symbol, 0) for symbol in symbols_of(step.expression)]
        at, value = _values.get(step, (None, _ONE))
        if at != known:
            before = len(steps)
            value = value_of(step.expression, name, step.section)
            if len(steps) == before:
                _values[step] = known, value
        steps.append(Assignment(name, value, step.section))
        ready[step.symbol] = value.ready
    results = [
        value_of(result, f"result_{place}", "results")
        for place, result in enumerate(function.results)
    ]
    return Schedule(tuple(steps), tuple(results))


def schedule(expression: sp.Expr, ready: Mapping[sp.Symbol, int] | None = None) -> Operation:
    """Return the operations of an expression in order.

    `ready` is the time at which each symbol is known, in cycles; zero for others. Terms or factors
    that are known first are combined first: a compiler must not change the order, and the longest
    chain of operations determines the time of a call. Raises `ValueError` if a power has no product
    of roots and factors.
    """
    return _Scheduler(ready or {}).operation(expression)


@dataclass(frozen=True)
class _Scheduler:
    """Orders expressions by the times at which their symbols are known."""

    ready: Mapping[sp.Symbol, int] = field(default_factory=dict)
    # names for parts that would be nested too deeply; None: they stay nested
    names: Iterator[str] | None = None
    parts: list[tuple[str, Operation]] = field(default_factory=list)  # those, by name

    def operation(self, expression: sp.Expr) -> Operation:
        if expression.is_Symbol:
            return Operation("symbol", of=expression, ready=self.ready.get(expression, 0))
        if expression.is_Number or expression is sp.pi:
            return Operation("number", of=expression)
        if expression.is_Add:
            return self._sum(expression)
        if expression.is_Mul:
            return self._product(expression)
        if expression.is_Pow:
            return self._power(expression)
        return self._function(expression)

    def _function(self, expression: sp.Expr) -> Operation:
        if isinstance(expression, Frozen):
            return self.operation(expression.args[0])
        if isinstance(expression, Component):
            results, place = expression.args
            ready = self.ready.get(results, 0)
            return Operation("component", (self.operation(results),), int(place), ready)
        if isinstance(expression, Iterated):
            block, *given = expression.args
            return _after("iterate", *map(self.operation, given), of=block.name)
        kind = "selection" if isinstance(expression, SELECTIONS) else "function"
        return _after(kind, *map(self.operation, expression.args), of=type(expression))

    def _sum(self, expression: sp.Expr) -> Operation:
        """Add the terms that are known first; subtract instead of putting a sign in front."""
        terms = [
            (self.operation(magnitude), negative)  # positive ones first
            for negative, magnitude in sorted(map(_signed, expression.args), key=itemgetter(0))
        ]
        if all(negative for _, negative in terms):  # the first term has time for the sign
            first = min(range(len(terms)), key=lambda i: terms[i][0].ready)
            terms[first] = _after("negate", terms[first][0]), False
        total, _ = _join(terms, self._added)
        return total

    def _added(
        self, one: tuple[Operation, bool], two: tuple[Operation, bool]
    ) -> tuple[Operation, bool]:
        total, negative = _add(one, two)
        return self._shallow(total), negative

    def _multiplied(self, one: Operation, two: Operation) -> Operation:
        return self._shallow(_after("multiply", one, two))

    def _shallow(self, operation: Operation) -> Operation:
        """Return an operation, or a name for it where it is too deep."""
        if self.names is None or operation.depth < _DEEPEST:
            return operation
        name = next(self.names)
        self.parts.append((name, operation))
        return Operation("symbol", of=sp.Symbol(name), ready=operation.ready)

    def _product(self, expression: sp.Expr) -> Operation:
        negative, magnitude = _signed(expression)
        if negative:
            return _after("negate", self.operation(magnitude))
        coefficient, factors = magnitude.as_coeff_mul()
        above = [self.operation(f) for f in factors if not _is_reciprocal(f)]
        below = [self.operation(1 / f) for f in factors if _is_reciprocal(f)]
        if coefficient != 1:
            above.insert(0, self.operation(coefficient))
        if not below:
            return _join(above, self._multiplied)
        dividend = _join(above, self._multiplied) if above else _ONE
        return _after("divide", dividend, _join(below, self._multiplied))

    def _power(self, expression: sp.Expr) -> Operation:
        base, exponent = expression.base, expression.exp
        if exponent.is_negative:
            return _after("divide", _ONE, self.operation(1 / expression))
        whole, half = divmod(exponent, 1)
        if half not in (0, sp.Rational(1, 2)) or whole > 4:
            message = f"the power {expression} has no product of roots and factors"
            raise ValueError(message)
        factor = self.operation(base)
        factors = [factor] * int(whole)
        if half:
            factors.append(_after("root", factor))
        return _join(factors, self._multiplied)


_ONE = Operation("number", of=sp.Integer(1))


def _after(kind: str, *operands: Operation, of: Any = None) -> Operation:
    """Return an operation that starts when its operands are known."""
    start = max([operand.ready for operand in operands], default=0)
    depth = max([operand.depth for operand in operands], default=0)
    return Operation(kind, operands, of, start + _LATENCY[kind], depth + 1)


def _join(parts: Sequence[T], together: Callable[[T, T], T]) -> T:
    """Combine parts, always the two that are known first; equals in their order."""
    waiting = [(_ready(part), place, part) for place, part in enumerate(parts)]
    heapq.heapify(waiting)
    places = count(len(waiting))
    while len(waiting) > 1:
        (_, _, first), (_, _, second) = heapq.heappop(waiting), heapq.heappop(waiting)
        joined = together(first, second)
        heapq.heappush(waiting, (_ready(joined), next(places), joined))
    return waiting[0][2]


def _ready(part: Operation | tuple[Operation, bool]) -> int:
    return part.ready if isinstance(part, Operation) else part[0].ready


def _add(one: tuple[Operation, bool], two: tuple[Operation, bool]) -> tuple[Operation, bool]:
    """Add two terms, each with whether it is negative; only a sum of two negatives stays so."""
    if one[1] and not two[1]:
        one, two = two, one
    (first, negative), (second, subtract) = one, two
    kind = "subtract" if subtract and not negative else "add"
    return _after(kind, first, second), negative


def _signed(term: sp.Expr) -> tuple[bool, sp.Expr]:
    """Split a term into (is negative, magnitude)."""
    negative = bool(term.as_coeff_Mul()[0].is_negative)
    return negative, -term if negative else term


def _is_reciprocal(factor: sp.Expr) -> bool:
    return bool(factor.is_Pow and factor.exp.is_negative)
