"""``kintrafo tolerance``: bands of the characteristics within tolerances of a file."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from ...core.tabulated import significant
from ...terminal.console import console, print_json, progress_bar, say, table
from .loading import of_study, variable_subject
from .options import File, argument, option
from .outputs import SingleFigureOptions, name_files, title_of
from .variation_options import StudyCurves, StudyOptions

if TYPE_CHECKING:
    from rich.table import Table
    from xarray import Dataset

# Shares of the variance are meaningless if the deviation of the cars differs from the one to first
# order by more than this part: three standard errors, 1 / sqrt(40) = 0.16, of twenty cars.
_NOT_OF_FIRST_ORDER = 0.5

EXAMPLES = (
    "kintrafo tolerance my_car.toml tolerances.toml",
    "kintrafo tolerance my_car.toml tolerances.toml --cars 2000 --of toe --plot bands.png",
)


def command(
    file: File,
    tolerances: Annotated[
        Path,
        argument(
            "TOML: [tolerances] of values, and optional [limits] of characteristics.",
            "TOLERANCES",
        ),
    ],
    *,
    cars: Annotated[int, option("Number of random cars.", "N")] = 500,
    seed: Annotated[int, option("Seed of the random cars.", "N")] = 1,
    asked: StudyOptions,
    output: SingleFigureOptions,
) -> None:
    """Print bands of the characteristics of many cars within tolerances, and their main causes.

    Causes are the values with the largest shares of the variance. The table is for one position;
    data files have all positions, netCDF files also the shares of all values, and the cars.
    """
    from ...datasets import export
    from .. import studies as variation
    from ..studies.sweep_axes import sweep_axes_of

    outputs = output.files(file, tolerances)
    subject = variable_subject(file)
    given = variation.read(tolerances)
    look = StudyCurves.of(subject, asked)
    with of_study(tolerances), progress_bar("cars") as progress:
        dataset = variation.tolerance(
            subject,
            given.get("tolerances", {}),
            distribution=given.get("distribution", "normal"),
            limits=given.get("limits"),
            count=cars,
            seed=seed,
            **look.how,
            names=None if outputs.data else look.names,
            progress=progress,
        )
    # cars and values would multiply the rows of a table: only netCDF has them
    written = outputs.write_data(dataset, rows=dataset.drop_dims(["car", "place"]))
    if outputs.pages:
        from ..plots.variation import write_bands

        title = f"{title_of(file)}: {cars} cars within {tolerances.stem}"
        limits = variation.limits(given.get("limits", {}), sweep_axes_of(subject))
        written += outputs.draw(write_bands, dataset, look.names, limits=limits, title=title)
    if output.json:
        print_json(export.as_dict(dataset) | {"yield": dataset.attrs["yield"]})
        return
    title = f"{file}: {cars} cars, {look.where}"
    console.print(_table(dataset, look.names, title, look.at))
    share = f"; {100.0 * dataset.attrs['yield']:.1f} % within all limits."
    say(f"{dataset.attrs['message']}{share if given.get('limits') else '.'}")
    name_files(written)


def _table(dataset: "Dataset", names: list[str], title: str, at: float) -> "Table":
    from ...core.quantities import displayed, heading_of
    from ..studies.tolerance import QUANTILE

    rows = []
    for name in names:
        over = next(str(d) for d in dataset[name].dims if d != QUANTILE)
        here = dataset.sel({over: at}, method="nearest")
        least, low, _, high, most = displayed(here[name])
        nominal = float(displayed(here[f"{name}_nominal"]))
        values = (significant(float(value)) for value in (nominal, least, low, high, most))
        rows.append((heading_of(dataset[name]), *values, _causes(here, name)))
    columns = ("characteristic", "as drawn", "least", "5 %", "95 %", "greatest", "caused most by")
    return table(title, columns, rows, words=(0, 6))


def _causes(here: "Dataset", name: str) -> str:
    """Return the two values that cause most of the variance at a position."""
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
