"""``kintrafo sensitivity``: by how much each value of a file moves each characteristic."""

from math import isfinite
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape
from rich.table import Column, Table

from ...core.tabulated import significant
from ...terminal.console import console, note, print_json, progress_bar
from .options import File, Force, Json, Of, by_comma
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

    from ..studies.sensitivity import Effect

# So many values are named in the table of several characteristics.
_GREATEST = 4

EXAMPLES = (
    "kintrafo sensitivity reference_car",
    "kintrafo sensitivity my_car.toml --of bump_steer --plot bars.png",
    "kintrafo sensitivity my_car.toml --place hardpoints.*.z,wheel --over rack -o all.nc",
)


def command(
    file: File,
    *,
    place: Annotated[
        list[str] | None,
        typer.Option(
            metavar="PLACE,...",
            help="Design variables: hardpoints.ball_joint.z, a point, a section, or with *. "
            "Default: all hardpoints.",
            callback=by_comma,
        ),
    ] = None,
    of: Of = None,
    over: Over = None,
    held: Held = None,
    at: At = 0.0,
    out: Out = None,
    plot: Bars = None,
    force: Force = False,
    json: Json = False,
) -> None:
    """Print the change of characteristics per millimetre or degree of each value of the file.

    The table is about one position; data files have all. What a section or * stands for and cannot
    move, as an inertia of a part without mass, is left out and named.
    """
    from ...datasets import export
    from .. import studies as variation

    outputs = Outputs.of(out, plot, force=force, inputs=[file])
    suspension = subject_of_file(file)
    way = way_of(suspension, over, held)
    names = chosen(suspension, of, way)
    with progress_bar("sensitivity") as progress:
        dataset = variation.sensitivity(
            suspension,
            place or ("hardpoints",),
            **asked_of(way),
            positions=positions_with(suspension, way, at),
            names=None if out else names,
            progress=progress,
        )
    written = outputs.write_data(dataset)
    for path in outputs.pages:
        from ..plots import variation as plots

        title = f"{title_of(file)}: effect of values, {along(way, at)}"
        written.append(
            plots.write_bars(
                dataset, path, names, at=position(way, at), title=title, force=force, inputs=[file]
            )
        )
    if dataset.attrs["message"]:
        note(str(dataset.attrs["message"]))
    if json:
        print_json(export.as_dict(dataset[names]))
        return
    console.print(_table(dataset, names, file, along(way, at), position(way, at)))
    name_files(written)


def _table(dataset: "Dataset", names: list[str], file: str, where: str, at: float) -> Table:
    """Return the effects: of one characteristic all of them, of several the greatest of each."""
    from ..studies import effects

    found = {name: list(effects(dataset, name, at)) for name in names}
    if len(names) == 1:
        (name,) = names
        title = f"{title_of(file)}: effect of values on {_words(dataset, name)}, {where}"
        table = Table("value", Column("effect", justify="right"), "unit", title=escape(title))
        for effect in found[name]:
            table.add_row(escape(effect.place), significant(effect.size), escape(effect.unit))
        return table
    title = f"{title_of(file)}: effect of values on characteristics, {where}"
    table = Table("characteristic", "unit", "moved most by", title=escape(title))
    for name in names:
        for unit in dict.fromkeys(effect.unit for effect in found[name]):
            same = [effect for effect in found[name] if effect.unit == unit]
            table.add_row(_words(dataset, name), escape(unit), escape(_greatest(same)))
    return table


def _greatest(effects: "list[Effect]") -> str:
    """Name the values that move a characteristic most; the largest stand first."""
    moved = [effect for effect in effects if isfinite(effect.size) and effect.size]
    words = [f"{_short(effect.place)} {effect.size:+.3g}" for effect in moved[:_GREATEST]]
    return ", ".join(words) or "none of them"


def _words(dataset: "Dataset", name: str) -> str:
    from ...core.quantities import long_name

    return escape(long_name(dataset[name]).removeprefix("sensitivity of "))


def _short(place: str) -> str:
    return place.removeprefix("hardpoints.")
