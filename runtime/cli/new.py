"""``kintrafo new``: an annotated file to begin with."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from .console import say
from .options import Force

EXAMPLES = (
    "kintrafo new my_car.toml",
    "kintrafo new my_car.toml --suspension double_wishbone",
    "kintrafo new my_car.toml --template chrono_generic --force",
)


def command(
    path: Annotated[Path, typer.Argument(metavar="PATH", help="File to write; ends in .toml.")],
    *,
    suspension: Annotated[
        Literal["macpherson", "double_wishbone"], typer.Option(help="What guides the wheel.")
    ] = "macpherson",
    template: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Packaged data set to copy. Default: by --suspension."),
    ] = None,
    force: Force = False,
) -> None:
    """Write an annotated hardpoint file to begin with: every key, its unit and its sign."""
    from ..suspension.starter import STARTERS, write_starter

    copied = STARTERS[suspension] if template is None else template
    say(f"  {write_starter(path, template=copied, force=force)}")
    say(f"Edit it, then: kintrafo check {path}")
