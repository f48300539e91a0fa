"""The range of a coordinate: a march to its limits that misses none between two positions.

Along one coordinate, a mechanism is evaluated at some positions: whether its loops close, margins
that must be positive, and a height that must be monotonic. Two usable neighbours show that
everything between them is usable only if the functions are smooth on the scale of their distance.
The check of this: the mean of two slopes agrees with the chord between them (the trapezoidal rule),
and three values of a margin do not bend too much.

With loops solved by iteration, neighbours may also be on different branches, with other attitudes
of the bodies (`attitudes`). Around the point at which branches meet, positions x have coordinates
``a = x^3 - d x``: between two branches, whose rates differ by a factor of three at most, the
trapezoidal rule misses the jump by half of it or more.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.named_types import Array
from .attitudes import Attitudes

GOAL, UNRESOLVED = -2, -3
"""The ends of a march besides a limit: the goal, and steps that have become too small."""

# The chord differs from the mean of two slopes by h^2 s'' / 12, and the slope between them by
# h^2 s'' / 8 at most: it keeps its sign if the first is less than 2/3 of the flatter slope. A third
# of that, because s'' is not constant.
_SMOOTH = 0.2
# A small rotation of bodies per coordinate, and the greatest relative difference of its rates.
_LITTLE, _ALIKE = 1.0, 2.0 / 3.0
# A parabola is below its lower neighbour by at most 1/8 of its second difference; twice that.
_DIP = 0.25
# Greater than the rounding of a height of some metres [m].
_ROUNDING = 1e-13
# Steps of a march that are evaluated together, and the smallest step [rad].
_TOGETHER = 8
_SMALLEST = 3e-13
_FASTER = 4.0
# A march needs some thirty evaluations.
_MOST_LOOKS = 400


class PlacesAlong(NamedTuple):
    """Values at some positions; the last axis of the first four is along the coordinate."""

    usable: NDArray[np.bool_]  # whether the position is within the range
    limit: NDArray[np.int64]  # limit that a position is beyond
    # monotonic quantity, and its derivative; without meaning if not usable
    height: Array
    slope: Array
    margins: Array  # positive if usable, (..., places, margins)
    attitudes: Attitudes  # attitudes of the bodies, if loops are solved by iteration


def resolved(width: Array, seen: PlacesAlong) -> NDArray[np.bool_]:
    """Return between which neighbours every position is usable.

    `width` is the signed distance of two neighbours, equal along the last axis, and broadcasts with
    it. The result has one element less along the last axis; it is false if one of the two is not
    usable.
    """
    both = seen.usable[..., :-1] & seen.usable[..., 1:]
    low, high = np.abs(seen.slope[..., :-1]), np.abs(seen.slope[..., 1:])
    mean = 0.5 * (seen.slope[..., :-1] + seen.slope[..., 1:])
    missed = np.abs(np.diff(seen.height, axis=-1) - mean * width)
    smooth = missed <= _SMOOTH * np.minimum(low, high) * np.abs(width) + _ROUNDING
    together = smooth & margins_stay(seen.margins) & _on_one_branch(width, seen.attitudes)
    return both & together


def _on_one_branch(width: Array, attitudes: Attitudes) -> NDArray[np.bool_]:
    """Return between which neighbours the bodies rotate as their rates predict."""
    turned, rate = attitudes
    if not turned.shape[-1]:
        return np.ones((), dtype=bool)
    width = np.asarray(width)[..., None]
    low, high = rate[..., :-1, :], rate[..., 1:, :]
    rates = np.abs(rate).max(axis=-1)
    most = np.maximum(np.maximum(rates[..., :-1], rates[..., 1:]), _LITTLE)
    missed = np.abs(np.diff(turned, axis=-2) - 0.5 * (low + high) * width).max(axis=-1)
    turns = missed <= _SMOOTH * most * np.abs(width[..., 0])
    alike = np.abs(high - low).max(axis=-1) <= _ALIKE * most
    return alike & turns


def margins_stay(margins: Array) -> NDArray[np.bool_]:
    """Return between which neighbours all margins stay positive, (..., places - 1).

    `margins`, (..., places, margins), are at equal distances; three places or more.
    """
    bend = np.maximum(np.diff(margins, 2, axis=-2), 0.0)
    first, last = bend[..., :1, :], bend[..., -1:, :]
    around = np.maximum(
        np.concatenate([first, bend], axis=-2), np.concatenate([bend, last], axis=-2)
    )
    lower = np.minimum(margins[..., :-1, :], margins[..., 1:, :])
    return (lower - _DIP * around > 0.0).all(axis=-1)


def march(
    look: Callable[[Array, NDArray[np.int64]], PlacesAlong], start: Array, goal: Array, step: float
) -> tuple[Array, NDArray[np.int64]]:
    """Return the last usable position from each start towards its goal, and the limit there.

    Everything up to the position is usable, to `_SMALLEST`; the limit is as in `PlacesAlong`, or
    `GOAL` or `UNRESOLVED`. `look` takes positions, (rows, places), and the indices of the rows'
    starts, and returns the values there. The starts, (starts,), are usable; `step` is the first and
    greatest distance of two positions.
    """
    reached = start.copy()
    width = np.full(start.shape, step)
    limit = np.full(start.shape, UNRESOLVED)
    rows = np.arange(start.size)
    for _ in range(_MOST_LOOKS):
        left = goal[rows] - reached[rows]
        limit[rows[left == 0.0]] = GOAL
        rows, left = rows[left != 0.0], left[left != 0.0]
        if rows.size == 0:
            break
        steps = np.sign(left) * np.minimum(width[rows], np.abs(left) / _TOGETHER)
        places = reached[rows, None] + steps[:, None] * np.arange(_TOGETHER + 1)
        ends = np.abs(steps) * _TOGETHER >= np.abs(left)
        places[ends, -1] = goal[rows][ends]
        seen = look(places, rows)
        fine = resolved(steps[:, None], seen)
        count = np.logical_and.accumulate(fine, axis=1).sum(axis=1)
        reached[rows] = places[np.arange(rows.size), count]
        stuck, all_fine = count == 0, count == _TOGETHER
        factor = np.where(stuck, 1.0 / _TOGETHER, np.where(all_fine, _FASTER, 1.0))
        width[rows] = np.minimum(np.abs(steps) * factor, step)
        done = stuck & (width[rows] < _SMALLEST)
        # the limit of the next position, if the step itself shows none
        wrong = ~seen.usable
        first = seen.limit[np.arange(rows.size), wrong.argmax(axis=1)]
        limit[rows[done]] = np.where(wrong.any(axis=1), first, UNRESOLVED)[done]
        rows = rows[~done]
    return reached, limit
