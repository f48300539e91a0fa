"""Functions with one program, in which equal quantities are written in one way.

Each function alone would share its own common subexpressions and group sums and products by them:
the last bits of a quantity would then depend on the function.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import count
from typing import TYPE_CHECKING

import sympy as sp

from .sharing import drop_dead, share
from .signs import LOCAL, take_out_signs
from .steps import Step, first_free
from .symbols import symbols_of, with_symbols

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from .function import Function


def share_together(
    variants: Mapping[str, Sequence[Function]],
    order: Iterable[sp.Symbol],
    has: Callable[[str], bool],
) -> tuple[list[Function], list[str]]:
    """Share the common subexpressions of functions, in all of them alike.

    `variants` are pruned functions of one program, and of variants of it in which steps of the same
    name may differ, by the ends of the names of these steps; the end is empty for the program
    itself. `order` is that of the steps of the program; `has` returns whether a name is that of a
    constant, a state or an input. The functions of all variants are returned, concatenated, and the
    names of the steps of all of them, in the order of the program.
    """
    joined = _Joined(order, has)
    pruned = [joined.added(f, ending) for ending, group in variants.items() for f in group]
    steps = joined.in_order()
    taken = {step.symbol.name for step in steps}
    free = (n for i in count(1) if (n := f"{LOCAL}{i}") not in taken and not has(n))
    steps, results = share(steps, [r for f in pruned for r in f.results], map(sp.Symbol, free))
    guarded = {guard.quantity for function in pruned for guard in function.guards}
    steps, results = take_out_signs(steps, results, guarded.union(results), has)
    functions, start = [], 0
    for function in pruned:
        values = results[start : start + function.size]
        own = drop_dead(steps, values)
        functions.append(replace(function, steps=tuple(own), results=tuple(values)))
        start += function.size
    return functions, [step.symbol.name for step in steps]


class _Joined:
    """The steps of several functions, each once, in the order of the program that most are from."""

    def __init__(self, order: Iterable[sp.Symbol], has: Callable[[str], bool]) -> None:
        self._has = has
        self._order = {symbol: place for place, symbol in enumerate(order)}
        self._steps: dict[sp.Symbol, Step] = {}
        self._places: dict[sp.Symbol, int] = {}

    def added(self, function: Function, ending: str) -> Function:
        """Add the steps of a function; return it with the names that its steps have here."""
        names: dict[sp.Symbol, sp.Symbol] = {}
        for step in function.steps:
            expression = with_symbols(step.expression, names)
            symbol = self._named(step.symbol, expression, ending)
            if symbol != step.symbol:
                names[step.symbol] = symbol
            if symbol not in self._steps:
                self._steps[symbol] = Step(symbol, expression, step.section)
                before = (self._places.get(s, 0) for s in symbols_of(expression))
                self._places[symbol] = max(self._order.get(step.symbol, 0), 0, *before)
        guards = tuple(
            replace(guard, quantity=names.get(guard.quantity, guard.quantity))
            for guard in function.guards
        )
        results = tuple(with_symbols(result, names) for result in function.results)
        return replace(function, results=results, guards=guards)

    def _named(self, symbol: sp.Symbol, expression: sp.Expr, ending: str) -> sp.Symbol:
        """Return the symbol of a step: a new one where the name has another value elsewhere."""

        def is_another(name: str) -> bool:
            step = self._steps.get(sp.Symbol(name))
            return self._has(name) or (step is not None and step.expression != expression)

        if not is_another(symbol.name):
            return symbol
        return first_free(f"{symbol}_{ending}", is_another)

    def in_order(self) -> list[Step]:
        """Return the steps in the order of the program, each behind those that it reads."""
        return sorted(self._steps.values(), key=lambda step: self._places[step.symbol])
