"""Numbers on the command line: what is none is refused with its unit and an example."""

import math
import re
from collections.abc import Callable
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin, get_type_hints

import typer

_UNITS = {
    **{name.upper(): name for name in ("mm", "m", "deg", "s", "ms", "km/h", "rev/s", "1/s", "kg")},
    "HZ": "Hz",
    "N": "N",
}
_NAMES = {float: "NUMBER", int: "COUNT"}


def explained(command: Callable[..., None]) -> Callable[..., None]:
    """Let the options and arguments of a command that are numbers be read by `_number`.

    Parameters
    ----------
    command : callable
        Whose parameters are annotated for Typer; what it says of numbers is completed.
    """
    for hint in get_type_hints(command, include_extras=True).values():
        if get_origin(hint) is not Annotated:
            continue
        kind = next((kind for kind in (float, int) if kind in _kinds(hint.__origin__)), None)
        for info in hint.__metadata__:
            if kind is not None and getattr(info, "parser", kind) is None:
                info.metavar = info.metavar or _NAMES[kind]
                info.parser = _number(kind, _UNITS.get(info.metavar, ""))
    return command


def _kinds(hint: Any) -> tuple[Any, ...]:
    """Return what a value may be, also in a list and where it may be left out."""
    if get_origin(hint) in (Union, UnionType, list, tuple):
        return tuple(kind for part in get_args(hint) for kind in _kinds(part))
    return (hint,)


def _number(kind: type[float], unit: str) -> Callable[[Any], float]:
    """Return what reads a number of a kind in a unit."""

    def read(text: Any) -> float:
        # Python's own way to group digits is a slip of the pen here
        try:
            number = None if "_" in str(text) else kind(text)
        except ValueError:
            number = None
        if number is None or not math.isfinite(number):
            raise typer.BadParameter(_problem(str(text), unit, whole=kind is int))
        return number

    read.__name__ = _NAMES[kind]  # what some versions of Typer show
    return read


def _problem(text: str, unit: str, *, whole: bool) -> str:
    if whole:
        return f"{text!r}: a whole number is needed, such as 20."
    number = re.match(r"\s*[-+]?\d+(?:[.,]\d+)?", text)
    example = number[0].strip().replace(",", ".") if number else "20" if unit else "1e-6"
    wanted = f"a finite number in {unit}, without the unit," if unit else "a finite number"
    return f"{text!r}: {wanted} is needed, such as {example}."
