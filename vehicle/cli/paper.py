"""``kintrafo paper``: the paper's results."""

from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Annotated

from rich.table import Table

from ...terminal.console import console, problems, say
from .options import Force, argument, option

if TYPE_CHECKING:
    from ..analysis import paper
    from ..models.model import Model

EXAMPLES = ("kintrafo paper out", "kintrafo paper out --data my_car.toml")


def command(
    folder: Annotated[Path, argument("Folder of the figures.")] = Path("out"),
    data: Annotated[str, option("Data set, by name, or a TOML file.")] = "reference_car",
    *,
    force: Force = False,
) -> None:
    """Show the results of the paper (Góis and Sarzeto, 2000): Figures 4 to 6 and a summary."""
    from ...core.files import refuse
    from ..analysis import paper
    from ..models.model import Model
    from ..plots.overview import write_overview
    from ..plots.paper import figure_files, write_figures

    overview = folder / "overview.png"
    refuse([*figure_files(folder), overview], force=force)
    model = Model(data)
    with problems.status("kinematics over the travel"):
        kinematics = paper.kinematics(model)
    with problems.status("one second of motion"):
        dynamics = paper.dynamics(model)
    with problems.status("figures"):
        files = write_figures(kinematics, dynamics, folder, data, force=force)
        write_overview(model, overview, force=force)
    console.print(summary(model, paper.rest(model), dynamics))
    console.print(
        "The paper gives no hardpoints, masses or rates. These are results of "
        f"{data}, which is not the paper's car: compare the shapes of the curves, not the numbers.",
        markup=False,
    )
    for file in [*files, overview]:
        say(f"  {file}")


def summary(model: "Model", rest: "paper.PaperRest", dynamics: "paper.PaperDynamics") -> Table:
    """Return the table of results."""
    from ..analysis.paper import PAPER_GEAR_S, PAPER_RUNGE_KUTTA_S

    equations, result = model.equations, dynamics.result
    loops = "; ".join(" - ".join(bodies) for bodies in equations.LOOPS)
    rows = {
        "mobility (Eq. 1)": f"{equations.MOBILITY}",
        "independent loops": f"{len(equations.LOOPS)}: {loops}" if loops else "none",
        "operations of the right-hand side": _operations(equations),
        "equilibrium": f"wheel centre at {rest.height * 1e3:.3f} mm",
        "eigenvalues there": f"{rest.hop.eigenvalues_text} 1/s, and two zeros (wheel spin)",
        "wheel-hop mode": _hop(model, rest),
        "integration of 1 s": f"Gear's method (BDF of {result.solver}), {result.nfev} evaluations, "
        f"{result.njev} Jacobians, {result.nlu} factorisations, output every 0.1 ms",
        "time taken": f"{dynamics.seconds * 1e3:.1f} ms, signals included; the paper, on a 233 MHz "
        f"Pentium: {PAPER_GEAR_S:.0f} s with Gear's method, more than "
        f"{PAPER_RUNGE_KUTTA_S / 60:.0f} min with Runge-Kutta",
    }
    table = Table(
        title=f"{model.suspension.vehicle.side} {model.suspension.TITLE}", show_header=False
    )
    for name, text in rows.items():
        table.add_row(name, text)
    return table


def _operations(equations: ModuleType) -> str:
    """Return the number of operations in one evaluation, with the rack held and moving."""
    total = f"{equations.rhs.operations['total']}"
    held = getattr(equations, "rhs_rack_held", None)
    if held is None:
        return total
    return f"{held.operations['total']} with the rack held, {total} with the rack moving"


def _hop(model: "Model", rest: "paper.PaperRest") -> str:
    """Return the wheel-hop mode in words; without friction, whose smoothing would damp it."""
    from ..analysis.checkup import without_friction
    from ..analysis.paper import rest as at_rest

    smooth = without_friction(model)
    return rest.hop.text if smooth is model else f"{at_rest(smooth).hop.text}, without friction"
