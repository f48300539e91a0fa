"""``kintrafo compare``: curves of several suspensions in one figure, and their differences."""

from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from ...core.tabulated import significant
from ...terminal.console import console, print_json, progress_bar, say, table
from . import goals as wanted
from .loading import assembly_of_file
from .options import Held, Of, among, argument, option
from .outputs import CurveOptions, name_files, title_of
from .variation_options import AXES_OF_CARS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rich.table import Table
    from xarray import Dataset

    from ..analysis.compare import Difference
    from ..assembly.assembly import Assembly
    from ..studies.evaluation import Subject

# Two curves cover each other in a figure if they differ by less than a line's width, which is this
# part of the span of the axis.
_WIDTH_OF_A_LINE = 0.01

EXAMPLES = (
    "kintrafo compare reference_car my_car.toml",
    "kintrafo compare before.toml after.toml --over rack --plot difference.png -o both.csv",
    "kintrafo compare before.toml after.toml --goals goals.toml --plot goals.png",
    "kintrafo compare rig.csv my_car.toml --plot measured.png",
    "kintrafo compare before.toml after.toml --of toe,bump_steer --plot steer.png",
    "kintrafo compare before.toml after.toml --held height --plot compliance.png",
)


def command(
    files: Annotated[
        list[str],
        argument(
            "Two or more input files, packaged names or files of curves; the first is the "
            "reference.",
            "FILE FILE...",
        ),
    ],
    *,
    over: Annotated[
        str | None,
        option(
            "Motion: travel or rack of suspensions; bump, roll, left, right, steer or rack of "
            "axles; heave, pitch or roll of cars, and, with options as of kintrafo sensitivity, "
            "speed or lateral_acceleration. Default: travel, bump of axles, heave of cars, or that "
            "of the measured curves.",
            "NAME[:OPTION=VALUE]",
        ),
    ] = None,
    of: Of = None,
    held: Annotated[
        Held | None,
        option(
            "Compare compliance on the bushes of the files, too, with this support of the wheel. "
            "Beside measured compliance the default is height."
        ),
    ] = None,
    goals: wanted.Goals = None,
    output: CurveOptions,
) -> None:
    """Compare the characteristics of two or more files, or of files and measured curves.

    Differences are relative to the first file: at design, and where they are largest. Data files
    have all characteristics. A .csv file has measured curves; its first line names wheel_travel
    [mm], rack_position [mm] or roll_angle [deg], and toe [deg] (toe_left [deg] of an axle) and so
    on. The other files are compared with it.
    """
    from ..analysis import compare
    from ..assembly.by_wheel import columns_of, flat
    from ..studies.sweep_axes import (
        compliances_over,
        name_of_axis,
        sweep_axes_of,
        sweep_axis,
    )

    outputs = output.files(*files, goals)
    dataset, axis, subjects = _compared(files, over, held)
    known = sweep_axes_of(next(iter(subjects.values())))
    table = flat(dataset)
    looked_at = [axis, held or "height"] if {*table} & {*compliances_over(axis)} else [axis]
    aims = wanted.read(goals, looked_at, known)
    if aims:
        wanted.refuse_elsewhere(dataset)
    if outputs.drawn:
        wanted.refuse_beyond(aims, dict.fromkeys(looked_at, dataset), goals)
    judged = wanted.judged(subjects, aims, goals)
    every = [*map(str, table.data_vars)]
    shown = among(columns_of(of, every), every) if of else every
    of_cars = name_of_axis(axis) in AXES_OF_CARS
    differences = compare.differences(dataset, sweep_axis(axis).at if of_cars else 0.0)
    found = [difference for difference in differences if difference.name in shown]
    first, *others = (str(name) for name in dataset["data_set"].values)
    drawn = table.assign_coords(
        data_set=("data_set", _titles(dataset["data_set"].values), dataset["data_set"].attrs)
    )
    title = " and ".join(map(str, drawn["data_set"].values))
    written = outputs.write(
        dataset, title=title, names=shown if of else _differing(table), drawn=drawn, goals=aims
    )
    if output.json:
        rows = [
            vars(each) | {"units": str(table[each.name].attrs.get("units", ""))} for each in found
        ]
        print_json({"differences": rows, "goals": judged} if aims else rows)
        return
    for name in others:
        chosen = [difference for difference in found if difference.data_set == name]
        console.print(_table(table, chosen, first, name))
    if aims:
        console.print(wanted.table(judged, f"targets and limits of {goals}"))
    if dataset.attrs.get("left_out"):
        say(f"columns that were not read: {dataset.attrs['left_out']}.")
    name_files(written)


def _differing(table: "Dataset") -> list[str]:
    """Return the curves with visible differences of two data sets; all if there are none."""
    from ...core.quantities import display_of
    from ...pictures.curves import LEAST_SPANS
    from ..plots.curves import without_copies

    found = []
    for name in without_copies(table, table.data_vars):
        data = table[name]
        between = data.max("data_set") - data.min("data_set")
        shown = display_of(data.attrs)
        span = max(float(data.max() - data.min()), LEAST_SPANS.get(shown.units, 0.0) / shown.factor)
        if float(between.max()) > _WIDTH_OF_A_LINE * span:
            found.append(str(name))
    return found or [str(name) for name in table.data_vars]


class _Compared(NamedTuple):
    """Curves of several data sets."""

    dataset: "Dataset"
    axis: str  # axis of the curves, such as `"travel"`
    subjects: "Mapping[str, Subject]"  # by data set, without the measured one


def _compared(files: list[str], over: str | None, held: Held | None) -> _Compared:
    from ..analysis import compare
    from ..analysis.characteristics.datasets import given_motion
    from ..studies.sweep_axes import name_of_axis

    measured = [file for file in files if file.lower().endswith(".csv")]
    assemblies = _assemblies([file for file in files if file not in measured])
    subjects = {name: assembly.subject for name, assembly in assemblies.items()}
    if measured:
        dataset, axis = _beside(assemblies, measured, over, held or "height")
        return _Compared(dataset, axis, subjects)
    if over is not None and len(assemblies) > 1 and name_of_axis(over) in AXES_OF_CARS:
        return _over_axis(assemblies, over)
    for file, assembly in assemblies.items():
        if over is not None and over not in assembly.motions:
            assembly.refuse_motion(over)
            there = ", ".join(assembly.motions)
            raise typer.BadParameter(f"--over {over}: the motions of a rig with {file} are {there}")
    first = next(iter(assemblies.values()))
    with progress_bar("characteristics") as progress:
        dataset = compare.compare(assemblies, over=over, held=held, progress=progress)
    return _Compared(dataset, given_motion(first, over), subjects)


def _over_axis(assemblies: "Mapping[str, Assembly]", over: str) -> _Compared:
    """Return curves of cars over speed or in steady turns."""
    from ...core.validator import Validator
    from ..analysis.compare import beside_each_other
    from ..studies.evaluation import common_positions, curves_over
    from ..studies.sweep_axes import given_axis, sweep_axes_of

    subjects = {name: assembly.subject for name, assembly in assemblies.items()}
    with Validator("--over") as given:
        for subject in subjects.values():
            over = given_axis(given, "--over", over, sweep_axes_of(subject))
    positions = common_positions([*assemblies.values()], over)
    datasets = [curves_over(assembly, over, positions) for assembly in assemblies.values()]
    return _Compared(beside_each_other(assemblies, datasets), over, subjects)


def _assemblies(files: list[str]) -> "dict[str, Assembly]":
    """Return the assemblies of files; refuse suspensions beside axles."""
    from ...core.quantities import distinct

    found = dict(zip(distinct(files), map(assembly_of_file, files), strict=True))
    motions = [assembly.usual_motion for assembly in found.values()]
    if len({*motions}) > 1:
        other = next(i for i, motion in enumerate(motions) if motion != motions[0])
        raise typer.BadParameter(
            f"{files[0]} and {files[other]}: one is a suspension and the other an axle. Compare "
            "files of one sort."
        )
    return found


def _beside(
    assemblies: "dict[str, Assembly]", measured: list[str], over: str | None, held: Held
) -> "tuple[Dataset, str]":
    """Return measured and computed curves, and their motion."""
    from ..analysis import rig

    if len(measured) > 1:
        raise typer.BadParameter(f"one file of measured curves, not {len(measured)}")
    curves = rig.measured_curves(measured[0])
    if not assemblies:
        raise typer.BadParameter("a hardpoint file is needed besides the measured curves")
    first = next(iter(assemblies.values()))
    axis = rig.motion_of(first, curves) or first.usual_motion
    if over is not None and (
        over not in first.motions or first.motions[over].along.name not in curves.dims
    ):
        raise typer.BadParameter(f"--over {over}: the measured curves are not over that")
    return rig.beside(curves, assemblies, measured[0], held=held), axis


def _titles(files: "Iterable[Any]") -> list[str]:
    """Return the titles of files in figures: names without folders if these differ."""
    given = [str(file) for file in files]
    titles = [title_of(file) for file in given]
    return titles if len(set(titles)) == len(titles) else given


def _table(dataset: "Dataset", found: list["Difference"], first: str, other: str) -> "Table":
    from ...core.quantities import display_of, heading_of

    along = next(str(name) for name in dataset.sizes if name != "data_set")
    at = f"at {heading_of(dataset[along])}"
    rows = []
    for difference in found:
        data = dataset[difference.name]
        factor = display_of(data.attrs).factor
        values = difference.first, difference.other, difference.at_design, difference.largest
        where = f"{difference.where * display_of(dataset[along].attrs).factor + 0.0:g}"
        rows.append((heading_of(data), *(significant(v * factor) for v in values), where))
    columns = ("characteristic", first, other, "difference", "largest", at)
    return table(f"{other} compared with {first}", columns, rows)
