"""Parsers of numbers and choices on the command line, with allowed values in messages."""

import math
import re
from collections.abc import Callable
from pathlib import Path
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

import typer

from ...core.suggestions import nearest

_UNITS = {
    **{name.upper(): name for name in ("mm", "m", "deg", "s", "ms", "km/h", "rev/s", "1/s", "kg")},
    "HZ": "Hz",
    "N": "N",
    "%": "%",
}
_NAMES = {float: "NUMBER", int: "COUNT"}


def explained(command: Callable[..., None]) -> Callable[..., None]:
    """Add the parsers of this module to a command's numbers and choices, and return it.

    The annotations of the command are completed in place. A flag has no opposite
    such as --no-json.
    """
    for name, hint in get_type_hints(command, include_extras=True).items():
        if get_origin(hint) is not Annotated:
            continue
        if hint.__origin__ is bool:
            (info,) = hint.__metadata__
            # its default is the first of the names that it has
            if info.default is ...:
                info.param_decls = (f"--{name.replace('_', '-')}",)
        kinds = _kinds(hint.__origin__)
        kind = next((kind for kind in (float, int) if kind in kinds), None)
        choices = next((get_args(kind) for kind in kinds if get_origin(kind) is Literal), None)
        for info in hint.__metadata__:
            if getattr(info, "parser", kind) is not None:
                continue
            if kind is not None:
                info.metavar = info.metavar or _NAMES[kind]
                info.parser = _number(kind, _UNITS.get(info.metavar, ""))
            elif choices is not None:
                info.metavar = info.metavar or f"<{'|'.join(choices)}>"
                info.autocompletion = info.autocompletion or completion_of(choices)
                info.parser = _choice(choices)
    return command


def existing_file(text: str) -> Path:
    """Return the path of an existing file."""
    path = Path(text)
    if path.is_dir():
        raise typer.BadParameter(f"{text}: this is a folder, and a file is needed.")
    if not path.exists():
        raise typer.BadParameter(f"{text}: there is no such file. Check its name and folder.")
    return path


def _kinds(hint: Any) -> tuple[Any, ...]:
    """Return the types in a union or list, at any depth."""
    if get_origin(hint) in (Union, UnionType, list, tuple):
        return tuple(kind for part in get_args(hint) for kind in _kinds(part))
    return (hint,)


def _choice(choices: tuple[str, ...]) -> Callable[[Any], str]:
    """Return the parser of one of some words."""

    def read(text: Any) -> str:
        if text not in choices:
            meant = nearest(str(text), choices)
            hint = f" Did you mean {meant}?" if meant else ""
            raise typer.BadParameter(f"{text!r}: it can be {', '.join(choices)}.{hint}")
        return str(text)

    read.__name__ = "CHOICE"
    return read


def completion_of(choices: tuple[str, ...]) -> Callable[[str], list[str]]:
    """Return the completion of one of some words."""

    def completed(incomplete: str) -> list[str]:
        return [choice for choice in choices if choice.startswith(incomplete)]

    return completed


def _number(kind: type[float], unit: str) -> Callable[[Any], float]:
    """Return the parser of a number in a unit."""

    def read(text: Any) -> float:
        # grouped digits as in Python, 1_000, are refused
        try:
            number = None if "_" in str(text) else kind(text)
        except ValueError:
            number = None
        if number is None or not math.isfinite(number):
            raise typer.BadParameter(_problem(str(text), unit, whole=kind is int))
        return number

    read.__name__ = _NAMES[kind]  # shown by some versions of Typer
    return read


def _problem(text: str, unit: str, *, whole: bool) -> str:
    if whole:
        return f"{text!r}: a whole number is needed, such as 20."
    number = re.match(r"\s*[-+]?\d+(?:[.,]\d+)?", text)
    example = number[0].strip().replace(",", ".") if number else "20" if unit else "1e-6"
    wanted = f"a finite number in {unit}, without the unit," if unit else "a finite number"
    return f"{text!r}: {wanted} is needed, such as {example}."
