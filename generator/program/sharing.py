"""Which steps are emitted: none that is not read, and what is common but once."""

from __future__ import annotations

from operator import attrgetter
from typing import TYPE_CHECKING

import sympy as sp
from sympy.simplify.cse_main import opt_cse

from .steps import Step
from .symbols import symbols_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator


def drop_dead(steps: list[Step], results: list[sp.Expr]) -> tuple[list[Step], list[sp.Expr]]:
    """Remove the steps that no result depends on.

    Parameters
    ----------
    steps, results
        The steps in their order, and the results.
    """
    wanted = set().union(*map(symbols_of, results))
    alive = []
    for step in reversed(steps):
        if step.symbol in wanted:
            alive.append(step)
            wanted |= symbols_of(step.expression)
    return alive[::-1], results


def share(
    steps: list[Step], results: list[sp.Expr], names: Iterator[sp.Symbol]
) -> tuple[list[Step], list[sp.Expr]]:
    """Name the common subexpressions of the whole program.

    Parameters
    ----------
    steps, results
        The steps in their order, and the results.
    names
        Of what is shared.
    """
    expressions = [*(s.expression for s in steps), *results]
    common = _Common(expressions, names)
    reduced = [common.named(e) for e in expressions]
    waiting = common.definitions
    owner: dict[sp.Symbol, sp.Symbol] = {}
    shared: list[Step] = []

    def place(expression: sp.Expr, section: str) -> None:
        for symbol in sorted(symbols_of(expression) & waiting.keys(), key=attrgetter("name")):
            if symbol in waiting:  # not placed meanwhile, with one that comes before it
                definition = waiting.pop(symbol)
                place(definition, section)
                shared.append(Step(symbol, definition, section))

    for step, expression in zip(steps, reduced, strict=False):
        if expression in waiting:  # a whole step is shared: it keeps its own name
            definition = waiting.pop(expression)
            place(definition, step.section)
            owner[expression] = step.symbol
            shared.append(Step(step.symbol, definition, step.section))
        else:
            place(expression, step.section)
            shared.append(Step(step.symbol, expression, step.section))
    results = list(reduced[len(steps) :])
    for result in results:
        place(result, "results")
    renamed = [Step(s.symbol, s.expression.xreplace(owner), s.section) for s in shared]
    return renamed, [r.xreplace(owner) for r in results]


class _Common:
    """What several expressions have in common.

    The names, and what they represent, are those of SymPy's ``cse``. That takes every expression
    apart, sorts what it consists of, and puts it together again; most have nothing in common with
    others, and stay as they are here.

    Parameters
    ----------
    expressions
        All of them, in order.
    names
        Of what they have in common.

    Attributes
    ----------
    definitions
        What each name represents, in terms of names before it.
    """

    def __init__(self, expressions: Iterable[sp.Expr], names: Iterator[sp.Symbol]) -> None:
        expressions = list(expressions)
        self.definitions: dict[sp.Symbol, sp.Expr] = {}
        self._names = names
        self._named: dict[sp.Expr, sp.Symbol] = {}
        # sums and products in which parts of others stand together
        self._regrouped = opt_cse(expressions)
        self._seen: set[sp.Expr] = set()
        self._repeated: set[sp.Expr] = set()
        self._changes: dict[sp.Expr, bool] = {}
        for expression in expressions:
            self._look_at(expression)

    def named(self, expression: sp.Expr) -> sp.Expr:
        """Return an expression with names for what it has in common with others."""
        if expression in self._named:
            return self._named[expression]
        settled = isinstance(expression, sp.Basic)  # what is regrouped is not put together yet
        if not self._parts(expression) or (settled and not self._is_changed(expression)):
            return expression
        grouped = self._regrouped.get(expression, expression)
        result = grouped.func(*map(self.named, self._in_order(grouped)))
        if expression not in self._repeated:
            return result
        name = self._named[expression] = next(self._names)
        self.definitions[name] = result
        return name

    def _look_at(self, expression: sp.Expr) -> None:
        """Note what comes for the second time."""
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
        """Return what an expression consists of; the exponent of what is regrouped is an int."""
        return tuple(getattr(self._regrouped.get(expression, expression), "args", ()))

    def _is_changed(self, expression: sp.Expr) -> bool:
        """Return whether an expression is repeated, or has something in it that is."""
        if expression not in self._changes:
            self._changes[expression] = expression in self._repeated or any(
                map(self._is_changed, self._parts(expression))
            )
        return self._changes[expression]

    def _in_order(self, expression: sp.Expr) -> Iterable[sp.Expr]:
        """Return the parts of an expression, so that names do not depend on hashes."""
        parts: Iterable[sp.Expr] = expression.args
        if not isinstance(expression, sp.Add | sp.Mul):
            return parts
        several = sum(map(self._is_changed, parts)) > 1
        return sp.ordered(parts) if several else parts
