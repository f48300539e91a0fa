"""Which steps are emitted: none that is not read, and what is common but once."""

from __future__ import annotations

from operator import attrgetter
from typing import TYPE_CHECKING

import sympy as sp

from .steps import Step
from .symbols import symbols_of

if TYPE_CHECKING:
    from collections.abc import Iterator


def drop_dead(steps: list[Step], results: list[sp.Expr]) -> tuple[list[Step], list[sp.Expr]]:
    """Remove the steps that no result depends on."""
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
    """Name the common subexpressions of the whole program (SymPy's ``cse``)."""
    replacements, reduced = sp.cse(
        [*(s.expression for s in steps), *results],
        symbols=names,
        order="canonical",
        list=True,
    )
    waiting = dict(replacements)
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
