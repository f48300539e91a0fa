"""Iterative solution of loops without a closed form, for functions over NumPy arrays.

It does the same as ``follow.c``, for all states together, with the same limits.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.named_types import Array

ITERATIONS = 400
"""Most iterations of a call. Within the travel of a suspension five to seven are needed."""
CONVERGED = 1e-13
"""Length of a correction that ends the iterations: its rounding error."""
STALLED = 1e-6
"""Largest rounding error of a correction next to a dead point."""
LONGEST = 0.5
"""Largest change of a coordinate, or of all unknowns together, in a stage."""
TURNED = 0.5
"""Largest relative change of J in a stage."""
CLOSE = 0.05
"""Longest last correction of a stage, relative to the stage; the last stage converges."""
SHORTEST = 1e-9
"""Shortest stage, relative to the whole way: the branch ends where a shorter one is needed."""
CLOSED = 1e-6
"""Largest distance from the design position after a full turn that leads back to it."""

_FULL_TURN = 2.0 * np.pi


def _square(values: Array) -> Any:
    return sum(v * v for v in values)


def _even(went: Array, first: Array, last: Array) -> Any:
    """Return where the unknowns follow the tangents at both ends of a stage.

    At a dead point within the stage, the last tangent differs by far more than the first one does.
    """
    ahead, back = _square(went - first), _square(went - last)
    bent = np.fmax(4.0 * ahead, _square(last) / 4.0)
    return back <= np.fmax(bent, STALLED * STALLED)


def _follow(
    once: Callable[..., Any],
    unknowns: int,
    elements: int,
    given: Array,
    start: Array,
    end: Array,
    unit: Array,
) -> tuple[Array, NDArray[np.bool_]]:
    """Follow loops straight from the design position to other coordinates, all states together.

    Each array has a column for each state. Return the solutions, and the states in which the loops
    have reached the end.
    """
    n, place, count = unknowns, unknowns + elements, given.shape[1]
    base, left, slope, move, step, gone = (np.zeros((n, count)) for _ in range(6))
    held, found = np.zeros((elements, count)), np.zeros((place + 2, count))
    farthest = np.max(np.abs(end - start) / unit, axis=0, initial=0.0)
    most = np.where(farthest > LONGEST, LONGEST / np.maximum(farthest, LONGEST), 1.0)
    part, size = np.where(farthest > 0.0, 0.0, 1.0), most.copy()
    target, before, side = part.copy(), np.full(count, np.inf), np.ones(count)
    started, arrived, at = np.zeros(count, bool), np.zeros(count, bool), np.arange(count)
    for _ in range(ITERATIONS):
        t = target[at]
        span, passed = end[:, at] - start[:, at], t - part[at]
        now = np.where(t < 1.0, start[:, at] + t * span, end[:, at])
        scale = np.where(passed > 0.0, passed, 1.0)
        out = once(given[:, at], now, scale * span, move[:, at], step[:, at], held[:, at])
        out = np.array([np.broadcast_to(value, at.shape) for value in out])
        correction, tangent, changed = out[place + 2 : -1 - n], out[-1 - n : -1], out[-1]
        change, moved = _square(correction), _square(gone[:, at])
        enough = np.where(t < 1.0, CLOSE * CLOSE * moved, 0.0)
        close = change <= np.fmax(enough, CONVERGED * CONVERGED)
        stalled = (change <= STALLED * STALLED) & (change > before[at] / 4.0)
        short = (moved <= LONGEST * LONGEST) & (change <= LONGEST * LONGEST)
        steady = (changed <= TURNED * TURNED) & short | ~started[at]
        room = 0.7 * TURNED / np.sqrt(changed)
        went = gone[:, at] + correction - left[:, at]
        even = _even(went, slope[:, at] * passed, tangent) | ~started[at]
        done = steady & even & (close | stalled)
        on = steady & ~close & ~stalled & (change <= before[at] / 4.0)
        again = ~done & ~on & started[at] & (size[at] > SHORTEST)
        # the stage is done
        d, now = at[done], out[:, done]
        side[d] = np.where(started[d], side[d], np.copysign(1.0, now[place]))
        started[d], found[:, d] = True, now[: place + 2]
        found[n : place + 1, d] *= side[d]
        ends = done & (t >= 1.0)
        arrived[at[ends]] = True
        slope[:, d] = tangent[:, done] / scale[done]
        left[:, d], base[:, d], held[:, d] = correction[:, done], now[:n], now[n:place] / now[place]
        grown = np.fmin(size[d] * np.fmin(room[done], 2.0), most[d])
        size[d], part[d] = np.where(passed[done] > 0.0, grown, size[d]), t[done]
        size[d] = np.fmin(size[d], 0.95 * LONGEST / np.sqrt(_square(slope[:, d])))
        # on with the same stage
        o = at[on]
        move[:, o], step[:, o], before[o] = out[:n, on], correction[:, on], change[on]
        gone[:, o] += correction[:, on]
        # again, shorter
        size[at[again]] *= np.fmax(np.fmin(room[again], 0.5), 0.1)
        s = at[(done & ~ends) | again]
        target[s], before[s] = np.fmin(part[s] + size[s], 1.0), np.inf
        move[:, s], step[:, s] = base[:, s], left[:, s] + slope[:, s] * (target[s] - part[s])
        gone[:, s] = step[:, s]
        at = at[(done & ~ends) | on | again]
        if not at.size:
            break
    return found, arrived


def follow_turns(
    once: Callable[..., Any],
    unknowns: int,
    elements: int,
    turns: Sequence[bool],
    given: Sequence[Any],
    along: Sequence[tuple[Any, Any, Any]],
) -> tuple[Array, ...]:
    """Follow loops to other coordinates, without whole turns that lead back to the design position.

    `once` is one iteration; `unknowns` and `elements` are the numbers of the unknowns of the loops,
    and of the elements of the inverse of their Jacobian; `turns` is whether each coordinate is an
    angle. `given` are constants, `along` start, end and unit of every coordinate. The solutions are
    returned; the last array is one where the loops have not reached the end, else zero.
    """
    shape = np.broadcast_shapes(*map(np.shape, (*given, *(v for values in along for v in values))))

    def columns(values: Sequence[Any]) -> Array:
        flat = [np.broadcast_to(v, shape).ravel() for v in values]
        return np.array(flat).reshape(len(flat), int(np.prod(shape)))

    rows = columns(given)
    start, end, unit = (columns([values[k] for values in along]) for k in range(3))
    for c in np.flatnonzero(turns):
        whole = np.trunc((end[c] - start[c]) / _FULL_TURN)
        some = np.flatnonzero(whole)
        if some.size:
            turned = start[:, some]
            turned[c] += np.copysign(_FULL_TURN, whole[some])
            ends = rows[:, some], start[:, some], turned, unit[:, some]
            found, arrived = _follow(once, unknowns, elements, *ends)
            back = some[arrived & (found[-1] <= CLOSED * CLOSED)]
            end[c, back] -= whole[back] * _FULL_TURN
    found, arrived = _follow(once, unknowns, elements, rows, start, end, unit)
    found[-1] = ~arrived
    return tuple(row.reshape(shape) for row in found)
