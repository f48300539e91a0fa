"""Targets and limits of a file beside curves: the option, and the table that says which are met."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.markup import escape
from rich.table import Table

from ..core.tabulated import significant

if TYPE_CHECKING:
    from ..study.variation.goals import Goal
    from ..study.variation.ways import Subject
    from ..suspension.axle import Axle

Goals = Annotated[
    Path | None,
    typer.Option(
        "--goals",
        metavar="FILE",
        help="TOML with [targets] and [limits] of characteristics, as of kintrafo optimise: they "
        "are drawn into curves, and a table says which are met; of axles the table.",
    ),
]


def read(
    path: Path | None, ways: Sequence[str], known: Sequence[str] = ("travel", "rack")
) -> "list[Goal]":
    """Return the goals of a file about curves over some ways; none without a file.

    Parameters
    ----------
    path : Path or None
    ways : sequence of str
        Those that are looked at.
    known : sequence of str, optional
        Those that the file may have, the usual first.
    """
    if path is None:
        return []
    from ..core.errors import InputError
    from ..study import variation

    goals = [goal for goal in variation.goals(variation.read(path), known) if goal.over in ways]
    if not goals:
        words = " or ".join(ways)
        problem = (
            f"it has no [targets.NAME] and no [limits.NAME] over {words}: one is needed, such as "
            "[limits.toe] with at_mm, least and most."
        )
        raise InputError([problem], str(path))
    return goals


def judged(
    subjects: "Mapping[str, Subject | Axle]", goals: "Sequence[Goal]"
) -> list[dict[str, Any]]:
    """Return what comes of each goal with each suspension or axle, as printed and as JSON."""
    from ..study import variation

    return [
        {"file": name, **vars(verdict)}
        for name, subject in subjects.items()
        for verdict in variation.judge(subject, goals)
    ]


def table(found: Sequence[Mapping[str, Any]], title: str) -> Table:
    """Return the table of what `judged` returns."""
    from ..core.quantities import bracketed, display_of
    from ..study.variation.ways import way

    files = list(dict.fromkeys(row["file"] for row in found))
    result = Table(title=escape(title))
    for column in ("goal", *files):
        result.add_column(escape(column))
    rows = [[row for row in found if row["file"] == file] for file in files]
    for same in zip(*rows, strict=True):
        first = same[0]
        over = way(first["over"])
        quantity = over.known[first["name"]]
        shown = display_of(quantity.attributes())
        words = bracketed(quantity.long_name, quantity.attributes())
        words = words if first["over"] in ("travel", "bump") else f"{words} over {over.words}"
        cells = [
            "met"
            if row["met"]
            else f"missed by {significant(row['beyond'] * shown.factor)} at "
            f"{over.factor * row['at']:g} {over.unit}"
            for row in same
        ]
        result.add_row(escape(f"{first['kind']}: {words}"), *cells)
    return result
