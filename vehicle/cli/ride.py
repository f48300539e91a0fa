"""``kintrafo ride``: how a car rests, swings and rides over a road."""

from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...core.tabulated import significant
from ...terminal.console import console, note, print_json, problems, table
from ...terminal.exits import Exit
from .loading import car_of
from .options import argument, option
from .outputs import PlotOptions, name_files, title_of

if TYPE_CHECKING:
    from rich.table import Table
    from xarray import Dataset

    from ..assembly.car import CarAssembly
    from ..roads import Road

EXAMPLES = (
    "kintrafo ride quarter_car",
    "kintrafo ride quarter_car --road C --speed 60 --seed 7 -o ride.csv",
    "kintrafo ride quarter_car --bump 20 --bump-length 1 --speed 30 -o bump.csv",
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
    simulation. Rear wheels meet the road later by the wheelbase. Data files have the motion; on a
    rough road others, with _response behind their names, the spectra and the responses to the
    road under each wheel.
    """
    from ...datasets import export
    from ..analysis import ride

    suffixes = ["", "_response"] if bump is None else [""]
    outputs = output.files(file, suffixes=suffixes, drawn=[""])
    assembly = car_of(file)
    v = speed / 3.6
    if not duration > 0.0:
        raise typer.BadParameter(f"--duration {duration:g}: more than 0 s is needed")
    chosen = _road(assembly, road, seed, bump, bump_length, under, v * duration)
    found = {"at_rest": ride.at_rest(assembly), "modes": ride.modes(assembly)}
    if bump is None:
        found["linear"] = ride.response(assembly, v, road)
    settle = min(5.0, 0.2 * duration) if bump is None else 0.0
    motion = ride.over(
        assembly, chosen, v, duration=duration, settle=settle, output_step=output_step / 1e3
    )
    written = outputs.write(motion, title=title_of(file))
    if "linear" in found:
        written += outputs.write_data(found["linear"], "_response")
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


def _rest(found: "Dataset", file: str) -> "Table":
    from ...core.quantities import displayed, heading_of
    from ..assembly.by_wheel import WHEEL

    wheels = [str(name).replace("_", " ") for name in found[WHEEL].values.ravel()]
    rows = [
        (heading_of(data), *map(significant, displayed(data).ravel().tolist()[: len(wheels)]))
        for data in found.data_vars.values()
    ]
    return table(f"{file}: at rest", ("", *wheels), rows)


def _modes(found: "Dataset", file: str) -> "Table":
    rows = [
        (str(name).replace("_", " "), f"{float(own['frequency']):.2f}",
         f"{float(own['damping_ratio']):.3f}")
        for name in found["mode"].values
        for own in [found.sel(mode=name)]
    ]  # fmt: skip
    return table(f"{file}: modes at rest", ("mode", "frequency [Hz]", "damping ratio"), rows)


def _ride(motion: "Dataset", linear: "Dataset | None", title: str) -> "Table":
    """Return what the ride is judged by, beside the linear prediction."""
    import numpy as np

    from ...core.quantities import display_of, heading_of

    rows = []
    wheels = np.atleast_1d(motion["wheel"].values)
    for name, data in motion.data_vars.items():
        predicted = {} if linear is None else linear.get(f"{name}_psd", motion[name]).attrs
        factor = display_of(data.attrs).factor
        keys = ("rms", "weighted_rms", "smallest", "largest")
        columns = [np.atleast_1d(data.attrs.get(key, np.nan)) for key in keys]
        columns += [
            np.atleast_1d(predicted.get(key, np.nan) if f"{name}_psd" in (linear or ()) else np.nan)
            for key in ("rms", "weighted_rms")
        ]
        several = len(columns[0]) > 1
        for i in range(len(columns[0])):
            wheel = f", {str(wheels[i]).replace('_', ' ')}" if several else ""
            cells = [_cell(column[min(i, len(column) - 1)] * factor) for column in columns]
            rows.append((heading_of(data) + wheel, *cells))
    heads = ("rms", "weighted rms", "smallest", "largest", "rms, linear", "weighted, linear")
    return table(title, ("output", *heads), rows)


def _cell(value: float) -> str:
    return "" if value != value else significant(float(value))  # noqa: PLR0124 (no number)


def _judged(data: Any) -> dict[str, Any]:
    keys = ("rms", "weighted_rms", "smallest", "largest", "off_the_road", "units")
    return {key: data.attrs[key] for key in keys if key in data.attrs}
