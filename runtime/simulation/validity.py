"""Motions beyond the bounds of a model.

The equations can be evaluated there, but the results are meaningless for the mechanism.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.named_types import Array
from ..core.quantities import attributes, display_of
from ..systems.system import System
from .levels import Values, value_of


@dataclass(frozen=True)
class Bound:
    """A bound of the model on a signal."""

    signal: str
    limit: Values  # of one system, or of each of many, SI units; infinite without a bound
    above: bool  # whether it is an upper bound; else a lower one
    words: str  # description of the state beyond, for a sentence
    possible: bool  # whether the mechanism can pass it, where only the data end


def bounds_of(model: System, varied: Mapping[str, Array] | None = None) -> Iterator[Bound]:
    """Yield the bounds on signals of a model, declared with its forces or in its file.

    `varied` are parameters that differ between systems, arrays by name, in SI units.
    """
    parameters: Mapping[str, Values] = {**model.parameters, **(varied or {})}
    for signal, described in model.equations.SIGNALS.items():
        for entry in described.get("ranges", ()):
            for bound in _ends(signal, entry, parameters):
                if np.isfinite(bound.limit).any():
                    yield bound
    for one in model.allowed_lengths():
        yield Bound(
            one.signal, abs(one.limit), above=one.limit < 0.0, words=one.beyond, possible=False
        )


def _ends(
    signal: str, entry: Mapping[str, Any], parameters: Mapping[str, Values]
) -> Iterator[Bound]:
    """Yield the ends of a range; they are infinite where it is empty or void."""
    least = value_of(entry.get("least", -np.inf), parameters)
    most = value_of(entry.get("most", np.inf), parameters)
    void = value_of(entry.get("unless", 0.0), parameters)
    holds = (np.asarray(least) < most) & (np.asarray(void) == 0.0)
    possible = entry.get("possible", False)
    if "most" in entry:
        # an empty index makes an array without dimensions a number
        limit = np.where(holds, most, np.inf)[()]
        yield Bound(signal, limit, above=True, words=entry["above"], possible=possible)
    if "least" in entry:
        limit = np.where(holds, least, -np.inf)[()]
        yield Bound(signal, limit, above=False, words=entry["below"], possible=possible)


@dataclass(frozen=True)
class Excursion:
    """A bound that a motion passed."""

    bound: Bound
    unit: str  # SI unit of the signal
    # first and last output of each time span beyond the bound [s]
    spans: tuple[tuple[float, float], ...]
    worst: float  # value farthest beyond, SI units
    time: float  # time of that value [s]

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


def excursions(
    model: System, bounds: Iterable[Bound], times: Array, signals: Mapping[str, Array]
) -> tuple[Excursion, ...]:
    """Return the bounds that outputs of a motion pass.

    Times [s] and signals by name, in SI units, have the shape (n,); NaN is ignored.
    """
    found = []
    for bound in bounds:
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
