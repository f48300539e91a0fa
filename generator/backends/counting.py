"""The arithmetic operations of a function, counted on the schedule that all back ends write."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

from ..memory import uncollected
from .sharing import scheduled

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ..program.function import Function, Stage
    from .schedule import Operation

OPERATIONS = ("add", "multiply", "divide", "root", "trigonometric")

# Class of each kind. A sign in front is an addition; guards, limits and the choice of a branch are
# comparisons and do not count.
_COUNTED = {
    "add": "add", "subtract": "add", "negate": "add", "multiply": "multiply", "divide": "divide",
    "root": "root", "function": "trigonometric",
}  # fmt: skip

_counts: WeakKeyDictionary[Function | Stage, Counter[str]] = WeakKeyDictionary()


def counted(operations: Iterable[Operation]) -> Counter[str]:
    """Count operations, with those of their operands."""
    total: Counter[str] = Counter()
    waiting = list(operations)
    while waiting:
        operation = waiting.pop()
        waiting += operation.operands
        if operation.kind in _COUNTED:
            total[_COUNTED[operation.kind]] += 1
    return total


@uncollected()
def operations_of(emitted: Function | Stage) -> Counter[str]:
    """Count the arithmetic operations of one call, exactly as they are written.

    For a block that iterates, they are those of one iteration.
    """
    if emitted not in _counts:
        order = scheduled(emitted)
        total = counted((*(step.value for step in order.steps), *order.results))
        blocks = {block.name: block for block in emitted.blocks}
        for step in order.steps:
            if step.value.kind == "iterate":
                total.update(operations_of(blocks[step.value.of].once))
        _counts[emitted] = total
    return Counter(_counts[emitted])
