"""Long functions in pieces, since compile time grows with the square of a function's length.

A function is a straight line; here it is cut where the fewest values are alive. Each piece is a
function of its own that reads values of earlier ones from an array, and writes values for later
ones there. Every operation is the same as in one piece, and so is every bit of a result.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..counting import counted
from ..sharing import alive_in, symbols_in

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from ...program.function import Function, Stage
    from ..schedule import Assignment, Operation
    from ..sharing import OwnSteps, Together

LONG = 5_000
"""Number of operations above which the functions of a file are cut. Below it, compile time per
operation is the same either way, and a call in one piece is faster by a twentieth or so."""

PIECE = 400
"""Largest number of operations in a piece, unless a single step has more. For pieces of half this
length GCC takes the same time in all, for those of twice this length a tenth more."""


@dataclass(frozen=True)
class Piece:
    """A piece of a function."""

    steps: tuple[Assignment, ...]
    # indices of the results that can be returned behind these steps, and not earlier
    results: tuple[int, ...]
    reads: frozenset[str]  # all names that are read and not defined here


@dataclass(frozen=True)
class Cut:
    """A function in pieces."""

    pieces: tuple[Piece, ...]
    kept: Mapping[str, int]  # index of each value that one piece leaves for others
    size: int  # number of indices


def length_of(whole: Together) -> int:
    """Return the number of operations of the functions of a file, each counted once."""
    values = [step.value for step in whole.steps]
    values += [step.value for part in whole.parts for step in part.steps]
    values += [result for part in whole.parts for result in part.results]
    return counted(values).total()


def is_long(steps: Sequence[Assignment]) -> bool:
    """Return whether steps that are computed once for a parameter set are more than a piece."""
    return sum(map(_weight, steps)) > PIECE


def _weight(step: Assignment) -> int:
    return counted([step.value]).total() + 1


def steps_of(function: Function | Stage, part: OwnSteps, whole: Together) -> list[Assignment]:
    """Return the steps that the results and the guards of a function need, in their order."""
    steps = [*whole.steps, *part.steps]
    alive = alive_in(function, part, steps)
    return [step for step in steps if step.name in alive]


def cut(
    steps: Sequence[Assignment],
    results: Sequence[Operation],
    guards: Sequence[frozenset[str]],
    sizes: Mapping[str, int],
) -> Cut:
    """Cut a function where the fewest values are alive.

    `guards` has the names that each guard reads, `sizes` the number of elements of values with more
    than one.
    """
    reading = [frozenset(symbols_in(step.value)) for step in steps]
    places = {step.name: i for i, step in enumerate(steps)}
    ends = list(_ends(steps, _alive(reading, places)))
    piece_of = [k for k, (start, end) in enumerate(ends) for _ in range(start, end)]
    behind = [_last(symbols_in(result), places, piece_of) for result in results]
    reads = [set[str]().union(*reading[start:end]) for start, end in ends]
    for k, result in zip(behind, results, strict=True):
        reads[k] |= set(symbols_in(result))
    for names in guards:
        reads[_last(names, places, piece_of)] |= names
    pieces = tuple(
        Piece(
            tuple(steps[start:end]),
            tuple(i for i, k in enumerate(behind) if k == number),
            frozenset(reads[number] - {step.name for step in steps[start:end]}),
        )
        for number, (start, end) in enumerate(ends)
    )
    return Cut(pieces, *_places(pieces, places, sizes))


def _last(names: Iterator[str] | frozenset[str], places: Mapping[str, int], of: list[int]) -> int:
    """Return the piece behind which all names are known."""
    return max((of[places[name]] for name in names if name in places), default=0)


def _alive(reading: Sequence[frozenset[str]], places: Mapping[str, int]) -> list[int]:
    """Return the number of values defined before each step and read from there on."""
    until = {name: place for place, names in enumerate(reading) for name in names if name in places}
    change = [0] * (len(reading) + 2)
    for name, last in until.items():
        change[places[name] + 1] += 1
        change[last + 1] -= 1
    alive, now = [], 0
    for step in change:
        now += step
        alive.append(now)
    return alive


def _ends(steps: Sequence[Assignment], alive: Sequence[int]) -> Iterator[tuple[int, int]]:
    """Yield the first index of each piece, one at least, and the index behind it."""
    weights = [*map(_weight, steps)]
    start = 0
    while sum(weights[start : start + PIECE]) > PIECE:
        total, found = 0, []
        for place in range(start, len(steps)):
            total += weights[place]
            if total > PIECE:
                break
            if total > PIECE // 2:
                found.append(place + 1)
        end = min(reversed(found), key=alive.__getitem__, default=place + 1 - bool(place > start))
        yield start, end
        start = end
    yield start, len(steps)


def _places(
    pieces: Sequence[Piece], places: Mapping[str, int], sizes: Mapping[str, int]
) -> tuple[dict[str, int], int]:
    """Return the indices of values left for other pieces; one is reused after its last reading."""
    last = {name: k for k, piece in enumerate(pieces) for name in piece.reads if name in places}
    kept: dict[str, int] = {}
    free: list[int] = []
    ending: dict[int, list[int]] = {}
    size = 0
    for number, piece in enumerate(pieces):
        for place in ending.get(number - 1, ()):
            heapq.heappush(free, place)
        for name in (step.name for step in piece.steps if step.name in last):
            count = sizes.get(name, 1)
            if count == 1 and free:
                kept[name] = heapq.heappop(free)
            else:
                kept[name], size = size, size + count
            ending.setdefault(last[name], []).extend(range(kept[name], kept[name] + count))
    return kept, size
