"""Arguments that several commands share."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...terminal.console import problems

if TYPE_CHECKING:
    from ...systems.system import System
    from ..models.model import Model


def by_comma(given: list[str] | None) -> list[str] | None:
    """Return the names of an option that is repeated, or whose value is a list with commas."""
    return given and [name.strip() for text in given for name in text.split(",")]


def complete_file(incomplete: str) -> list[str]:
    """Return packaged names and TOML files that begin like this."""
    from ..data.starter import RIGID_AXLE, packaged, packaged_axles

    parent = Path(incomplete).parent if "/" in incomplete else Path()
    files = sorted(str(path) for path in parent.glob("*.toml"))
    names = (*files, *packaged(), *packaged_axles(), RIGID_AXLE)
    return [name for name in names if name.startswith(incomplete)]


File = Annotated[
    str,
    typer.Argument(
        metavar="FILE",
        help="Hardpoint file (TOML), or the name of a packaged data set: reference_car.",
        autocompletion=complete_file,
    ),
]
Files = Annotated[
    list[str],
    typer.Argument(
        metavar="FILE FILE...",
        help="Two or more hardpoint files or packaged names; the first is the reference.",
        autocompletion=complete_file,
    ),
]
Json = Annotated[
    bool,
    typer.Option(
        "--json",
        help="Print the result as JSON, in SI units, and nothing else.",
        rich_help_panel="Output",
    ),
]
Force = Annotated[
    bool,
    typer.Option(
        "--force",
        help="Replace files that are there, too, where kintrafo did not write them.",
        rich_help_panel="Output",
    ),
]
Rebound = Annotated[
    float | None, typer.Option(metavar="MM", help="Wheel travel downward. Default: 80, if reached.")
]
Bump = Annotated[
    float | None, typer.Option(metavar="MM", help="Wheel travel upward. Default: 80, if reached.")
]
RackExtent = Annotated[
    float | None,
    typer.Option(
        "--rack-extent", metavar="MM", help="Rack to either side. Default: 60, if reached."
    ),
]
Of = Annotated[
    list[str] | None,
    typer.Option(
        metavar="NAME,...",
        help="Characteristics that are shown, such as bump_steer,toe.",
        callback=by_comma,
    ),
]
Which = Annotated[
    str | None,
    typer.Option("--model", metavar="NAME", help="Which model, where a Python file has several."),
]
Step = Annotated[float, typer.Option(metavar="MM", help="Distance of the positions.")]


def load(file: str, *, wheel_loads: bool = False) -> "Model":
    """Return the model of a file: the one in which every body that has mass counts.

    Parameters
    ----------
    file : str
        Path of a TOML file, or name of a packaged data set.
    wheel_loads
        Whether what acts on the wheel are inputs.

    Returns
    -------
    Model
    """
    from ..kinds import Suspension
    from ..models.model import Model

    suspension = Suspension.load(file)
    free_rack = bool(suspension.neglected_masses())
    if not free_rack and not wheel_loads:
        return Model(suspension)
    # these equations may have to be derived first
    with problems.status("preparing the equations"):
        return Model(suspension, free_rack=free_rack, wheel_loads=wheel_loads)


def system_of(file: str, name: str | None = None) -> "System":
    """Return the equations of a mechanism of one's own, derived when they are first needed."""
    from ...systems.compile import compile_mechanism
    from ...systems.system import System

    return System(compile_mechanism(file, name=name))


def refuse_which(file: str | None, model: str | None) -> None:
    """Refuse to choose a model where there is but one."""
    if model is not None and not (file or "").endswith(".py"):
        raise typer.BadParameter("--model is for Python files, which may have several")


def refuse_options(sort: str, given: Mapping[str, Any]) -> None:
    """Refuse options that the files of one sort do not have."""
    for option, value in given.items():
        if value is not None:
            raise typer.BadParameter(f"{option} is only for {sort}")


def among(wanted: list[str], known: Iterable[str], option: str = "--of") -> list[str]:
    """Return what an option names, each once, or refuse what there is not."""
    from ...core.arguments import Arguments

    with Arguments(option) as given:
        names = given.names(option, wanted, known)
    return list(dict.fromkeys(names))


def metres(millimetres: float | None) -> float | None:
    """Return a length from the command line in metres."""
    return None if millimetres is None else millimetres / 1e3
