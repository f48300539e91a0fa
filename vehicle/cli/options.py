"""Arguments shared by commands, and functions to declare and check arguments."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import typer

from .values import existing_file

OUTPUT = "Output"
"""Panel of the help for files to write and the form of printed results."""

FILE: Mapping[str, Any] = {"parser": existing_file}
"""Keywords of `argument` and `option` for the path of an existing file."""


def by_comma(given: list[str] | None) -> list[str] | None:
    """Return the names in a repeated option, whose values may be lists with commas."""
    return given and [name.strip() for text in given for name in text.split(",")]


def option(
    words: str, value: str | None = None, *names: str, panel: str | None = None, **how: Any
) -> Any:
    """Return the declaration of an option with some help, and names other than its parameter's.

    `value` is the placeholder of its value: a unit in capitals; ``NAME,...`` for a list, given
    repeatedly or with commas. `how` is as in `typer.Option`.
    """
    if value is not None and value.endswith(",..."):
        how["callback"] = by_comma
    return typer.Option(*names, metavar=value, help=words, rich_help_panel=panel, **how)


def argument(words: str, value: str | None = None, **how: Any) -> Any:
    """Return the declaration of an argument with some help; `how` is as in `typer.Argument`.

    `value` is its placeholder; FILE completes the names of files.
    """
    if value is not None and value.startswith("FILE") and not how:
        how["autocompletion"] = complete_file
    return typer.Argument(metavar=value, help=words, **how)


def complete_file(incomplete: str) -> list[str]:
    """Return TOML files and packaged names with this beginning."""
    from ..data.starter import all_packaged

    parent = Path(incomplete).parent if "/" in incomplete else Path()
    files = sorted(str(path) for path in parent.glob("*.toml"))
    return [name for name in (*files, *all_packaged()) if name.startswith(incomplete)]


File = Annotated[
    str,
    argument("Input file (TOML), or the name of a packaged one, such as reference_car.", "FILE"),
]
Json = Annotated[
    bool, option("Print the result as JSON, in SI units, and nothing else.", panel=OUTPUT)
]
Force = Annotated[
    bool, option("Replace existing files, also those that kintrafo did not write.", panel=OUTPUT)
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
SUPPORT = (
    "Support of the wheel. height: the contact stays at its height; tyre: the tyre deflects; "
    "spring: the vertical force is constant; locked: the length of the spring is constant."
)
Bushes = Annotated[
    Path | None,
    option("TOML: [bushings.POINT] with stiffnesses, in place of those of FILE.", "PATH"),
]


def refuse_which(file: str | None, model: str | None) -> None:
    """Refuse --model for files with one model."""
    if model is not None and not (file or "").endswith(".py"):
        raise typer.BadParameter("--model is for Python files, which may have several")


def refuse_options(sort: str, given: Mapping[str, Any]) -> None:
    """Refuse given options that are only for `sort`; None is an option that is not given."""
    for name, value in given.items():
        if value is not None:
            raise typer.BadParameter(f"{name} is only for {sort}")


def among(wanted: list[str], known: Iterable[str], name: str = "--of") -> list[str]:
    """Return the names in an option, each once; unknown ones are refused."""
    from ...core.validator import Validator

    with Validator(name) as given:
        names = given.names(name, wanted, known)
    return list(dict.fromkeys(names))


def metres(millimetres: float | None) -> float | None:
    """Return a length in millimetres, or None, in metres."""
    return None if millimetres is None else millimetres / 1e3
