"""Results that are collected from systems as soon as they are done; series need not be kept."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..core.named_types import Array
from ..simulation.lanes.problem import End, Problem
from .output_spec import OutputSpec, Reduced
from .series import frequencies, percentile, spectra
from .stiff_fallback import StiffFallback


@dataclass
class Collected:
    """Series and reductions of an ensemble; called with some systems when they are done."""

    problem: Problem
    asked: OutputSpec
    again: StiffFallback | None
    # signals kept at all times; NaN after the last time that a system reached, (count, number of
    # signals, number of times)
    samples: Array = field(init=False)
    # reductions of whole series, shape (count,) or (count, number of frequencies)
    of_series: dict[Reduced, Array] = field(init=False)
    # method that found the results of each system; empty for a system that never began
    solvers: NDArray[np.object_] = field(init=False)
    # why the second simulation of a system failed; empty if it succeeded
    reasons: dict[int, str] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        count, asked = self.problem.systems.count, self.asked
        self.samples = np.full((count, len(asked.signals), asked.times.size), np.nan)
        shapes = {
            r: frequencies(asked.times, int(r.level)).shape if r.kind == "psd" else ()
            for r in asked.of_series
        }
        self.of_series = {r: np.full((count, *shape), np.nan) for r, shape in shapes.items()}
        self.solvers = np.full(count, "", dtype=object)

    def __call__(self, first: int, last: int, samples: Array, stopped: Callable[[], bool]) -> None:
        """Collect the results of the systems from the first to the one before the last.

        `samples` have the shape (last - first, number of series, number of times); `stopped`
        returns whether the caller wants to stop.
        """
        outcome = self.problem.outcome
        began = outcome.ends[first:last] != End.PARAMETERS
        self.solvers[first:last][began] = EXPLICIT
        if self.again:
            self._do_again(self.again, first, samples, stopped)
        self.samples[first:last] = samples[:, : len(self.asked.signals)]
        done = np.flatnonzero(outcome.ends[first:last] == End.DONE)
        for reduced, found in self.of_series.items():
            series = samples[done, self.asked.sampled.index(reduced.signal)]
            if reduced.kind == "psd":
                found[first + done] = spectra(series, self.asked.times, int(reduced.level))
            else:
                found[first + done] = percentile(series, reduced.level)

    def _do_again(
        self, again: StiffFallback, first: int, samples: Array, stopped: Callable[[], bool]
    ) -> None:
        beyond_it = np.isin(self.problem.outcome.ends[first : first + len(samples)], BEYOND_IT)
        for place in np.flatnonzero(beyond_it).tolist():
            reason = again.do(first + place, samples[place], stopped)
            self.solvers[first + place] = EXPLICIT if reason else again.method
            self.reasons[first + place] = reason


EXPLICIT = "DormandPrince"
"""Name of the method in lanes, as in `kintrafo.simulate`."""

BEYOND_IT = (End.MANY_STEPS, End.SMALL_STEP, End.STIFF)
"""Ends of systems that an implicit method may finish."""
