"""``kintrafo optimise``: values of a file that bring characteristics to targets."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ...core.tabulated import significant
from ...terminal.console import console, print_json, progress_bar, say, table
from ...terminal.exits import Exit
from .loading import of_study, variable_subject
from .options import File, argument
from .outputs import CarOptions, name_files, title_of

if TYPE_CHECKING:
    from rich.table import Table

    from ..studies import Optimum
    from ..studies.design_variables import DesignVariable

EXAMPLES = (
    "kintrafo optimise my_car.toml goals.toml",
    "kintrafo optimise my_car.toml goals.toml -o better_car.toml --plot before_and_after.png",
)


def command(
    file: File,
    goals: Annotated[
        Path,
        argument(
            "TOML: values that are [free], and [targets] and [limits] of characteristics.", "GOALS"
        ),
    ],
    *,
    output: CarOptions,
) -> None:
    """Find values of the file that bring characteristics to their targets, within limits.

    The exit code is 1 if limits cannot be kept, or the search does not converge.
    """
    from .. import studies as variation

    outputs = output.files(file, goals, car=output.car)
    subject = variable_subject(file)
    asked = variation.read(goals)
    with of_study(goals), progress_bar("optimisation") as progress:
        found = variation.optimise(
            subject,
            asked.get("free", {}),
            asked.get("targets", {}),
            asked.get("limits"),
            progress=lambda left: progress(1.0 - left),
        )
    written: list[Path] = []
    if outputs.pages:
        from ..plots.variation import write_optimum

        written += outputs.draw(write_optimum, found, title=f"{title_of(file)}: {goals.stem}")
    head = f"{file}, with values that kintrafo optimise found for {goals.name}."
    written += outputs.write_car(found.suspension, head)
    if output.json:
        facts = {"moved": found.moved, "success": found.success, "message": found.message}
        print_json(facts | {"suspension": found.suspension.to_dict()})
    else:
        _print(found, file)
        name_files(written)
    if not found.success:
        raise typer.Exit(Exit.REFUSED)


def _print(found: "Optimum", file: str) -> None:
    console.print(
        moved_table(found.places, found.moved, f"{file}: changes of the design variables")
    )
    console.print(_goals(found))
    say(f"{found.message}; {found.evaluations} evaluations.")


def _goals(found: "Optimum") -> "Table":
    from ...core.quantities import bracketed, display_of
    from ..assembly.of import assembly_of

    rows = []
    for target in found.targets:
        attributes = target.quantity.attributes()
        factor = display_of(attributes).factor
        missed = [
            abs(target.curves.of(assembly_of(suspension))[0] - target.value).max()
            for suspension in (found.start, found.suspension)
        ]
        name = bracketed(f"{target.quantity.long_name}{target.over_words}", attributes)
        rows.append((name, *(significant(float(v) * factor) for v in (*missed, target.within))))
    columns = ("characteristic", "before", "after", "within")
    return table("largest deviations from the targets", columns, rows)


def moved_table(
    places: "Iterable[DesignVariable]", moved: Mapping[str, float], title: str
) -> "Table":
    """Return a table of design variables: old values, new ones, and changes."""
    rows = []
    for place in places:
        by = moved[place.name]
        numbers = (f"{value:.3f}" for value in (place.value, place.value + by, by))
        rows.append((place.name, *numbers, place.unit or "-"))
    return table(title, ("value", "was", "is", "moved by", "unit"), rows, words=(0, 4))
