"""``kintrafo tolerance``: what tolerances of a file make of the characteristics."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape
from rich.table import Table

from ...core.tabulated import significant
from ...terminal.console import console, print_json, progress_bar, say
from .options import File, Force, Json, Of
from .outputs import Out, Outputs, name_files, title_of
from .subject import subject_of_file
from .variation_options import (
    At,
    Bars,
    Held,
    Over,
    along,
    asked_of,
    chosen,
    position,
    positions_with,
    way_of,
)

if TYPE_CHECKING:
    from xarray import Dataset

# Where the cars deviate by more or less than that much of what they do to first order, shares tell
# nothing. Twenty cars tell their deviation to 1 / sqrt(40) = 0.16, so that this is three of it.
_NOT_OF_FIRST_ORDER = 0.5

EXAMPLES = (
    "kintrafo tolerance my_car.toml tolerances.toml",
    "kintrafo tolerance my_car.toml tolerances.toml --cars 2000 --of toe --plot bands.png",
)


def command(
    file: File,
    tolerances: Annotated[
        Path,
        typer.Argument(
            metavar="TOLERANCES",
            help="TOML: [tolerances] of values, and [limits] of characteristics if there are some.",
        ),
    ],
    *,
    cars: Annotated[int, typer.Option(metavar="N", help="How many cars are drawn.")] = 500,
    seed: Annotated[int, typer.Option(metavar="N", help="Other cars for another seed.")] = 1,
    of: Of = None,
    over: Over = None,
    held: Held = None,
    at: At = 0.0,
    out: Out = None,
    plot: Bars = None,
    force: Force = False,
    json: Json = False,
) -> None:
    """Print bands of the characteristics of many cars within tolerances, and their causes.

    The table is about one position; data files have all, netCDF the shares and each car besides.
    """
    from ...datasets import export
    from .. import studies as variation
    from ..studies.sweep_axes import sweep_axes_of

    inputs: list[str | Path] = [file, tolerances]
    outputs = Outputs.of(out, plot, force=force, inputs=inputs)
    suspension = subject_of_file(file)
    way = way_of(suspension, over, held)
    asked = variation.read(tolerances)
    names = chosen(suspension, of, way)
    with progress_bar("cars") as progress:
        dataset = variation.tolerance(
            suspension,
            asked.get("tolerances", {}),
            distribution=asked.get("distribution", "normal"),
            limits=asked.get("limits"),
            count=cars,
            seed=seed,
            **asked_of(way),
            positions=positions_with(suspension, way, at),
            names=None if out else names,
            progress=progress,
        )
    # cars and values would multiply the rows of a table: they are in netCDF
    written = outputs.write_data(dataset, rows=dataset.drop_dims(["car", "place"]))
    for path in outputs.pages:
        from ..plots import variation as plots

        title = f"{title_of(file)}: {cars} cars by {tolerances.stem}"
        limits = variation.limits(asked.get("limits", {}), sweep_axes_of(suspension))
        written.append(
            plots.write_bands(
                dataset, path, names, limits=limits, title=title, force=force, inputs=inputs
            )
        )
    if json:
        print_json(export.as_dict(dataset) | {"yield": dataset.attrs["yield"]})
        return
    console.print(
        _table(dataset, names, f"{file}: {cars} cars, {along(way, at)}", position(way, at))
    )
    share = f"; {100.0 * dataset.attrs['yield']:.1f} % within all limits."
    say(f"{dataset.attrs['message']}{share if asked.get('limits') else '.'}")
    name_files(written)


def _table(dataset: "Dataset", names: list[str], title: str, at: float) -> Table:
    from ...core.quantities import bracketed, displayed, long_name
    from ..studies.tolerance import QUANTILE

    table = Table(title=escape(title))
    table.add_column("characteristic")
    for column in ("as drawn", "least", "5 %", "95 %", "greatest"):
        table.add_column(column, justify="right")
    table.add_column("caused most by")
    for name in names:
        data = dataset[name]
        over = next(str(d) for d in data.dims if d != QUANTILE)
        here = dataset.sel({over: at}, method="nearest")
        least, low, _, high, most = displayed(here[name])
        nominal = float(displayed(here[f"{name}_nominal"]))
        values = (significant(float(value)) for value in (nominal, least, low, high, most))
        table.add_row(escape(bracketed(long_name(data), data.attrs)), *values, _causes(here, name))
    return table


def _causes(here: "Dataset", name: str) -> str:
    """Name the two values that cause most of the variance at a position."""
    if abs(float(here[f"{name}_first_order"]) - 1.0) > _NOT_OF_FIRST_ORDER:
        return "not to first order"
    shares = here[f"{name}_share"].dropna("place")
    first = shares.sortby(shares, ascending=False)[:2]
    words = ", ".join(
        f"{str(place).removeprefix('hardpoints.')} {100.0 * float(share):.0f} %"
        for place, share in zip(first["place"].values, first.values, strict=True)
        if share > 0.005
    )
    return words or "-"
