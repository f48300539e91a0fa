"""``kintrafo generate``: derive the equations anew, where the generator is installed."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = ("kintrafo generate generated",)


def command(
    folder: Annotated[Path, typer.Argument(metavar="FOLDER", help="Where the C and Python go.")],
) -> None:
    """Derive the equations of motion and write them as C and Python.

    Needs the packages of the extra "generator": pip install "kintrafo[generator]".
    """
    from ..optional import require

    for package in ("sympy", "networkx"):
        require(package, purpose="Deriving equations", extra="generator")
    from ..generator.__main__ import generate_all

    generate_all(folder)
