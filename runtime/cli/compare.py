"""``kintrafo compare``: curves of several suspensions over each other, and what differs."""

from typing import TYPE_CHECKING, Annotated, Literal

import typer
from rich.markup import escape
from rich.table import Table

from .console import console, print_json, progress_bar, significant
from .options import Files, Force, Json, Of, among, load
from .outputs import Figures, Formats, Out, Outputs, Plot, name_files

if TYPE_CHECKING:
    from xarray import Dataset

    from ..study.compare import Difference

EXAMPLES = (
    "kintrafo compare reference_car my_car.toml",
    "kintrafo compare before.toml after.toml --over rack --plot difference.png -o both.csv",
    "kintrafo compare before.toml after.toml --of toe --of bump_steer --plot steer.png",
)


def command(
    files: Files,
    *,
    over: Annotated[Literal["travel", "rack"], typer.Option(help="What varies.")] = "travel",
    of: Of = None,
    out: Out = None,
    plot: Plot = None,
    figures: Figures = None,
    formats: Formats = None,
    force: Force = False,
    json: Json = False,
) -> None:
    """Compare the characteristics of two or more suspensions.

    Differences are those from the first file: at design, and where they are largest. Data files
    have all characteristics.
    """
    from ..core.quantities import distinct
    from ..study import compare

    outputs = Outputs.of(out, plot, figures, formats, force=force, inputs=files)
    models = dict(zip(distinct(files), map(load, files), strict=True))
    with progress_bar("characteristics") as progress:
        dataset = compare.compare(models, over=over, progress=progress)
    shown = among(of, map(str, dataset.data_vars)) if of else [str(n) for n in dataset.data_vars]
    found = [difference for difference in compare.differences(dataset) if difference.name in shown]
    written = outputs.write(dataset, title=" and ".join(models), names=shown if of else ())
    if json:
        print_json(
            [vars(difference) | {"units": _units(dataset, difference)} for difference in found]
        )
        return
    for name in list(models)[1:]:
        chosen = [difference for difference in found if difference.data_set == name]
        console.print(_table(dataset, chosen, next(iter(models)), name))
    name_files(written)


def _units(dataset: "Dataset", difference: "Difference") -> str:
    return str(dataset[difference.name].attrs.get("units", ""))


def _table(dataset: "Dataset", found: list["Difference"], first: str, other: str) -> Table:
    from ..core.quantities import bracketed, display_of, long_name

    along = next(str(name) for name in dataset.sizes if name != "data_set")
    where = bracketed(long_name(dataset[along]), dataset[along].attrs)
    table = Table(title=escape(f"{other} compared with {first}"))
    table.add_column("characteristic")
    for column in (first, other, "difference", "largest", f"at {where}"):
        table.add_column(escape(column), justify="right")
    for difference in found:
        data = dataset[difference.name]
        factor = display_of(data.attrs).factor
        values = difference.first, difference.other, difference.at_design, difference.largest
        table.add_row(
            escape(bracketed(long_name(data), data.attrs)),
            *(significant(value * factor) for value in values),
            f"{difference.where * display_of(dataset[along].attrs).factor + 0.0:g}",
        )
    return table
