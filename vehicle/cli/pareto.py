"""``kintrafo pareto``: the Pareto front of several objectives over values of a file."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...core.tabulated import significant
from ...terminal.console import console, print_json, progress_bar, say, table
from ...terminal.exits import Exit
from .loading import of_study, variable_subject
from .optimise import moved_table
from .options import OUTPUT, File, argument, option
from .outputs import Outputs, SingleFigureOptions, name_files, title_of

if TYPE_CHECKING:
    from rich.table import Table

    from ..studies import Front

EXAMPLES = (
    "kintrafo pareto my_car.toml objectives.toml -o front.csv --plot front.png",
    "kintrafo pareto my_car.toml objectives.toml --member 7 --member-file chosen_car.toml",
)

_ROWS = 20  # of the table; data files have all members


def command(
    file: File,
    study: Annotated[
        Path,
        argument(
            "TOML: values that are [free]; [targets], [minimise] and [maximise], each an "
            "objective; and optional [limits].",
            "STUDY",
        ),
    ],
    *,
    population: Annotated[
        int, option("Suspensions in each generation, and most members of the front.", "N")
    ] = 48,
    generations: Annotated[int, option("Number of generations.", "N")] = 40,
    seed: Annotated[int, option("Seed of the search.", "N")] = 1,
    member: Annotated[
        int | None,
        option(
            "Number of the chosen member. Default: the compromise, nearest to the best values of "
            "all objectives.",
            "N",
        ),
    ] = None,
    member_file: Annotated[
        Path | None,
        option("Write the input file of the chosen member: .toml.", "PATH", panel=OUTPUT),
    ] = None,
    output: SingleFigureOptions,
) -> None:
    """Find the Pareto front of several objectives: the best compromises between them.

    No suspension of the front can be improved in one objective without loss in another one. The
    exit code is 1 if no suspension keeps the limits.
    """
    from ...datasets import export
    from .. import studies as variation

    outputs = output.files(file, study, car=member_file)
    _refuse_member(member, population)
    subject = variable_subject(file)
    asked = variation.read(study)
    with of_study(study), progress_bar("suspensions") as progress:
        found = variation.pareto(
            subject,
            asked.get("free", {}),
            asked.get("targets"),
            minimise=asked.get("minimise"),
            maximise=asked.get("maximise"),
            limits=asked.get("limits"),
            population=population,
            generations=generations,
            seed=seed,
            progress=progress,
        )
    chosen = 0
    written: list[Path] = []
    if found.success:
        chosen = found.compromise if member is None else member
        written = _write(found, chosen, outputs, title=f"{title_of(file)}: {study.stem}")
    if output.json:
        print_json(_facts(found, chosen) | export.as_dict(found.dataset))
    else:
        _print(found, chosen, file)
        name_files(written)
    if not found.success:
        raise typer.Exit(Exit.REFUSED)


def _refuse_member(member: int | None, population: int) -> None:
    """Refuse a member beyond the population before computing."""
    from ...core.validator import Validator

    with Validator("pareto") as given:
        if member is not None:
            given.whole("--member", member, most=max(population, 1))


def _write(found: "Front", chosen: int, outputs: Outputs, *, title: str) -> list[Path]:
    """Write the data, the figure, and the input file of the chosen member."""
    suspension = found.suspension(chosen)
    written = outputs.write_data(found.dataset)
    if outputs.pages:
        from ..plots.pareto import write_front

        written += outputs.draw(write_front, found, chosen=chosen, title=title)
    head = f"{title}, member {chosen} of the front that kintrafo pareto found."
    return written + outputs.write_car(suspension, head)


def _facts(found: "Front", chosen: int) -> dict[str, Any]:
    names = ("before", "keeps_limits", "compromise", "success", "message")
    facts: dict[str, Any] = {name: getattr(found, name) for name in names}
    return facts | {"chosen": chosen}


def _print(found: "Front", chosen: int, file: str) -> None:
    console.print(_table(found, chosen, file))
    if chosen:
        title = f"{file}: values of member {chosen}"
        console.print(moved_table(found.places, found.moved[chosen - 1], title))
    say(f"{found.message}; {found.evaluations} were evaluated.")


def _table(found: "Front", chosen: int, file: str) -> "Table":
    """Return the table of the original suspension and of the members, or some of many."""
    from ...core.quantities import bracketed, display_of

    count = len(found.moved)
    described = [objective.attributes() for objective in found.objectives]
    headings = [
        f"{bracketed(str(attrs['long_name']), attrs)}\n{attrs['wanted']}" for attrs in described
    ]
    factors = [display_of(attrs).factor for attrs in described]

    def row(member: str, numbers: Sequence[float], remark: str) -> tuple[str, ...]:
        cells = (significant(v * factor) for v, factor in zip(numbers, factors, strict=True))
        return member, *cells, remark

    members = _rows(count, chosen, found.compromise)
    values = [found.dataset[objective.name].values for objective in found.objectives]
    remark = "file" if found.keeps_limits else "file, beyond limits"
    rows = [row("", [*found.before.values()], remark)]
    rows += [row(str(m), [float(v[m - 1]) for v in values], _remark(found, m, chosen))
             for m in members]  # fmt: skip
    columns = ("member", *headings, "")
    caption = "some of them; data files have all" if len(members) < count else None
    return table(f"{file}: {count} on the front", columns, rows, (len(columns) - 1,), caption)


def _remark(found: "Front", member: int, chosen: int) -> str:
    remarks = ["compromise"] if member == found.compromise else []
    return ", ".join(remarks + (["chosen"] if member == chosen != found.compromise else []))


def _rows(count: int, *always: int) -> list[int]:
    """Return the members in the table: at most `_ROWS` evenly spaced ones, and `always`."""
    some = {round(1 + step * (count - 1) / (_ROWS - 1)) for step in range(_ROWS)}
    shown = some | {*always} if count > _ROWS else {*range(1, count + 1)}
    return sorted(shown - {0}) if count else []
