"""Kinks and jumps of the right-hand side: a function that is emitted with its derivatives.

A stop that is touched, a tyre that leaves the road, a knot of a curve: each is where the argument
of a `Positive` or an `IsPositive` passes zero. An integration of derivatives along a motion ends
its steps there.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import chain
from typing import TYPE_CHECKING

import sympy as sp

from ..program.directions import written
from ..program.functions import IsPositive, Positive
from ..program.symbols import symbols_of

if TYPE_CHECKING:
    from collections.abc import Collection

    from ..program.function import Function

KINKS = "kinks"


def kinks_of(rhs: Function, moving: Collection[str]) -> Function | None:
    """Return the quantities that pass zero at kinks of the right-hand side; None without any.

    Quantities that depend on no `moving` element of the state are left out.
    """
    expressions = [*(step.expression for step in rhs.steps), *rhs.results]
    found = dict.fromkeys(chain.from_iterable(_arguments(e) for e in expressions))
    moved = _moved(rhs, moving)
    passed = [e for e in found if not moved.isdisjoint(symbols_of(e))]
    if not passed:
        return None
    unguarded = replace(
        rhs,
        name=KINKS,
        doc="Quantities that pass zero where the right-hand side has a kink, or jumps.",
        labels=tuple(f"{KINKS}_{i}" for i in range(len(passed))),
        shape=(len(passed),),
        guards=(),
    )
    return written(unguarded, list(rhs.steps), tuple(passed))


def _arguments(expression: sp.Expr) -> list[sp.Expr]:
    """Return the arguments that are compared with zero, in an order that is the same everywhere."""
    functions = expression.atoms(Positive, IsPositive)
    return sorted((function.args[0] for function in functions), key=sp.default_sort_key)


def _moved(rhs: Function, moving: Collection[str]) -> set[sp.Symbol]:
    """Return all symbols that depend on the state."""
    moved = set(map(sp.Symbol, moving))
    for step in rhs.steps:
        if not moved.isdisjoint(symbols_of(step.expression)):
            moved.add(step.symbol)
    return moved
