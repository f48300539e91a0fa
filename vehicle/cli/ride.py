"""``kintrafo ride``: rest, modes and motion of a car over a road."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from ...core.tabulated import significant
from ...terminal.console import console, print_json, problems, table
from ...terminal.exits import Exit
from .loading import car_of, derived, naming, note_unused
from .options import OUTPUT, argument, option, refuse_options
from .outputs import PlotOptions, name_files, title_of

if TYPE_CHECKING:
    from rich.table import Table
    from xarray import DataArray, Dataset

    from ..assembly.car import CarAssembly
    from ..roads import Road

EXAMPLES = (
    "kintrafo ride quarter_car",
    "kintrafo ride quarter_car --road C --speed 60 --seed 7 -o ride.csv",
    "kintrafo ride quarter_car --bump 20 --bump-length 1 --speed 30 -o bump.csv",
    "kintrafo ride quarter_car --road tracks.csv --contact-length 120",
    "kintrafo ride quarter_car --bump 20 --speed 20 --duration 3 --animate bump.gif",
    "kintrafo ride quarter_car --kerb 60 --contact-length 120 --speed 15",
)

_BUMP_LENGTH = 0.5  # [m]
_DURATION = 30.0  # of the simulation, where nothing else ends it [s]


def command(
    file: Annotated[
        str, argument("File of a car (TOML), or the name of a packaged one: quarter_car.", "FILE")
    ],
    *,
    road: Annotated[
        str | None,
        option(
            "Rough road, a class of ISO 8608 from A to H; or the file of a measured one: CSV with "
            "distance_m, left_height_mm and right_height_mm, or OpenCRG (.crg). Default: B.",
            "CLASS|FILE",
        ),
    ] = None,
    seed: Annotated[
        int | None,
        option("Seed of the rough road: equal seeds give equal roads. Default: 1.", "NUMBER"),
    ] = None,
    bump: Annotated[
        float | None,
        option("Height of one bump instead of the rough road; negative: a pothole.", "MM"),
    ] = None,
    bump_length: Annotated[float | None, option("Length of the bump. Default: 0.5 m.", "M")] = None,
    kerb: Annotated[
        float | None,
        option("Height of an edge instead of the rough road; negative: a drop.", "MM"),
    ] = None,
    under: Annotated[
        Literal["both", "left", "right"] | None,
        option("Wheels that meet the bump or the kerb. Default: both."),
    ] = None,
    contact_length: Annotated[
        float | None,
        option(
            "Length of the contact of a tyre, which then envelopes short waves and edges: by two "
            "elliptical cams. A kerb needs it. Default: contact in a point.",
            "MM",
        ),
    ] = None,
    speed: Annotated[float, option("Speed of the car.", "KM/H")] = 80.0,
    duration: Annotated[
        float | None,
        option("Duration of the simulation. Default: 30 s; to the end of a measured road.", "S"),
    ] = None,
    output_step: Annotated[float, option("Time between outputs.", "MS")] = 5.0,
    animate: Annotated[
        Path | None,
        option("Write the motion, in real time: .gif, or .html to play.", "PATH", panel=OUTPUT),
    ] = None,
    output: PlotOptions,
) -> None:
    """Simulate a car over a road: rest, modes, accelerations, wheel loads, wheel travel.

    Accelerations are those of the body, unweighted and weighted for comfort (W_k of ISO 2631-1).
    On a rough road the tables also have the prediction by the exact linearisation at rest. Rear
    wheels meet the road later, by the wheelbase over the speed. Data files have the motion; on a
    rough road further files, whose names end in _response, have the spectra and the responses to
    the road under each wheel. --animate shows the car on the road in motion.
    """
    from ...core.files import refuse
    from ...core.validator import Validator
    from ...datasets import export
    from ..analysis import ride
    from ..plots.by_axle import by_axle
    from ..plots.motion import ENDINGS, shown_names
    from ..plots.motion import animate as write_motion

    with Validator("kintrafo ride") as given:
        given.number("--speed", speed, "km/h", above=0.0)
        given.number("--duration", _DURATION if duration is None else duration, "s", above=0.0)
        given.number("--output-step", output_step, "ms", above=0.0)
    chosen = _Chosen(road, seed, bump, bump_length, kerb, under, contact_length)
    suffixes = ["", "_response"] if chosen.is_rough else [""]
    outputs = output.files(
        file, *([chosen.name] if chosen.is_measured else []), suffixes=suffixes, drawn=[""]
    )
    if animate is not None:
        refuse([animate], endings=ENDINGS, **outputs.rule)
    assembly = car_of(file)
    with naming(file):
        assembly.require_riding()
    v = speed / 3.6
    profile, duration = chosen.for_time(assembly, v, duration)
    assembly = derived(assembly)
    found = {"at_rest": ride.at_rest(assembly), "modes": ride.modes(assembly)}
    if chosen.is_rough and contact_length is None:
        found["linear"] = ride.response(assembly, v, chosen.name)
    settle = min(5.0, 0.2 * duration) if chosen.is_rough else 0.0
    with problems.status("the motion over the road"):
        run = ride.run(
            assembly, profile, v, duration=duration, settle=settle, output_step=output_step / 1e3
        )
    motion = run.motion
    drawn = by_axle(motion)
    written = outputs.write(motion, title=title_of(file), drawn=drawn, names=shown_names(drawn))
    if "linear" in found:
        written += outputs.write_data(found["linear"], "_response")
    title = f"{title_of(file)}: {profile.words}, {speed:g} km/h"
    if animate is not None:
        with problems.status("animation"):
            written.append(write_motion(run, animate, title=title, **outputs.rule))
    if output.json:
        judged = {str(n): _judged(d) for n, d in motion.items()}
        print_json({n: export.as_dict(d) for n, d in found.items() if n != "linear"} | judged)
        return
    note_unused(assembly.car, file)
    for made in [*_rest(found["at_rest"], file), _modes(found["modes"], file)]:
        console.print(made)
    title = f"{file}: {profile.words}, {speed:g} km/h, {duration:g} s"
    for made in _ride(motion, found.get("linear"), title):
        console.print(made)
    name_files(written)
    left = motion.attrs["not_valid"]
    for text in left:
        problems.print(f"not valid: {text}", style="red", highlight=False, markup=False)
    if left:
        raise typer.Exit(Exit.REFUSED)


@dataclass(frozen=True)
class _Chosen:
    """The road that the options say; None is an option that is not given."""

    road: str | None
    seed: int | None
    bump: float | None
    bump_length: float | None
    kerb: float | None
    under: Literal["both", "left", "right"] | None
    contact_length: float | None

    def __post_init__(self) -> None:
        from ...core.validator import Validator

        roads = {"--road": self.road, "--bump": self.bump, "--kerb": self.kerb}
        chosen = [name for name, value in roads.items() if value is not None]
        if len(chosen) > 1:
            raise typer.BadParameter(f"{' and '.join(chosen)} are given: choose one of them")
        if self.bump is None:
            refuse_options("--bump", {"--bump-length": self.bump_length})
        if not self.is_single:
            refuse_options("--bump and --kerb", {"--under": self.under})
        if not self.is_rough:
            refuse_options("a rough road", {"--seed": self.seed})
        lengths = {
            "--bump-length": (self.bump_length, "m"),
            "--contact-length": (self.contact_length, "mm"),
        }
        with Validator("kintrafo ride") as given:
            for name, (length, unit) in lengths.items():
                if length is not None:
                    given.number(name, length, unit, above=0.0)
            if self.seed is not None:
                given.whole("--seed", self.seed, least=0)
        if self.kerb is not None and self.contact_length is None:
            raise typer.BadParameter(
                "--kerb needs --contact-length, as a wheel does not touch an edge at a point"
            )

    @property
    def name(self) -> str:
        """The class of a rough road, or the file of a measured one."""
        return self.road or "B"

    @property
    def sides(self) -> Literal["both", "left", "right"]:
        """Which wheels meet an obstacle."""
        return self.under or "both"

    @property
    def is_single(self) -> bool:
        """Whether it is one obstacle."""
        return self.bump is not None or self.kerb is not None

    @property
    def is_rough(self) -> bool:
        """Whether it is a class of ISO 8608."""
        from ..roads import CLASSES

        return not self.is_single and self.name in CLASSES

    @property
    def is_measured(self) -> bool:
        """Whether it is a file."""
        return not self.is_single and not self.is_rough

    def for_time(
        self, assembly: "CarAssembly", speed: float, duration: float | None
    ) -> "tuple[Road, float]":
        """Return the road, and how long a car is on it where nothing else is said [s]."""
        found = self._road(assembly, speed * (duration or _DURATION))
        if duration is None and self.is_measured:
            return found, (found.length + max(assembly.behind().values())) / speed
        return found, duration or _DURATION

    def _road(self, assembly: "CarAssembly", way: float) -> "Road":
        """Return the road for a way [m]."""
        from .. import roads

        sides = {wheel.rpartition("_")[2] for wheel in assembly.wheels}
        if self.is_single and self.sides in {"left", "right"} - sides:
            raise typer.BadParameter(
                f"--under {self.sides}: this car has its wheel on the other side"
            )
        if self.kerb is not None:
            at = min(5.0, 0.2 * way)
            how: Any = {**self._tyre(assembly), "sides": self.sides}
            return roads.kerb(self.kerb / 1e3, at=at, end=max(way, 2.0 * at), **how)
        if self.bump is not None:
            at = min(5.0, 0.1 * way)
            length = _BUMP_LENGTH if self.bump_length is None else self.bump_length
            end = max(way, at + length)
            found = roads.bump(self.bump / 1e3, length, at=at, end=end, sides=self.sides)
        elif self.is_rough:
            longest = max(way, 1.01 / roads.rough.WAVES[0])
            seed = 1 if self.seed is None else self.seed
            found = roads.iso8608(self.name, length=longest, seed=seed, track=assembly.track)
        else:
            found = self._measured(assembly)
        if self.contact_length is None:
            return found
        return roads.enveloped(found, **self._tyre(assembly))

    def _measured(self, assembly: "CarAssembly") -> "Road":
        from ...core.errors import InputError
        from .. import roads

        if not Path(self.name).suffix and not Path(self.name).is_file():
            raise typer.BadParameter(
                f"--road {self.name}: a class of ISO 8608, {', '.join(roads.CLASSES)}, or a file "
                "is needed"
            )
        found = roads.read(self.name, track=assembly.track)
        least = max(assembly.behind().values())
        if found.length <= least:
            problem = (
                f"the road is {found.length:g} m long, and the wheelbase {least:g} m: the rear "
                "wheels would not reach it. Give a longer road."
            )
            raise InputError([problem], self.name)
        return found

    def _tyre(self, assembly: "CarAssembly") -> dict[str, float]:
        """Return what envelopes: the mean radius of the tyres, and the contact [m]."""
        from ...core.errors import InputError

        radii = [radius for radius in assembly.tyre_radii if radius]
        if not radii:
            problem = "no tyre has a radius, which --contact-length needs: enter [tyre] radius_mm."
            raise InputError([problem], "--contact-length")
        assert self.contact_length is not None
        return {
            "radius": sum(radii) / len(radii),
            "contact_length": self.contact_length / 1e3,
        }


def _rest(found: "Dataset", file: str) -> "list[Table]":
    """Return a table of the wheels, a column for each, and one of the body."""
    from ...core.quantities import displayed, heading_of
    from ..assembly.by_wheel import WHEEL

    wheels, body = (
        [(heading_of(data), *map(significant, displayed(data).ravel())) for data in some]
        for some in _wheels_and_body(found)
    )
    return [
        table(f"{file}: at rest", ("wheels", *_words(found[WHEEL])), wheels),
        table(f"{file}: at rest", ("body", "value"), body),
    ]


def _wheels_and_body(found: "Dataset") -> "list[list[DataArray]]":
    """Return the variables of the wheels, and those of the body."""
    variables = found.data_vars.items()
    return [
        [data for name, data in variables if (name in _OF_WHEELS) is of_wheels]
        for of_wheels in (True, False)
    ]


def _words(names: "DataArray") -> list[str]:
    return [str(name).replace("_", " ") for name in names.values.ravel()]


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
    """Return a table of the body, and one of the wheels, a column for each."""
    from ...core.quantities import heading_of
    from ..assembly.by_wheel import WHEEL

    wheels, body = (
        {heading_of(data): _figures(data, linear) for data in some}
        for some in _wheels_and_body(motion)
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
        table(title, ("wheels", "", *_words(motion[WHEEL])), of_wheels, words=(0, 1)),
    ]


def _figures(data: "DataArray", linear: "Dataset | None") -> dict[str, list[str]]:
    """Return the texts of what a variable is judged by, each by wheel if it is of the wheels."""
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


_OF_WHEELS = {"load", "travel", "camber", "toe", "road"}
_FIGURES = {key: key.replace("_", " ") for key in ("rms", "weighted_rms", "smallest", "largest")}


def _judged(data: Any) -> dict[str, Any]:
    keys = ("rms", "weighted_rms", "smallest", "largest", "off_the_road", "units")
    return {key: data.attrs[key] for key in keys if key in data.attrs}
