"""Print a model over NumPy arrays, for where there is no compiler: the steps of the C code.

Sums and products are put together in the same order as in C, so that the two agree to the last
digits of the library's sines and cosines.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..arithmetic import NUMPY, write
from ..assumptions import ROUNDING
from ..iteration import CONVERGED, ITERATIONS
from .c import CPrinter, blocks_of
from .python import template

if TYPE_CHECKING:
    from collections.abc import Iterable

    import sympy as sp

    from ..iteration import Block
    from ..outputs import GeneratedModel
    from ..program import Function


class ArraysPrinter:
    """Prints the functions of one model as Python over arrays."""

    def __init__(self, model: GeneratedModel) -> None:
        self.model = model

    def source(self) -> str:
        """Return the text of the file that stands in for the addresses of the C functions."""
        names = ["prepare", *self.model.functions]
        return template("arrays.py").substitute(
            name=self.model.model.name,
            rounding=ROUNDING,
            functions="\n\n\n".join(
                [
                    *map(_block, blocks_of(self.model.functions.values())),
                    self._prepare(),
                    *map(self._body, self.model.functions.values()),
                ]
            ),
            table="\n".join(f'    "{name}": {name},' for name in names),
        )

    def _prepare(self) -> str:
        loads = _loads("parameters", [e.name for e in self.model.parameters], self.model.prepare)
        tests = [
            *(
                f"not abs({a.quantity}) > ROUNDING{'' if a.scale == 1 else f' * {a.scale}'}"
                for a in self.model.assumptions
            ),
            *(
                f"not abs({c.quantity}) <= {write(c.least, NUMPY).text}"
                for c in self.model.conditions
            ),
        ]
        holds = [f"{place}: {test}" for place, test in enumerate(tests)]
        return _definition(self.model.prepare, "parameters", loads, holds)

    def _body(self, function: Function) -> str:
        loads = [
            *_loads("constants", self.model.prepare.labels, function),
            *_loads("state", [e.name for e in self.model.state], function),
            *_loads("inputs", [e.name for e in self.model.inputs], function),
        ]
        arguments = "constants, state, inputs"
        if CPrinter.reads_given(function):
            arguments += ", given"
            names = [f"given_{e.name}" for e in self.model.relative]
            loads += _loads("given", names, function)
        holds = [
            f"{place}: {guard.quantity} > {write(guard.floor, NUMPY).text}"
            for place, guard in enumerate(self.model.guards)
            if guard in function.guards
        ]
        return _definition(function, arguments, loads, holds)


def _definition(function: Function, arguments: str, loads: list[str], holds: list[str]) -> str:
    """Return a function: what it reads, its steps, its results and what its guards say."""
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


def _block(block: Block) -> str:
    """Return an iteration: where one state has converged, its unknowns wait for the others."""
    steps, results = _written(block.once)
    count = len(block.results)
    found, following, change = results[:count], results[count:-1], results[-1]
    lines = [
        f"def {block.name}({', '.join(map(str, block.arguments))}):",
        f'    """Find {block.doc}."""',
        *(f"    {u} = 0.0" for u in block.unknowns),
        f"    for _ in range({ITERATIONS}):",
        *(f"        {step}" for step in steps),
        "        found = (",
        *(f"            {value}," for value in found),
        "        )",
        f"        moving = ({change} > {CONVERGED} * {CONVERGED}) & np.isfinite({change})",
        "        if not np.any(moving):",
        "            break",
        "        following = (",
        *(f"            {value}," for value in following),
        "        )",
        *(
            f"        {u} = np.where(moving, following[{i}], {u})"
            for i, u in enumerate(block.unknowns)
        ),
        "    return found",
    ]
    return "\n".join(lines)


def _loads(array: str, names: Iterable[str], function: Function) -> list[str]:
    read = {s.name for s in function.free_symbols}
    return [f"{n} = {array}[..., {i}]" for i, n in enumerate(names) if n in read]


def _written(function: Function) -> tuple[list[str], list[str]]:
    """Write steps and results in the order of operations that the C code has."""
    ready: dict[sp.Symbol, int] = {}
    steps = []
    for step in function.steps:
        written = write(step.expression, NUMPY, ready)
        ready[step.symbol] = written.ready
        steps.append(f"{step.symbol} = {written.text}")
    return steps, [write(result, NUMPY, ready).text for result in function.results]
