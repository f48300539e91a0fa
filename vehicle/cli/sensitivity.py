"""``kintrafo sensitivity``: the change of each characteristic per unit of each value of a file."""

from math import isfinite
from typing import TYPE_CHECKING, Annotated

from ...core.tabulated import significant
from ...terminal.console import console, note, print_json, progress_bar, table
from .loading import variable_subject
from .options import File, option
from .outputs import SingleFigureOptions, name_files, title_of
from .variation_options import StudyCurves, StudyOptions

if TYPE_CHECKING:
    from rich.table import Table
    from xarray import Dataset

    from ..studies.sensitivity import Effect

_GREATEST = 4  # effects in a row of the table of several characteristics

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
        option(
            "Values of the file: hardpoints.ball_joint.z; a hardpoint or a section, for all of its "
            "values; * for any text. Default: all points of the linkage.",
            "PLACE,...",
        ),
    ] = None,
    asked: StudyOptions,
    output: SingleFigureOptions,
) -> None:
    """Print the change of characteristics per millimetre or degree of each value of the file.

    The table is for one position; data files have all positions. Values of a section or * that
    cannot change, such as an inertia of a part without mass, are left out and listed.
    """
    from ...datasets import export
    from .. import studies as variation

    outputs = output.files(file)
    subject = variable_subject(file)
    look = StudyCurves.of(subject, asked)
    with progress_bar("sensitivity") as progress:
        dataset = variation.sensitivity(
            subject,
            place or None,
            **look.how,
            names=None if outputs.data else look.names,
            progress=progress,
        )
    written = outputs.write_data(dataset)
    if outputs.pages:
        from ..plots.variation import write_bars

        title = f"{title_of(file)}: effect of values, {look.where}"
        written += outputs.draw(write_bars, dataset, look.names, at=look.at, title=title)
    if dataset.attrs["message"]:
        note(str(dataset.attrs["message"]))
    if output.json:
        print_json(export.as_dict(dataset[look.names]))
        return
    console.print(_table(dataset, look, file))
    name_files(written)


def _table(dataset: "Dataset", look: StudyCurves, file: str) -> "Table":
    """Return the table of all effects on one characteristic, or of the greatest on several."""
    from ..studies import effects

    names = look.names
    found = {name: list(effects(dataset, name, look.at)) for name in names}
    if len(names) == 1:
        (name,) = names
        title = f"{title_of(file)}: effect of values on {_words(dataset, name)}, {look.where}"
        every = [(effect.place, significant(effect.size), effect.unit) for effect in found[name]]
        return table(title, ("value", "effect", "unit"), every, words=(0, 2))
    rows = [
        (_words(dataset, name), unit, _greatest([one for one in found[name] if one.unit == unit]))
        for name in names
        for unit in dict.fromkeys(effect.unit for effect in found[name])
    ]
    title = f"{title_of(file)}: effect of values on characteristics, {look.where}"
    return table(title, ("characteristic", "unit", "largest effects"), rows, words=range(3))


def _greatest(effects: "list[Effect]") -> str:
    """Return the values with the largest effects on a characteristic, the largest first."""
    moved = [effect for effect in effects if isfinite(effect.size) and effect.size]
    words = [f"{e.place.removeprefix('hardpoints.')} {e.size:+.3g}" for e in moved[:_GREATEST]]
    return ", ".join(words) or "none"


def _words(dataset: "Dataset", name: str) -> str:
    from ...core.quantities import long_name

    return long_name(dataset[name]).removeprefix("sensitivity of ")
