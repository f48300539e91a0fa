"""Functions of some results, with the steps, guards and iterations that these need."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .function import Function
from .functions import Iterated
from .sharing import drop_dead
from .symbols import guarded_in

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    import sympy as sp

    from .function import IterationBlock
    from .steps import Guard, Step


def function_of(
    name: str,
    doc: str,
    results: Mapping[str, sp.Expr],
    steps: Iterable[Step],
    guards: Iterable[Guard],
    blocks: Iterable[IterationBlock],
    *,
    shape: Sequence[int] | None = None,
    part: str = "",
) -> Function:
    """Return a function of labelled results, with those steps, guards and blocks that they need.

    Name, doc, shape and part are as in `Function`; without a shape the results are a row. As a rule
    steps, guards and blocks are more than the results need.
    """
    expressions = list(results.values())
    alive = drop_dead([*steps], expressions)
    read = [*(step.expression for step in alive), *expressions]
    guarded = set().union(*map(guarded_in, read))
    called = {e.args[0].name for e in read if isinstance(e, Iterated)}
    return Function(
        name,
        doc,
        tuple(alive),
        tuple(expressions),
        tuple(results),
        tuple(shape) if shape is not None else (len(expressions),),
        tuple(guard for guard in guards if guard.quantity in guarded),
        part,
        tuple(block for block in blocks if block.name in called),
    )
