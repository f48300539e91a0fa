"""``kintrafo sensitivity``: by how much each value of a file moves each characteristic."""

from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer
from rich.markup import escape
from rich.table import Column, Table

from .console import console, print_json, progress_bar, significant
from .options import File, Force, Json, Of
from .outputs import Out, Outputs, name_files
from .variation_options import At, Bars, Over, chosen

if TYPE_CHECKING:
    from xarray import Dataset

# So many values are named in the table of several characteristics.
_GREATEST = 4

EXAMPLES = (
    "kintrafo sensitivity reference_car",
    "kintrafo sensitivity my_car.toml --of bump_steer --plot bars.png",
    "kintrafo sensitivity my_car.toml --place hardpoints.*.z --place wheel --over rack -o all.nc",
)


def command(
    file: File,
    *,
    place: Annotated[
        list[str] | None,
        typer.Option(
            metavar="PLACE",
            help="Values that move: hardpoints.ball_joint.z, a point, a section, or with *. "
            "Default: all hardpoints. May be repeated.",
        ),
    ] = None,
    of: Of = None,
    over: Over = "travel",
    at: At = 0.0,
    out: Out = None,
    plot: Bars = None,
    force: Force = False,
    json: Json = False,
) -> None:
    """By how much values of the file move the characteristics, a millimetre or a degree of each.

    The table is about one position; data files have all.
    """
    from ..study import export, variation
    from ..study.variation.curves import model_of
    from ..suspension.kinds import Suspension

    outputs = Outputs.of(out, plot, force=force, inputs=[file])
    suspension = Suspension.load(file)
    names = chosen(model_of(suspension), of, over)
    # what is shown is at one position; data files have all of everything
    looked_at: dict[str, Any] = {} if out else {"names": names, "positions": [at / 1e3]}
    with progress_bar("sensitivity") as progress:
        dataset = variation.sensitivity(
            suspension, place or ("hardpoints",), over=over, progress=progress, **looked_at
        )
    written = outputs.write_data(dataset)
    for path in outputs.pages:
        from ..plots import variation as plots

        title = f"{file}: effect of values, at {at:g} mm of {_along(over)}"
        written.append(
            plots.write_bars(
                dataset, path, names, at=at / 1e3, title=title, force=force, inputs=[file]
            )
        )
    if json:
        print_json(export.as_dict(dataset[names]))
        return
    console.print(_table(dataset, names, file, over, at))
    name_files(written)


def _along(over: Literal["travel", "rack"]) -> str:
    return "wheel travel" if over == "travel" else "the rack"


def _table(
    dataset: "Dataset", names: list[str], file: str, over: Literal["travel", "rack"], at: float
) -> Table:
    """Return the effects: of one characteristic all of them, of several the greatest of each."""
    from ..study.variation import effects

    found = {name: list(effects(dataset, name, at / 1e3)) for name in names}
    title = f"{file}: effect of values on characteristics, at {at:g} mm of {_along(over)}"
    if len(names) == 1:
        (name,) = names
        title = f"{file}: effect of values on {_words(dataset, name)}, at {at:g} mm"
        table = Table("value", Column(_unit(dataset, name), justify="right"), title=escape(title))
        for place, effect in found[name]:
            table.add_row(escape(place), significant(effect))
        return table
    table = Table("characteristic", "unit", "moved most by", title=escape(title))
    for name in names:
        greatest = [(place, effect) for place, effect in found[name][:_GREATEST] if effect]
        moved = ", ".join(f"{_short(place)} {effect:+.3g}" for place, effect in greatest)
        table.add_row(_words(dataset, name), _unit(dataset, name), escape(moved or "none of them"))
    return table


def _words(dataset: "Dataset", name: str) -> str:
    from ..core.quantities import long_name

    return escape(long_name(dataset[name]).removeprefix("sensitivity of "))


def _unit(dataset: "Dataset", name: str) -> str:
    from ..core.quantities import display_of

    return escape(display_of(dataset[name].attrs).units)


def _short(place: str) -> str:
    return place.removeprefix("hardpoints.")
