"""``kintrafo report``: one file to send to a colleague."""

from pathlib import Path
from typing import Annotated

import typer

from .console import problems, say
from .options import File, load

EXAMPLES = (
    "kintrafo report reference_car",
    'kintrafo report my_car.toml front_axle.html --title "Front axle, stage 2"',
)


def command(
    file: File,
    path: Annotated[
        Path | None, typer.Argument(metavar="PATH", help="Default: the file's name with .html.")
    ] = None,
    *,
    title: Annotated[str | None, typer.Option(help="Heading of the report.")] = None,
) -> None:
    """Write a report that opens in any browser: the mechanism to move by hand, curves, data."""
    model = load(file)
    target = path or Path(f"{Path(file).stem}.html")
    with problems.status("report") as status:
        from ..report import write

        written = write(model, target, title=title, progress=status.update)
    say(f"  {written}")
