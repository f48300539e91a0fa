"""``kintrafo loads``: the forces on every part in load cases."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from ...core.errors import InputError
from ...core.tabulated import whole
from ...terminal.console import console, print_json, print_table, problems, say, table
from ...terminal.exits import Exit
from .loading import assembly_of_file, of_cases
from .options import OUTPUT, File, among, option
from .outputs import Outputs, SingleFigureOptions, name_files, title_of

if TYPE_CHECKING:
    from rich.table import Table
    from xarray import Dataset

EXAMPLES = (
    "kintrafo loads reference_car",
    "kintrafo loads my_car.toml --cases cases.toml -o loads.csv",
    "kintrafo loads my_car.toml --out loads.xlsx",
    "kintrafo loads my_car.toml --part knuckle,chassis -o loads.bdf",
    "kintrafo loads my_car.toml -o loads.inp --units m --axes-of vehicle",
    "kintrafo loads my_car.toml --case brake,corner --part knuckle --plot knuckle.pdf",
    "kintrafo loads reference_axle --case corner",
    "kintrafo loads rigid_axle --case brake --part beam --plot beam.png",
)


@dataclass(frozen=True)
class LoadOptions(SingleFigureOptions):
    """The options of data files and load cards."""

    out: Annotated[
        list[Path] | None,
        option(
            "Write the data: .csv or .xlsx (mm), .nc, .parquet or .mat (SI); or load cards, a file "
            "for each part: .bdf (Nastran), .inp (Abaqus). May be repeated.",
            "PATH",
            "--out",
            "-o",
            panel=OUTPUT,
        ),
    ] = None
    axes: Annotated[
        Literal["vehicle", "part"] | None,
        option(
            "Axes of the data and cards: those of the vehicle, or of each part, fixed in it and "
            "parallel to those of the vehicle at design. Default: vehicle for data, part for "
            "cards.",
            None,
            "--axes-of",
            panel=OUTPUT,
        ),
    ] = None
    units: Annotated[
        str | None,
        option("Of the cards: mm (N, N mm) or m (N, N m). Default: mm.", "NAME", panel=OUTPUT),
    ] = None

    def split(self) -> "tuple[LoadOptions, list[Path]]":
        """Return the options of data alone, and the files of cards; refuse unused options."""
        from ..analysis.loads.cards import ENDINGS
        from ..analysis.loads.cards.sheet import LENGTHS

        every = self.out or []
        cards = [path for path in every if path.suffix.lower() in ENDINGS]
        problem = ""
        if self.axes is not None:
            problem = "" if every else "--axes-of is for files of data or cards: give one by --out"
        if self.units is not None:
            among([self.units], LENGTHS, "--units")
            problem = "" if cards else "--units is for load cards: --out loads.bdf or loads.inp"
        if problem:
            raise typer.BadParameter(problem)
        return replace(self, out=[path for path in every if path not in cards] or None), cards


def command(
    file: File,
    *,
    cases: Annotated[
        Path | None, option("TOML of load cases. Default: the standard cases.", "PATH")
    ] = None,
    case: Annotated[list[str] | None, option("Show these cases by components.", "NAME,...")] = None,
    part: Annotated[
        list[str] | None,
        option(
            "Show loads on these parts: knuckle, chassis, knuckle_left of an axle, beam of a rigid "
            "one; total has the sums at the mounts.",
            "NAME,...",
        ),
    ] = None,
    envelope: Annotated[
        bool, option("Show the extremes of every component, and their cases.")
    ] = False,
    output: LoadOptions,
) -> None:
    """Print forces and moments on every part at its hardpoints, in static load cases.

    An axle has the loads of both sides, of the anti-roll bar and of the rack; a rigid axle those
    of its rods, springs, dampers and wheels.
    The table has the magnitude of each force; --case shows components. Data files have everything;
    load cards have a file for each part, or for those of --part.
    The figure has the free bodies of the parts, in a file for each case. The exit code is 1 if a
    case of --cases or --case has no equilibrium; without these options, if no standard case has
    one.
    """
    from ...datasets import export
    from ..analysis import loads as study
    from ..analysis.loads.mounts import ALL, with_totals
    from ..analysis.loads.sheets import overview
    from ..assembly.by_wheel import flat

    assembly = assembly_of_file(file, "loads")
    described = {} if cases is None else study.read(cases)
    named = described["cases"] if "cases" in described else study.standard_cases(assembly)
    shown = among(case, [*named], "--case") if case else None
    data, cards = output.split()
    outputs = data.files(file, cases, drawn=[f"_{name}" for name in shown or named])
    with problems.status("loads"), of_cases(cases):
        found = study.static(assembly, named, static_load=described.get("static_load_N"))
    parts = among(part, dict.fromkeys(with_totals(found)["part"].values), "--part") if part else []
    bodies = [name for name in parts if name != ALL]
    if outputs.pages and parts and not bodies:
        problem = f"{ALL} is not a part that can be drawn. Name one, or leave --plot out."
        raise InputError([problem], "--part")
    axes = output.axes or "vehicle"
    written = _write_cards(found, cards, bodies, output, outputs, file)
    rows, sheets = study.table(found, axes), study.workbook(found, axes)
    written += outputs.write_data(found, rows=rows, sheets=sheets)
    if outputs.pages:
        drawn = shown or [str(name) for name in found["case"].values]
        written += _draw(found, drawn, bodies, outputs, file)
    if output.json:
        print_json(export.as_dict(flat(found)))
    else:
        with_sums = with_totals(found, several=ALL not in parts)
        for name in shown or ():
            console.print(_components(with_sums, name, parts, file))
        if envelope:
            console.print(_extremes(with_sums, study.envelope(with_sums), parts, file))
        elif not shown:
            print_table(overview(found, f"{file}: magnitudes of the forces [N]", parts))
        _print_rest(found)
        name_files(written)
    if not _did_what_was_asked(found, [*described.get("cases", shown or ())]):
        raise typer.Exit(Exit.REFUSED)


def _write_cards(
    found: "Dataset",
    paths: list[Path],
    parts: list[str],
    options: LoadOptions,
    outputs: Outputs,
    file: str,
) -> list[Path]:
    """Write the load cards, a file for each part, and return the files."""
    from ..analysis import loads as study

    how: Any = {"axes": options.axes or "part", "length": options.units or "mm", **outputs.rule}
    source = title_of(file)
    each = (study.write_cards(found, path, parts or None, source=source, **how) for path in paths)
    return [path for files in each for path in files]


def _draw(
    found: "Dataset", cases: list[str], parts: list[str], outputs: Outputs, file: str
) -> list[Path]:
    """Draw the free bodies in cases with an equilibrium, and return the files."""
    from ..plots.loads import write_free_bodies

    still = [name for name in cases if not str(found["reason"].sel(case=name).values)]
    each = (
        outputs.draw(write_free_bodies, found, name, parts, title=title_of(file), suffix=f"_{name}")
        for name in still
    )
    return [path for files in each for path in files]


def _did_what_was_asked(found: "Dataset", asked: list[str]) -> bool:
    """Return whether all wanted cases have an equilibrium; or any of the standard ones."""
    if asked:
        return not found["reason"].sel(case=asked).values.any()
    return not all(found["reason"].values)


def _print_rest(found: "Dataset") -> None:
    """Print cases without equilibrium, and the rules of the others."""
    for name, reason in zip(found["case"].values, found["reason"].values, strict=True):
        if reason:
            say(f"{name}: {reason}")
    say("; ".join(filter(None, (found.attrs["message"], found.attrs["rules"]))) + ".")


def _components(found: "Dataset", case: str, parts: list[str], file: str) -> "Table":
    """Return the table of forces and moments in one case."""
    from ..analysis.loads.sheets import shown_rows

    here = found.sel(case=case)
    rows = [
        (
            _label(found, i),
            *(whole(float(v)) for v in (*here["force"].values[i], *here["moment"].values[i])),
        )
        for i in shown_rows(found, parts)
    ]
    columns = ("on the part, at, by", "Fx [N]", "Fy", "Fz", "Mx [N m]", "My", "Mz")
    return table(f"{file}: loads in {case}, chassis axes", columns, rows)


def _extremes(found: "Dataset", ends: "Dataset", parts: list[str], file: str) -> "Table":
    """Return the table of least and greatest components, with their cases."""
    from ..analysis.loads.sheets import shown_rows

    def cell(row: int, axis: int) -> str:
        return "\n".join(
            f"{ends[f'force_{end}_case'].values[row, axis]} "
            f"{whole(float(ends[f'force_{end}'].values[row, axis])):>7}"
            for end in ("min", "max")
        )

    title = f"{file}: extremes of the forces [N], chassis axes"
    rows = ((_label(found, i), *(cell(i, axis) for axis in range(3)))
            for i in shown_rows(found, parts))  # fmt: skip
    return table(title, ("on the part, at, by", "Fx", "Fy", "Fz"), rows)


def _label(found: "Dataset", row: int) -> str:
    part, point, by = (str(found[name].values[row]) for name in ("part", "point", "by"))
    return f"{part}, {point}, {by}"
