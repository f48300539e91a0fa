"""The steps that are emitted: without those that are not read, with common parts only once."""

from __future__ import annotations

from operator import attrgetter
from typing import TYPE_CHECKING

import sympy as sp

from .composing import composed
from .orders import by_size
from .regrouping import regrouped
from .steps import Step
from .symbols import symbols_of, with_symbols

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator


def drop_dead(steps: list[Step], results: Iterable[sp.Expr]) -> list[Step]:
    """Return the steps that some results depend on, in order."""
    wanted = set().union(*map(symbols_of, results))
    alive = []
    for step in reversed(steps):
        if step.symbol in wanted:
            alive.append(step)
            wanted |= symbols_of(step.expression)
    return alive[::-1]


def share(
    steps: list[Step], results: list[sp.Expr], names: Iterator[sp.Symbol]
) -> tuple[list[Step], list[sp.Expr]]:
    """Return steps and results in which every common subexpression is a step with a new name."""
    expressions = [*(s.expression for s in steps), *results]
    common = _Common(expressions, names)
    reduced = [common.named(e) for e in expressions]
    waiting = common.definitions
    owner: dict[sp.Symbol, sp.Symbol] = {}
    shared: list[Step] = []
    for step, expression in zip(steps, reduced, strict=False):
        if expression in waiting:  # a whole step is shared: it keeps its own name
            definition = waiting.pop(expression)
            _place(definition, step.section, waiting, shared)
            owner[expression] = step.symbol
            shared.append(Step(step.symbol, definition, step.section))
        else:
            _place(expression, step.section, waiting, shared)
            shared.append(Step(step.symbol, expression, step.section))
    results = list(reduced[len(steps) :])
    for result in results:
        _place(result, "results", waiting, shared)
    renamed = [Step(s.symbol, with_symbols(s.expression, owner), s.section) for s in shared]
    return renamed, [with_symbols(r, owner) for r in results]


def _place(
    expression: sp.Expr, section: str, waiting: dict[sp.Symbol, sp.Expr], shared: list[Step]
) -> None:
    """Add the steps that an expression reads, and that wait for their first reader."""
    for symbol in sorted(symbols_of(expression) & waiting.keys(), key=attrgetter("name")):
        if symbol in waiting:  # not placed meanwhile, with an earlier one
            definition = waiting.pop(symbol)
            _place(definition, section, waiting, shared)
            shared.append(Step(symbol, definition, section))


class _Common:
    """The common subexpressions of several expressions.

    The names, and the order, are those of SymPy's ``cse``, which takes every expression apart,
    sorts its parts, and composes it again; here, expressions without common parts stay as they are.
    `definitions` has the expression of each name, in terms of names before it.
    """

    def __init__(self, expressions: Iterable[sp.Expr], names: Iterator[sp.Symbol]) -> None:
        expressions = list(expressions)
        self.definitions: dict[sp.Symbol, sp.Expr] = {}
        self._names = names
        self._named: dict[sp.Expr, sp.Symbol] = {}
        # sums and products in which parts of others are grouped
        self._regrouped = regrouped(expressions)
        self._seen: set[sp.Expr] = set()
        self._repeated: set[sp.Expr] = set()
        self._changes: dict[sp.Expr, bool] = {}
        for expression in expressions:
            self._look_at(expression)

    def named(self, expression: sp.Expr) -> sp.Expr:
        """Return an expression with names for its common parts."""
        if expression in self._named:
            return self._named[expression]
        settled = isinstance(expression, sp.Basic)  # a regrouped one is not composed yet
        if not self._parts(expression) or (settled and not self._is_changed(expression)):
            return expression
        grouped = self._regrouped.get(expression, expression)
        result = composed(grouped.func, map(self.named, self._in_order(grouped)))
        if expression not in self._repeated:
            return result
        name = self._named[expression] = next(self._names)
        self.definitions[name] = result
        return name

    def _look_at(self, expression: sp.Expr) -> None:
        """Note the parts that occur a second time."""
        parts = self._parts(expression)
        if not parts:
            return
        if expression in self._seen:
            self._repeated.add(expression)
            return
        self._seen.add(expression)
        for part in parts:
            self._look_at(part)

    def _parts(self, expression: sp.Expr) -> tuple[sp.Expr, ...]:
        """Return the parts of an expression; the exponent of a regrouped one is an int."""
        return tuple(getattr(self._regrouped.get(expression, expression), "args", ()))

    def _is_changed(self, expression: sp.Expr) -> bool:
        """Return whether an expression, or a part of it, is repeated."""
        if expression not in self._changes:
            self._changes[expression] = expression in self._repeated or any(
                map(self._is_changed, self._parts(expression))
            )
        return self._changes[expression]

    def _in_order(self, expression: sp.Expr) -> Iterable[sp.Expr]:
        """Return the parts of an expression, in an order that does not depend on hashes."""
        parts: Iterable[sp.Expr] = expression.args
        if not isinstance(expression, sp.Add | sp.Mul):
            return parts
        several = sum(map(self._is_changed, parts)) > 1
        return by_size(parts) if several else parts
