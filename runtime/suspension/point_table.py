"""Hardpoints as a table of a spreadsheet: reading one into an input file, and writing one.

A table has a row for each point, with its name and three coordinates; the first row names the
columns, ``point, x [mm], y [mm], z [mm]``. CSV and Excel are read.
"""

import csv
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tomlkit

from ..core.arguments import Arguments
from ..core.csv_lines import cells_of, delimiter_of, lines_of
from ..core.errors import InputError
from ..core.files import Paths, reason, refuse, replacing
from ..core.optional import require
from ..core.suggestions import nearest
from .data import find
from .input.units import LengthUnit, in_metres
from .kinds import Suspension

ENDINGS = (".csv", ".xlsx")
"""What the name of a table ends in."""

_UNITS: dict[str, LengthUnit] = {"mm": "mm", "m": "m"}
_NAMES = ("point", "name", "hardpoint")
_HEADING = re.compile(r"([^\[\]()]+?)\s*(?:[\[(]\s*(\w*)\s*[\])])?")

Row = tuple[int, list[Any]]


@dataclass(frozen=True)
class PointTable:
    """What a table has.

    Attributes
    ----------
    source : str
        Where it comes from.
    unit : {'mm', 'm'}
    points : dict
        By names as they stand in the table, three coordinates in that unit.
    """

    source: str
    unit: LengthUnit
    points: dict[str, tuple[float, float, float]]


@dataclass(frozen=True)
class Merged:
    """An input file into which a table was read.

    Attributes
    ----------
    text : str
        The new file, with the comments of the old one.
    read : dict of str to str
        Hardpoints that come from the table, with what they are called there.
    kept : tuple of str
        Hardpoints that are as in the old file.
    left_out : tuple of str
        Rows of the table that are no hardpoints.
    """

    text: str
    read: dict[str, str]
    kept: tuple[str, ...]
    left_out: tuple[str, ...]


def read_points(path: str | Path) -> PointTable:
    """Read a table of hardpoints.

    Parameters
    ----------
    path : str or pathlib.Path
        A file ``.csv`` (commas, semicolons or tabs) or ``.xlsx`` (its first sheet).

    Returns
    -------
    PointTable

    Raises
    ------
    InputError
        If it cannot be read; with the rows that are wrong.
    MissingPackageError
        If the package for Excel is not installed.
    """
    with Arguments("read_points") as given:
        given.path("path", path)
    file = Path(path)
    if file.suffix.lower() not in ENDINGS:
        problem = f"a table of hardpoints ends in {' or '.join(ENDINGS)}."
        raise InputError([problem], str(path))
    rows = _rows_of_excel(file) if file.suffix.lower() == ".xlsx" else _rows_of_csv(file)
    if not rows:
        raise InputError(["the table is empty: the first row names the columns."], str(path))
    (_, heading), *others = rows
    columns, unit = _columns(heading, str(path))
    points: dict[str, tuple[float, float, float]] = {}
    problems = []
    for number, cells in others:
        name, *values = (cells[i] if i < len(cells) else "" for i in columns)
        numbers = tuple(map(_number, values))
        if not str(name or "").strip():
            continue
        if not all(map(math.isfinite, numbers)):
            shown = ", ".join(repr(value) for value in values)
            problems.append(f"row {number}, {name}: three numbers are needed, not {shown}.")
        elif str(name).strip() in points:
            problems.append(f"row {number}: {name} is there twice. Keep one of them.")
        else:
            points[str(name).strip()] = (numbers[0], numbers[1], numbers[2])
    if not points and not problems:
        problems.append("there are no points below the names of the columns.")
    if problems:
        raise InputError(problems, str(path))
    return PointTable(str(path), unit, points)


def merged(table: PointTable, file: str | Path, *, mirrored: bool = False) -> Merged:
    """Return an input file with the hardpoints of a table.

    Parameters
    ----------
    table : PointTable
    file : str or pathlib.Path
        The file whose points are replaced; or the name of a packaged data set.
    mirrored : bool, optional
        Whether the table is of the other side of the car.

    Returns
    -------
    Merged

    Raises
    ------
    InputError
        If no suspension can be like this, or no row is a hardpoint.
    """
    with Arguments("merged") as given:
        given.kind("table", table, PointTable, "what read_points returns is needed")
        given.flag("mirrored", mirrored)
    old = Suspension.load(file)
    known = [*type(old.hardpoints).names(), *old.hardpoints.STAND_INS]
    read: dict[str, str] = {}
    left_out = []
    for name in table.points:
        plain = re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_")
        if plain in known and plain not in read:
            read[plain] = name
        else:
            left_out.append(name)
    if not read:
        hints = {n: nearest(n, known) for n in left_out}
        near = ", ".join(f"{n} (is it {hint}?)" for n, hint in hints.items() if hint)
        problem = (
            f"none of its rows is a hardpoint of a {old.TITLE}: {near or ', '.join(left_out)}. "
            f"Known are: {', '.join(known)}."
        )
        raise InputError([problem], table.source)
    document = tomlkit.parse(find(file).read_text(encoding="utf-8-sig"))
    put_points(
        document,
        {
            key: (x, -y if mirrored else y, z)
            for key, (x, y, z) in ((key, table.points[name]) for key, name in read.items())
        },
        table.unit,
    )
    if not mirrored:
        _refuse_other_side(old, document["hardpoints"], read, table.source)
    text = tomlkit.dumps(document)
    source = f"{file} with the points of {table.source}"
    Suspension.from_dict(tomlkit.parse(text).unwrap(), source=source)
    kept = tuple(name for name in old.hardpoints.given() if name not in read)
    return Merged(text, read, kept, tuple(left_out))


def put_points(document: Any, points: Mapping[str, Iterable[float]], unit: LengthUnit) -> None:
    """Put hardpoints into the text of an input file, in the unit that it has.

    Parameters
    ----------
    document : tomlkit.TOMLDocument
        Is changed; its comments stay.
    points : mapping
        By name three coordinates.
    unit : {'mm', 'm'}
        Of these.
    """
    section = document["hardpoints"]
    scale = _scale(unit, section["unit"])
    for name, point in points.items():
        # the sum makes no zero negative
        section[name] = [scale * value + 0.0 for value in point]


def _refuse_other_side(old: Suspension, section: Any, read: Iterable[str], source: str) -> None:
    """Refuse points that are all on the other side of the car."""
    moved = [(float(section[name][1]), float(getattr(old.hardpoints, name)[1])) for name in read
             if getattr(old.hardpoints, name) is not None]  # fmt: skip
    if moved and all(new * before < 0.0 for new, before in moved):
        problem = (
            f"all of its points are on the other side of the car, and the file is of the "
            f"{old.vehicle.side} side. Mirror them: --mirror (mirrored=True)."
        )
        raise InputError([problem], source)


def write_merged(
    found: Merged, path: str | Path, *, force: bool = False, inputs: Paths = ()
) -> Path:
    """Write an input file into which a table was read; see `merged`."""
    with Arguments("write_merged") as given:
        given.kind("found", found, Merged, "what merged returns is needed")
    refuse([path], force=force, inputs=inputs, endings=[".toml"])
    with replacing(path, force=force, inputs=inputs) as temporary:
        temporary.write_text(found.text, encoding="utf-8", newline="\n")
    return Path(path)


def write_points(
    suspension: Suspension, path: str | Path, *, force: bool = False, inputs: Paths = ()
) -> Path:
    """Write the hardpoints of a suspension as a table, which `read_points` reads.

    Parameters
    ----------
    suspension : Suspension
    path : str or pathlib.Path
        A name that ends in ``.csv``.
    force : bool, optional
        Whether a file that somebody else wrote is replaced, see `kintrafo.core.files`.
    inputs : iterable of str or pathlib.Path, optional
        Files that are never replaced.

    Returns
    -------
    pathlib.Path

    Raises
    ------
    InputError
        If the file must not or cannot be written.
    """
    with Arguments("write_points") as given:
        given.kind("suspension", suspension, Suspension, "a kintrafo.Suspension is needed")
    refuse([path], force=force, inputs=inputs, endings=[".csv"])
    points = suspension.hardpoints
    with (
        replacing(path, force=force, inputs=inputs) as temporary,
        temporary.open("w", encoding="utf-8", newline="") as opened,
    ):
        writer = csv.writer(opened, lineterminator="\n")
        writer.writerow(["point", *(f"{axis} [{points.unit}]" for axis in "xyz")])
        writer.writerows([name, *getattr(points, name)] for name in points.given())
    return Path(path)


def _scale(given: LengthUnit, wanted: LengthUnit) -> float:
    """Return what a length in one unit is multiplied with for the other."""
    if given == wanted:
        return 1.0
    return 1000.0 if wanted == "mm" else in_metres(1.0, "mm")


def _columns(heading: Sequence[Any], source: str) -> tuple[list[int], LengthUnit]:
    """Return which columns have name, x, y and z, and their unit."""
    matches = [_HEADING.fullmatch(str(cell or "").strip()) for cell in heading]
    words = [(m[1].lower(), m[2] or "") if m else ("", "") for m in matches]
    names = [i for i, (word, _) in enumerate(words) if word in _NAMES]
    axes = [[i for i, (word, _) in enumerate(words) if word == axis] for axis in "xyz"]
    problems = []
    if len(names) != 1:
        problems.append(f"one column with the names is needed, called {' or '.join(_NAMES)}.")
    problems += [
        f"one column {axis} is needed, with its unit: {axis} [mm]."
        for axis, found in zip("xyz", axes, strict=True)
        if len(found) != 1
    ]
    units = {words[i][1] for found in axes for i in found}
    if not problems and (len(units) != 1 or not units <= _UNITS.keys()):
        told = ", ".join(sorted(unit or "none" for unit in units))
        problems.append(f"the unit of x, y and z must be mm or m, of all the same; it is {told}.")
    if problems:
        found = ", ".join(str(cell) for cell in heading if cell is not None)
        raise InputError([*problems, f"the first row is: {found}."], source)
    return [names[0], *(found[0] for found in axes)], _UNITS[units.pop()]


def _number(cell: Any) -> float:
    """Return the number in a cell; NaN where there is none."""
    if isinstance(cell, bool):
        return math.nan
    if isinstance(cell, int | float):
        return float(cell)
    text = str(cell or "").strip()
    try:
        return math.nan if "_" in text else float(text)
    except ValueError:
        return math.nan


def _rows_of_csv(file: Path) -> list[Row]:
    lines = lines_of(file)
    delimiter = delimiter_of(lines[0][1]) if lines else ","
    # where commas do not separate, they are those of decimals
    plain = str if delimiter == "," else _with_point
    return [(n, [plain(cell) for cell in cells_of(line, delimiter)]) for n, line in lines]


def _with_point(cell: str) -> str:
    """Return a number with a decimal comma as one with a point; other texts as they are."""
    return cell.replace(",", ".") if re.fullmatch(r"\s*[-+]?\d+,\d+\s*", cell) else cell


def _rows_of_excel(file: Path) -> list[Row]:
    require("openpyxl", purpose="Reading Excel files", extra="excel")
    from openpyxl import load_workbook  # noqa: PLC0415 (an extra)

    try:
        book = load_workbook(file, read_only=True, data_only=True)
        try:
            sheet: Iterable[Sequence[Any]] = book.worksheets[0].iter_rows(values_only=True)
            rows: list[Row] = [(n, list(cells)) for n, cells in enumerate(sheet, 1)]
        finally:
            book.close()
    except OSError as error:
        problem = f"the file cannot be read: {reason(error)}"
        raise InputError([problem], str(file)) from None
    except Exception:  # noqa: BLE001 (whatever a damaged workbook makes of its reader)
        problem = "the file is no Excel workbook that can be read. Save it as .xlsx or .csv."
        raise InputError([problem], str(file)) from None
    return [(n, cells) for n, cells in rows if any(cell is not None for cell in cells)]


def as_words(found: Merged) -> Mapping[str, str]:
    """Return what was read, kept and left out, in words."""
    with Arguments("as_words") as given:
        given.kind("found", found, Merged, "what merged returns is needed")
    read = (n if n == called else f"{n} (from {called})" for n, called in found.read.items())
    said = {
        "read": ", ".join(read),
        "as in the file": ", ".join(found.kept),
        "no hardpoints": ", ".join(found.left_out),
    }
    return {head: text for head, text in said.items() if text}
