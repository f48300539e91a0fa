"""What the commands do with the file of an axle."""

from collections.abc import Mapping
from typing import Any

import typer


def is_axle(file: str) -> bool:
    """Tell whether a file is that of an axle."""
    from ..suspension.axle.axle import is_axle as found

    return found(file)


def refuse_options(sort: str, given: Mapping[str, Any]) -> None:
    """Refuse options that the files of one sort do not have."""
    for option, value in given.items():
        if value is not None:
            raise typer.BadParameter(f"{option} is only for {sort}")
