"""Exudyn: its variation of parameters, a system for every car in as many processes as cores."""

from collections.abc import Callable, Mapping
from functools import cache, partial
from typing import Any

import numpy as np
from exudyn.processing import ProcessParameterList

from .case import SAMPLES, Array, Instant, instant
from .exudyn_model import Exudyn, extrapolated
from .exudyn_system import Setting

STEPS = (1200, 1600, 2400, 4800)
"""Of the second, from loose to tight; of a quarter less it finds no solution."""


def varied(
    start: Array, samples: Array, cars: Callable[[int], dict[str, Array]], processes: int
) -> Callable[[int, int], Array]:
    """Return what simulates many cars, with so many steps.

    Parameters
    ----------
    start : ndarray
        Of all cars.
    samples : ndarray
        Times of the outputs, of which the first is the start [s].
    cars : callable
        From a number of cars to their parameters by name.
    processes : int
    """
    places = np.searchsorted(SAMPLES, samples - 1e-9)

    def solve(number: int, steps: int) -> Array:
        own = cars(number)
        listed = [
            dict(zip(own, row, strict=True)) for row in np.transpose([*own.values()]).tolist()
        ]
        one = partial(_angles, tuple(start.tolist()), steps)
        found = ProcessParameterList(one, listed, processes > 1, numberOfThreads=processes)
        return np.array(found)[:, places]

    return solve


def _angles(start: tuple[float, ...], steps: int, rates: Mapping[str, float]) -> Any:
    """Simulate one car, by the settings that are the fastest of `make benchmark-peers`."""
    system = Exudyn(_begin(start), rates)
    return extrapolated(system, Setting(steps, modified_newton=True))


@cache
def _begin(start: tuple[float, ...]) -> Instant:
    return instant(np.array(start))
