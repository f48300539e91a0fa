"""The command line: ``kintrafo``."""

import sys
from pathlib import Path
from typing import Annotated, NoReturn

import typer
from rich.console import Console
from rich.table import Table

from . import __version__, paper
from .errors import KintrafoError
from .model import Model
from .solvers import native_version

app = typer.Typer(
    help="Closed-form equations of motion for mechanisms with loops, compiled and simulated.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)
console = Console(width=None if sys.stdout.isatty() else 110)


def _show_version(*, wanted: bool) -> None:
    if wanted:
        console.print(f"kintrafo {__version__}, SUNDIALS {native_version()}")
        raise typer.Exit


@app.callback()
def main(
    *,
    version: Annotated[
        bool,
        typer.Option("--version", callback=lambda v: _show_version(wanted=v), is_eager=True),
    ] = False,
) -> None:
    """Closed-form equations of motion for mechanisms with loops, compiled and simulated."""
    del version


@app.command("paper")
def paper_command(
    folder: Annotated[Path, typer.Argument(help="Where the figures go.")] = Path("out"),
    data: Annotated[str, typer.Option(help="Data set, by name, or a TOML file.")] = "reference_car",
) -> None:
    """Show the paper's results: Figures 4, 5 and 6 and a summary.

    Example: kintrafo paper out --data my_car.toml
    """
    from .figures import write_figures  # noqa: PLC0415 (matplotlib is slow to import)
    from .overview import write_overview  # noqa: PLC0415

    model = Model(data)
    folder.mkdir(parents=True, exist_ok=True)
    with console.status("kinematics over the travel"):
        kinematics = paper.kinematics(model)
    with console.status("one second of motion"):
        dynamics = paper.dynamics(model)
    with console.status("figures"):
        files = write_figures(kinematics, dynamics, folder, data)
        write_overview(model, folder / "overview.png")
    console.print(summary(model, paper.rest(model), dynamics))
    console.print(
        "The paper gives no hardpoints, masses or rates. These are results of "
        f"{data}, which is not the paper's car: compare them in kind.",
        markup=False,
    )
    for file in [*files, folder / "overview.png"]:
        console.print(f"  {file}", markup=False)


def summary(model: Model, rest: paper.Rest, dynamics: paper.Dynamics) -> Table:
    """Return the table of what was found."""
    equations, result = model.equations, dynamics.result
    loops = "; ".join(" - ".join(bodies) for bodies in equations.LOOPS)
    rows = {
        "mobility (Eq. 1)": f"{equations.MOBILITY}",
        "independent loops": f"{len(equations.LOOPS)}: {loops}",
        "operations of the right-hand side": f"{equations.rhs_rack_held.operations['total']} "
        "with the rack held, "
        f"{equations.rhs.operations['total']} with the rack moving",
        "equilibrium": f"wheel centre at {rest.height * 1e3:.3f} mm",
        "eigenvalues there": f"{rest.eigenvalues_text} 1/s, and two zeros (wheel spin)",
        "wheel-hop mode": rest.mode_text,
        "integration of 1 s": f"Gear's method (BDF of {result.solver}), {result.nfev} evaluations, "
        f"{result.njev} Jacobians, {result.nlu} factorisations, output every 0.1 ms",
        "time taken": f"{dynamics.seconds * 1e3:.1f} ms, signals included; the paper, on a 233 MHz "
        f"Pentium: {paper.PAPER_GEAR_S:.0f} s with Gear's method, more than "
        f"{paper.PAPER_RUNGE_KUTTA_S / 60:.0f} min with Runge-Kutta",
    }
    table = Table(title=f"{model.suspension.vehicle.side} MacPherson suspension", show_header=False)
    for name, text in rows.items():
        table.add_row(name, text)
    return table


def run() -> None:
    """Run the command line; a user's mistake ends with a message, not with a traceback."""
    try:
        app()
    except KintrafoError as error:
        _refuse(str(error))
    except OSError as error:
        _refuse(f"{error.filename}: {error.strerror}")


def _refuse(message: str) -> NoReturn:
    # no markup: the names of sections stand in brackets
    printer = Console(stderr=True)
    printer.print(f"error: {message}", style="red", highlight=False, markup=False, soft_wrap=True)
    raise SystemExit(2)
