"""``kintrafo import-chrono``: a suspension of Project Chrono as a hardpoint file."""

from pathlib import Path
from textwrap import wrap
from typing import Annotated

import typer

from ...terminal.console import say
from .options import Force

EXAMPLES = (
    "kintrafo import-chrono MacPhersonStrut.json my_car.toml",
    "kintrafo import-chrono DoubleWishbone.json my_car.toml",
    "kintrafo import-chrono MacPhersonStrut.json my_car.toml --tire RigidTire.json --side right",
    "kintrafo import-chrono DoubleWishbone.json my_car.toml --points-only",
)

_WIDTH = 98  # of a comment's text

_File = {"exists": True, "dir_okay": False}


def command(
    file: Annotated[
        Path,
        typer.Argument(
            metavar="JSON", help="File of the template MacPhersonStrut or DoubleWishbone.", **_File
        ),
    ],
    path: Annotated[Path, typer.Argument(metavar="PATH", help="File to write; ends in .toml.")],
    *,
    tire: Annotated[
        Path | None,
        typer.Option(
            metavar="JSON",
            help="File of a tire: radius, mass and inertia.",
            **_File,
        ),
    ] = None,
    side: Annotated[
        str, typer.Option(metavar="SIDE", help="left, as in the file, or right.")
    ] = "left",
    points_only: Annotated[
        bool,
        typer.Option(
            "--points-only",
            help="Take hardpoints, camber and toe alone; the rest is as in the packaged file.",
        ),
    ] = False,
    force: Force = False,
) -> None:
    """Write the hardpoint file of a suspension that Project Chrono describes.

    What its file leaves open is assumed. The assumptions, and what is not read of the file, are
    printed, and stand in the new file.
    """
    from ...core.errors import InputError
    from ..files.chrono import read
    from ..input.toml_writer import write_toml

    if side not in ("left", "right"):
        raise InputError([f"side {side!r} is not known; there are left and right."], "--side")
    found = read(file, tire=tire, points_only=points_only)
    sources = f"{file.name} and {tire.name}" if tire else file.name
    head = [f"From {sources} of Project Chrono (https://projectchrono.org)."]
    for title, lines in (("Assumed:", found.assumptions), ("Left out:", found.left_out)):
        head += [title, *(line for told in lines for line in indented(told))] if lines else []
    write_toml(
        found.suspension if side == "left" else found.suspension.mirrored(),
        path,
        head=head,
        force=force,
        inputs=[file, *([tire] if tire else [])],
    )
    say(f"  {path}")
    for told in found.assumptions:
        say(f"  assumed   {told}")
    for told in found.left_out:
        say(f"  left out  {told}")
    say(f"Check it: kintrafo check {path}")


def indented(text: str) -> list[str]:
    """Return a sentence as lines of a comment."""
    return wrap(text, _WIDTH, initial_indent="  ", subsequent_indent="    ")
