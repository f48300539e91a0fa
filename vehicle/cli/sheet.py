"""``kintrafo sheet``: the K&C sheet of a suspension or an axle, at design."""

from pathlib import Path  # noqa: TC003 (typer reads it)
from typing import Annotated

import typer

from ...terminal.console import print_json, print_table, say
from .compliance import Bushes, Held, described
from .options import File, Force, Json
from .outputs import Out, Outputs, name_files
from .subject import described_by

EXAMPLES = (
    "kintrafo sheet my_car.toml bushes.toml",
    "kintrafo sheet my_axle.toml -o sheet.csv",
    "kintrafo sheet rigid_axle axle_bushes.toml",
)


def command(
    file: File,
    bushes: Bushes = None,
    *,
    held: Annotated[
        Held, typer.Option(help="What holds the wheel: see docs/suspension/loads.md.")
    ] = "height",
    out: Out = None,
    force: Force = False,
    json: Json = False,
) -> None:
    """Print the K&C sheet: kinematic and compliance gradients at design, as measured on a rig.

    With definitions, and with the signs of ISO 8855 and of SAE J670 (z down). Compliance is there
    where the file has bushes, or BUSHES are given.
    """
    from ...datasets import export
    from ..analysis.sheet import sheet, tabulated

    inputs: list[str | Path] = [file, *([] if bushes is None else [bushes])]
    outputs = Outputs.of(out, None, force=force, inputs=inputs)
    found = sheet(described_by(file), described(file, bushes), held=held)
    written = outputs.write_data(found)
    if json:
        print_json(export.as_dict(found))
        return
    for table in tabulated(found, f"{file}: "):
        print_table(table)
    say("At design. SAE J670 with its z axis down; definitions are in data files (-o).")
    name_files(written)
