"""The schedule of what is emitted; what the functions of a stage have in common comes once.

Each function of a stage has a program of its own, and the order of its operations. Equal operations
on equal operands are found by numbering values, so that nothing is put together in another order:
every result is the same to the last bit as if its function stood alone.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from itertools import count
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import sympy as sp

from .schedule import Assignment, Operation, Schedule, ordered

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterable

    from ..program.function import Function, Stage

_schedules: WeakKeyDictionary[Function | Stage, Schedule] = WeakKeyDictionary()

_COMMUTATIVE = ("add", "multiply")
_LEAVES = ("symbol", "number")
_LOCAL = "shared_"
"""How names begin that say nothing: those of common subexpressions."""


def scheduled(emitted: Function | Stage) -> Schedule:
    """Return the operations of what is emitted; they are put in order once."""
    if emitted not in _schedules:
        orders = [ordered(function) for function in emitted.members]
        read = {symbol.name for symbol in emitted.free_symbols}
        _schedules[emitted] = orders[0] if len(orders) == 1 else _Values(read).merged(orders)
    return _schedules[emitted]


@dataclass
class _Values:
    """The values of several schedules, each with a number.

    Attributes
    ----------
    taken
        Names that no value may have.
    found
        Numbers, by operation and the numbers of its operands.
    operations
        Each with the numbers of its operands, in the order of numbers.
    named
        The name of a value, and the part of the derivation where it first has one.
    """

    taken: set[str]
    found: dict[Hashable, int] = field(default_factory=dict)
    operations: list[tuple[Operation, tuple[int, ...]]] = field(default_factory=list)
    named: dict[int, str] = field(default_factory=dict)

    def merged(self, orders: Iterable[Schedule]) -> Schedule:
        """Return one schedule: the steps of all, and the results one behind the other."""
        steps: list[tuple[int, str]] = []
        results: list[int] = []
        for order in orders:
            values: dict[str, int] = {}
            for step in order.steps:
                value = values[step.name] = self._number(step.value, values)
                steps.append((value, step.section))
                if not step.name.startswith(_LOCAL) and self.operations[value][0].operands:
                    self._name(value, step.name)
            results += [self._number(result, values) for result in order.results]
        self._name_repeated(results)
        return self._written(steps, results)

    def _number(self, operation: Operation, values: dict[str, int]) -> int:
        """Return the number of a value; a name of a step is that of the value it has."""
        if operation.kind == "symbol" and operation.of.name in values:
            return values[operation.of.name]
        operands = tuple(self._number(operand, values) for operand in operation.operands)
        ordered_ = tuple(sorted(operands)) if operation.kind in _COMMUTATIVE else operands
        key = (operation.kind, operation.of, ordered_)
        if key not in self.found:
            self.found[key] = len(self.operations)
            self.operations.append((operation, operands))
        return self.found[key]

    def _name(self, value: int, name: str) -> None:
        if value not in self.named:
            names = (name, *(f"{name}_{i}" for i in range(2, 100)))
            self.named[value] = next(n for n in names if n not in self.taken)
            self.taken.add(self.named[value])

    def _name_repeated(self, results: Iterable[int]) -> None:
        """Give names to what is read more than once and has none."""
        uses = Counter(results)
        for _, operands in self.operations:
            uses.update(set(operands))
        numbers = count(1)
        for value, (operation, _) in enumerate(self.operations):
            if uses[value] > 1 and operation.kind not in _LEAVES and value not in self.named:
                self._name(
                    value, next(n for i in numbers if (n := f"{_LOCAL}{i}") not in self.taken)
                )

    def _written(self, steps: Iterable[tuple[int, str]], results: Iterable[int]) -> Schedule:
        assignments: dict[int, Assignment] = {}

        def place(value: int, section: str) -> Operation:
            """Return what stands for a value, and put what has names before it."""
            operation, operands = self.operations[value]
            name = self.named.get(value)
            if value not in assignments and operation.kind not in _LEAVES:
                parts = tuple(place(operand, section) for operand in operands)
                operation = Operation(operation.kind, parts, operation.of, operation.ready)
                if name is not None:
                    assignments[value] = Assignment(name, operation, section)
            if name is None:
                return operation
            return Operation("symbol", of=sp.Symbol(name), ready=operation.ready)

        for value, section in steps:
            if value in self.named:
                place(value, section)
        finals = tuple(place(value, "results") for value in results)
        return Schedule(tuple(assignments.values()), finals)
