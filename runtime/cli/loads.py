"""``kintrafo loads``: the forces on every part in load cases."""

from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape
from rich.table import Table

from .console import console, print_json, say
from .exits import Exit
from .options import File, Force, Json, among, load
from .outputs import Out, Outputs, name_files

if TYPE_CHECKING:
    from xarray import Dataset

# What acts by itself, not between parts at a joint.
_ACTING = ("spring", "damper", "road", "drive")

EXAMPLES = (
    "kintrafo loads reference_car",
    "kintrafo loads my_car.toml --cases cases.toml -o loads.csv",
    "kintrafo loads my_car.toml --case brake --part knuckle --plot knuckle.pdf",
)


def command(
    file: File,
    *,
    cases: Annotated[
        Path | None,
        typer.Option(metavar="PATH", help="TOML of load cases. Default: usual ones."),
    ] = None,
    case: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="Show these cases by components. May be repeated."),
    ] = None,
    part: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME", help="Show loads on these parts: knuckle, chassis. May be repeated."
        ),
    ] = None,
    envelope: Annotated[
        bool,
        typer.Option("--envelope", help="Show the extremes of every component, and their cases."),
    ] = False,
    out: Out = None,
    plot: Annotated[
        list[Path] | None,
        typer.Option(
            "--plot",
            metavar="PATH",
            help="Write the free bodies of the parts in each case: .pdf, .png or .svg, a file for "
            "each case. May be repeated.",
            rich_help_panel="Output",
        ),
    ] = None,
    force: Force = False,
    json: Json = False,
) -> None:
    """Tell forces and moments on every part at its hardpoints, in load cases at rest.

    The table has the size of each force; --case shows components. Data files have everything. The
    exit code is 1 where a case cannot be carried.
    """
    from ..study import export
    from ..study import loads as study

    inputs: list[str | Path] = [file, *([] if cases is None else [cases])]
    model = load(file)
    described = {} if cases is None else study.read(cases)
    named = described.get("cases", study.standard_cases(model.suspension.vehicle.sign))
    shown = among(case, [*named], "--case") if case else None
    suffixes = [f"_{name}" for name in shown or named]
    outputs = Outputs.of(out, None, force=force, inputs=inputs)
    pages = Outputs.of(None, plot, force=force, inputs=inputs, suffixes=suffixes)
    found = study.static(model, named, static_load=described.get("static_load_N"))
    parts = among(part, [*dict.fromkeys(found["part"].values)], "--part") if part else None
    written = outputs.write_data(found, rows=study.table(found))
    if pages.pages:
        from ..plots import loads as plots

        for name in shown or [str(name) for name in found["case"].values]:
            if not str(found["reason"].sel(case=name).values):
                written += plots.write_free_bodies(
                    found, pages.pages, name, parts, title=file, force=force, inputs=inputs
                )
    if json:
        print_json(export.as_dict(found))
    else:
        for name in shown or ():
            console.print(_components(found, name, parts, file))
        if envelope:
            console.print(_extremes(found, study.envelope(found), parts, file))
        elif not shown:
            console.print(_overview(found, parts, file))
        _tell(found)
        name_files(written)
    if found["reason"].values.any():
        raise typer.Exit(Exit.REFUSED)


def _tell(found: "Dataset") -> None:
    """Say what decided, and what could not be carried."""
    for name, reason in zip(found["case"].values, found["reason"].values, strict=True):
        if reason:
            say(f"{name}: {reason}")
    say(f"{found.attrs['message']}; {found.attrs['rules']}.")


def _overview(found: "Dataset", parts: list[str] | None, file: str) -> Table:
    """Return the size of every force in every case."""
    import numpy as np

    table = Table(title=escape(f"{file}: sizes of the forces [N]"))
    table.add_column("at")
    for name in found["case"].values:
        table.add_column(escape(str(name)), justify="right")
    table.add_row("wheel load", *(_cell(float(load)) for load in found["wheel_load"].values))
    travels = (f"{1e3 * travel:.1f}".replace("-0.0", "0.0") for travel in found["travel"].values)
    table.add_row(escape("wheel travel [mm]"), *(t.replace("nan", "-") for t in travels))
    table.add_section()
    sizes = np.linalg.norm(found["force"].values, axis=-1)
    for i in _rows(found, parts):
        point, by = str(found["point"].values[i]), str(found["by"].values[i])
        name = by if by in _ACTING else point
        table.add_row(escape(name), *(_cell(float(size)) for size in sizes[:, i]))
    return table


def _components(found: "Dataset", case: str, parts: list[str] | None, file: str) -> Table:
    """Return forces and moments of one case."""
    here = found.sel(case=case)
    table = Table(title=escape(f"{file}: loads in {case}, chassis axes"))
    table.add_column("on the part, at, by")
    for column in ("Fx [N]", "Fy", "Fz", "Mx [N m]", "My", "Mz"):
        table.add_column(escape(column), justify="right")
    for i in _rows(found, parts):
        numbers = (*here["force"].values[i], *here["moment"].values[i])
        table.add_row(escape(_label(found, i)), *(_cell(float(number)) for number in numbers))
    return table


def _extremes(found: "Dataset", ends: "Dataset", parts: list[str] | None, file: str) -> Table:
    """Return the least and the greatest of each component, with the cases in which they are."""
    table = Table(title=escape(f"{file}: extremes of the forces [N], chassis axes"))
    table.add_column("on the part, at, by")
    for column in ("Fx", "Fy", "Fz"):
        table.add_column(column, justify="right")
    for i in _rows(found, parts):
        cells = [
            "\n".join(
                f"{ends[f'force_{end}_case'].values[i, axis]} "
                f"{_cell(float(ends[f'force_{end}'].values[i, axis])):>7}"
                for end in ("min", "max")
            )
            for axis in range(3)
        ]
        table.add_row(escape(_label(found, i)), *map(escape, cells))
    return table


def _rows(found: "Dataset", parts: list[str] | None) -> list[int]:
    """Return the loads that are shown: of what two parts exert on each other one, if not asked."""
    import numpy as np

    given = [*found["part"].values]
    sizes = np.abs(found["force"].values) + np.abs(found["moment"].values)
    strong = np.nan_to_num(sizes).max(axis=(0, 2)) > 0.0
    if parts:
        return [i for i, name in enumerate(given) if name in parts and strong[i]]
    seen: set[frozenset[str]] = set()
    rows = []
    for i, (name, point, by) in enumerate(
        zip(given, found["point"].values, found["by"].values, strict=True)
    ):
        pair = frozenset((by,) if by in _ACTING else (f"{name} {point}", f"{by} {point}"))
        if strong[i] and pair not in seen and by != "gravity":
            rows.append(i)
            seen.add(pair)
    return rows


def _label(found: "Dataset", row: int) -> str:
    part, point, by = (str(found[name].values[row]) for name in ("part", "point", "by"))
    return f"{part}, {point}, {by}"


def _cell(value: float) -> str:
    """Return a force in whole newtons."""
    if not isfinite(value):
        return "-"
    return f"{round(value)}"
