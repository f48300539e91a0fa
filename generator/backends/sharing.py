"""The schedule of emitted code, with the common steps of several functions once.

Each function has a program of its own, and the order of its operations. Equal operations on equal
operands are found by numbering values, so that no order changes: every result is the same to the
last bit as if its function were alone.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from itertools import chain, count
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import sympy as sp

from ..program.functions import Guarded
from ..program.signs import LOCAL
from .schedule import Assignment, Operation, Schedule, ordered

if TYPE_CHECKING:
    from collections.abc import Container, Hashable, Iterable, Iterator, Mapping, Sequence

    from ..program.function import Function, Stage

_found: WeakKeyDictionary[Function | Stage, tuple[Schedule, dict[str, str]]] = WeakKeyDictionary()

_COMMUTATIVE = ("add", "multiply")
# Between the name of a step and the number of a part of it.
_PART = "_part_"
_LEAVES = ("symbol", "number")
_SPOKEN = {
    "add": "plus", "subtract": "less", "multiply": "times", "divide": "over", "negate": "minus",
    "root": "root",
}  # fmt: skip
# Longest name in the words of a formula; otherwise a value is named as a part of its reader.
_LONGEST = 36


def scheduled(emitted: Function | Stage) -> Schedule:
    """Return the operations of a function or stage, in an order that is found once."""
    return _scheduled(emitted)[0]


def names_in(emitted: Function | Stage) -> dict[str, str]:
    """Return the names of a program's steps in its schedule; equal ones share the first name."""
    return _scheduled(emitted)[1]


def _scheduled(emitted: Function | Stage) -> tuple[Schedule, dict[str, str]]:
    if emitted not in _found:
        values = _Values.of([emitted])
        _found[emitted] = values.schedule, values.names_in(emitted)
    return _found[emitted]


@dataclass(frozen=True)
class OwnSteps:
    """Steps of one of several functions beside the common ones."""

    reads: frozenset[str]  # names of arguments that only some functions have, and this one reads
    steps: tuple[Assignment, ...]  # those that depend on them
    results: tuple[Operation, ...]
    names: Mapping[str, str]  # names here of the steps of its own program


@dataclass(frozen=True)
class Together:
    """Several functions with every step once."""

    reads: frozenset[str]  # names of arguments that all functions have, and one of them reads
    steps: tuple[Assignment, ...]  # steps of all functions
    parts: tuple[OwnSteps, ...]  # further steps of each function

    @property
    def names(self) -> set[str]:
        """All names in them."""
        steps = (self.steps, *(part.steps for part in self.parts))
        taken = {step.name for group in steps for step in group}
        return taken.union(self.reads, *(part.reads for part in self.parts))


def together(
    functions: Sequence[Function | Stage], order: Mapping[str, int], own: Container[str]
) -> Together:
    """Write functions with every step once.

    `order` has the positions of the steps by their names, `own` the names of arguments that only
    some functions have.
    """
    values = _Values.of(functions, order)
    reading = {step.name: {*symbols_in(step.value)} for step in values.schedule.steps}
    needed: dict[str, set[str]] = {}
    for name, read in reading.items():
        needed[name] = {n for n in read if n in own}.union(*(needed.get(n, ()) for n in read))
    parts, start = [], 0
    for function in functions:
        reads = frozenset(s.name for s in function.free_symbols if s.name in own)
        results = values.schedule.results[start : start + function.size]
        names = values.names_in(function)
        guarded = (names.get(g.quantity.name, g.quantity.name) for g in function.guards)
        alive = _behind([*chain(*map(symbols_in, results)), *guarded], reading)
        steps = tuple(s for s in values.schedule.steps if needed[s.name] and s.name in alive)
        parts.append(OwnSteps(reads, steps, results, names))
        start += function.size
    all_read = {s.name for function in functions for s in function.free_symbols}
    return Together(
        frozenset(name for name in all_read if name not in own),
        tuple(step for step in values.schedule.steps if not needed[step.name]),
        tuple(parts),
    )


def _behind(names: Iterable[str], reading: Mapping[str, Iterable[str]]) -> set[str]:
    """Return names, and the names of all values that they depend on."""
    waiting, found = [*names], set[str]()
    while waiting:
        name = waiting.pop()
        if name not in found:
            found.add(name)
            waiting += reading.get(name, ())
    return found


def alive_in(function: Function | Stage, part: OwnSteps, steps: Iterable[Assignment]) -> set[str]:
    """Return the names that a function of several needs for its results and guards."""
    guarded = (part.names.get(g.quantity.name, g.quantity.name) for g in function.guards)
    reading = {step.name: {*symbols_in(step.value)} for step in steps}
    return _behind([*chain(*map(symbols_in, part.results)), *guarded], reading)


def symbols_in(operation: Operation) -> Iterator[str]:
    """Yield the names of the symbols in an operation."""
    waiting = [operation]
    while waiting:
        part = waiting.pop()
        waiting += part.operands
        if part.kind == "symbol":
            yield part.of.name


def _short_formula(kind: str, parts: Sequence[Operation], of: Any) -> str:
    """Return a name for an operation on one or two symbols, in words; empty where it is long."""
    names = [part.of.name if part.kind == "symbol" else "" for part in parts]
    if any(_PART in name for name in names):
        return ""  # the name of the reader of a part is more meaningful than that of the part
    if kind == "divide" and parts[0].kind == "number" and parts[0].of == 1:
        found = f"{names[1]}_inverse" if names[1] else ""
    elif kind == "selection" and of is Guarded:
        found = f"{names[0]}_guarded" if names[0] else ""
    elif not all(names):
        found = ""
    elif kind == "function":
        found = "_".join([of.__name__.lower(), *names])
    elif kind == "multiply" and names[0] == names[1]:
        found = f"{names[0]}_squared"
    elif kind in _SPOKEN:
        found = "_".join([*names[:-1], _SPOKEN[kind], names[-1]])
    else:
        found = ""
    return found if len(found) <= _LONGEST else ""


@dataclass
class _Written:
    """Values as far as they are assigned, by their numbers."""

    repeated: set[int]  # those with several readers
    owners: dict[int, str]  # first readers of those without a name
    assignments: dict[int, Assignment] = field(default_factory=dict)
    by_name: dict[int, Operation] = field(default_factory=dict)


@dataclass
class _Values:
    """The values of several functions, each with a number."""

    taken: set[str]  # names that no value may have
    several: bool  # functions
    # numbers, by operation and the numbers of its operands
    found: dict[Hashable, int] = field(default_factory=dict)
    # each with the numbers of its operands, in the order of numbers
    operations: list[tuple[Operation, tuple[int, ...]]] = field(default_factory=list)
    named: dict[int, str] = field(default_factory=dict)  # names of values that have one
    # numbers of the steps of each function, by their names
    steps: dict[Function, dict[str, int]] = field(default_factory=dict)
    parts: dict[str, Iterator[int]] = field(default_factory=dict)
    # names that a step reads with their numbers, and its number, by the id of its value
    known: dict[int, tuple[tuple[tuple[str, int | None], ...], int]] = field(default_factory=dict)
    # steps of all, and the results of one behind those of the other
    schedule: Schedule = field(init=False)

    @classmethod
    def of(
        cls, functions: Iterable[Function | Stage], order: Mapping[str, int] | None = None
    ) -> _Values:
        """Return the numbered values of functions, with their steps in order."""
        members = [member for function in functions for member in function.members]
        taken = {s.name for member in members for s in member.free_symbols}
        values = cls(taken, several=len(members) > 1)
        steps: list[tuple[int, Assignment]] = []
        results: list[int] = []
        for member in members:
            values._add(member, steps, results)
        if order:
            steps.sort(key=lambda step: order.get(step[1].within or step[1].name, len(order)))
        sources = [member.name for member in members for _ in range(member.size)]
        values.schedule = values._written(steps, results, sources)
        return values

    def names_in(self, function: Function | Stage) -> dict[str, str]:
        """Return the names of the steps of a function; equal ones have that of the first."""
        numbers: dict[str, int] = {}
        for member in function.members:
            numbers = self.steps[member] | numbers
        return {name: self.named[n] for name, n in numbers.items() if n in self.named}

    def _add(
        self, function: Function, steps: list[tuple[int, Assignment]], results: list[int]
    ) -> None:
        order, values = ordered(function), self.steps.setdefault(function, {})
        for step in order.steps:
            value = values[step.name] = self._of_step(step, values)
            steps.append((value, step))
            if not step.name.startswith(LOCAL) and self.operations[value][0].operands:
                self._name(value, step.name)
        results += [self._number(result, values) for result in order.results]

    def _of_step(self, step: Assignment, values: dict[str, int]) -> int:
        """Return the number of a step, which other functions may have with equal operands."""
        if not self.several:
            return self._number(step.value, values)
        reads, number = self.known.get(id(step.value), ((), -1))
        if number < 0 or any(values.get(name) != operand for name, operand in reads):
            number = self._number(step.value, values)
            reads = tuple([(name, values.get(name)) for name in {*symbols_in(step.value)}])
            self.known[id(step.value)] = reads, number
        return number

    def _number(self, operation: Operation, values: dict[str, int]) -> int:
        """Return the number of a value; a name of a step is that of the value it has."""
        kind, of = operation.kind, operation.of
        if kind == "symbol":
            of = of.name  # hashed faster than the symbol
            if of in values:
                return values[of]
        operands = tuple([self._number(operand, values) for operand in operation.operands])
        key = (kind, of, tuple(sorted(operands)) if kind in _COMMUTATIVE else operands)
        if key not in self.found:
            self.found[key] = len(self.operations)
            self.operations.append((operation, operands))
        return self.found[key]

    def _name(self, value: int, name: str) -> None:
        if value not in self.named:
            names = chain((name,), (f"{name}_{i}" for i in count(2)))
            self.named[value] = next(n for n in names if n not in self.taken)
            self.taken.add(self.named[value])

    def _name_shared(
        self, value: int, kind: str, parts: tuple[Operation, ...], of: Any, owner: str
    ) -> None:
        """Name a value with several readers: by a short formula, or as a part of the first."""
        name = _short_formula(kind, parts, of)
        if not name or name in self.taken:
            numbers = self.parts.setdefault(owner, count(1))
            name = next(n for i in numbers if (n := f"{owner}{_PART}{i}") not in self.taken)
        self._name(value, name)

    def _owners(
        self,
        steps: Sequence[tuple[int, Assignment]],
        results: Sequence[int],
        sources: Sequence[str],
    ) -> dict[int, str]:
        """Return the first reader of each value without a name: a step, or a function."""
        found: dict[int, str] = {}
        for value, step in steps:
            if value in self.named:
                self._claim(value, step.within or self.named[value], found)
        for value, source in zip(results, sources, strict=True):
            if value not in self.named and value not in found:
                found[value] = source
            self._claim(value, source, found)
        return found

    def _claim(self, value: int, owner: str, found: dict[int, str]) -> None:
        """Note the owner of all values without a name and owner that a value depends on."""
        for operand in self.operations[value][1]:
            if operand not in self.named and operand not in found:
                found[operand] = owner
                self._claim(operand, owner, found)

    def _repeated(self, results: Iterable[int]) -> set[int]:
        """Return the values that are read more than once."""
        uses = Counter(results)
        for _, operands in self.operations:
            uses.update(operands)
        return {value for value, times in uses.items() if times > 1}

    def _written(
        self,
        steps: Sequence[tuple[int, Assignment]],
        results: Sequence[int],
        sources: Sequence[str],
    ) -> Schedule:
        written = _Written(self._repeated(results), self._owners(steps, results, sources))
        for value, step in steps:
            if value in self.named or value in written.repeated:
                self._place(value, step.section, written)
        finals = tuple(self._place(value, "results", written) for value in results)
        return Schedule(tuple(written.assignments.values()), finals)

    def _place(self, value: int, section: str, written: _Written) -> Operation:
        """Return the operation or the name of a value, with named ones assigned before."""
        operation, operands = self.operations[value]
        if operation.kind in _LEAVES:
            return operation
        if value not in written.by_name:
            parts = tuple([self._place(operand, section, written) for operand in operands])
            operation = Operation(operation.kind, parts, operation.of, operation.ready)
            if value in written.repeated and value not in self.named:
                owner = written.owners[value]
                self._name_shared(value, operation.kind, parts, operation.of, owner)
            if value not in self.named:
                return operation
            name = self.named[value]
            written.assignments[value] = Assignment(name, operation, section)
            symbol = Operation("symbol", of=sp.Symbol(name), ready=operation.ready)
            written.by_name[value] = symbol
        return written.by_name[value]
