"""``kintrafo sweep``: the motion over a grid of values of a file."""

from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...core.tabulated import significant
from ...terminal.console import console, print_json, progress_bar, say, table
from ...terminal.exits import Exit
from ..models.sides import SIDES
from .loading import variable_subject
from .options import File, argument, option
from .outputs import SingleFigureOptions, name_files, title_of
from .simulation_options import ScenarioOptions
from .variation_options import StudyCurves, StudyOptions

if TYPE_CHECKING:
    from rich.table import Table
    from xarray import Dataset

    from ...systems.system import System
    from ..studies.evaluation import Subject

_MOST_VALUES = 100_000  # of one place

EXAMPLES = (
    "kintrafo sweep my_car.toml strut.damper_rate_N_s_per_m=500:3000:11 --road-step 20",
    "kintrafo sweep my_car.toml hardpoints.tie_rod_inner.z=270,280,290 --keep toe:max -o toe.csv",
    "kintrafo sweep my_car.toml wheel.toe_deg=0,1 --over load:case=corner --of tie_rod_force",
    "kintrafo sweep quarter_car corner.strut.spring_rate_N_per_m=20e3:30e3:3 --over speed:road=C",
)

_USUAL = ("wheel_acceleration:rms", "tyre_force:min", "tyre_force:rms")
_ROWS = 40  # of the table; data files have all combinations


def command(
    file: File,
    values: Annotated[
        list[str],
        argument(
            "Values of the file that vary: from:to:count, or a list with commas.",
            "PLACE=VALUES...",
        ),
    ],
    *,
    keep: Annotated[
        list[str] | None,
        option(
            "Results of each motion: max, min, mean, rms, above:LEVEL, percentile:NUMBER. "
            f"Default: {','.join(_USUAL)}.",
            "SIGNAL:KIND,...",
        ),
    ] = None,
    asked: StudyOptions,
    driven: ScenarioOptions,
    output: SingleFigureOptions,
) -> None:
    """Compute motions, or characteristics of a car, for combinations of values.

    Each motion starts at rest, or at --height. The exit code is 1 if one does not reach the end.
    With --over, --of, --at or --held, and of a car, there is no simulation: the table has
    characteristics, compliance or loads at one position.
    """
    from ...datasets import export

    outputs = output.files(file, driven.measured)
    subject = variable_subject(file)
    of_curves = subject.whole_car or asked != StudyOptions()
    if of_curves and (keep or driven != ScenarioOptions()):
        raise typer.BadParameter(
            "a sweep of a car, or with --over, --of, --at or --held, has no simulation: leave out "
            "--keep and the options of road, rack, start and time"
        )
    grid = dict(map(_numbers, values))
    if len(grid) < len(values):
        raise typer.BadParameter("a place is named twice: write all of its values together")
    if outputs.pages and len(grid) > 2:
        raise typer.BadParameter("a figure shows one value or two; leave out --plot, or a value")
    if of_curves:
        kept, names = _of_curves(subject, grid, asked)
    else:
        kept, names = _motions(subject, grid, keep, driven)
    drawn = kept.drop_vars([str(name) for name, data in kept.coords.items() if not data.ndim])
    title = ", ".join([title_of(file), *([kept.attrs["where"]] if of_curves else [])])
    written = outputs.write(kept, title=title, drawn=drawn if of_curves else kept, names=names)
    if output.json:
        print_json(export.as_dict(kept))
    else:
        console.print(_table(kept, names, file))
        say(str(kept.attrs["message"]))
        name_files(written)
    if not kept["success"].all():
        raise typer.Exit(Exit.REFUSED)


def _of_curves(
    subject: "Subject", grid: dict[str, list[float]], asked: StudyOptions
) -> "tuple[Dataset, list[str]]":
    """Return curves of cars over a grid of values at one position, and their names."""
    import xarray as xr

    from ...core.validator import Validator
    from .. import studies as variation
    from ..studies.design_variables import matching

    look = StudyCurves.of(subject, asked)
    with Validator("sweep") as given:
        matched = [matching(given, subject, [name]) for name in grid]
        for name, several in zip(grid, matched, strict=True):
            if len(several) > 1:
                given.fail(f"{name} names {len(several)} numbers: name one of them.")
    places = {n: place for several in matched for n, place in several.items()}
    grid = dict(zip(places, grid.values(), strict=True))
    with progress_bar("cars") as progress:
        found = variation.cars(
            subject, xr.Dataset(coords=grid), **look.how | {"positions": [look.at]},
            names=look.names, progress=progress,
        )  # fmt: skip
    along = next(str(name) for name in found.dims if name not in grid)
    found = found.isel({along: 0})
    for name in grid:
        place = places[name]
        found[name] = found[name] * place.to_si
        found[name].attrs = place.attributes()
    found["success"] = found["reason"] == ""
    words = f"{found.attrs['message']}, {look.where}"
    failed = [str(reason) for reason in dict.fromkeys(found["reason"].values.ravel()) if reason]
    found = found.assign_attrs(message=". ".join([words, *failed[:1]]), where=look.where)
    return found, look.names


def _motions(
    subject: "Subject",
    grid: dict[str, list[float]],
    keep: list[str] | None,
    driven: ScenarioOptions,
) -> "tuple[Dataset, list[str]]":
    """Return results of motions over a grid of values, and their names."""
    from .. import studies as variation
    from ..assembly.of import model_of

    scenario = driven.scenario()
    model = model_of(subject)
    reductions = _reductions(model, keep or _usual(model))
    with progress_bar("suspensions") as progress:
        found = variation.sweep(subject, grid, scenario, reductions=reductions, progress=progress)
    kept = found.drop_dims(["time", "state_element", "bound"])
    names = [str(n) for n in kept.data_vars if kept[n].dtype.kind == "f" and n != "end_time"]
    return kept, names


def _numbers(text: str) -> tuple[str, list[float]]:
    """Return the place and values of ``place=from:to:count`` or ``place=a,b,c``."""
    import numpy as np

    place, mark, given = text.partition("=")
    parts = given.split(":")
    try:
        if len(parts) == 3 and 1 < int(parts[2]) <= _MOST_VALUES:
            return place, np.linspace(float(parts[0]), float(parts[1]), int(parts[2])).tolist()
        if mark and len(parts) == 1:
            return place, [float(number) for number in given.split(",")]
    except ValueError:
        pass
    raise typer.BadParameter(
        f"{text!r}: write PLACE=FROM:TO:COUNT with 2 to {_MOST_VALUES} values, or "
        "PLACE=VALUE,VALUE,...: numbers in the unit of the file, written without it"
    )


def _usual(model: "System") -> tuple[str, ...]:
    """Return the default results; a rigid axle has them for both wheels."""
    if _USUAL[0].partition(":")[0] in model.signal_names:
        return _USUAL
    return tuple(f"{side}_axle_{kept}" for kept in _USUAL for side in SIDES)


def _reductions(model: "System", kept: tuple[str, ...] | list[str]) -> dict[str, list[Any]]:
    """Return the reductions of each signal; levels in the texts are in display units."""
    from ...core.quantities import attributes, display_of

    found: dict[str, list[Any]] = {}
    for text in kept:
        signal, _, kind = text.partition(":")
        word, mark, level = kind.partition(":")
        entry: Any = word
        if word == "psd":
            raise typer.BadParameter(
                f"{text!r}: a spectrum is not a number for a table; kintrafo.ensemble keeps spectra"
            )
        if mark and signal in model.signal_names:
            unit = model.equations.SIGNALS[signal]["unit"]
            try:
                factor = display_of(attributes("", unit)).factor if word == "above" else 1.0
                entry = word, float(level) / factor
            except ValueError:
                raise typer.BadParameter(f"{text!r}: {level!r} is not a number") from None
        found.setdefault(signal, []).append(entry)
    return found


def _table(dataset: "Dataset", names: list[str], file: str) -> "Table":
    """Return the table of all combinations, or of the extremes of many."""
    from ...core.quantities import display_of, heading_of

    rows, caption = dataset[names].to_dataframe().reset_index(), None
    title = f"{file}: {len(rows)} suspension{'s' * (len(rows) > 1)}"
    if len(rows) > _ROWS:
        numbers = [rows[name].dropna() for name in names]
        extremes = {i for some in numbers if some.size for i in (some.idxmin(), some.idxmax())}
        rows = rows.loc[sorted(extremes)]
        caption = "those with the smallest and the greatest numbers"
    columns = [dataset[name] for name in rows.columns]
    factors = [display_of(data.attrs).factor for data in columns]
    cells = (
        [significant(float(value) * factor) for value, factor in zip(row, factors, strict=True)]
        for row in rows.itertuples(index=False)
    )
    return table(title, map(heading_of, columns), cells, (), caption)
