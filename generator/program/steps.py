"""Steps of a program, the guards among them, and the steps that a result depends on."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain, count
from typing import TYPE_CHECKING

import sympy as sp

from .symbols import symbols_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping


@dataclass(frozen=True)
class Step:
    """One assignment of the program."""

    symbol: sp.Symbol
    expression: sp.Expr
    section: str


@dataclass(frozen=True)
class Guard:
    """A quantity that must exceed a floor, its unit, and the cause of a value below it.

    The floor is a constant, or a number; see `floors`. A guard of steps that are repeated for given
    coordinates (`Program.substitute`) has the quantity that was repeated as `original`.
    """

    quantity: sp.Symbol
    name: str
    meaning: str
    unit: str
    floor: sp.Expr
    original: sp.Symbol | None = None

    @property
    def margin(self) -> sp.Expr:
        """The quantity at the state less its floor: positive where the model is valid."""
        return (self.original or self.quantity) - self.floor


def first_free(name: str, taken: Callable[[str], bool]) -> sp.Symbol:
    """Return the symbol of a name, with a number added if `taken` returns that it is taken."""
    names = chain([name], (f"{name}_{i}" for i in count(2)))
    return sp.Symbol(next(n for n in names if not taken(n)))


def ancestors(steps: Mapping[sp.Symbol, Step], expressions: Iterable[sp.Expr]) -> set[sp.Symbol]:
    """Return the symbols of the steps that some expressions depend on."""
    waiting = [s for e in expressions for s in symbols_of(e) if s in steps]
    found: set[sp.Symbol] = set()
    while waiting:
        symbol = waiting.pop()
        if symbol not in found:
            found.add(symbol)
            waiting += [s for s in symbols_of(steps[symbol].expression) if s in steps]
    return found
