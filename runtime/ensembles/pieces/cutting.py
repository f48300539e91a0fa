"""Which systems go together: thousands, beside which a piece costs little by itself."""

from collections.abc import Iterable

from ..collected import Collected

Span = tuple[int, int]
"""The first of some systems, and the one behind the last."""

_FEWEST, _MOST, _PARTS = 1000, 4096, 8
# What is found of a piece goes over a network, and is held here until it is put into the whole.
_BYTES = 2**26


def left_of(count: int, done: Iterable[Span]) -> list[Span]:
    """Return what is left of some systems when some of them, which may overlap, are done."""
    behind, left = 0, []
    for first, last in sorted([*done, (count, count)]):
        if first > behind:
            left.append((behind, first))
        behind = max(behind, last)
    return left


def spans_of(collected: Collected, left: Iterable[Span], threads: int) -> list[Span]:
    """Return what is left to do, in pieces.

    Parameters
    ----------
    collected : Collected
    left : iterable
        What is left, in a row.
    threads : int
        How many work at a time.
    """
    count = collected.problem.systems.count
    size = min(max(count // (threads * _PARTS), _FEWEST), _MOST)
    size = min(size, max(_BYTES // _bytes_of_one(collected), collected.problem.width))
    return [
        (start, min(start + size, last))
        for first, last in left
        for start in range(first, last, size)
    ]


def _bytes_of_one(collected: Collected) -> int:
    arrays = (collected.samples, *collected.of_series.values(), collected.problem.outcome.finals)
    return sum(array.nbytes for array in arrays) // max(1, len(collected.samples)) + 1
