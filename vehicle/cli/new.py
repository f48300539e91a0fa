"""``kintrafo new``: an annotated file to begin with."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from ...terminal.console import say
from ..data.starter import DEFAULT, kinds, manoeuvres, whole_axles
from .options import Force, argument, option

EXAMPLES = (
    "kintrafo new my_car.toml",
    "kintrafo new my_car.toml --suspension double_wishbone",
    "kintrafo new my_axle.toml --axle",
    "kintrafo new my_rear.toml --rigid-axle",
    "kintrafo new my_vehicle.toml --car",
    "kintrafo new my_car.toml --template chrono_generic --force",
)


# the choices are read from the files of the kinds
if TYPE_CHECKING:
    Kind = str
else:
    Kind = Literal[(*kinds(), *whole_axles())]


def command(
    path: Annotated[Path, argument("File to write; ends in .toml.", "PATH")],
    *,
    suspension: Annotated[Kind, option("Type of suspension or axle.")] = DEFAULT,
    template: Annotated[
        str | None,
        option("Packaged file to copy, also a manoeuvre. Default: by --suspension.", "NAME"),
    ] = None,
    axle: Annotated[bool, option("Write the file of an axle, which names its sides.")] = False,
    rigid_axle: Annotated[bool, option("Write the file of a rigid axle on four rods.")] = False,
    car: Annotated[bool, option("Write the file of a car, which names its axles.")] = False,
    force: Force = False,
) -> None:
    """Write an annotated input file to begin with: every key, its unit and its sign."""
    from ..data.starter import write_starter
    from ..kinds import KINDS

    whole = {
        "--axle": (axle, "reference_axle", "such an axle names its sides"),
        "--rigid-axle": (rigid_axle, "rigid_axle", "such an axle has none"),
        "--car": (car, "reference_vehicle", "a car names its axles"),
    }
    chosen = [option for option, (given, *_) in whole.items() if given]
    if len(chosen) > 1:
        raise typer.BadParameter(f"{' and '.join(chosen)} are both given: choose one of them")
    if chosen and (template is not None or suspension != DEFAULT):
        other = "--suspension" if template is None else "--template"
        raise typer.BadParameter(f"{chosen[0]} and {other} are both given: {whole[chosen[0]][2]}")
    of_kind = suspension if suspension in whole_axles() else KINDS[suspension].STARTER
    usual = whole[chosen[0]][1] if chosen else of_kind
    copied = usual if template is None else template
    say(f"  {write_starter(path, template=copied, force=force)}")
    then = f"drive FILE --manoeuvre {path}" if copied in manoeuvres() else f"check {path}"
    say(f"Edit it, then: kintrafo {then}")
