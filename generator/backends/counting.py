"""The arithmetic operations of a function, counted on what all back ends write."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

from ..program.functions import Iterated
from .schedule import scheduled

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ..program.function import Function
    from .schedule import Operation

OPERATIONS = ("add", "multiply", "divide", "root", "trigonometric")

# What each kind counts as. A sign in front is an addition; guards, limits and the choice of a
# branch are comparisons and do not count.
_COUNTED = {
    "add": "add",
    "subtract": "add",
    "negate": "add",
    "multiply": "multiply",
    "divide": "divide",
    "root": "root",
    "function": "trigonometric",
}

_counts: WeakKeyDictionary[Function, Counter[str]] = WeakKeyDictionary()


def counted(operations: Iterable[Operation]) -> Counter[str]:
    """Count some operations, with all that they are carried out on."""
    total: Counter[str] = Counter()
    waiting = list(operations)
    while waiting:
        operation = waiting.pop()
        waiting += operation.operands
        if operation.kind in _COUNTED:
            total[_COUNTED[operation.kind]] += 1
    return total


def operations_of(function: Function) -> Counter[str]:
    """Count the arithmetic operations of one call, exactly as they are written.

    Of a block that iterates, those of one iteration.
    """
    if function not in _counts:
        order = scheduled(function)
        total = counted((*order.steps, *order.results))
        blocks = {block.name: block for block in function.blocks}
        for step in function.steps:
            if isinstance(step.expression, Iterated):
                total.update(operations_of(blocks[step.expression.args[0].name].once))
        _counts[function] = total
    return Counter(_counts[function])
