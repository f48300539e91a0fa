"""``kintrafo report``: one file to send to a colleague."""

from pathlib import Path
from typing import Annotated

import typer

from .console import problems, say
from .options import File, Force, load

EXAMPLES = (
    "kintrafo report reference_car",
    'kintrafo report my_car.toml front_axle.html --title "Front axle, stage 2"',
)


def command(
    file: File,
    path: Annotated[
        Path | None,
        typer.Argument(metavar="PATH", help="Ends in .html. Default: the file's name with .html."),
    ] = None,
    *,
    title: Annotated[str | None, typer.Option(help="Heading of the report.")] = None,
    force: Force = False,
) -> None:
    """Write a report that opens in any browser: the mechanism to move by hand, curves, data."""
    from ..core.files import refuse
    from ..report import ENDINGS

    target = path or Path(f"{Path(file).stem}.html")
    refuse([target], force=force, inputs=[file], endings=ENDINGS)
    model = load(file)
    with problems.status("report") as status:
        from ..report import write

        written = write(
            model, target, title=title, progress=status.update, force=force, inputs=[file]
        )
    say(f"  {written}")
