"""Steps of a program, the guards among them, and which steps a result depends on."""

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
    """A quantity that must be over a floor, its unit, and what it means when it is not.

    The floor is a constant, or a number; see `conditioning`.
    """

    quantity: sp.Symbol
    name: str
    meaning: str
    unit: str
    floor: sp.Expr

    @property
    def margin(self) -> sp.Expr:
        """How far the quantity is over its floor: positive where the model is valid."""
        return self.quantity - self.floor


def first_free(name: str, taken: Callable[[str], bool]) -> sp.Symbol:
    """Return the symbol of a name, with a number behind it if the name is taken.

    Parameters
    ----------
    name
        The name.
    taken
        Returns whether a name is taken.
    """
    names = chain([name], (f"{name}_{i}" for i in count(2)))
    return sp.Symbol(next(n for n in names if not taken(n)))


def ancestors(steps: Mapping[sp.Symbol, Step], expressions: Iterable[sp.Expr]) -> set[sp.Symbol]:
    """Return the steps that some expressions depend on.

    Parameters
    ----------
    steps
        By their symbols.
    expressions
        In these symbols.
    """
    waiting = [s for e in expressions for s in symbols_of(e) if s in steps]
    found: set[sp.Symbol] = set()
    while waiting:
        symbol = waiting.pop()
        if symbol not in found:
            found.add(symbol)
            waiting += [s for s in symbols_of(steps[symbol].expression) if s in steps]
    return found
