"""``python -m benchmarks``: Gear against Runge-Kutta, written to ``out/benchmark/``."""

import shutil
from pathlib import Path
from typing import Annotated, Any

import typer
from kintrafo.simulation.solvers import native_available
from kintrafo.vehicle.analysis.paper import OUTPUT_INTERVAL
from rich.console import Console
from rich.markdown import Markdown
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from . import friction, paper_timing, work_precision
from .report import NO_SUNDIALS, environment, fill_page, machine_line, one_core, write_json


def run(
    out: Annotated[Path, typer.Option(help="Folder for the results.")] = Path("out/benchmark"),
    page: Annotated[
        Path | None, typer.Option(help="Also put tables and picture into this page of docs/.")
    ] = None,
    *,
    quick: Annotated[
        bool, typer.Option("--quick", help="Few outputs, tolerances and repetitions.")
    ] = False,
) -> None:
    """Measure Gear's method against Runge-Kutta: as the paper did, with free steps, when stiff."""
    console = Console()
    out.mkdir(parents=True, exist_ok=True)
    with one_core(), _progress(console) as progress:
        results = _measure(progress, quick=quick)
    machine = environment()
    blocks = _blocks(results, machine)
    files = [
        work_precision.write_figure(results["work_precision"], machine["processor"], out)[0],
        friction.write_figure(results["friction"], machine["processor"], out)[0],
    ]
    write_json(out / "gear_against_runge_kutta.json", {"environment": machine, **results})
    report = out / "gear_against_runge_kutta.md"
    report.write_text(_report(blocks), encoding="utf-8")
    if page is not None:
        fill_page(page, blocks)
        for file in files:
            shutil.copy(file, page.parents[1] / "images" / file.name)
    console.print(Markdown(_report({k: v for k, v in blocks.items() if k != "points"})))
    console.print(f"{report} and, beside it, JSON and the diagrams as PNG and SVG")


def _progress(console: Console) -> Progress:
    return Progress(
        TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), console=console
    )


def _measure(progress: Progress, *, quick: bool) -> dict[str, Any]:
    case = paper_timing.standard_case()
    results: dict[str, Any] = {"stiffness": work_precision.stiffness(case)}
    if native_available():
        rounds = 2 if quick else 60
        task = progress.add_task("the paper's protocol", total=rounds)
        results["paper_timing"] = paper_timing.measure(
            case,
            interval=1e-3 if quick else OUTPUT_INTERVAL,
            rounds=rounds,
            advance=lambda: progress.advance(task),
        )
    else:
        progress.console.print(NO_SUNDIALS)
    chosen = work_precision.TOLERANCES[1:4:2] if quick else work_precision.TOLERANCES
    passes = 1 if quick else 3
    total = passes * len(chosen) * len(work_precision.curves())
    bar = progress.add_task("free steps", total=total)
    results["work_precision"] = work_precision.measure(
        case,
        chosen,
        passes=passes,
        budget=0.0 if quick else work_precision.BUDGET,
        advance=lambda: progress.advance(bar),
    )
    speeds = friction.SPEEDS[1:4:2] if quick else friction.SPEEDS
    last = progress.add_task("friction", total=len(speeds) * len(friction.methods()))
    results["friction"] = friction.measure(
        speeds, rounds=1 if quick else 3, advance=lambda: progress.advance(last)
    )
    return results


def _blocks(results: dict[str, Any], machine: dict[str, str]) -> dict[str, str]:
    """Return the parts of the report by name; a page may have any of them."""
    points = results["work_precision"]
    blocks = {"machine": machine_line(machine)}
    if "paper_timing" in results:
        timing = results["paper_timing"]
        blocks["methods"] = paper_timing.methods_table(timing)
        blocks["ratios"] = paper_timing.ratio_table(timing)
    else:
        blocks["methods"] = NO_SUNDIALS
    blocks["stiffness"] = work_precision.stiffness_table(results["stiffness"], points)
    blocks["costs"] = work_precision.cost_table(work_precision.cost_at(points))
    blocks["friction"] = friction.table(results["friction"])
    blocks["points"] = work_precision.points_table(points)
    return blocks


_HEADINGS = {
    "machine": "# Gear against Runge-Kutta",
    "methods": "## The paper's protocol",
    "ratios": "### Ratios",
    "stiffness": "## Stiffness",
    "costs": f"## Free steps: cost of an error of {work_precision.ERROR_OF_COMPARISON:g}",
    "friction": "## With friction in the strut, which is stiff",
    "points": "## Free steps: all points",
}


def _report(blocks: dict[str, str]) -> str:
    return "\n\n".join(f"{_HEADINGS[name]}\n\n{block}" for name, block in blocks.items()) + "\n"


if __name__ == "__main__":
    typer.run(run)
