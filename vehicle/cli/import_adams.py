"""``kintrafo import-adams``: a suspension of Adams/Car as a hardpoint file."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from ...terminal.console import say
from ..data.starter import kinds
from .options import Force, complete_file

EXAMPLES = (
    "kintrafo import-adams front_suspension.sub my_car.toml",
    "kintrafo import-adams front_suspension.sub right.toml --side right --from my_car.toml",
    "kintrafo import-adams own.sub my_car.toml --name lower_ball_joint=my_lca_outer",
)

# the choices that are shown are the files that there are
if TYPE_CHECKING:
    Kind = str
    Side = Literal["left", "right"]
else:
    Kind = Literal[kinds()]
    Side = Literal["left", "right"]


def command(
    file: Annotated[
        Path,
        typer.Argument(
            metavar="SUB",
            help="Subsystem of a suspension as text (TeimOrbit).",
            exists=True,
            dir_okay=False,
        ),
    ],
    path: Annotated[Path, typer.Argument(metavar="PATH", help="File to write; ends in .toml.")],
    *,
    side: Annotated[
        Side | None, typer.Option(help="Side of the car. Default: that of --from, or left.")
    ] = None,
    kind: Annotated[
        Kind | None, typer.Option(help="What guides the wheel. Default: by the hardpoints.")
    ] = None,
    base: Annotated[
        str | None,
        typer.Option(
            "--from",
            metavar="FILE",
            help="Hardpoint file that everything else is taken from. Default: a packaged one.",
            autocompletion=complete_file,
        ),
    ] = None,
    name: Annotated[
        list[str] | None,
        typer.Option(
            metavar="OURS=THEIRS",
            help="What the subsystem calls a hardpoint; may be given more than once.",
        ),
    ] = None,
    force: Force = False,
) -> None:
    """Write the hardpoint file of a suspension that a subsystem of Adams/Car describes.

    Hardpoints, camber, toe and a spring are read. What was read, assumed and left out is
    printed.
    """
    from ...core.files import refuse
    from ..files.adams_car import imported, read, read_names
    from ..files.point_table import write_merged

    inputs: list[str | Path] = [file, *([base] if base else [])]
    refuse([path], force=force, inputs=inputs, endings=[".toml"])
    names = read_names(name or ())
    found = imported(read(file), side=side, kind=kind, base=base, names=names)
    say(f"  {write_merged(found, path, force=force, inputs=inputs)}")
    for head, text in found.words():
        say(f"  {head:<8}  {text}")
    say(f"Check it: kintrafo check {path}")
