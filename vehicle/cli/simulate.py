"""``kintrafo simulate``: the motion of a suspension, an axle or a car over a road."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from ...core.tabulated import number
from ...terminal.console import console, print_json, problems, say, table
from ...terminal.exits import Exit
from .loading import model_of
from .options import File, option
from .outputs import CurveOptions, Loads, Outputs, name_files, title_of
from .simulation_options import ScenarioOptions, SolverOptions

if TYPE_CHECKING:
    from rich.table import Table
    from xarray import Dataset

    from ...simulation.result import Simulation
    from ..analysis.scenario import Scenario

EXAMPLES = (
    "kintrafo simulate reference_car --height 305",
    "kintrafo simulate my_car.toml --road-step 20 --road-step-at 0.1 -o bump.csv --plot bump.png",
    "kintrafo simulate my_car.toml --road-sine 10 --road-frequency 2 --duration 5",
    "kintrafo simulate my_car.toml --road-step 60 --loads loads.csv",
    "kintrafo simulate my_car.toml --measured road.csv --speed 60 -o ride.nc",
    "kintrafo simulate reference_axle --road-step 20 --wheels left",
    "kintrafo simulate rigid_axle --road-step 20 --wheels left",
)

# Order of the page of curves, for each wheel and for coupling elements; constant ones are left out.
_DRAWN = (
    "road_height", "rack_position", "wheel_center_z", "wheel_acceleration", "tyre_force", "fz",
    "spring_force", "spring_spring_force", "damper_force", "damper_damper_force", "strut_length",
    "spring_length", "camber", "toe", "axle_steer", "heave", "roll", "bar_angle",
    "bar_spring_moment",
)  # fmt: skip


@dataclass(frozen=True)
class SimulationOutput(CurveOptions):
    """The options of curves of a motion, and of the loads on parts."""

    loads: Loads = None


def command(
    file: File,
    *,
    driven: ScenarioOptions,
    wheels: Annotated[
        Literal["both", "left", "right"] | None,
        option("Of an axle: wheels on this road. Default: both.", panel="Road"),
    ] = None,
    solver: SolverOptions,
    output: SimulationOutput,
) -> None:
    """Simulate a suspension, an axle or a car over a step, a sine or a measured road.

    The body of a suspension or an axle is held; that of a car, such as quarter_car, moves. Without
    --height the motion starts at rest on the road. The equations of an axle or a car are derived
    and compiled at first use, which takes up to a minute.
    """
    from ..corner.wheel_loads import UNITS

    outputs = output.files(file, driven.measured)
    scenario = driven.scenario()
    model = model_of(file, wheel_loads=not UNITS.keys().isdisjoint(scenario.inputs))
    run = _ScenarioRun(model, file, scenario, wheels)
    result, motion = _played(run, solver.of_simulate(), outputs, silent=output.json)
    written = _written(run, motion, outputs, title_of(file))
    if outputs.loads:
        from ..analysis.loads import along

        written += outputs.write_loads(along(model, result))
    left = result.validity
    if output.json:
        print_json(_summary(result, motion, run))
    else:
        console.print(_table(motion, run))
        for line in _in_words(result, run):
            say(line)
        name_files(written)
    for excursion in left:
        head, style = ("note", "yellow") if excursion.bound.possible else ("not valid", "red")
        problems.print(f"{head}: {excursion}", style=style, highlight=False, markup=False)
    if not all(excursion.bound.possible for excursion in left):
        raise typer.Exit(Exit.REFUSED)


class _ScenarioRun:
    """A model and its scenario, checked against options that are not for its file."""

    def __init__(self, model: Any, file: str, scenario: "Scenario", wheels: str | None) -> None:
        from ..assembly.of import assembly_of

        self.model, self.file, self.scenario = model, file, scenario
        assembly = assembly_of(model)
        self.names = {wheel: assembly.names_of(wheel) for wheel in assembly.wheels}
        self.moves = assembly.body_moves
        if len(self.names) == 1 and wheels is not None:
            raise typer.BadParameter("--wheels is only for the file of an axle")
        self.wheels = wheels or "both"
        if getattr(model, "free_rack", False):
            _note_free_rack(file, scenario.inputs)

    def curves(self, motion: "Dataset") -> list[str]:
        """Return the names of the shown curves of a motion, in order."""
        starts = ("", *(s for n in self.names.values() for s in (n.prefix, n.signals)))
        names = dict.fromkeys(f"{start}{stem}" for stem in _DRAWN for start in starts)
        return [name for name in names if name in motion]


def _note_free_rack(file: str, inputs: dict[str, Any]) -> None:
    """Print that the rack moves freely; refuse to prescribe its motion."""
    from ...core.errors import InputError

    reason = "tie rod, rack or upper strut have mass, so the rack moves freely"
    if "rack_position" in inputs:
        problem = f"{reason}: its motion cannot be prescribed. Set their mass_kg to 0 to do so."
        raise InputError([problem], file)
    problems.print(f"note: {reason}, without a force on it.", style="yellow", markup=False)


def _played(
    run: _ScenarioRun, options: dict[str, Any], outputs: Outputs, *, silent: bool
) -> "tuple[Simulation, Dataset]":
    """Simulate; if the integration stops early, write the motion up to there and raise."""
    from ...simulation.result import SimulationError
    from ..analysis import scenario

    try:
        with problems.status("integrating"):
            return scenario.run(run.model, run.scenario, wheels=run.wheels, **options)
    except SimulationError as error:
        if error.partial is not None and error.partial.t.size > 1:
            motion = scenario.motion_of(run.model, error.partial)
            written = _written(run, motion, outputs, f"{title_of(run.file)}, unfinished")
            name_files(() if silent else written)
        reason, advice = (
            text.replace("max_steps", "--max-steps").replace("rtol", "--rtol")
            for text in (error.reason, error.advice)
        )
        raise SimulationError(reason, error.time, error.state, error.partial, advice) from error


def _written(run: _ScenarioRun, motion: "Dataset", outputs: Outputs, title: str) -> list[Path]:
    """Write the motion; its page has the curves that are not constant."""
    from ..analysis.scenario import by_wheel

    drawn, first = by_wheel(run.model, motion), f"{next(iter(run.names))}_"
    names = dict.fromkeys(n for c in run.curves(motion) for n in (c, c.removeprefix(first)))
    known = [name for name in names if name in drawn]
    varying = [n for n in known if float(drawn[n].max() - drawn[n].min()) > 0.0]
    return outputs.write(motion, title=title, names=varying, drawn=drawn)


def _crossings(result: "Simulation", run: _ScenarioRun) -> dict[str, list[float]]:
    """Return the times [s] at which each wheel left and touched the ground."""
    names = [
        f"{own.prefix}wheel_{what}_ground"
        for own in run.names.values()
        for what in ("leaves", "touches")
    ]
    if not result.t_events:
        return {name: [] for name in names}
    return {n: [float(t) for t in at] for n, at in zip(names, result.t_events, strict=True)}


def _counts(result: "Simulation") -> dict[str, int]:
    names = ("steps", "nfev", "njev", "nlu", "error_test_failures", "order")
    return {name: int(result[name]) for name in names if name in result}


def _summary(result: "Simulation", motion: "Dataset", run: _ScenarioRun) -> dict[str, Any]:
    from ...datasets.recording import statistics

    return {
        "duration": float(result.t[-1]),
        "message": result.message,
        "solver": {"name": result.solver, **_counts(result)},
        **_crossings(result, run),
        "validity": [
            vars(found) | {"bound": vars(found.bound), "text": str(found)}
            for found in result.validity
        ],
        "statistics": {
            name: {"units": motion[name].attrs["units"], **vars(found)}
            for name, found in statistics(motion).items()
        },
    }


def _table(motion: "Dataset", run: _ScenarioRun) -> "Table":
    from ...core.quantities import display_of, heading_of
    from ...datasets.recording import statistics

    found, rows = statistics(motion), []
    for name in run.curves(motion):
        factor = display_of(motion[name].attrs).factor
        values = (number(value * factor) for value in vars(found[name]).values())
        rows.append((heading_of(motion[name]), *values))
    title = f"{run.file}: motion from 0 s to {float(motion['time'][-1]):g} s"
    columns = ("signal", "smallest", "largest", "mean", "rms about it", "last")
    return table(title, columns, rows)


def _in_words(result: "Simulation", run: _ScenarioRun) -> list[str]:
    """Return sentences on the solver, the body, and wheels that left the ground."""
    crossings, counts = _crossings(result, run), _counts(result)
    lines = [f"{result.solver}: " + ", ".join(_WORDS[n].format(v) for n, v in counts.items())]
    if not run.moves:
        lines.append(
            "The body is held; in the file of a car it moves (see docs/suspension/car.md)."
        )
    for prefix in (own.prefix for own in run.names.values()):
        left = crossings[f"{prefix}wheel_leaves_ground"]
        if not left:
            continue
        times = ", ".join(f"{time:.4g} s" for time in left[:5])
        more = ", ..." if len(left) > 5 else ""
        often = "once" if len(left) == 1 else f"{len(left)} times"
        which = f"The {prefix.replace('_', ' ')}wheel"
        lines.append(f"{which} leaves the ground {often}: {times}{more}")
    return lines


_WORDS = {
    "steps": "{} steps", "nfev": "{} evaluations", "njev": "{} Jacobians",
    "nlu": "{} factorisations", "error_test_failures": "{} failed error tests",
    "order": "last order {}",
}  # fmt: skip
