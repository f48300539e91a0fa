"""Print the functions of a model as Python over arrays of some library.

A library is a `Dialect`: NumPy where there is no compiler, and the libraries that models are
exported to.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..equations.kinks import KINKS
from .sharing import names_in
from .text import formula, written
from .words import reads_given

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from ..equations.outputs import Derivation
    from ..program.function import Function, IterationBlock, Stage
    from .text import Dialect


def differentiable(derivation: Derivation) -> list[Function]:
    """Return the functions of constants, state and inputs that are not derivatives themselves."""
    others = {KINKS, *(function.name for function in derivation.by_parameters.functions)}
    return [
        function
        for name, function in derivation.functions.items()
        if not function.part and not reads_given(function) and name not in others
    ]


def exported(derivation: Derivation, dialect: Dialect) -> str:
    """Return the functions of a model for a library that differentiates them.

    These are ``prepare``, ``design_state`` and those of `differentiable`, each of which returns its
    results and, by the index of each guard, whether it holds. Equations that iterate have none.
    """
    arrays = ArrayFunctions(derivation, dialect)
    texts = [arrays.prepare(), arrays.of_parameters(derivation.design)]
    return "\n\n\n".join([*texts, *map(arrays.body, differentiable(derivation))])


@dataclass(frozen=True)
class ArrayFunctions:
    """Prints the functions of one model."""

    derivation: Derivation
    dialect: Dialect

    def prepare(self) -> str:
        """Return the function that computes the constants from the parameters."""
        derivation, dialect = self.derivation, self.dialect
        called = {
            sp.Symbol(n): sp.Symbol(other) for n, other in names_in(derivation.prepare).items()
        }

        def text(expression: sp.Expr) -> str:
            return formula(expression.xreplace(called), dialect)

        def size(expression: sp.Expr) -> str:
            return dialect.magnitude.format(text(expression))

        tests = [
            *(
                f"{size(a.quantity)} > ROUNDING" + ("" if a.scale == 1 else f" * {text(a.scale)}")
                for a in derivation.assumptions
            ),
            *(f"{size(c.quantity)} <= {text(c.least)}" for c in derivation.conditions),
        ]
        holds = [f"{place}: {dialect.negation.format(test)}" for place, test in enumerate(tests)]
        names = [e.name for e in derivation.parameters]
        loads = self._loaded("parameters", names, derivation.prepare)
        return definition(derivation.prepare, "parameters", loads, dialect, holds)

    def of_parameters(self, function: Function) -> str:
        """Return a function of the parameters alone."""
        names = [e.name for e in self.derivation.parameters]
        loads = self._loaded("parameters", names, function)
        return definition(function, "parameters", loads, self.dialect)

    def body(self, function: Function | Stage) -> str:
        """Return a function of constants, state and inputs."""
        derivation = self.derivation
        loads = [
            *self._loaded("constants", derivation.prepare.labels, function),
            *self._loaded("state", [e.name for e in derivation.state], function),
            *self._loaded("inputs", [e.name for e in derivation.inputs], function),
        ]
        arguments = "constants, state, inputs"
        if reads_given(function):
            arguments += ", given"
            names = [f"given_{e.name}" for e in derivation.relative]
            loads += self._loaded("given", names, function)
        places = {guard.name: place for place, guard in enumerate(derivation.guards)}
        called = names_in(function)
        holds = [
            f"{places[guard.name]}: {called.get(guard.quantity.name, guard.quantity)}"
            f" > {formula(guard.floor, self.dialect)}"
            for guard in function.guards
        ]
        return definition(function, arguments, loads, self.dialect, holds)

    def _loaded(self, array: str, names: Iterable[str], function: Function | Stage) -> list[str]:
        behind = self.derivation.by_parameters.places(array)
        return loaded(array, names, function, self.dialect, behind)


def definition(
    function: Function | Stage,
    arguments: str,
    loads: Sequence[str],
    dialect: Dialect,
    holds: Sequence[str] = (),
) -> str:
    """Return the text of a function, with the conditions of its guards.

    `arguments` are as they are declared; `loads` are the lines that read elements of arrays,
    `holds` the conditions of the guards, each after its index.
    """
    steps, results = _written(function, dialect)
    lines = [
        f"def {function.name}({arguments}):",
        *(f"    {line}" for line in (*loads, *steps)),
        "    results = (",
        *(f"        {result}," for result in results),
        "    )",
        f"    return results, {{{', '.join(holds)}}}",
    ]
    return "\n".join(lines)


def printed_blocks(blocks: Sequence[IterationBlock], dialect: Dialect) -> list[str]:
    """Return the equations of loops that are followed, and the call that follows them."""
    return [_block(block, dialect) for block in blocks]


def _block(block: IterationBlock, dialect: Dialect) -> str:
    """Return one iteration, and the call that repeats it."""
    steps, results = _written(block.once, dialect)
    read = {s.name for s in block.once.free_symbols}
    kinds = {
        "given": block.constants,
        "now": [d.now for d in block.driven],
        "way": [d.way for d in block.driven],
        "base": block.estimate.base,
        "step": block.estimate.step,
        "held": [s for line in block.estimate.held for s in line],
    }
    loads = [
        f"{s} = {array}[{i}]"
        for array, symbols in kinds.items()
        for i, s in enumerate(symbols)
        if s.name in read
    ]
    along = [f"({d.now}_start, {d.now}_end, {d.now}_unit)" for d in block.driven]
    names = [name for d in along for name in d.strip("()").split(", ")]
    lines = [
        f"def {block.name}_once({', '.join(kinds)}):",
        *(f"    {line}" for line in (*loads, *steps)),
        "    return (",
        *(f"        {value}," for value in results),
        "    )",
        "",
        "",
        f"def {block.name}({', '.join([*map(str, block.constants), *names])}):",
        f'    """Find {block.doc}."""',
        f"    turns = {[d.turns for d in block.driven]}",
        f"    given = [{', '.join(map(str, block.constants))}]",
        f"    along = [{', '.join(along)}]",
        f"    once, elements = {block.name}_once, {len(block.elements)}",
        f"    return follow_turns(once, {len(block.unknowns)}, elements, turns, given, along)",
    ]
    return "\n".join(lines)


def loaded(
    array: str,
    names: Iterable[str],
    function: Function | Stage,
    dialect: Dialect,
    behind: Mapping[str, int] | None = None,
) -> list[str]:
    """Return the lines that load the elements of an array that a function reads.

    `names` are those of the elements in order; `behind` has names and indices behind the values.
    """
    read = {s.name for s in function.free_symbols}
    read.update(s.name for guard in function.guards for s in guard.floor.free_symbols)
    places = {name: i for i, name in enumerate(names)} | dict(behind or {})
    return [f"{n} = {dialect.element.format(array, i)}" for n, i in places.items() if n in read]


def _written(function: Function | Stage, dialect: Dialect) -> tuple[list[str], list[str]]:
    """Return steps and results in the order of operations of the C code."""
    steps, results = written(function, dialect)
    return [f"{step.name} = {step.text}" for step in steps], results
