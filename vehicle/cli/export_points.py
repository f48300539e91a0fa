"""``kintrafo export-points``: the hardpoints of a file as a table for a spreadsheet."""

from pathlib import Path
from typing import Annotated

import typer

from ...terminal.console import say
from .options import File, Force

EXAMPLES = ("kintrafo export-points my_car.toml points.csv",)


def command(
    file: File,
    path: Annotated[Path, typer.Argument(metavar="PATH", help="Table to write; ends in .csv.")],
    *,
    force: Force = False,
) -> None:
    """Write the hardpoints of a file as a table; import-points reads it again."""
    from ..files.point_table import write_points
    from ..kinds import Suspension

    say(f"  {write_points(Suspension.load(file), path, force=force, inputs=[file])}")
