"""``kintrafo ride``: rest, modes and motion of a car over a road."""

from typing import TYPE_CHECKING, Annotated, Any

from ...core.tabulated import significant
from ...core.units import KM_PER_H
from ...terminal.console import console, print_json, problems, table
from .loading import car_of, derived, naming, note_unused
from .options import argument, option
from .outputs import MotionOptions, end_if_not_valid, name_files, title_of
from .road import DURATION, RoadOptions

if TYPE_CHECKING:
    from rich.table import Table
    from xarray import DataArray, Dataset

EXAMPLES = (
    "kintrafo ride quarter_car",
    "kintrafo ride quarter_car --road C --speed 60 --seed 7 -o ride.csv",
    "kintrafo ride quarter_car --bump-height 20 --bump-length 1 --speed 30 -o bump.csv",
    "kintrafo ride quarter_car --road tracks.csv --contact-length 120",
    "kintrafo ride quarter_car --bump-height 20 --speed 20 --duration 3 --animate bump.gif",
    "kintrafo ride quarter_car --kerb 60 --contact-length 120 --speed 15",
)


def command(
    file: Annotated[
        str, argument("File of a car (TOML), or a packaged name, such as quarter_car.", "FILE")
    ],
    *,
    road: RoadOptions,
    speed: Annotated[float, option("Speed of the car.", "KM/H")] = 80.0,
    duration: Annotated[
        float | None,
        option("Duration of the simulation. Default: 30 s; to the end of a measured road.", "S"),
    ] = None,
    output_step: Annotated[float, option("Time between outputs.", "MS")] = 5.0,
    output: MotionOptions,
) -> None:
    """Simulate a car over a road: rest, modes, accelerations, wheel loads, wheel travel.

    Accelerations are those of the body, unweighted and weighted for comfort (W_k of ISO 2631-1).
    On a rough road the tables also have the prediction by the exact linearisation at rest. Rear
    wheels meet the road later, by the wheelbase over the speed. Data files have the motion; on a
    rough road further files, whose names end in _response, have the spectra and the responses to
    the road under each wheel. --animate shows the car on the road in motion.
    """
    from ...core.validator import Validator
    from ...datasets import export
    from ..analysis import ride
    from ..assembly.quantity import GREATEST_SPEED, LEAST_SPEED
    from ..plots.by_axle import by_axle
    from ..plots.motion import shown_names

    with Validator("kintrafo ride") as given:
        given.number("--speed", speed, "km/h", least=LEAST_SPEED, below=GREATEST_SPEED)
        given.number("--duration", DURATION if duration is None else duration, "s", above=0.0)
        given.number("--output-step", output_step, "ms", above=0.0)
    suffixes = ["", "_response"] if road.is_rough else [""]
    outputs = output.files(
        file, *([road.name] if road.is_measured else []), suffixes=suffixes, drawn=[""]
    )
    assembly = car_of(file)
    with naming(file):
        assembly.require_riding()
    v = speed / KM_PER_H
    profile, duration = road.for_time(assembly, v, duration)
    times = {
        "duration": duration,
        "settle": min(5.0, 0.2 * duration) if road.is_rough else 0.0,
        "output_step": output_step / 1e3,
    }
    ride.simulated.check_times(**times)  # before the equations are derived
    assembly = derived(assembly)
    found = {"at_rest": ride.at_rest(assembly), "modes": ride.modes(assembly)}
    if road.is_rough and road.contact_length is None:
        found["linear"] = ride.response(assembly, v, road.name)
    with problems.status("the motion over the road"):
        run = ride.run(assembly, profile, v, **times)
    motion = run.motion
    drawn = by_axle(motion)
    title = f"{title_of(file)}: {profile.words}, {speed:g} km/h"
    written = outputs.write(motion, title=title, drawn=drawn, names=shown_names(drawn))
    if "linear" in found:
        written += outputs.write_data(found["linear"], "_response")
    written += outputs.write_animation(run, title)
    if output.json:
        judged = {str(n): _judged(d) for n, d in motion.items()}
        shown = {n: export.as_dict(d) for n, d in found.items() if n != "linear"}
        print_json(shown | judged | {"not_valid": motion.attrs["not_valid"]})
    else:
        note_unused(assembly.car, file)
        for made in [*_rest(found["at_rest"], file), _modes(found["modes"], file)]:
            console.print(made)
        title = f"{file}: {profile.words}, {speed:g} km/h, {duration:g} s"
        for made in _ride(motion, found.get("linear"), title):
            console.print(made)
        name_files(written)
    end_if_not_valid(motion.attrs["not_valid"])


def _rest(found: "Dataset", file: str) -> "list[Table]":
    """Return a table with a column for each wheel, and one of the body."""
    from ...core.quantities import displayed, heading_of, names_in_words
    from ..analysis.ride.rest import wheels_and_body
    from ..assembly.by_wheel import WHEEL

    wheels, body = (
        [(heading_of(data), *map(significant, displayed(data).ravel())) for data in some]
        for some in wheels_and_body(found)
    )
    return [
        table(f"{file}: at rest", ("wheels", *names_in_words(found[WHEEL])), wheels),
        table(f"{file}: at rest", ("body", "value"), body),
    ]


def _modes(found: "Dataset", file: str) -> "Table":
    rows = [
        (str(name).replace("_", " "), f"{float(own['frequency']):.2f}",
         f"{float(own['damping_ratio']):.3f}", f"{100.0 * float(own['energy']):.0f} %")
        for name in found["mode"].values
        for own in [found.sel(mode=name)]
    ]  # fmt: skip
    head = ("mode", "frequency [Hz]", "damping ratio", "energy in this motion")
    return table(f"{file}: modes at rest", head, rows)


def _ride(motion: "Dataset", linear: "Dataset | None", title: str) -> "list[Table]":
    """Return a table of the body, and one with a column for each wheel."""
    from ...core.quantities import heading_of, names_in_words
    from ..analysis.ride.rest import wheels_and_body
    from ..assembly.by_wheel import WHEEL

    wheels, body = (
        {heading_of(data): _figures(data, linear) for data in some}
        for some in wheels_and_body(motion)
    )
    heads = list(dict.fromkeys(name for own in body.values() for name in own))
    of_body = [
        (output, *("".join(own.get(name, ())) for name in heads)) for output, own in body.items()
    ]
    of_wheels = [
        (output if i == 0 else "", name, *values)
        for output, own in wheels.items()
        for i, (name, values) in enumerate(own.items())
    ]
    return [
        table(title, ("body", *heads), of_body),
        table(title, ("wheels", "", *names_in_words(motion[WHEEL])), of_wheels, words=(0, 1)),
    ]


def _figures(data: "DataArray", linear: "Dataset | None") -> dict[str, list[str]]:
    """Return the RMS and extreme values of a variable as texts, one for each wheel."""
    import numpy as np

    from ...core.quantities import display_of

    spectrum = None if linear is None else linear.get(f"{data.name}_psd")
    sources = {"": data.attrs, ", linear": {} if spectrum is None else spectrum.attrs}
    factor = display_of(data.attrs).factor
    return {
        words + suffix: [significant(float(v) * factor) for v in np.atleast_1d(own[key])]
        for suffix, own in sources.items()
        for key, words in _FIGURES.items()
        if key in own
    }


_FIGURES = {key: key.replace("_", " ") for key in ("rms", "weighted_rms", "smallest", "largest")}


def _judged(data: Any) -> dict[str, Any]:
    keys = ("rms", "weighted_rms", "smallest", "largest", "off_the_road", "units")
    return {key: data.attrs[key] for key in keys if key in data.attrs}
