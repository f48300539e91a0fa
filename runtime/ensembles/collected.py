"""What is gathered of systems as soon as they are done, so that series need not stay."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..simulation.lanes.problem import End, Problem
from .again import Again
from .series import frequencies, percentile, spectra
from .wanted import OutputSpec, Reduced

Array = NDArray[np.float64]


@dataclass
class Collected:
    """What stays of the series, and who found them; called with some systems when they are done.

    Attributes
    ----------
    samples : ndarray, shape (count, number of signals, number of times)
        Of what is kept at all times; NaN behind the end of what did not come to an end.
    of_series : dict
        What was asked for of whole series: of shape (count,) or (count, number of frequencies).
    solvers : ndarray of str
        The method by which the results of each system were found; empty for what never began.
    reasons : dict
        Why systems that were done again did not come to an end that way either; or nothing.
    """

    problem: Problem
    asked: OutputSpec
    again: Again | None
    samples: Array = field(init=False)
    of_series: dict[Reduced, Array] = field(init=False)
    solvers: NDArray[np.object_] = field(init=False)
    reasons: dict[int, str] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        count, asked = self.problem.systems.count, self.asked
        self.samples = np.full((count, len(asked.signals), asked.times.size), np.nan)
        self.of_series = {r: np.full((count, *_shape(r, asked)), np.nan) for r in asked.of_series}
        self.solvers = np.full(count, "", dtype=object)

    def __call__(self, first: int, last: int, samples: Array, stopped: Callable[[], bool]) -> None:
        """Gather what came of some systems.

        Parameters
        ----------
        first, last : int
            The first of them, and the one behind the last.
        samples : ndarray, shape (last - first, number of series, number of times)
        stopped : callable
            Returns whether the caller wants an end.
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
            found[first + done] = _reduced(reduced, series, self.asked)

    def _do_again(
        self, again: Again, first: int, samples: Array, stopped: Callable[[], bool]
    ) -> None:
        beyond_it = np.isin(self.problem.outcome.ends[first : first + len(samples)], BEYOND_IT)
        for place in np.flatnonzero(beyond_it).tolist():
            reason = again.do(first + place, samples[place], stopped)
            self.solvers[first + place] = EXPLICIT if reason else again.method
            self.reasons[first + place] = reason


EXPLICIT = "DormandPrince"
"""The method in lanes, as `kintrafo.simulate` calls it."""

BEYOND_IT = (End.MANY_STEPS, End.SMALL_STEP, End.STIFF)
"""How systems end that an implicit method may do."""


def _shape(reduced: Reduced, asked: OutputSpec) -> tuple[int, ...]:
    return (frequencies(asked.times, int(reduced.level)).size,) if reduced.kind == "psd" else ()


def _reduced(reduced: Reduced, series: Array, asked: OutputSpec) -> Array:
    if reduced.kind == "psd":
        return spectra(series, asked.times, int(reduced.level))
    return percentile(series, reduced.level)
