"""``kintrafo new``: an annotated file to begin with."""

from pathlib import Path
from typing import Annotated

import typer

from .console import say

EXAMPLES = ("kintrafo new my_car.toml", "kintrafo new my_car.toml --force")


def command(
    path: Annotated[Path, typer.Argument(metavar="PATH", help="File to write; ends in .toml.")],
    *,
    template: Annotated[
        str, typer.Option(metavar="NAME", help="Packaged data set to copy.")
    ] = "reference_car",
    force: Annotated[bool, typer.Option("--force", help="Replace a file that is there.")] = False,
) -> None:
    """Write an annotated hardpoint file to begin with: every key, its unit and its sign."""
    from ..starter import write_starter

    say(f"  {write_starter(path, template=template, force=force)}")
    say(f"Edit it, then: kintrafo check {path}")
