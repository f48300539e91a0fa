"""``kintrafo drive``: manoeuvres of a car that drives."""

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal

from ...core.tabulated import significant, whole
from ...terminal.console import console, print_json, problems, progress_bar, table
from ..data.starter import manoeuvres
from .loading import car_of, derived, naming, note_unused
from .options import argument, option
from .outputs import (
    Loads,
    MotionOptions,
    Outputs,
    end_if_not_valid,
    name_files,
    title_of,
)
from .road import RoadOptions

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from rich.table import Table
    from xarray import DataArray, Dataset

    from ..analysis.handling import HandlingResult
    from ..analysis.handling.manoeuvres import Manoeuvre
    from ..assembly.car import CarAssembly
    from ..models.car.slope import Slope
    from ..roads import Road

EXAMPLES = (
    "kintrafo drive driving_car",
    "kintrafo drive driving_car --manoeuvre circle --plot circle.png",
    "kintrafo drive driving_car --manoeuvre double_lane_change --animate lane.gif -o lane.csv",
    "kintrafo drive driving_car --manoeuvre braking --speed 50 --loads loads.csv",
    "kintrafo drive driving_car --manoeuvre straight --bump-height -40 --plot pothole.png",
    "kintrafo drive driving_car --manoeuvre straight --grade 8 --crossfall 3",
    "kintrafo new my_step.toml --template step_steer",
)


@dataclass(frozen=True)
class DriveOutput(MotionOptions):
    """The options of the motion of a car, and of the loads on its parts."""

    loads: Loads = None


def command(
    file: Annotated[
        str, argument("File of a car (TOML), or a packaged name, such as driving_car.", "FILE")
    ],
    *,
    manoeuvre: Annotated[
        str,
        option(f"File of a manoeuvre (TOML), or one of {', '.join(manoeuvres())}.", "NAME"),
    ] = "step_steer",
    speed: Annotated[
        float | None, option("Speed in place of that of the manoeuvre.", "KM/H")
    ] = None,
    turn: Annotated[
        Literal["left", "right"] | None, option("Side in place of that of the manoeuvre.")
    ] = None,
    road: RoadOptions,
    grade: Annotated[
        float,
        option("Slope of the road along the path of the car, positive uphill.", "%"),
    ] = 0.0,
    crossfall: Annotated[
        float,
        option("Slope across the car, positive if the road falls to the right.", "%"),
    ] = 0.0,
    output: DriveOutput,
) -> None:
    """Drive a car through a manoeuvre: step steer, circle, lane change, braking, and others.

    The car is one whose body moves freely, car = "full" in its file. A manoeuvre is a file that
    can be edited; kintrafo new FILE --template NAME writes one that comes with kintrafo. Metrics
    are those of the standards, in the axes of ISO 8855. Data files have the curves over time,
    lateral acceleration or frequency; figures show them. If a simulated car does not run straight,
    a second figure, whose name ends in _path, shows its path. The tracks of a road (--road,
    --bump-height, --kerb) follow the path of the car. --animate shows the car in motion, with the
    forces on its tyres; --loads has the forces of all joints, springs and tyres, whose greatest
    ones are printed.
    """
    from ...core.errors import InputError
    from ...datasets import export
    from ..analysis import handling

    changes = {"--speed": ("speed_km_per_h", speed), "--turn": ("turn", turn)}
    chosen = _manoeuvre(manoeuvre, {n: one for n, one in changes.items() if one[1] is not None})
    pages = (*_drawn(chosen), *(("_path",) if chosen.TRAVELS else ()))
    own = [] if manoeuvre in manoeuvres() else [manoeuvre]
    own += [road.name] if road.is_measured else []
    outputs = output.files(file, *own, suffixes=chosen.CURVES, drawn=pages)
    if not chosen.TRAVELS and (outputs.loads or outputs.animation is not None):
        problem = f"{chosen.TITLE} {_NO_MOTION}"
        raise InputError([problem], "--loads" if outputs.loads else "--animate")
    slope = _slope(chosen, grade, crossfall)
    assembly, profile = _on_road(file, chosen, road)
    with progress_bar(chosen.TITLE) as progress:
        found = handling.drive(
            assembly, chosen, road=profile, grade=slope.grade, crossfall=slope.crossfall,
            progress=progress,
        )  # fmt: skip
    title = f"{title_of(file)}: {found.metrics.attrs['title']}"
    written = _write(outputs, found, chosen, title)
    written += outputs.write_animation(found, title)
    made = _tables(found, title)
    if outputs.loads:
        with problems.status("loads"):
            on_every = handling.dynamic_loads(found)
        written += outputs.write_loads(on_every)
        made.append(_greatest(on_every, title))
    if output.json:
        print_json({"metrics": export.as_dict(found.metrics), "not_valid": found.not_valid})
    else:
        note_unused(assembly.car, file)
        for each in made:
            console.print(each)
        name_files(written)
    end_if_not_valid(found.not_valid)


def _manoeuvre(name: str, changes: "Mapping[str, tuple[str, Any]]") -> "Manoeuvre":
    """Return a manoeuvre with keys and values of options, which its problems name."""
    from ...core.errors import InputError
    from ..analysis.handling import load_manoeuvre

    try:
        return load_manoeuvre(name, dict(changes.values()))
    except InputError as error:
        problems = list(error.problems)
        for option, (key, _) in changes.items():
            named = re.compile(rf"^{key}\b(?: =)?|\b{key} =")
            problems = [named.sub(option, problem) for problem in problems]
        words = " is not a known key.", ": this manoeuvre has no such key."
        problems = [problem.replace(*words) for problem in problems]
        of_option = any(problem.startswith("--") for problem in problems)
        raise InputError(problems, "drive" if of_option else error.source) from None


def _slope(chosen: "Manoeuvre", grade: float, crossfall: float) -> "Slope":
    """Return the slope from options in percent; refuse it in manoeuvres for a level road."""
    from ...core.validator import Validator
    from ..analysis.handling.driving import refuse_slope
    from ..models.car.slope import STEEPEST, Slope

    percent = {"grade": grade, "crossfall": crossfall}
    with Validator("kintrafo drive") as given:
        for name, value in percent.items():
            given.number(f"--{name}", value, "%", least=-100 * STEEPEST, below=100 * STEEPEST)
        if any(percent.values()):
            refuse_slope(given, chosen)
    return Slope(grade / 100.0, crossfall / 100.0)


def _on_road(
    file: str, chosen: "Manoeuvre", road: RoadOptions
) -> "tuple[CarAssembly, Road | None]":
    """Return the car with its equations, and its road; refuse before equations are derived."""
    from ...core.errors import InputError

    road.refuse_without_road()
    assembly = car_of(file)
    with naming(file):
        assembly.require_driving()
        chosen.check(assembly.car)
    if road.is_given and not chosen.TRAVELS:
        raise InputError([f"{chosen.TITLE} {_NO_ROAD}"], "--road, --bump-height, --kerb")
    profile = road.for_distance(assembly, chosen.greatest_distance) if road.is_given else None
    return derived(assembly), profile


def _drawn(chosen: "Manoeuvre") -> tuple[str, ...]:
    """Return the suffixes of figures: cones are in the figure of the path."""
    return tuple(suffix for suffix in chosen.CURVES if suffix != "_cones")


def _write(
    outputs: Outputs, found: "HandlingResult", chosen: "Manoeuvre", title: str
) -> "list[Path]":
    written = []
    for suffix, curves in found.curves.items():
        written += outputs.write_data(curves, suffix)
    if not outputs.pages:
        return written
    from ..analysis.handling.driven import runs_straight
    from ..plots.handling import write_curves, write_path

    for suffix in _drawn(chosen):
        curves = found.curves[suffix]
        written += outputs.draw(write_curves, curves, title=title, suffix=suffix)
    motion, cones = found.curves[""], found.curves.get("_cones")
    if chosen.TRAVELS and not (cones is None and runs_straight(motion)):
        drawn = {"cones": cones, "wanted": chosen.wanted_path()}
        written += outputs.draw(write_path, motion, **drawn, title=title, suffix="_path")
    return written


def _tables(found: "HandlingResult", title: str) -> "list[Table]":
    """Return a table of scalar metrics, and tables of metrics by run or turn."""
    from ...core.quantities import displayed, heading_of

    single = {n: data for n, data in found.metrics.data_vars.items() if not data.ndim}
    rows = [(heading_of(data), significant(float(displayed(data)))) for data in single.values()]
    made = [table(title, ("metric", "value"), rows)] if rows else []
    several = [data for name, data in found.metrics.data_vars.items() if name not in single]
    if several:
        made.append(_by_column(several, title))
    curves = found.curves[""]
    for along, names in _OVER.items():
        if along in curves.dims:
            count = curves.sizes[along]
            some = curves.isel({along: slice(None, None, -(-count // _most_columns()))})
            made.append(_by_column([some[name] for name in names], title))
    return made


# Curves in a printed table, by axis.
_OVER = {
    "lateral_acceleration": (
        "steering_wheel_angle", "understeer_gradient", "roll_angle", "sideslip_angle",
        "drive_torque",
    ),
    "speed": (
        "yaw_rate_gain", "lateral_acceleration_gain", "understeer_gradient", "sideslip_gradient",
        "roll_gradient",
    ),
}  # fmt: skip
# Widths of the headings of rows, and of a column of numbers [characters].
_HEADS, _COLUMN = 30, 10
# Smaller forces are rounding [N].
_LEAST = 0.5
# Ends of messages about a manoeuvre.
_NO_ROAD = "is not simulated, and so not over a road. Leave it out."
_NO_MOTION = "has no simulation, and so no motion to show. Leave it out."


def _greatest(on_every: "Dataset", title: str) -> "Table":
    """Return a table of the greatest force at every joint, spring and tyre, with its time."""
    from ..analysis.loads import peaks
    from ..analysis.loads.sheets import shown_rows
    from ..assembly.by_wheel import without_side

    found = peaks(on_every)
    rows = []
    for i in shown_rows(on_every):
        own = found.isel(load=i)
        names = [str(own[name].values) for name in ("point", "part", "by")]
        words = [each.replace("_", " ") for each in (names[0], *map(without_side, names[1:]))]
        forces = (whole(float(force)) for force in own["force"].values)
        size, when = float(own["force_peak"]), float(own["force_peak_time"])
        if size >= _LEAST and names[2] != "inertia":
            rows.append((*words, whole(size), *forces, f"{when:.3f}"))
    heads = ("at", "on", "by", "greatest force [N]", "x", "y", "z", "at time [s]")
    return table(f"{title}: loads", heads, rows, words=(0, 1, 2))


def _most_columns() -> int:
    """Return the number of columns that fit into the terminal, at least 3."""
    return max(3, (console.width - _HEADS) // _COLUMN)


def _by_column(several: "list[DataArray]", title: str) -> "Table":
    """Return a table with a column for each run or turn; with a row for each if too wide."""
    from ...core.quantities import displayed, heading_of

    along = several[0][str(several[0].dims[0])]
    heads = (heading_of(along), *map(significant, displayed(along)))
    rows = [(heading_of(data), *map(significant, displayed(data))) for data in several]
    if along.size > _most_columns():
        heads, *rows = zip(heads, *rows, strict=True)
    return table(title, heads, rows)
