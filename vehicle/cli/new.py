"""``kintrafo new``: an annotated file to begin with."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from ...terminal.console import say
from ..data.starter import DEFAULT, RIGID_AXLE, kinds
from .options import Force, argument, option

EXAMPLES = (
    "kintrafo new my_car.toml",
    "kintrafo new my_car.toml --suspension double_wishbone",
    "kintrafo new my_axle.toml --axle",
    "kintrafo new my_rear.toml --rigid-axle",
    "kintrafo new my_car.toml --template chrono_generic --force",
)


# the choices that are shown are the files that there are
if TYPE_CHECKING:
    Kind = str
else:
    Kind = Literal[kinds()]


def command(
    path: Annotated[Path, argument("File to write; ends in .toml.", "PATH")],
    *,
    suspension: Annotated[Kind, option("What guides the wheel.")] = DEFAULT,
    template: Annotated[
        str | None, option("Packaged data set to copy. Default: by --suspension.", "NAME")
    ] = None,
    axle: Annotated[
        bool, option("Write the file of an axle, which names its sides.", None, "--axle")
    ] = False,
    rigid_axle: Annotated[
        bool, option("Write the file of a rigid axle on four rods.", None, "--rigid-axle")
    ] = False,
    force: Force = False,
) -> None:
    """Write an annotated hardpoint file to begin with: every key, its unit and its sign."""
    from ..data.starter import write_starter
    from ..kinds import KINDS

    if (axle or rigid_axle) and (template is not None or suspension != DEFAULT):
        other = "--suspension" if template is None else "--template"
        given, why = ("--axle", "names its sides") if axle else ("--rigid-axle", "has none")
        raise typer.BadParameter(f"{given} and {other} are both given: such an axle {why}")
    if axle and rigid_axle:
        raise typer.BadParameter("--axle and --rigid-axle are both given: choose one of them")
    usual = "reference_axle" if axle else RIGID_AXLE if rigid_axle else KINDS[suspension].STARTER
    copied = usual if template is None else template
    say(f"  {write_starter(path, template=copied, force=force)}")
    say(f"Edit it, then: kintrafo check {path}")
