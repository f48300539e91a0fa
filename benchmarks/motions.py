"""How fast a motion of a car is simulated: by several methods, and of many cars in lanes."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any, NamedTuple

import kintrafo
import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from kintrafo.vehicle.models.car.equations import CarModel

REPEATED = 3
TOGETHER = 64
"""Cars of an ensemble, whose front right dampers differ."""


class Motion(NamedTuple):
    """Start, times of the outputs [s] and inputs of a motion."""

    start: np.ndarray
    times: np.ndarray
    inputs: dict[str, Any]

    @property
    def span(self) -> tuple[float, float]:
        """First and last time [s]."""
        return float(self.times[0]), float(self.times[-1])


def processor_seconds(call: Callable[[], object]) -> float:
    """Return the processor time of a call, in all threads [s]."""
    begun = time.process_time()
    call()
    return time.process_time() - begun


def by_methods(
    model: CarModel,
    motion: Motion,
    methods: Sequence[tuple[str, dict[str, Any]]],
    acceleration: Callable[[kintrafo.Simulation], np.ndarray],
    size: Callable[[np.ndarray], float],
) -> Iterator[str]:
    """Yield cells of a table for each method: its name, times real time, and its error.

    Parameters
    ----------
    model, motion
        The simulated car and its motion.
    methods
        Names, and arguments of ``kintrafo.simulate``.
    acceleration
        Returns the acceleration of which the error is measured, against Verner's method at 1e-11.
    size
        Returns the number that the largest error is divided by, from the exact acceleration.
    """

    def run(**options: Any) -> tuple[float, np.ndarray]:
        found: list[kintrafo.Simulation] = []
        seconds = processor_seconds(
            lambda: found.append(
                kintrafo.simulate(
                    model, motion.span, motion.start, inputs=motion.inputs, t_eval=motion.times,
                    **options,
                )
            )
        )  # fmt: skip
        return seconds, acceleration(found[0])

    _, exact = run(method="Verner", rtol=1e-11, atol=1e-13)
    for name, options in methods:
        runs = [run(**options) for _ in range(REPEATED)]
        seconds, found = min(runs, key=lambda each: each[0])
        error = np.abs(found - exact).max() / size(exact)
        yield f"{name} | {motion.span[1] / seconds:,.0f} | {error:.1e}"


def in_lanes(model: CarModel, motion: Motion, reductions: Mapping[str, str]) -> str:
    """Return the cells of `TOGETHER` cars in lanes, on one thread by Dormand-Prince at 1e-4."""
    damper = next(p for p in model.parameters if p.endswith("damper_rate"))
    cars = {damper: model.parameters[damper] * np.linspace(0.7, 1.4, TOGETHER)}

    def together() -> None:
        kintrafo.ensemble(
            model, cars, motion.span, motion.start, inputs=motion.inputs, threads=1,
            reductions=reductions, rtol=1e-4, atol=1e-6,
        )  # fmt: skip

    seconds = min(processor_seconds(together) for _ in range(REPEATED))
    name = f"Dormand-Prince, 1e-4, {TOGETHER} cars in vector lanes, all together"
    return f"{name} | {TOGETHER * motion.span[1] / seconds:,.0f} | "
