"""Division of an ensemble into chunks, each large enough that its overhead is small."""

from collections.abc import Iterable

from ..collected import Collected

Span = tuple[int, int]
"""The first of some systems, and the one after the last."""

_FEWEST, _MOST, _PARTS = 1000, 4096, 8
# Results of a chunk are sent over a network, and are held in memory until they are collected.
_BYTES = 2**26


def left_of(count: int, done: Iterable[Span]) -> list[Span]:
    """Return the systems that are left when some of them, which may overlap, are done."""
    behind, left = 0, []
    for first, last in sorted([*done, (count, count)]):
        if first > behind:
            left.append((behind, first))
        behind = max(behind, last)
    return left


def spans_of(collected: Collected, left: Iterable[Span], threads: int) -> list[Span]:
    """Return the systems that are left, in chunks for a number of threads."""
    count = collected.problem.systems.count
    size = min(max(count // (threads * _PARTS), _FEWEST), _MOST)
    arrays = (collected.samples, *collected.of_series.values(), collected.problem.outcome.finals)
    of_one = sum(array.nbytes for array in arrays) // max(1, count) + 1
    size = min(size, max(_BYTES // of_one, collected.problem.width))
    return [
        (start, min(start + size, last))
        for first, last in left
        for start in range(first, last, size)
    ]
