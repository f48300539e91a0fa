"""``kintrafo import-points``: hardpoints from a spreadsheet into a hardpoint file."""

from pathlib import Path
from typing import Annotated

import typer

from ...terminal.console import note, say
from .options import File, Force

EXAMPLES = (
    "kintrafo import-points points.csv my_car.toml new_car.toml",
    "kintrafo import-points left_side.xlsx my_car.toml new_car.toml --mirror",
    'kintrafo import-points cad.csv my_car.toml new_car.toml --unit in --axes "rearward right up"',
    (
        "kintrafo import-points cad.csv my_car.toml new.toml --unit in --mirror "
        '--name "ball_joint=FLCA outboard"'
    ),
)

_File = {"exists": True, "dir_okay": False}


def command(
    points: Annotated[
        Path,
        typer.Argument(
            metavar="POINTS",
            help="Table .csv, .txt or .xlsx: a row a point; columns point, x [mm], y [mm], z [mm]. "
            "Also an export of OptimumK (.xlsx) or a text of Lotus Suspension Analysis (.txt).",
            **_File,
        ),
    ],
    file: File,
    path: Annotated[Path, typer.Argument(metavar="PATH", help="File to write; ends in .toml.")],
    *,
    mirror: Annotated[
        bool, typer.Option("--mirror", help="The table is of the other side of the car.")
    ] = False,
    unit: Annotated[
        str | None,
        typer.Option(metavar="UNIT", help="If the table gives no unit: mm, cm, m, in or ft."),
    ] = None,
    axes: Annotated[
        str | None,
        typer.Option(
            metavar="WORDS",
            help="Directions of x, y and z: three of forward, rearward, left, right, up, down. "
            "Default: forward left up (ISO 8855).",
        ),
    ] = None,
    left_handed: Annotated[
        bool, typer.Option("--left-handed", help="The axes of --axes are left-handed.")
    ] = False,
    sheet: Annotated[
        str | None, typer.Option(metavar="NAME", help="Sheet of a workbook that has several.")
    ] = None,
    name: Annotated[
        list[str] | None,
        typer.Option(
            metavar="OURS=THEIRS",
            help="What the table calls a hardpoint; may be given more than once.",
        ),
    ] = None,
    force: Force = False,
) -> None:
    """Write a copy of a hardpoint file with the hardpoints of a spreadsheet.

    Everything else, comments too, is as in FILE. What was read, kept and left out is printed.
    """
    from ...core.files import refuse
    from ..files.point_names import read_names
    from ..files.point_table import as_words, doubts, merged, read_points, write_merged

    inputs: list[str | Path] = [points, file]
    refuse([path], force=force, inputs=inputs, endings=[".toml"])
    names = read_names(name or ())
    table = read_points(points, unit=unit, axes=axes, left_handed=left_handed, sheet=sheet)
    found = merged(table, file, mirrored=mirror, names=names)
    say(f"  {write_merged(found, path, force=force, inputs=inputs)}")
    for head, text in as_words(found, table).items():
        say(f"  {head}: {text}")
    if doubt := doubts(found):
        note(f"note: {doubt}")
    say(f"Check it: kintrafo check {path}")
