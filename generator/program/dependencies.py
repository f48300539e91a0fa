"""Dependencies between the steps of a program, by which a derivative finds the steps it needs."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    import sympy as sp

_KEPT = 8  # sets of targets: all columns of a Jacobian have the same targets


class Dependencies:
    """The symbols that each step of a program reads, and the steps that read each symbol.

    Every symbol has a number. A step is added after the steps that it reads, so that the numbers
    of steps have their order, and the dependencies of a step never change.
    """

    def __init__(self) -> None:
        self._numbers: dict[sp.Symbol, int] = {}
        self._symbols: list[sp.Symbol] = []
        self._reads: list[list[int]] = []
        self._readers: list[list[int]] = []
        self._behind = lru_cache(maxsize=_KEPT)(self._all_behind)

    def add(self, symbol: sp.Symbol, read: Iterable[sp.Symbol]) -> None:
        """Add a step that reads some symbols."""
        reads = [self._number(s) for s in read]
        number = self._number(symbol)
        self._reads[number] = reads
        for other in reads:
            self._readers[other].append(number)

    def changing(
        self,
        moving: Iterable[sp.Symbol],
        targets: Iterable[sp.Symbol],
        instead: Mapping[sp.Symbol, Collection[sp.Symbol]],
    ) -> list[sp.Symbol]:
        """Return the steps that change with some symbols and that targets depend on, in order.

        The own steps of the `moving` symbols do not count; `instead` are symbols that some steps
        depend on, instead of those that they read.
        """
        given = self._known(moving)
        ends = self._known(targets)
        reads = {self._number(s): self._known(others) for s, others in instead.items()}
        behind = self._behind(ends)
        changed, waiting = set[int](), list(given)
        while waiting:
            for reader in self._readers[waiting.pop()]:
                if reader in behind and reader not in changed and reader not in given:
                    changed.add(reader)
                    waiting.append(reader)
        found, waiting = set[int](), [number for number in ends if number in changed]
        while waiting:
            number = waiting.pop()
            if number not in found:
                found.add(number)
                others = reads.get(number, self._reads[number])
                waiting += [other for other in others if other in changed]
        return [self._symbols[number] for number in sorted(found)]

    def _number(self, symbol: sp.Symbol) -> int:
        number = self._numbers.setdefault(symbol, len(self._symbols))
        if number == len(self._symbols):
            self._symbols.append(symbol)
            self._reads.append([])
            self._readers.append([])
        return number

    def _known(self, symbols: Iterable[sp.Symbol]) -> frozenset[int]:
        """Return the numbers of those symbols that a step reads or defines."""
        return frozenset(self._numbers[s] for s in symbols if s in self._numbers)

    def _all_behind(self, numbers: frozenset[int]) -> set[int]:
        """Return the numbers of some symbols, and of all symbols that these depend on."""
        found, waiting = set(numbers), list(numbers)
        while waiting:
            fresh = [n for n in self._reads[waiting.pop()] if n not in found]
            found.update(fresh)
            waiting += fresh
        return found
