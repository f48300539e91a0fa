"""Arguments that several commands share, and how arguments are declared and checked."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import typer

from .values import existing_file

OUTPUT = "Output"
"""The panel of the help that names files, and how a result is printed."""

FILE: Mapping[str, Any] = {"parser": existing_file}
"""What `argument` and `option` take where a path must be a file that is there."""


def by_comma(given: list[str] | None) -> list[str] | None:
    """Return the names of an option that is repeated, or whose value is a list with commas."""
    return given and [name.strip() for text in given for name in text.split(",")]


def option(
    words: str, value: str | None = None, *names: str, panel: str | None = None, **how: Any
) -> Any:
    """Return the declaration of an option.

    Parameters
    ----------
    words : str
        Its help.
    value : str, optional
        Placeholder of its value: a unit in capitals; ``NAME,...`` for a list, which is
        repeated or has commas.
    *names : str
        Its names, where they are not that of the parameter.
    panel : str, optional
        Where in the help it is.
    **how
        As of `typer.Option`.
    """
    if value is not None and value.endswith(",..."):
        how["callback"] = by_comma
    return typer.Option(*names, metavar=value, help=words, rich_help_panel=panel, **how)


def argument(words: str, value: str | None = None, **how: Any) -> Any:
    """Return the declaration of an argument.

    Parameters
    ----------
    words : str
        Its help.
    value : str, optional
        Placeholder of it; FILE for one whose names are completed.
    **how
        As of `typer.Argument`.
    """
    if value is not None and value.startswith("FILE") and not how:
        how["autocompletion"] = complete_file
    return typer.Argument(metavar=value, help=words, **how)


def complete_file(incomplete: str) -> list[str]:
    """Return packaged names and TOML files that begin like this."""
    from ..data.starter import all_packaged

    parent = Path(incomplete).parent if "/" in incomplete else Path()
    files = sorted(str(path) for path in parent.glob("*.toml"))
    return [name for name in (*files, *all_packaged()) if name.startswith(incomplete)]


File = Annotated[
    str,
    argument("Hardpoint file (TOML), or the name of a packaged data set: reference_car.", "FILE"),
]
Json = Annotated[
    bool,
    option(
        "Print the result as JSON, in SI units, and nothing else.", None, "--json", panel=OUTPUT
    ),
]
Force = Annotated[
    bool,
    option(
        "Replace existing files, also those that kintrafo did not write.",
        None,
        "--force",
        panel=OUTPUT,
    ),
]
Rebound = Annotated[float | None, option("Wheel travel downward. Default: 80, if reached.", "MM")]
Bump = Annotated[float | None, option("Wheel travel upward. Default: 80, if reached.", "MM")]
Of = Annotated[
    list[str] | None,
    option("Characteristics to show, such as bump_steer,toe.", "NAME,..."),
]
Which = Annotated[
    str | None, option("Name of the model, if a Python file has several.", "NAME", "--model")
]
Held = Literal["height", "tyre", "spring", "locked"]
Bushes = Annotated[
    Path | None,
    option("TOML: [bushings.POINT] with stiffnesses, in place of those of FILE.", "PATH"),
]


def refuse_which(file: str | None, model: str | None) -> None:
    """Refuse to choose a model where there is but one."""
    if model is not None and not (file or "").endswith(".py"):
        raise typer.BadParameter("--model is for Python files, which may have several")


def refuse_options(sort: str, given: Mapping[str, Any]) -> None:
    """Refuse options that the files of one sort do not have."""
    for name, value in given.items():
        if value is not None:
            raise typer.BadParameter(f"{name} is only for {sort}")


def among(wanted: list[str], known: Iterable[str], name: str = "--of") -> list[str]:
    """Return what an option names, each once, or refuse what there is not."""
    from ...core.validator import Validator

    with Validator(name) as given:
        names = given.names(name, wanted, known)
    return list(dict.fromkeys(names))


def metres(millimetres: float | None) -> float | None:
    """Return a length from the command line in metres."""
    return None if millimetres is None else millimetres / 1e3
