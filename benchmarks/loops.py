"""Loops without a closed form against paths followed in maximal coordinates.

``make benchmark-loops`` draws mechanisms of random dimensions, follows each along a straight path
of its driven coordinates (`tests/mechanisms/random_loops.py`, which shares nothing with the
generator but the declaration), and asks the emitted code for positions on the path: how many of
those that a regular path reaches are answered, and how many answers are on another branch.
"""

from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from mechanisms.random_loops import FAMILIES, REGULAR, Judged, judged
from rich.console import Console
from rich.markdown import Markdown
from rich.progress import track

from .report import fill_page, markdown_table


def table(found: dict[str, Judged]) -> str:
    """Return the results as Markdown."""
    header = ("mechanism", "that move", "positions", "on regular paths", "accepted", "wrong")
    total = sum(found.values(), Judged())
    rows = [
        (
            title,
            f"{one.mechanisms:,}",
            f"{one.reached:,}",
            f"{one.regular:,}",
            f"{100.0 * one.answered / max(one.regular, 1):.1f} %",
            f"{one.wrong:,}",
        )
        for title, one in {**found, "all": total}.items()
    ]
    return markdown_table(header, rows)


def run(
    count: Annotated[int, typer.Option(help="Mechanisms of each kind.")] = 20,
    page: Annotated[Path | None, typer.Option(help="Also put the table into this page.")] = None,
) -> None:
    """Count what is answered of regular paths, and what is wrong."""
    console, found = Console(), {}
    for family in FAMILIES:
        seeds = track(range(count), family.title, console=console)
        found[family.title] = sum(
            (judged(family, np.random.default_rng(seed)) for seed in seeds), Judged()
        )
    text = table(found)
    if page is not None:
        fill_page(page, {"loops": text})
    console.print(Markdown(text))
    console.print(f"Regular: the least singular value is above {REGULAR:g} of the greatest.")


if __name__ == "__main__":
    typer.run(run)
