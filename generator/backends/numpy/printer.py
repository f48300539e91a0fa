"""Print a model over NumPy arrays, for where there is no compiler: the steps of the C code.

Sums and products are put together in the same order as in C, so that the two agree to the last
digits of the library's sines and cosines.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

from ...program.floors import ROUNDING
from ..sharing import names_in
from ..templates import template
from ..text import formula, written
from ..words import blocks_of, emitted_names, reads_given
from .dialect import NUMPY

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from ...equations.outputs import Derivation
    from ...program.function import Block, Function, Stage


class ArraysPrinter:
    """Prints the functions of one model as Python over arrays."""

    def __init__(self, derivation: Derivation) -> None:
        self.derivation = derivation

    def source(self) -> str:
        """Return the text of the file that replaces the addresses of the C functions."""
        return template("numpy", "arrays.py").substitute(
            name=self.derivation.formulation.name,
            rounding=ROUNDING,
            functions="\n\n\n".join(
                [
                    *printed_blocks(blocks_of(self.derivation.emitted.values())),
                    self._prepare(),
                    *map(
                        self._of_parameters,
                        (self.derivation.design, *self.derivation.by_parameters.of_parameters),
                    ),
                    *map(self._body, self.derivation.emitted.values()),
                ]
            ),
            table="\n".join(f'    "{name}": {name},' for name in emitted_names(self.derivation)),
        )

    def _prepare(self) -> str:
        names = [e.name for e in self.derivation.parameters]
        loads = self._loaded("parameters", names, self.derivation.prepare)
        called = {
            sp.Symbol(n): sp.Symbol(other) for n, other in names_in(self.derivation.prepare).items()
        }

        def told(expression: sp.Expr) -> str:
            return formula(expression.xreplace(called), NUMPY)

        tests = [
            *(
                f"not abs({told(a.quantity)}) > ROUNDING"
                + ("" if a.scale == 1 else f" * {told(a.scale)}")
                for a in self.derivation.assumptions
            ),
            *(
                f"not abs({told(c.quantity)}) <= {told(c.least)}"
                for c in self.derivation.conditions
            ),
        ]
        holds = [f"{place}: {test}" for place, test in enumerate(tests)]
        return definition(self.derivation.prepare, "parameters", loads, holds)

    def _of_parameters(self, function: Function) -> str:
        names = [e.name for e in self.derivation.parameters]
        return definition(function, "parameters", self._loaded("parameters", names, function))

    def _body(self, function: Function | Stage) -> str:
        loads = [
            *self._loaded("constants", self.derivation.prepare.labels, function),
            *self._loaded("state", [e.name for e in self.derivation.state], function),
            *self._loaded("inputs", [e.name for e in self.derivation.inputs], function),
        ]
        arguments = "constants, state, inputs"
        if reads_given(function):
            arguments += ", given"
            names = [f"given_{e.name}" for e in self.derivation.relative]
            loads += self._loaded("given", names, function)
        places = {guard.name: place for place, guard in enumerate(self.derivation.guards)}
        called = names_in(function)
        holds = [
            f"{places[guard.name]}: {called.get(guard.quantity.name, guard.quantity)}"
            f" > {formula(guard.floor, NUMPY)}"
            for guard in function.guards
        ]
        return definition(function, arguments, loads, holds)

    def _loaded(self, array: str, names: Iterable[str], function: Function | Stage) -> list[str]:
        behind = self.derivation.by_parameters.places(array)
        return loaded(array, names, function, behind)


def definition(
    function: Function | Stage, arguments: str, loads: Sequence[str], holds: Sequence[str] = ()
) -> str:
    """Return a function: what it reads, its steps, its results and what its guards say.

    Parameters
    ----------
    function
        The function.
    arguments
        As they are declared.
    loads
        The lines that read elements of arrays.
    holds
        What the guards say, each after its place.
    """
    steps, results = _written(function)
    lines = [
        f"def {function.name}({arguments}):",
        *(f"    {line}" for line in (*loads, *steps)),
        "    results = (",
        *(f"        {result}," for result in results),
        "    )",
        f"    return results, {{{', '.join(holds)}}}",
    ]
    return "\n".join(lines)


def printed_blocks(blocks: Sequence[Block]) -> list[str]:
    """Return the equations of loops that are followed, and the call that follows them."""
    return [_block(block) for block in blocks]


def _block(block: Block) -> str:
    """Return one iteration, and the call that repeats it."""
    steps, results = _written(block.once)
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
    behind: Mapping[str, int] | None = None,
) -> list[str]:
    """Return the lines that give the elements of an array, as far as they are read, their names.

    Parameters
    ----------
    behind
        Names and places of what follows the values.
    """
    read = {s.name for s in function.free_symbols}
    read.update(s.name for guard in function.guards for s in guard.floor.free_symbols)
    places = {name: i for i, name in enumerate(names)} | dict(behind or {})
    return [f"{n} = {array}[..., {i}]" for n, i in places.items() if n in read]


def _written(function: Function | Stage) -> tuple[list[str], list[str]]:
    """Write steps and results in the order of operations that the C code has."""
    steps, results = written(function, NUMPY)
    return [f"{step.name} = {step.text}" for step in steps], results
