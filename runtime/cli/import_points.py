"""``kintrafo import-points``: hardpoints from a spreadsheet into a hardpoint file."""

from pathlib import Path
from typing import Annotated

import typer

from .console import say
from .options import File, Force

EXAMPLES = (
    "kintrafo import-points points.csv my_car.toml new_car.toml",
    "kintrafo import-points left_side.xlsx my_car.toml new_car.toml --mirror",
)

_File = {"exists": True, "dir_okay": False}


def command(
    points: Annotated[
        Path,
        typer.Argument(
            metavar="POINTS",
            help="Table .csv or .xlsx: a row a point; columns point, x [mm], y [mm], z [mm].",
            **_File,
        ),
    ],
    file: File,
    path: Annotated[Path, typer.Argument(metavar="PATH", help="File to write; ends in .toml.")],
    *,
    mirror: Annotated[
        bool, typer.Option("--mirror", help="The table is of the other side of the car.")
    ] = False,
    force: Force = False,
) -> None:
    """Write a copy of a hardpoint file with the hardpoints of a spreadsheet.

    Everything else, comments too, is as in FILE. What was read, kept and left out is printed.
    """
    from ..core.files import refuse
    from ..suspension.point_table import as_words, merged, read_points, write_merged

    inputs: list[str | Path] = [points, file]
    refuse([path], force=force, inputs=inputs, endings=[".toml"])
    found = merged(read_points(points), file, mirrored=mirror)
    say(f"  {write_merged(found, path, force=force, inputs=inputs)}")
    for head, text in as_words(found).items():
        say(f"  {head}: {text}")
    say(f"Check it: kintrafo check {path}")
