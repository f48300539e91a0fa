"""What is kept of many motions: signals at times, reductions on the way, and what passes bounds."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.arguments import Arguments, shown
from ...simulation.lanes.problem import Kind, Outcome, Reduction, Wanted
from ...simulation.validity import Bound
from ...systems.system import System

Array = NDArray[np.float64]

REDUCTIONS = ("max", "min", "mean", "rms", "above")


@dataclass(frozen=True)
class Reduced:
    """A number that is kept of a signal.

    Attributes
    ----------
    signal : str
    kind : str
        One of `REDUCTIONS`.
    level : float
        Of 'above'.
    """

    signal: str
    kind: str
    level: float = 0.0

    @property
    def name(self) -> str:
        """What the variable of the dataset is called."""
        if self.kind != "above":
            return f"{self.signal}_{self.kind}"
        short = f"{self.level:g}"
        exact = short if float(short) == self.level else repr(self.level)
        return f"{self.signal}_above_{exact}"

    @property
    def words(self) -> str:
        """What it is, for a person."""
        texts = {
            "max": "greatest value of {}",
            "min": "smallest value of {}",
            "mean": "mean of {} over time",
            "rms": "root of the mean square of {}, about its mean",
            "above": "time for which {} is above {:g}",
        }
        return texts[self.kind].format(self.signal, self.level)


@dataclass(frozen=True)
class Asked:
    """What was asked for, and what is watched.

    Attributes
    ----------
    times : ndarray
        Of the outputs [s].
    signals : tuple of str
        Kept at all times.
    reduced : tuple of Reduced
    bounds : tuple of Bound
        What signals must not pass.
    """

    times: Array
    signals: tuple[str, ...]
    reduced: tuple[Reduced, ...]
    bounds: tuple[Bound, ...]

    @property
    def items(self) -> tuple[str, ...]:
        """All signals that are looked at, those that are kept at all times first."""
        return tuple(dict.fromkeys([*self.signals, *(r.signal for r in self.reduced)]))

    @property
    def weights(self) -> Array:
        """How long each output stands for the motion: half of the time to those beside it [s]."""
        steps = np.diff(self.times, prepend=self.times[0], append=self.times[-1])
        weights: Array = (steps[:-1] + steps[1:]) / 2.0
        return weights

    def places(self) -> dict[tuple[str, Kind, float], int]:
        """Return what is kept on the way, each once, in the order in which C keeps it."""
        found: dict[tuple[str, Kind, float], int] = {}
        for reduced in self.reduced:
            for kind in _KEPT[reduced.kind]:
                found.setdefault((reduced.signal, kind, reduced.level), len(found))
        return found

    def for_c(self, model: System) -> Wanted:
        """Return the same as C takes it."""
        names = (*model.signal_names, *model.state_names)
        items, places = self.items, self.places()
        limits = [np.atleast_1d(bound.limit) for bound in self.bounds]
        return Wanted(
            times=self.times,
            items=np.array([names.index(item) for item in items], dtype=np.int32),
            sample_count=len(self.signals),
            reductions=[
                Reduction(items.index(s), kind, places.get((s, Kind.FIRST, level), 0), level)
                for s, kind, level in places
            ],
            weights=self.weights,
            bound_items=np.array([names.index(b.signal) for b in self.bounds], dtype=np.int32),
            above=np.array([b.above for b in self.bounds], dtype=np.int32),
            limits=np.stack(np.broadcast_arrays(*limits), axis=-1) if limits else np.zeros((1, 0)),
        )

    def reductions(self, outcome: Outcome) -> Iterator[tuple[Reduced, Array]]:
        """Yield what was asked for, from what C has kept."""
        places, total = self.places(), float(self.times[-1] - self.times[0])

        def kept(reduced: Reduced, kind: Kind) -> Array:
            column: Array = outcome.reduced[:, places[reduced.signal, kind, reduced.level]]
            return column

        for reduced in self.reduced:
            if reduced.kind in ("mean", "rms"):
                moved = kept(reduced, Kind.SUM) / total
                if reduced.kind == "mean":
                    yield reduced, kept(reduced, Kind.FIRST) + moved
                else:
                    variance = kept(reduced, Kind.SQUARES) / total - moved**2
                    yield reduced, np.sqrt(np.maximum(variance, 0.0))
            else:
                yield reduced, kept(reduced, _KEPT[reduced.kind][0])


# What C keeps for each; sums are of what differs from the first value.
_KEPT = {
    "max": (Kind.GREATEST,),
    "min": (Kind.LEAST,),
    "mean": (Kind.FIRST, Kind.SUM),
    "rms": (Kind.FIRST, Kind.SUM, Kind.SQUARES),
    "above": (Kind.ABOVE,),
}


def asked_of(given: Arguments, model: System, times: Array, signals: Any, reductions: Any) -> Asked:
    """Check what was asked for; the bounds are not known yet."""
    known = (*model.signal_names, *model.state_names)
    names = given.names("signals", signals, known)
    reduced = []
    for signal, kinds in given.mapping("reductions", reductions, "signals, kinds").items():
        given.among("signal in reductions", signal, known)
        listed = kinds if isinstance(kinds, list) else [kinds]
        reduced += [_reduced(given, str(signal), kind) for kind in listed]
    if reduced and times.size < 2:
        given.refuse("reductions are over time: t_eval needs two times or more.")
    return Asked(times, tuple(dict.fromkeys(names)), tuple(dict.fromkeys(reduced)), ())


def _reduced(given: Arguments, signal: str, kind: Any) -> Reduced:
    if isinstance(kind, tuple) and len(kind) == 2 and shown(kind[0]) == "'above'":
        return Reduced(signal, "above", given.number(f"level of {signal!r}", kind[1]))
    if not isinstance(kind, str):
        given.refuse(
            f"reductions {signal!r}: {shown(kind)} is none; there are {', '.join(REDUCTIONS)}."
        )
        return Reduced(signal, "max")
    if kind == "above":
        given.refuse(f"reductions {signal!r}: 'above' needs a level, ('above', 0.0).")
        return Reduced(signal, "above")
    return Reduced(signal, given.among(f"reduction of {signal!r}", kind, REDUCTIONS))
