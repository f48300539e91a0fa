"""Second simulations, by an implicit method, of systems that the explicit method did not finish."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from ..core.errors import KintrafoError
from ..core.named_types import Array
from ..simulation.lanes.problem import End, Kind, Problem
from ..simulation.simulate import simulate_inputs
from ..systems.system import System


@dataclass(frozen=True)
class StiffFallback:
    """Simulation of single systems of a problem by an implicit method."""

    problem: Problem  # outcome is overwritten where the simulation succeeds
    method: Literal["BDF"] = "BDF"  # of `kintrafo.simulate`

    def do(self, place: int, samples: Array, stopped: Callable[[], bool]) -> str:
        """Simulate one system with the same inputs and tolerances; return the reason of a failure.

        The reason is empty if there is none. `samples`, (number of series, number of times), are
        then overwritten; `stopped` returns whether the caller wants to stop.
        """
        problem, systems, outcome = self.problem, self.problem.systems, self.problem.outcome
        drive = systems.drives[systems.drive_of[place]]
        inputs = replace(drive, constant=_row(systems.inputs, place))
        try:
            model = self._system(place)
            state = _row(systems.states, place)
            state = np.where(np.isnan(state), model.design_state, state)
            end, times = inputs.segments[-1].end, problem.wanted.times
            with_end = times if times[-1] == end else np.append(times, end)
            found = simulate_inputs(
                model,
                inputs,
                state,
                with_end,
                problem.accuracy,
                method=self.method,
                stopped=stopped,
            )
            values = np.array([*found.signals.values(), *found.y])[:, : times.size]
        except KintrafoError as error:
            return str(error)
        samples[:] = values[problem.wanted.items[: len(samples)]]
        outcome.reduced[place] = self._reduced(values)
        outcome.beyond[place] = self._beyond(values, place)
        outcome.finals[place], outcome.ended[place] = found.y[:, -1], end
        outcome.steps[place], outcome.ends[place] = found.steps, End.DONE
        return ""

    def _system(self, place: int) -> System:
        model, systems = self.problem.model, self.problem.systems
        values = systems.parameters.copy()
        values[systems.varied] = systems.variants[place]
        names = model.equations.PARAMETERS
        return System(model.equations, dict(zip(names, values.tolist(), strict=True)))

    def _reduced(self, values: Array) -> Array:
        """Return the reductions that lanes keep during integration."""
        wanted = self.problem.wanted
        found = np.empty(len(wanted.reductions))
        for place, (item, kind, _, level) in enumerate(wanted.reductions):
            series = values[wanted.items[item]]
            found[place] = _KEPT[kind](series, wanted.weights, wanted.times, level)
        return found

    def _beyond(self, values: Array, place: int) -> Array:
        """Return the values farthest beyond the bounds; NaN where none is passed."""
        wanted = self.problem.wanted
        limits = _row(wanted.limits, place)
        found = np.full(limits.size, np.nan)
        for bound, (item, above) in enumerate(zip(wanted.bound_items, wanted.above, strict=True)):
            worst = values[item].max() if above else values[item].min()
            if worst > limits[bound] if above else worst < limits[bound]:
                found[bound] = worst
        return found


def _row(rows: Array, place: int) -> Array:
    """Return the row of a system, or the only row, which all systems share."""
    return rows[place if len(rows) > 1 else 0]


def _time_above(series: Array, _weights: Array, times: Array, level: float) -> float:
    """Return the time for which straight lines between outputs are above a level [s]."""
    by = series - level
    up, size = np.maximum(by, 0.0), np.abs(by)
    both = size[:-1] + size[1:]
    part = np.divide(up[:-1] + up[1:], both, out=np.zeros_like(both), where=both > 0.0)
    return float((np.diff(times) * part).sum())


_KEPT: dict[Kind, Callable[[Array, Array, Array, float], float]] = {
    Kind.GREATEST: lambda series, *_: series.max(),
    Kind.LEAST: lambda series, *_: series.min(),
    Kind.FIRST: lambda series, *_: series[0],
    Kind.LAST: lambda series, *_: series[-1],
    Kind.SUM: lambda series, weights, *_: (weights * (series - series[0])).sum(),
    Kind.SQUARES: lambda series, weights, *_: (weights * (series - series[0]) ** 2).sum(),
    Kind.ABOVE: _time_above,
}
