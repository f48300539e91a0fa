"""``kintrafo ride``: how a car rests, swings and rides over a road."""

from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.markup import escape
from rich.table import Table

from ...core.tabulated import significant
from ...terminal.console import console, note, print_json, problems
from ...terminal.exits import Exit
from .loading import car_of
from .options import argument, option
from .outputs import PlotOptions, name_files, title_of

if TYPE_CHECKING:
    from xarray import Dataset

    from ..assembly.car import CarAssembly
    from ..roads import Road

EXAMPLES = (
    "kintrafo ride quarter_car",
    "kintrafo ride reference_vehicle --road C --speed 60 --seed 7",
    "kintrafo ride my_vehicle.toml --bump 50 --bump-length 0.5 --speed 30 -o bump.csv",
)


def command(
    file: Annotated[
        str, argument("File of a car (TOML), or the name of a packaged one: quarter_car.", "FILE")
    ],
    *,
    road: Annotated[str, option("Rough road: a class of ISO 8608, A to H.", "CLASS")] = "B",
    seed: Annotated[int, option("Of the rough road.", "NUMBER")] = 1,
    bump: Annotated[
        float | None, option("A bump of this height in place of it; negative: a pothole.", "MM")
    ] = None,
    bump_length: Annotated[float, option("Length of the bump.", "M")] = 0.5,
    under: Annotated[str, option("Wheels that meet the bump: both, left, right.", "SIDE")] = "both",
    speed: Annotated[float, option("Speed of the car.", "KM/H")] = 80.0,
    duration: Annotated[float, option("Duration of the simulation.", "S")] = 30.0,
    output_step: Annotated[float, option("Time between outputs.", "MS")] = 5.0,
    output: PlotOptions,
) -> None:
    """Let a car ride over a road: rest, modes, accelerations, wheel loads, rattle space.

    The acceleration is that of the body, unweighted and weighted for comfort (W_k of ISO 2631-1).
    On a rough road the linear prediction, from the exact linearisation at rest, is beside the
    simulation. Rear wheels meet the road later by the wheelbase. Data files have the motion.
    """
    from ...datasets import export
    from ..analysis import ride

    outputs = output.files(file)
    assembly = car_of(file)
    v = speed / 3.6
    chosen = _road(assembly, road, seed, bump, bump_length, under, v * duration)
    found = {"at_rest": ride.at_rest(assembly), "modes": ride.modes(assembly)}
    if bump is None:
        found["linear"] = ride.response(assembly, v, road)
    settle = min(5.0, 0.2 * duration) if bump is None else 0.0
    motion = ride.over(
        assembly, chosen, v, duration=duration, settle=settle, output_step=output_step / 1e3
    )
    written = outputs.write(motion, title=title_of(file))
    if output.json:
        judged = {str(n): _judged(d) for n, d in motion.items()}
        print_json({n: export.as_dict(d) for n, d in found.items() if n != "linear"} | judged)
        return
    for unused in assembly.car.unused:
        note(f"not used: {unused}")
    console.print(_rest(found["at_rest"], file))
    console.print(_modes(found["modes"], file))
    title = f"{file}: {chosen.words}, {speed:g} km/h, {duration:g} s"
    console.print(_ride(motion, found.get("linear"), title))
    name_files(written)
    left = motion.attrs["not_valid"]
    for text in left:
        problems.print(f"not valid: {text}", style="red", highlight=False, markup=False)
    if left:
        raise typer.Exit(Exit.REFUSED)


def _road(
    assembly: "CarAssembly",
    road: str,
    seed: int,
    bump: float | None,
    bump_length: float,
    under: str,
    way: float,
) -> "Road":
    from .. import roads

    if bump is None:
        longest = max(way, 1.01 / roads.rough.WAVES[0])
        return roads.iso8608(road, length=longest, seed=seed, track=assembly.track)
    at = min(5.0, 0.1 * way)
    return roads.bump(bump / 1e3, bump_length, at=at, end=max(way, at + bump_length), sides=under)


def _rest(found: "Dataset", file: str) -> Table:
    from ..assembly.by_wheel import WHEEL

    table = Table(title=escape(f"{file}: at rest"))
    wheels = [str(name) for name in found[WHEEL].values.ravel()]
    for name in ("", *wheels):
        table.add_column(name.replace("_", " "), justify="left" if not name else "right")
    for data in found.data_vars.values():
        values = _displayed(data).ravel().tolist()
        cells = [significant(float(value)) for value in values]
        table.add_row(_label(data), *cells[: len(wheels)])
    return table


def _modes(found: "Dataset", file: str) -> Table:
    table = Table(title=escape(f"{file}: modes at rest"))
    table.add_column("mode")
    table.add_column("frequency [Hz]", justify="right")
    table.add_column("damping ratio", justify="right")
    for name in found["mode"].values:
        own = found.sel(mode=name)
        cells = f"{float(own['frequency']):.2f}", f"{float(own['damping_ratio']):.3f}"
        table.add_row(str(name).replace("_", " "), *cells)
    return table


def _ride(motion: "Dataset", linear: "Dataset | None", title: str) -> Table:
    """Return what the ride is judged by, beside the linear prediction."""
    import numpy as np

    table = Table(title=escape(title))
    table.add_column("output")
    heads = ("rms", "weighted rms", "smallest", "largest", "rms, linear", "weighted, linear")
    for head in heads:
        table.add_column(head, justify="right")
    wheels = np.atleast_1d(motion["wheel"].values)
    for name, data in motion.data_vars.items():
        predicted = {} if linear is None else linear.get(f"{name}_psd", motion[name]).attrs
        factor = _factor(data)
        keys = ("rms", "weighted_rms", "smallest", "largest")
        columns = [np.atleast_1d(data.attrs.get(key, np.nan)) for key in keys]
        columns += [
            np.atleast_1d(predicted.get(key, np.nan) if f"{name}_psd" in (linear or ()) else np.nan)
            for key in ("rms", "weighted_rms")
        ]
        several = len(columns[0]) > 1
        for i in range(len(columns[0])):
            label = _label(data) + (f", {str(wheels[i]).replace('_', ' ')}" if several else "")
            cells = [_cell(column[min(i, len(column) - 1)] * factor) for column in columns]
            table.add_row(label, *cells)
    return table


def _cell(value: float) -> str:
    return "" if value != value else significant(float(value))  # noqa: PLR0124 (no number)


def _judged(data: Any) -> dict[str, Any]:
    keys = ("rms", "weighted_rms", "smallest", "largest", "off_the_road", "units")
    return {key: data.attrs[key] for key in keys if key in data.attrs}


def _factor(data: Any) -> float:
    from ...core.quantities import display_of

    return float(display_of(data.attrs).factor)


def _displayed(data: Any) -> Any:
    return data.values * _factor(data)


def _label(data: Any) -> str:
    from ...core.quantities import bracketed, long_name

    return escape(bracketed(long_name(data), data.attrs))
