"""Derive the models that come with the project and write them: ``python -m kintrafo.generator``."""

import sys
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.progress import Progress, SpinnerColumn, TaskID, TextColumn, TimeElapsedColumn
from rich.table import Table

from ..terminal.exits import guarded, standing_streams
from .backends.files import project_files, shared_files
from .backends.report.derivation import (
    bodies_of,
    cycles_line,
    joint_rows,
    mobility_line,
    path_rows,
    transformation,
)
from .backends.report.markdown import block_diagram
from .equations.outputs import generate
from .mechanisms import MODELS
from .planning.plan import CataloguePlan

if TYPE_CHECKING:
    from .loops.graph import JointGraph

app = typer.Typer(help=__doc__, no_args_is_help=True, add_completion=False)
console = Console(width=None if sys.stdout.isatty() else 110)


# In the head of every emitted file; a file without it is a user's own.
_MARK = "do not edit"


def _write(target: Path, text: str) -> bool:
    """Write a file unless its contents are the same already, so that it is not compiled again."""
    if target.exists():
        found = target.read_text(encoding="utf-8", errors="replace")
        if found == text:
            return False
        if found and _MARK not in found[:1000]:
            raise typer.BadParameter(f"{target} was not written by kintrafo; choose another folder")
    target.write_text(text, encoding="utf-8", newline="\n")
    return True


def _show(progress: Progress, task: TaskID, title: str, text: str) -> None:
    progress.update(task, description=f"{title}: {text}")


@app.command("generate")
def generate_all(
    folder: Annotated[Path, typer.Argument(help="Where to write, usually 'generated'.")],
) -> None:
    """Derive every model and write C, Cython and report."""
    texts = shared_files()
    columns = SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn()
    with Progress(*columns, console=console) as progress:
        for model in MODELS:
            title = f"deriving {model.name}"
            task = progress.add_task(title, total=1)
            notify = partial(_show, progress, task, title)
            texts |= project_files(generate(model, progress=notify))
            progress.update(task, description=title, advance=1)
    changed = 0
    for path, text in texts.items():
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        changed += _write(target, text)
    console.print(f"{len(texts)} files in {folder}, {changed} of them changed")


@app.command()
def topology(
    picture: Annotated[
        Path | None, typer.Option(help="Write the joint graph here (PNG, SVG).")
    ] = None,
    model: Annotated[
        str, typer.Option(help="Which of the models that come with the project.")
    ] = MODELS[0].name,
    figures: Annotated[
        Path | None,
        typer.Option(help="Write bodies, graph and transformers as figures (SVG, PNG) here."),
    ] = None,
    *,
    force: Annotated[
        bool, typer.Option("--force", help="Replace a file that kintrafo did not write.")
    ] = False,
) -> None:
    """Show mobility, shortest paths, cycles and transformers of a mechanism."""
    names = {known.name: known for known in MODELS}
    if model not in names:
        raise typer.BadParameter(f"there is no model {model!r}; there are {', '.join(names)}")
    plan = CataloguePlan.of(names[model])
    show_topology(plan)
    if picture is not None:
        from .backends.report.picture import draw  # noqa: PLC0415 (matplotlib is slow to import)

        draw(plan, picture, force=force)
        console.print(f"joint graph written to {picture}")
    if figures is not None:
        from .backends.report.figures import draw_figures  # noqa: PLC0415 (as above)

        for path in draw_figures(plan, figures, force=force):
            console.print(f"  {path}")


def show_topology(plan: CataloguePlan) -> None:
    """Print the analysis of a mechanism as tables."""
    graph: JointGraph = plan.topology
    joints = Table(title=f"{graph.mechanism.title}: joints (Table 1)")
    for column in ("joint", "type", "first body", "second body", "degrees of freedom", "in common"):
        joints.add_column(column)
    for row in joint_rows(graph):
        joints.add_row(*row)
    console.print(joints)
    console.print(
        f"Mobility (Eq. 1): {mobility_line(graph)}; independent loops: {graph.loop_count}"
    )
    paths = Table(title="Shortest paths between bodies (Table 2)")
    for column in ("", *map(str, graph.mechanism.numbers.values())):
        paths.add_column(column)
    for row in path_rows(graph):
        paths.add_row(*(cell.strip("*") for cell in row))
    console.print(paths)
    console.print(cycles_line(graph), soft_wrap=True)
    cycles = Table(title="Cycles (Horton)")
    for column in ("bodies", "length", "in the basis"):
        cycles.add_column(column)
    basis = {t.cycle.key: t.number for t in plan.transformers}
    for cycle in graph.candidate_cycles:
        mark = f"transformer {basis[cycle.key]}" if cycle.key in basis else ""
        cycles.add_row(bodies_of(graph, cycle), str(cycle.length), mark)
    console.print(cycles)
    for transformer in plan.transformers:
        console.print(
            block_diagram(transformation(graph, transformer)), highlight=False, soft_wrap=True
        )


if __name__ == "__main__":
    with standing_streams(), guarded():
        app()
