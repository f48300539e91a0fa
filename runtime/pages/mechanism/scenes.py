"""Scenes of a page of a mechanism: positions over each coordinate, each input, or time."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...core.legible import legible
from ...core.named_types import Array
from ...equations.errors import ModelError
from ...simulation.result import Simulation
from ...systems.skeleton import Skeleton

# Positions on each side of the design position; most frames of a motion.
_TO_EACH_SIDE, MOST_FRAMES = 60, 400
# Largest change of a coordinate: half a turn [rad], or this part of the mechanism's extent.
_MOST_TURN, _MOST_SLIDE = np.pi, 0.5
# A smaller displacement, relative to the extent, is a rounding error.
_MOVES = 1e-9


@dataclass(frozen=True)
class Scene:
    """Positions over a coordinate, an input or time."""

    # of the variable; SI unit
    name: str
    unit: str
    meaning: str
    values: Array  # of the variable, (n,)
    places: dict[str, Array]  # points of each body, shape (n, points, 3) [m]
    states: Array  # (n, elements)
    # arrays of shape (n,), SI units; NaN where the model has no value
    signals: dict[str, Array] = field(default_factory=dict)
    remark: str = ""  # sentence for the reader


def of_motion(skeleton: Skeleton, result: Simulation) -> Scene:
    """Return the scene of a simulation, with no more than `MOST_FRAMES` of its outputs."""
    count = len(result.t)
    even = np.linspace(result.t[0], result.t[-1], min(count, MOST_FRAMES))
    kept = np.unique([int(np.abs(result.t - time).argmin()) for time in even])
    states, inputs = result.y.T[kept], result.inputs[kept]
    return Scene(
        "time",
        "s",
        "time",
        result.t[kept],
        skeleton.places(states, inputs),
        states,
        {name: np.asarray(values)[kept] for name, values in result.signals.items()},
    )


def by_hand(skeleton: Skeleton) -> Iterator[Scene]:
    """Yield a scene for each coordinate, and for each input that moves the mechanism.

    All others stay at the design position. Free bodies have no scene: they would move the whole
    mechanism.
    """
    system = skeleton.system
    point = system.design_state, np.zeros(len(system.input_names))
    for place in system.layout.joints:
        name = system.state_names[place]
        yield from _scene(skeleton, name, system.equations.STATE[name], _varied(point, 0, place))
    for place, name in enumerate(system.input_names):
        entries = system.equations.INPUTS[name]
        moved = _varied(point, 1, place)
        if entries["unit"] in ("m", "rad") and _moves(skeleton, moved[1]):
            yield from _scene(skeleton, name, entries, moved)


Position = Callable[[float], tuple[Array, Array]]


def _varied(point: tuple[Array, Array], which: int, place: int) -> tuple[float, Position]:
    """Return an element of the state (0) or the inputs (1), and the point for other values."""

    def at(value: float) -> tuple[Array, Array]:
        state, inputs = (array.copy() for array in point)
        (state, inputs)[which][place] = value
        return state, inputs

    return float(point[which][place]), at


def _moves(skeleton: Skeleton, at: Position) -> bool:
    """Return whether an input moves any point."""
    try:
        after = skeleton.places(*at(1e-3))
    except ModelError:
        return False
    before = skeleton.places(skeleton.system.design_state)
    far = max(np.abs(after[b] - before[b]).max(initial=0.0) for b in before)
    return bool(far > _MOVES * extent(before))


def extent(places: dict[str, Array]) -> float:
    """Return the largest distance along an axis between any two of the points [m]."""
    points = np.concatenate([p.reshape(-1, 3) for p in places.values()])
    return max(float(np.ptp(points, axis=0).max()), 1e-9)


def _scene(
    skeleton: Skeleton, name: str, entries: dict[str, Any], moved: tuple[float, Position]
) -> Iterator[Scene]:
    middle, at = moved
    size = extent(skeleton.places(skeleton.system.design_state))
    most = _MOST_TURN if entries["unit"] == "rad" else _MOST_SLIDE * size
    down, up = (_reach(skeleton, at, middle, sign * most) for sign in (-1, 1))
    if up - down < 1e-6 * most:
        return
    sides = [np.linspace(middle, end, _TO_EACH_SIDE + 1) for end in (down, up)]
    values = np.concatenate([sides[0][:0:-1], sides[1]])
    states, inputs = map(np.array, zip(*(at(float(v)) for v in values), strict=True))
    ends = [
        word
        for word, end, sign in (("below", down, -1), ("above", up, 1))
        if abs(end - middle) < 0.999 * most and sign
    ]
    remark = f"It cannot go further {' or '.join(ends)}: a loop does not close." if ends else ""
    yield Scene(
        name,
        entries["unit"],
        legible(entries["meaning"]),
        values,
        skeleton.places(states, inputs),
        states,
        _signals(skeleton, states, inputs),
        remark,
    )


def _reach(skeleton: Skeleton, at: Position, middle: float, most: float) -> float:
    """Return the last value before a loop no longer closes, by steps and bisection."""

    def closes(value: float) -> bool:
        try:
            skeleton.places(*at(value))
        except ModelError:
            return False
        return True

    reached = middle
    for value in np.linspace(middle, middle + most, _TO_EACH_SIDE + 1)[1:]:
        if not closes(float(value)):
            beyond = float(value)
            for _ in range(20):
                half = 0.5 * (reached + beyond)
                reached, beyond = (half, beyond) if closes(half) else (reached, half)
            return reached
        reached = float(value)
    return reached


def _signals(skeleton: Skeleton, states: Array, inputs: Array) -> dict[str, Array]:
    """Return the signals of each position; NaN where the model refuses them."""
    system = skeleton.system
    try:
        return system.signals(states, inputs)
    except ModelError:
        rows = []
        for state, given in zip(states, inputs, strict=True):
            try:
                rows.append({n: float(v) for n, v in system.signals(state, given).items()})
            except ModelError:
                rows.append({})
        return {n: np.array([r.get(n, np.nan) for r in rows]) for n in system.signal_names}
