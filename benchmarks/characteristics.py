"""``python -m benchmarks.characteristics``: how long all characteristics take."""

import time
from collections.abc import Callable

import numpy as np
from kintrafo import Model, characteristics
from kintrafo.vehicle.models.positions import arm_angles
from rich.console import Console
from rich.table import Table

from .report import one_core

COUNTS = (81, 10_000)
TRAVEL, RACK = 0.080, 0.050  # to either side [m]
ROUNDS = 7


def best(task: Callable[[], object]) -> float:
    """Return the shortest of several times [s]."""
    times = []
    for _ in range(ROUNDS):
        before = time.perf_counter()
        task()
        times.append(time.perf_counter() - before)
    return min(times)


def measure(count: int) -> dict[str, float]:
    """Return the times for so many positions of the reference car [s]."""
    model = Model("reference_car")
    travel = np.linspace(-TRAVEL, TRAVEL, count)
    rack = np.linspace(-RACK, RACK, count)
    return {
        "arm angles from wheel heights": best(lambda: arm_angles(model, 0.3 + travel)),
        "all characteristics over wheel travel": best(
            lambda: characteristics.over(model, "travel", travel)
        ),
        "all characteristics over the rack, both sides": best(
            lambda: characteristics.over(model, "rack", rack)
        ),
    }


def run() -> None:
    """Measure and print."""
    with one_core():
        columns = {count: measure(count) for count in COUNTS}
    table = Table(title="reference car, one core, milliseconds")
    table.add_column("")
    for count in COUNTS:
        table.add_column(f"{count} positions", justify="right")
    for name in columns[COUNTS[0]]:
        table.add_row(name, *(f"{1e3 * columns[count][name]:.1f}" for count in COUNTS))
    Console().print(table)


if __name__ == "__main__":
    run()
