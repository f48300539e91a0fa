"""Derivatives of a whole function: along a direction, and of a weighted sum of its results.

Both are functions again: straight-line, without branches, with the guards of the original function.
They follow its steps as emitted, and so are the derivatives of the values that it computes.

A *tangent* (forward mode) reads a direction, the rate of each symbol that the function reads, and
returns the rates of its results. An *adjoint* (reverse mode) reads a weight for each result, and
returns the derivatives of the weighted sum with respect to all symbols that the function reads. It
passes the steps once, from the last to the first, and costs a few evaluations of the function.

Source: A. Griewank and A. Walther, Evaluating Derivatives, second edition, SIAM, 2008.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import sympy as sp

from .derivatives import chain_rule, partials
from .functions import Iterated
from .sharing import drop_dead
from .steps import Step, first_free
from .symbols import symbols_of
from .together import share_together

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from .function import Function

TANGENT, ADJOINT = "tangent", "adjoint"
"""Ends of the names of such functions."""


def tangent(function: Function, direction: Mapping[sp.Symbol, sp.Symbol], doc: str) -> Function:
    """Return the derivative of the results of a function along a direction.

    `direction` has the symbol of the derivative of each symbol that is read; `doc` is the
    docstring, of one line.
    """
    known = _Names(function, direction.values())
    along: dict[sp.Symbol, sp.Expr] = {s: direction[s] for s in function.free_symbols}
    steps = []
    for step in function.steps:
        steps.append(step)
        derivative = chain_rule(step.expression, along, step.symbol)
        if derivative.is_Atom or (-derivative).is_Symbol:
            along |= {step.symbol: derivative} if derivative != 0 else {}
        else:
            along[step.symbol] = known.free(f"d_{step.symbol}")
            steps.append(Step(along[step.symbol], derivative, step.section))
    results = tuple(chain_rule(result, along) for result in function.results)
    return written(replace(function, name=f"{function.name}_{TANGENT}", doc=doc), steps, results)


def adjoint(
    function: Function, by: Sequence[sp.Symbol], weights: Sequence[sp.Symbol], doc: str
) -> Function:
    """Return the derivatives of a weighted sum of the results of a function.

    They are with respect to the symbols `by`, in the order of the results; `doc` is the docstring,
    of one line.
    """
    known = _Names(function, weights)
    active = set(by)
    shares: dict[sp.Symbol, list[sp.Expr]] = {symbol: [] for symbol in by}
    for step in function.steps:
        if not active.isdisjoint(symbols_of(step.expression)):
            active.add(step.symbol)
            shares[step.symbol] = []
    for result, weight in zip(function.results, weights, strict=True):
        for symbol, partial in partials(result, active):
            shares[symbol].append(weight * partial)
    steps = list(function.steps)
    for step in reversed([s for s in function.steps if s.symbol in active]):
        total = sp.Add(*shares[step.symbol])
        if not (total.is_Atom or (-total).is_Symbol):
            name = known.free(f"by_{step.symbol}")
            steps.append(Step(name, total, f"backwards: {step.section}"))
            total = name
        if total != 0:
            for symbol, partial in partials(step.expression, active, step.symbol):
                shares[symbol].append(total * partial)
    results = tuple(sp.Add(*shares[symbol]) for symbol in by)
    changed = replace(
        function,
        name=f"{function.name}_{ADJOINT}",
        doc=doc,
        labels=tuple(map(str, by)),
        shape=(len(results),),
    )
    return written(changed, steps, results)


class _Names:
    """Names for the steps of a derivative, distinct from all others in it."""

    def __init__(self, function: Function, more: Iterable[sp.Symbol]) -> None:
        known = function.free_symbols.union(more, (step.symbol for step in function.steps))
        self._taken = {symbol.name for symbol in known}

    def free(self, name: str) -> sp.Symbol:
        """Return a symbol of a name, with a number added where it is taken."""
        symbol = first_free(name, self._taken.__contains__)
        self._taken.add(symbol.name)
        return symbol


def written(function: Function, steps: list[Step], results: tuple[sp.Expr, ...]) -> Function:
    """Return a function with new results and the steps that they need; its guards stay the same."""
    kept = (*results, *(guard.quantity for guard in function.guards))
    alive = drop_dead(steps, kept)
    called = {s.expression.args[0].name for s in alive if isinstance(s.expression, Iterated)}
    blocks = tuple(block for block in function.blocks if block.name in called)
    pruned = replace(function, steps=tuple(alive), results=kept, blocks=blocks)
    read = {symbol.name for symbol in pruned.free_symbols}
    (shared,), _ = share_together({"": [pruned]}, [s.symbol for s in alive], read.__contains__)
    return replace(shared, results=shared.results[: len(results)])
