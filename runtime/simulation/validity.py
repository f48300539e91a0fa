"""Where a motion leaves what a model describes: a strut beyond its ends, a tyre that pulls.

The equations go on there, and what they give has no meaning for the car.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.quantities import attributes, display_of
from ..systems.system import System

Array = NDArray[np.float64]

# A pull below this is rounding: nanometres of a tyre's deflection [N].
_TOUCH = 1e-3


@dataclass(frozen=True)
class Bound:
    """What a signal must not pass.

    Attributes
    ----------
    signal : str
    limit : float
        SI units.
    above : bool
        Whether the signal must not be greater; else it must not be smaller.
    words : str
        What is the case beyond, ready for a sentence.
    possible : bool
        Whether the car can go there, and only the data end.
    """

    signal: str
    limit: float
    above: bool
    words: str
    possible: bool = False


@dataclass(frozen=True)
class Excursion:
    """A bound that was passed.

    Attributes
    ----------
    bound : Bound
    unit : str
        SI unit of the signal.
    spans : tuple of (float, float)
        First and last output of each time beyond [s].
    worst : float
        The value furthest beyond, SI units.
    time : float
        When that was [s].
    """

    bound: Bound
    unit: str
    spans: tuple[tuple[float, float], ...]
    worst: float
    time: float

    def __str__(self) -> str:
        shown = display_of(attributes(self.bound.signal, self.unit))
        first, last = self.spans[0]
        times = "once" if len(self.spans) == 1 else f"{len(self.spans)} times, first"
        return (
            f"{self.bound.words} ({self.bound.signal} = {self.worst * shown.factor:.4g} "
            f"{shown.units} at {self.time:.4g} s, the limit is "
            f"{self.bound.limit * shown.factor:.4g} {shown.units}): {times} from {first:.4g} s to "
            f"{last:.4g} s"
        )


def excursions(model: System, times: Array, signals: Mapping[str, Array]) -> tuple[Excursion, ...]:
    """Return what a motion passes, by its outputs.

    Parameters
    ----------
    model : System or Model
    times : ndarray, shape (n,)
        [s]
    signals : mapping
        Name to array of shape (n,), SI units; NaN is not looked at.

    Returns
    -------
    tuple of Excursion
    """
    found = []
    for bound in bounds_of(model):
        values = signals[bound.signal]
        by = values - bound.limit if bound.above else bound.limit - values
        beyond = by > 0.0
        if beyond.any():
            worst = int(np.nanargmax(by))
            unit = model.equations.SIGNALS[bound.signal]["unit"]
            spans = _spans(times, beyond)
            found.append(Excursion(bound, unit, spans, float(values[worst]), float(times[worst])))
    return tuple(found)


def _spans(times: Array, beyond: NDArray[np.bool_]) -> tuple[tuple[float, float], ...]:
    padded = np.concatenate(([False], beyond, [False]))
    edges = np.flatnonzero(padded[1:] != padded[:-1])
    return tuple(
        (float(times[a]), float(times[b - 1])) for a, b in zip(edges[::2], edges[1::2], strict=True)
    )


def bounds_of(model: System) -> Iterator[Bound]:
    """Yield what the signals of a model must not pass.

    Whoever has a new bound writes a function like those in `_KINDS`.
    """
    for signal in model.signal_names:
        for ending, kind in _KINDS.items():
            if signal == ending or signal.endswith(f"_{ending}"):
                yield from kind(model, signal, signal.removesuffix(ending))


def _strut_length(model: System, signal: str, prefix: str) -> Iterator[Bound]:
    greatest = _parameter(model, prefix, "strut_length_max")
    if greatest:
        yield Bound(signal, greatest, above=True, words="the strut is longer than it can be")
    least = _parameter(model, prefix, "strut_length_min") or 0.0
    yield Bound(signal, least, above=False, words="the strut is shorter than it can be")


def _tyre_force(model: System, signal: str, prefix: str) -> Iterator[Bound]:
    if not _parameter(model, prefix, "tyre_lifts_off"):
        yield Bound(signal, -_TOUCH, above=False, words="the tyre pulls at the road")


def _compression(model: System, signal: str, prefix: str) -> Iterator[Bound]:
    """Yield the ends of a damper's table, which is one of velocities in bump."""
    if signal.endswith("spring_velocity") and f"{prefix}strut_velocity" in model.signal_names:
        return
    table = {
        name.removeprefix(prefix): value
        for name, value in model.parameters.items()
        if name.removeprefix(prefix).startswith("damper_table_")
    }
    knots = [value for name, value in table.items() if "_knot_" in name]
    if not knots or max(knots) <= min(knots):
        return
    words = "the damper is faster in {} than its table goes, and is taken to go on straight"
    yield Bound(signal, -max(knots), above=False, words=words.format("bump"), possible=True)
    yield Bound(signal, -min(knots), above=True, words=words.format("rebound"), possible=True)


def _parameter(model: System, prefix: str, name: str) -> float | None:
    """Return a parameter of this side, or the common one; None where there is neither."""
    return model.parameters.get(f"{prefix}{name}", model.parameters.get(name))


_KINDS: dict[str, Callable[[System, str, str], Iterator[Bound]]] = {
    "strut_length": _strut_length,
    "tyre_force": _tyre_force,
    "strut_velocity": _compression,
    "spring_velocity": _compression,
}
