"""An ensemble by workers of Dask beside the same by threads of one process.

``make benchmark-cluster`` simulates 100,000 cars over a road by two threads, and by two local
workers with a thread each, in turns: what else the machine does disturbs both of a pair alike.
"""

import statistics
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import kintrafo
import numpy as np
import typer
from dask.distributed import Client, LocalCluster
from rich.console import Console
from rich.markdown import Markdown

from .report import count, environment, fill_page, machine_line, markdown_table

CARS, PAIRS, WORKERS = 100_000, 7, 2
SPAN = (0.0, 1.0)
ROAD = (np.linspace(*SPAN, 101), 0.01 * np.sin(np.linspace(0.0, 25.0, 101)))


@dataclass(frozen=True)
class Pair:
    """The same ensemble by both ways, one after the other.

    Attributes
    ----------
    threads, workers : float
        [s] by the clock.
    """

    threads: float
    workers: float

    @property
    def ratio(self) -> float:
        """How many times as long workers take."""
        return self.workers / self.threads


def seconds(cars: int, **where: Any) -> float:
    """Return how long an ensemble takes [s]."""
    model = kintrafo.Model("reference_car")
    start = kintrafo.state_at_height(model, 0.310)
    dampers = {"damper_rate": np.linspace(1000.0, 2000.0, cars)}
    reductions = {"tyre_force": ["min", "rms"], "camber": ["min", "max"]}
    inputs = {"road_height": ROAD}
    begin = time.perf_counter()
    kintrafo.ensemble(model, dampers, SPAN, start, inputs=inputs, reductions=reductions, **where)
    return time.perf_counter() - begin


def pairs(cars: int, number: int) -> Iterator[Pair]:
    """Yield pairs, of workers that have been started, and have loaded what they need."""
    there = {"n_workers": WORKERS, "threads_per_worker": 1, "dashboard_address": "127.0.0.1:0"}
    with LocalCluster(**there) as cluster, Client(cluster) as client:
        seconds(max(1, cars // 10), cluster=client)
        for _ in range(number):
            yield Pair(seconds(cars, threads=WORKERS), seconds(cars, cluster=client))


def table(found: list[Pair], cars: int) -> str:
    """Return the middle times, and the middle of the ratios, as Markdown."""
    threads = statistics.median(pair.threads for pair in found)
    workers = statistics.median(pair.workers for pair in found)
    return markdown_table(
        (f"{count(cars)} cars, 1 s over a road", "s", "times as long"),
        [
            (f"{WORKERS} threads of one process", f"{threads:.2g}", "1"),
            (f"{WORKERS} workers with a thread each", f"{workers:.2g}", f"{_middle(found):.2f}"),
        ],
    )


def _middle(found: list[Pair]) -> float:
    return statistics.median(pair.ratio for pair in found)


def sentence(found: list[Pair], cars: int, started: float) -> str:
    """Say in words what workers cost."""
    ratios = [pair.ratio for pair in found]
    return (
        f"For {count(cars)} cars, {WORKERS} local workers take {_middle(found):.2f} times as long "
        f"as {WORKERS} threads: the middle of {len(found)} pairs of runs, which were "
        f"{min(ratios):.2f} to {max(ratios):.2f}. Where `cluster={WORKERS}` starts them for one "
        f"call and ends them, that takes {started:.1f} s besides."
    )


def run(
    page: Annotated[Path | None, typer.Option(help="Page of docs/ with the tables.")] = None,
    *,
    quick: Annotated[bool, typer.Option("--quick", help="Few cars.")] = False,
) -> None:
    """Measure threads and workers in turns."""
    cars, number = (2_000, 1) if quick else (CARS, PAIRS)
    found = list(pairs(cars, number))
    started = statistics.median(
        seconds(1, cluster=WORKERS, threads=WORKERS) for _ in range(min(3, number))
    )
    blocks = {
        "cluster": table(found, cars),
        "cluster sentence": sentence(found, cars, started),
        "machine cluster": machine_line(environment()).replace(
            "Processor time on one core of", "Measured on"
        ),
    }
    Console().print(Markdown("\n\n".join(blocks.values())))
    if page is not None:
        fill_page(page, blocks)


if __name__ == "__main__":
    typer.run(run)
