"""When a system of an ensemble goes to BDF, and what percentiles and spectra of many cost.

``make benchmark-stiff`` measures cars whose struts come to stick, by the velocity of
regularisation: in lanes alone, by BDF alone, and as `ensemble` does it, which tries the lanes
first; and the memory and time of what is kept of 100,000 cars.
"""

import resource
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Annotated, Any

import kintrafo
import numpy as np
import typer
import xarray as xr
from rich.console import Console
from rich.markdown import Markdown

from .report import count, environment, fill_page, machine_line, markdown_table

SPEEDS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5)  # of regularisation [m/s]
FRICTION = 300.0  # [N]
SPAN = (0.0, 2.0)
CARS, MANY, TIMES = 16, 100_000, 1001
KEPT = {
    "nothing but the end": {},
    "`max`": {"reductions": {"tyre_force": "max"}},
    "`('percentile', 95)`": {"reductions": {"tyre_force": ("percentile", 95.0)}},
    "`('psd', 256)`": {"reductions": {"tyre_force": ("psd", 256)}},
    "all samples": {"signals": ["tyre_force"]},
}


def car(speed: float) -> tuple[kintrafo.Model, Any]:
    """Return a car whose strut comes to stick, and its start."""
    changes = {"strut.friction_N": FRICTION, "strut.friction_velocity_m_per_s": speed}
    model = kintrafo.Model(kintrafo.Suspension.load("reference_car").with_changes(changes))
    return model, kintrafo.state_at_height(model, 0.305)


def by_gear(speed: float, cars: int) -> float:
    """Return milliseconds of a core for one of the same cars by BDF."""
    model, start = car(speed)
    options: dict[str, Any] = {"rtol": 1e-6, "atol": 1e-9, "t_eval": np.linspace(*SPAN, 201)}
    begin = time.process_time()
    for _ in range(cars):
        one = kintrafo.System(model.equations, model.parameters)
        dict(kintrafo.simulate(one, SPAN, start, method="BDF", **options).signals)
    return (time.process_time() - begin) / cars * 1e3


def sticking(speed: float, cars: int, **options: Any) -> tuple[xr.Dataset, float]:
    """Simulate cars that come to stick; also return milliseconds of a core for one."""
    model, start = car(speed)
    frictions = {"strut_friction": np.full(cars, FRICTION)}
    begin = time.process_time()
    found = kintrafo.ensemble(model, frictions, SPAN, start, threads=1, **options)
    return found, (time.process_time() - begin) / cars * 1e3


def stiff_rows(speeds: tuple[float, ...], cars: int) -> Iterator[tuple[str, ...]]:
    """Yield steps and times of the ways, for each velocity of regularisation."""
    sticking(speeds[0], 1)  # what is imported and compiled once
    for speed in speeds:
        lanes, of_lanes = sticking(speed, cars, stiff=None)
        found, taken = sticking(speed, cars)
        yield (
            f"{speed:g}", count(float(lanes["steps"][0])), f"{of_lanes:.2g}",
            f"{by_gear(speed, cars):.2g}", str(found["solver"].item(0)), f"{taken:.2g}",
        )  # fmt: skip


def kept_rows(what: list[str], cars: int) -> Iterator[tuple[str, ...]]:
    """Yield what it takes to keep something of many cars, each in a process of its own."""
    for one in what:
        command = [sys.executable, "-m", "benchmarks.ensemble_stiff", "--kept", one]
        output = subprocess.run(
            [*command, "--cars", str(cars)], check=True, capture_output=True, text=True
        )
        seconds, megabytes = map(float, output.stdout.split())
        yield one, f"{seconds:.2g}", f"{megabytes:.0f}"


def keep(what: str, cars: int) -> None:
    """Print seconds, and by how many megabytes the greatest memory grew."""
    model = kintrafo.Model("reference_car")
    rest = kintrafo.state_at_height(model, 0.310)
    rates = {"damper_rate": np.linspace(1000.0, 2000.0, cars)}
    run: Callable[..., Any] = kintrafo.ensemble
    options = {"t_eval": np.linspace(*SPAN, TIMES), **KEPT[what]}
    run(model, {"damper_rate": rates["damper_rate"][:1]}, SPAN, rest, **options)
    before, begin = _memory(), time.perf_counter()
    run(model, rates, SPAN, rest, **options)
    print(time.perf_counter() - begin, _memory() - before)


def _memory() -> float:
    """Return the greatest memory of this process so far [MB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3


def run(
    page: Annotated[Path | None, typer.Option(help="Page of docs/ with the tables.")] = None,
    kept: Annotated[str, typer.Option(hidden=True)] = "",
    cars: Annotated[int, typer.Option(help="How many cars something is kept of.")] = MANY,
    *,
    quick: Annotated[bool, typer.Option("--quick", help="Few cars.")] = False,
) -> None:
    """Measure stiff cars, and what is kept of many."""
    if kept:
        keep(kept, cars)
        return
    speeds, few = (SPEEDS[:1], 2) if quick else (SPEEDS, CARS)
    blocks = {
        "stiff": markdown_table(
            ("v0 [m/s]", "steps in lanes", "lanes alone [ms]", "BDF alone [ms]", "`solver`",
             "`ensemble` [ms]"),
            list(stiff_rows(speeds, few)),
        ),
        "kept": markdown_table(
            ("kept", "s", "memory [MB]"),
            list(kept_rows([*KEPT][2:3], few) if quick else kept_rows([*KEPT], cars)),
        ),
    }  # fmt: skip
    machine = machine_line(environment()).replace("Processor time on one core of", "Measured on")
    blocks["machine stiff"] = machine
    Console().print(Markdown("\n\n".join(blocks.values())))
    if page is not None:
        fill_page(page, blocks)


if __name__ == "__main__":
    typer.run(run)
