"""Results of an ensemble: signals at times, reductions during integration, and bounds."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..core.named_types import Array
from ..core.quantities import display_of
from ..core.validator import Validator, shown
from ..simulation.lanes.problem import Kind, LaneOutputs, Outcome, Reduction
from ..simulation.validity import Bound
from ..systems.system import System
from .series import LEAST_SEGMENT, USUAL_SEGMENT, uniform_step

ON_THE_WAY = ("max", "min", "mean", "rms", "above")
OF_SERIES = ("percentile", "psd")
REDUCTIONS = (*ON_THE_WAY, *OF_SERIES)


@dataclass(frozen=True)
class Reduced:
    """A reduction of a signal: a number, or for 'psd' one for each frequency."""

    signal: str
    kind: str  # one of `REDUCTIONS`
    # level of 'above', the percentage of 'percentile', the outputs in a segment of 'psd'
    level: float = 0.0

    @property
    def name(self) -> str:
        """Name of the variable in the dataset."""
        if self.kind not in ("above", "percentile"):
            return f"{self.signal}_{self.kind}"
        short = f"{self.level:g}"
        exact = short if float(short) == self.level else repr(self.level)
        return f"{self.signal}_{self.kind}_{exact}"

    def words(self, unit: str) -> str:
        """Return a description in words, from the unit of the signal."""
        display = display_of({"units": unit})
        # with all digits that a user may have given
        level = f"{self.level * display.factor:.12g} {display.units}".removesuffix(" 1").strip()
        texts = {
            "max": "greatest value of {}",
            "min": "smallest value of {}",
            "mean": "mean of {} over time",
            "rms": "rms of {} about its mean",
            "above": f"time for which {{}} is above {level}",
            "percentile": "value of {} that {:g} % of the outputs are below",
            "psd": "power spectral density of {}, one-sided",
        }
        return texts[self.kind].format(self.signal.replace("_", " "), self.level)

    def unit(self, unit: str) -> str:
        """Return the unit of the reduction, from that of the signal."""
        if self.kind == "psd":
            plain = {"1": "1/Hz"}
            alone = f"({unit})" if set(unit) & set(" /^*") else unit
            return plain.get(unit, f"{alone}^2/Hz")
        return "s" if self.kind == "above" else unit


@dataclass(frozen=True)
class OutputSpec:
    """The requested results, and the bounds that are checked."""

    times: Array  # of the outputs [s]
    signals: tuple[str, ...]  # kept at all times
    reduced: tuple[Reduced, ...]
    bounds: tuple[Bound, ...]  # bounds of the model on signals

    @property
    def items(self) -> tuple[str, ...]:
        """All signals that are evaluated, beginning with the `sampled` ones."""
        return tuple(dict.fromkeys([*self.sampled, *(r.signal for r in self.reduced)]))

    @property
    def of_series(self) -> tuple[Reduced, ...]:
        """Reductions of whole series, which are computed at the end of a motion."""
        return tuple(r for r in self.reduced if r.kind in OF_SERIES)

    @property
    def sampled(self) -> tuple[str, ...]:
        """Signals whose whole series are needed, beginning with those of the results."""
        return tuple(dict.fromkeys([*self.signals, *(r.signal for r in self.of_series)]))

    @property
    def numbers(self) -> int:
        """Count of the numbers that are kept for each system."""
        spectra = sum(int(r.level) // 2 + 1 for r in self.of_series if r.kind == "psd")
        others = sum(r.kind == "percentile" for r in self.of_series) + len(self.places())
        return len(self.signals) * self.times.size + spectra + others

    @property
    def weights(self) -> Array:
        """Weights of the outputs in an integral over time by the trapezoidal rule [s]."""
        steps = np.diff(self.times, prepend=self.times[0], append=self.times[-1])
        return (steps[:-1] + steps[1:]) / 2.0

    def places(self) -> dict[tuple[str, Kind, float], int]:
        """Return the numbers that C accumulates during integration, each with its place."""
        found: dict[tuple[str, Kind, float], int] = {}
        for reduced in self.reduced:
            for kind in _KEPT.get(reduced.kind, ()):
                found.setdefault((reduced.signal, kind, reduced.level), len(found))
        return found

    def for_c(self, model: System) -> LaneOutputs:
        """Return the specification in the form that C reads."""
        names = (*model.signal_names, *model.state_names)
        items, places = self.items, self.places()
        limits = [np.atleast_1d(bound.limit) for bound in self.bounds]
        return LaneOutputs(
            times=self.times,
            items=np.array([names.index(item) for item in items], dtype=np.int32),
            sample_count=len(self.sampled),
            reductions=[
                Reduction(items.index(s), kind, places.get((s, _ORIGIN[kind], level), 0), level)
                for s, kind, level in places
            ],
            weights=self.weights,
            bound_items=np.array([names.index(b.signal) for b in self.bounds], dtype=np.int32),
            above=np.array([b.above for b in self.bounds], dtype=np.int32),
            limits=np.stack(np.broadcast_arrays(*limits), axis=-1) if limits else np.zeros((1, 0)),
        )

    def on_the_way(self, outcome: Outcome) -> Iterator[tuple[Reduced, Array]]:
        """Yield the reductions that follow from the numbers that C accumulated."""
        places, total = self.places(), float(self.times[-1] - self.times[0])

        def kept(reduced: Reduced, kind: Kind) -> Array:
            return outcome.reduced[:, places[reduced.signal, kind, reduced.level]]

        for reduced in self.reduced:
            if reduced.kind in OF_SERIES:
                continue
            if reduced.kind in ("mean", "rms"):
                moved = kept(reduced, Kind.SUM) / total
                if reduced.kind == "mean":
                    yield reduced, kept(reduced, Kind.FIRST) + moved
                else:
                    variance = kept(reduced, Kind.SQUARES) / total - moved**2
                    yield reduced, np.sqrt(np.maximum(variance, 0.0))
            else:
                yield reduced, kept(reduced, _KEPT[reduced.kind][0])


# Numbers that C accumulates for each; sums are of differences from the first value.
_KEPT = {
    "max": (Kind.GREATEST,),
    "min": (Kind.LEAST,),
    "mean": (Kind.FIRST, Kind.SUM),
    "rms": (Kind.FIRST, Kind.SUM, Kind.SQUARES),
    "above": (Kind.ABOVE, Kind.LAST),
}
# The number from which each of them is computed.
_ORIGIN = dict.fromkeys(Kind, Kind.FIRST) | {Kind.ABOVE: Kind.LAST}


def asked_of(
    given: Validator, model: System, times: Array, signals: Any, reductions: Any
) -> OutputSpec:
    """Return the requested results, checked; without bounds, which are not known yet."""
    known = (*model.signal_names, *model.state_names)
    described = {**model.equations.SIGNALS, **model.equations.STATE}
    names = given.names("signals", signals, known)
    reduced = []
    for signal, kinds in given.mapping("reductions", reductions, "signals, kinds").items():
        given.among("signal in reductions", signal, known)
        listed = kinds if isinstance(kinds, list) else [kinds]
        unit = described.get(signal, {}).get("unit", "")
        reduced += [_reduced(given, str(signal), kind, unit) for kind in listed]
    _check_spectra(given, times, {r.level for r in reduced if r.kind == "psd"})
    if reduced and times.size < 2:
        given.fail("reductions are over time: t_eval needs two times or more.")
    return OutputSpec(times, tuple(dict.fromkeys(names)), tuple(dict.fromkeys(reduced)), ())


def _check_spectra(given: Validator, times: Array, segments: set[float]) -> None:
    """Refuse times that are unfit for spectra, and segments that do not fit the times."""
    if not segments or given.failed:
        return
    if len(segments) > 1:
        lengths = ", ".join(f"{length:g}" for length in sorted(segments))
        given.fail(
            f"reductions: segments of 'psd' have {lengths} outputs; they need one length, "
            "since the results have one row of frequencies."
        )
    if times.size < max(segments):
        given.fail(
            f"reductions: a segment of 'psd' has {max(segments):g} outputs, and t_eval has "
            f"{times.size}: ask for more times, or for shorter segments, ('psd', {times.size})."
        )
    elif uniform_step(times) is None:
        steps = np.diff(times)
        given.fail(
            f"t_eval: 'psd' needs times at equal distances, and these are {steps.min():g} s to "
            f"{steps.max():g} s. numpy.linspace has such times."
        )


def _reduced(given: Validator, signal: str, kind: Any, unit: str) -> Reduced:
    if isinstance(kind, tuple) and len(kind) == 2 and isinstance(kind[0], str):
        return _with_value(given, signal, *kind, unit)
    if not isinstance(kind, str):
        given.fail(f"reductions {signal!r}: {shown(kind)} is not one of {', '.join(REDUCTIONS)}.")
        return Reduced(signal, "max")
    if kind in _EXAMPLES:
        given.fail(f"reductions {signal!r}: {kind!r} needs {_EXAMPLES[kind]}.")
        return Reduced(signal, "max")
    found = given.among(f"reduction of {signal!r}", kind, REDUCTIONS)
    return Reduced(signal, found, USUAL_SEGMENT if found == "psd" else 0.0)


_EXAMPLES = {
    "above": "a level, ('above', 0.0)",
    "percentile": "a number of 0 to 100, ('percentile', 95.0)",
}


def _with_value(given: Validator, signal: str, kind: str, value: Any, unit: str) -> Reduced:
    """Check a kind that has a level, or another number."""
    text = getattr(value, "attrs", {}).get("units")
    number, wanted = f"{kind!r} of {signal!r}", {"above": unit, "percentile": "%"}.get(kind, "1")
    if text is not None and text != wanted:
        given.fail(f"{number} is in {shown(text)}: it is needed in {wanted!r}.")
    if kind == "above":
        return Reduced(signal, kind, given.number(number, value, unit))
    if kind == "percentile":
        percent = given.number(number, value, "%", least=0.0)
        if percent > 100.0:
            given.fail(f"{number} = {percent:g} %: a number from 0 % to 100 % is needed.")
        return Reduced(signal, kind, percent)
    if kind == "psd":
        return Reduced(signal, kind, float(given.whole(number, value, least=LEAST_SEGMENT)))
    given.fail(f"reductions {signal!r}: {kind!r} takes no number, or is not known.")
    return Reduced(signal, "max")
