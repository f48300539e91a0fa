"""A function of some results of another."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .function import Function
from .functions import Guarded, Iterated
from .sharing import drop_dead

if TYPE_CHECKING:
    from collections.abc import Sequence


def narrowed(function: Function, name: str, doc: str, labels: Sequence[str]) -> Function:
    """Return a function of results with some labels: only their steps, guards and iterations."""
    of_label = dict(zip(function.labels, function.results, strict=True))
    steps, results = drop_dead([*function.steps], [of_label[label] for label in labels])
    expressions = [*(step.expression for step in steps), *results]
    guarded = {g.args[0] for e in expressions for g in e.atoms(Guarded)}
    called = {e.args[0].name for e in expressions if isinstance(e, Iterated)}
    return Function(
        name,
        doc,
        tuple(steps),
        tuple(results),
        tuple(labels),
        (len(results),),
        tuple(guard for guard in function.guards if guard.quantity in guarded),
        function.part,
        tuple(block for block in function.blocks if block.name in called),
    )
