"""Run the comparison: ``make benchmark-peers``."""

import argparse
import json
import platform
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from kintrafo.simulation.solvers import native_available, native_version
from rich.console import Console
from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

from ..report import fill_page
from . import simulations, timing
from .agreement import DisagreementError
from .case import instant, start
from .models import candidates
from .report import blocks, markdown

METHODS = ("BDF", "Adams", "DOP853", "DormandPrince", "Verner", "Tsitouras", "LSODA")
"""Methods of ``kintrafo.simulate`` that are tried; those that it does not have are left out."""


def main() -> None:
    """Build, check, time and write the report."""
    arguments = _arguments()
    console = Console()
    timing.use_one_core()
    with Progress(
        SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn(), console=console
    ) as progress:
        task = progress.add_task("starting", total=None)

        def report(text: str) -> None:
            progress.update(task, description=text)
            if not console.is_terminal:
                console.print(text)

        entries, skipped = timing.compile_all(candidates(), report)
        timing.time_evaluations(entries, report)
        seconds = _seconds(entries, skipped, report)
    evaluations = [entry.evaluation for entry in entries]
    text = markdown(evaluations, seconds, skipped, _machine())
    if arguments.page is not None:
        fill_page(arguments.page, blocks(evaluations, seconds, _machine()))
    arguments.out.mkdir(parents=True, exist_ok=True)
    (arguments.out / "peers.md").write_text(text)
    data = timing.as_data(evaluations, seconds, skipped) | {"machine": _machine()}
    (arguments.out / "peers.json").write_text(json.dumps(data, indent=1) + "\n")
    print(text)
    print(f"written: {arguments.out / 'peers.md'}, {arguments.out / 'peers.json'}")


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.peers", description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("out/benchmark"), help="folder to write")
    parser.add_argument("--page", type=Path, help="also put the ratios into this page of docs/")
    return parser.parse_args()


def _seconds(
    entries: list[timing.Entry], skipped: dict[str, str], report: timing.Report
) -> list[timing.Second]:
    contenders = []
    for simulator in _simulators(entries, skipped):
        report(f"the second: {simulator.name}")
        try:
            contenders.append(timing.loosest(simulator))
        except DisagreementError as error:
            skipped[simulator.name] = str(error)
    return timing.time_seconds(contenders, report)


def _simulators(
    entries: list[timing.Entry], skipped: dict[str, str]
) -> Iterator[simulations.Simulator]:
    for method in METHODS:
        yield simulations.kintrafo(method)
    if native_available():
        yield simulations.native("DormandPrince")
    begin = instant(start())
    for entry in entries:
        if entry.evaluation.flags == "native" and entry.library.source.is_derivative:
            literal = entry.evaluation.parameters == "literal"
            name = f"{entry.evaluation.name}{', numbers' if literal else ''}"
            yield simulations.runge_kutta(name, entry.library, entry.built.state(begin))
    for package, tool in (
        ("casadi", simulations.casadi_plain),
        ("casadi", simulations.casadi_tuned),
        ("exudyn", simulations.exudyn),
    ):
        if simulations.installed(package):
            yield from tool()
        else:
            skipped[package] = f"not installed: {package}"


def _machine() -> str:
    name = platform.processor() or platform.machine()
    information = Path("/proc/cpuinfo")
    if information.exists():
        for line in information.read_text().splitlines():
            if line.startswith("model name"):
                name = line.partition(":")[2].strip()
                break
    solver = native_version() if native_available() else "not built in"
    return (
        f"{name}, {platform.system()}, SUNDIALS {solver}, Python {platform.python_version()}, "
        f"NumPy {np.__version__}"
    )


if __name__ == "__main__":
    main()
