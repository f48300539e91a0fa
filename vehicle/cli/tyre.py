"""``kintrafo tyre``: key figures of a tyre, and its curves."""

from typing import Annotated

from ...terminal.console import print_json, print_table, say
from .options import argument, option
from .outputs import SingleFigureOptions, name_files, title_of

EXAMPLES = (
    "kintrafo tyre passenger_205_55",
    "kintrafo tyre passenger_205_55 --load 2000,4000 --plot tyre.pdf",
    "kintrafo tyre passenger_205_55 -o tyre.csv",
)


def command(
    file: Annotated[
        str, argument("Property file (.tir), TMeasy tyre (.json), or a packaged name.", "TYRE")
    ],
    *,
    load: Annotated[
        list[str] | None,
        option("Loads [N]. Default: 0.5, 1 and 1.5 times the nominal load.", "NUMBER,..."),
    ] = None,
    output: SingleFigureOptions,
) -> None:
    """Print stiffnesses, friction, load sensitivity and lengths of a tyre; --plot draws curves.

    Speed and pressure are those of the file, axes those of ISO 8855. Keys of the file that are
    not used are listed.
    """
    from ...core.validator import Validator
    from ...datasets import export
    from ..tyres import key_figures, tabulated
    from ..tyres import load as load_tyre

    outputs = output.files(file)
    tyre = load_tyre(file)
    with Validator("tyre") as given:
        loads = [given.number("--load", _number(text), "N") for text in load or ()]
    found = key_figures(tyre, loads or None)
    written = outputs.write_data(found)
    if outputs.pages:
        from ..plots.tyres import write_tyre

        written += outputs.draw(write_tyre, tyre, title=f"{title_of(file)}, {tyre.name}")
    if output.json:
        print_json(export.as_dict(found))
        return
    print_table(tabulated(found, f"{title_of(file)}: "))
    for line in tyre.assumed:
        say(f"Assumed: {line}")
    for line in tyre.left_out:
        say(f"Not used: {line}")
    name_files(written)


def _number(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text
