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
class Time:
    """The cost of an ensemble."""

    clock: float  # [s]
    cores: float  # processor time of all processes, which other programs disturb less [s]


@dataclass(frozen=True)
class Pair:
    """The same ensemble by both ways, one after the other."""

    threads: Time
    workers: Time


def simulate(cars: int, **where: Any) -> None:
    """Simulate cars over a road."""
    model = kintrafo.Model("reference_car")
    start = kintrafo.state_at_height(model, 0.310)
    dampers = {"damper_rate": np.linspace(1000.0, 2000.0, cars)}
    reductions = {"tyre_force": ["min", "rms"], "camber": ["min", "max"]}
    inputs = {"road_height": ROAD}
    kintrafo.ensemble(model, dampers, SPAN, start, inputs=inputs, reductions=reductions, **where)


def timed(client: Client, cars: int, **where: Any) -> Time:
    """Simulate cars; return the times here and with the workers of a client."""

    def of_all() -> float:
        return time.process_time() + sum(client.run(time.process_time).values())

    before, begin = of_all(), time.perf_counter()
    simulate(cars, **where)
    clock = time.perf_counter() - begin
    return Time(clock, of_all() - before)


def pairs(client: Client, cars: int, number: int) -> Iterator[Pair]:
    """Yield pairs, of workers that have been started, and have loaded what they need."""
    simulate(max(1, cars // 10), cluster=client)
    for _ in range(number):
        threads = timed(client, cars, threads=WORKERS)
        yield Pair(threads, timed(client, cars, cluster=client))


def start_and_end() -> float:
    """Return what an ensemble of one car takes whose workers are started for it [s]."""
    begin = time.perf_counter()
    simulate(1, cluster=WORKERS, threads=WORKERS)
    return time.perf_counter() - begin


def table(found: list[Pair], cars: int) -> str:
    """Return the middle of all times, as Markdown."""
    ways = {
        f"{WORKERS} threads of one process": [pair.threads for pair in found],
        f"{WORKERS} workers with a thread each": [pair.workers for pair in found],
    }
    return markdown_table(
        (f"{count(cars)} cars, 1 s over a road", "wall-clock time [s]", "processor time [s]"),
        [
            (
                way,
                f"{statistics.median(one.clock for one in times):.2g}",
                f"{statistics.median(one.cores for one in times):.2g}",
            )
            for way, times in ways.items()
        ],
    )


def sentence(found: list[Pair], cars: int, started: float) -> str:
    """Return a sentence about the cost of workers."""
    by_clock = [pair.workers.clock / pair.threads.clock for pair in found]
    of_cores = [pair.workers.cores / pair.threads.cores for pair in found]
    return (
        f"For {count(cars)} cars, {WORKERS} local workers take {statistics.median(by_clock):.2f} "
        f"times as long as {WORKERS} threads, and {statistics.median(of_cores):.2f} times the "
        f"processor time (median of {len(found)} pairs of runs; ratios of wall-clock times of "
        f"{min(by_clock):.2f} to {max(by_clock):.2f}). With `cluster={WORKERS}`, starting and "
        f"ending the workers takes {started:.1f} s more."
    )


def run(
    page: Annotated[Path | None, typer.Option(help="Page of docs/ with the tables.")] = None,
    *,
    quick: Annotated[bool, typer.Option("--quick", help="Few cars.")] = False,
) -> None:
    """Measure threads and workers in turns."""
    cars, number = (2_000, 1) if quick else (CARS, PAIRS)
    there = {"n_workers": WORKERS, "threads_per_worker": 1, "dashboard_address": "127.0.0.1:0"}
    with LocalCluster(**there) as cluster, Client(cluster) as client:
        found = list(pairs(client, cars, number))
    started = statistics.median(start_and_end() for _ in range(min(3, number)))
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
