"""``kintrafo import-chrono``: a suspension of Project Chrono as a hardpoint file."""

from pathlib import Path
from typing import Annotated

import typer

from .console import say
from .options import Force

EXAMPLES = (
    "kintrafo import-chrono MacPhersonStrut.json my_car.toml",
    "kintrafo import-chrono DoubleWishbone.json my_car.toml",
    "kintrafo import-chrono MacPhersonStrut.json my_car.toml --tire RigidTire.json --side right",
)

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
        typer.Option(metavar="JSON", help="File of a tire: radius, mass and inertia.", **_File),
    ] = None,
    side: Annotated[
        str, typer.Option(metavar="SIDE", help="left, as in the file, or right.")
    ] = "left",
    force: Force = False,
) -> None:
    """Write the hardpoint file of a suspension that Project Chrono describes.

    What its file leaves open is assumed; the assumptions are printed, and stand in the new file.
    """
    from ..core.errors import InputError
    from ..suspension.chrono import read
    from ..suspension.toml_writer import write_toml

    if side not in ("left", "right"):
        raise InputError([f"side {side!r} is not known; there are left and right."], "--side")
    suspension, assumptions = read(file, tire=tire)
    sources = f"{file.name} and {tire.name}" if tire else file.name
    head = [f"From {sources} of Project Chrono (https://projectchrono.org).", "Assumed:"]
    head += [f"  {told}" for told in assumptions]
    write_toml(
        suspension if side == "left" else suspension.mirrored(),
        path,
        head=head,
        force=force,
        inputs=[file, *([tire] if tire else [])],
    )
    say(f"  {path}")
    for told in assumptions:
        say(f"  assumed  {told}")
    say(f"Check it: kintrafo check {path}")
