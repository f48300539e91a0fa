"""Tables of hardpoints of any program: their columns and sides.

Above the names of the columns there may be a title and a unit. There may be two sets of columns x,
y and z, below ``Left`` and ``Right``, as OptimumK writes them. A text of Lotus Suspension Analysis
has its points after their coordinates.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ...core.errors import InputError
from ...core.excel import Page, pages_of
from ...core.legible import legible, short
from ...core.reading import MOST_OF_DATA, text_of
from ...core.suggestions import suggestion
from ...core.tables import ColumnHeading, Row, Table, csv_rows, key
from ...core.units import LENGTHS, unit_of
from ..models.sides import SIDES
from .vehicle_axes import ISO, REARWARD

AXES = ("x", "y", "z")

_NAMES = (
    "point", "name", "hardpoint", "point name", "hardpoint name", "feature", "feature name",
    "label", "joint",
)  # fmt: skip
_KEYS = {key(name): "point" for name in _NAMES} | {axis: axis for axis in AXES}
_LOOKED_AT = 50  # first rows in which the names of the columns are searched
_UNITS_ABOVE = {key(name) for name in ("unit", "units", "length", "length unit", "length units")}
_NUMBER = r"([-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?)"
_LOTUS = re.compile(
    rf"\s*{_NUMBER}\s+{_NUMBER}\s+{_NUMBER}\s+POINT\s*(?:\(\s*(\d+)\s*\)\s*=|:\s*(\d+)\b)(.*)"
)
_NAME_OF_LOTUS = re.compile(r"\bPOINT\s*(?:\(\s*\d+\s*\)|:\s*\d+)")
_UNITS_OF_LOTUS = re.compile(r"\s*\((\w+)\)\s+\(\1\)\s+\(\1\)\s*")


class NamedColumns(NamedTuple):
    """A table with the places of its columns."""

    table: Table
    name: int  # column with the names
    # columns of x, y and z by side; '' if there is only one
    coordinates: Mapping[str, tuple[int, int, int]]
    above: tuple[str, ...] = ()  # units above the table
    axes: str = ISO  # directions of x, y and z in files of its program
    left_out: tuple[str, ...] = ()  # unread sheets and columns


def found_in(file: Path, sheet: str | None) -> NamedColumns:
    """Return the table of hardpoints of a file; refuse a file with none, or more than one."""
    if file.suffix.lower() == ".xlsx":
        return _of_workbook(file, pages_of(file), sheet)
    if sheet is not None:
        problem = f"a sheet {sheet!r} is for workbooks (.xlsx): this file has none. Leave it out."
        raise InputError([problem], str(file))
    lotus = _of_lotus(file)
    if lotus is not None:
        return lotus
    rows, comments, commas = csv_rows(file, MOST_OF_DATA)
    if not rows:
        raise InputError(["the table is empty: the first row names the columns."], str(file))
    found = _of_rows(str(file), rows, comments, commas=commas)
    _refuse_further_values(found.table)
    return found


def _refuse_further_values(table: Table) -> None:
    """Refuse rows with values beyond the last column: a decimal comma may separate columns."""
    count = len(table.headings)
    problems = [
        f"row {number} has {len(cells)} values, and there are {count} columns. Separate columns by "
        "semicolons if numbers have decimal commas, and give a column of remarks a name."
        for number, cells in table.rows
        if any(cells[count:])
    ]
    if problems:
        raise InputError(problems, table.source)


def _of_workbook(file: Path, pages: Sequence[Page], wanted: str | None) -> NamedColumns:
    """Return the table of a requested sheet, or of the only one with a table of hardpoints."""
    names = [page.name for page in pages]
    if wanted is not None and wanted not in names:
        raise InputError([f"there is no sheet {wanted!r}. {suggestion(wanted, names)}"], str(file))
    filled = [page for page in pages if page.rows and not page.hidden]
    having = [page for page in filled if _heading(page.rows) is not None]
    if wanted is not None:
        having = [page for page in pages if page.name == wanted]
    if len(having) > 1:
        text = " and ".join(repr(page.name) for page in having)
        problem = f"there are hardpoints on the sheets {text}. Choose one: --sheet (sheet=)."
        raise InputError([problem], str(file))
    page = next(iter(having or filled), None)
    if page is None or not page.rows:
        raise InputError(["the table is empty: the first row names the columns."], str(file))
    remarks = [row for row in page.rows if str(_first(row)).startswith("#")]
    comments = [(number, [str(_first((number, cells))).lstrip("#")]) for number, cells in remarks]
    rows = [row for row in page.rows if row not in remarks]
    found = _of_rows(str(file), rows, comments, commas=False)
    others = tuple(f"sheet {page_name}" for page_name in names if page_name != page.name)
    return found._replace(left_out=(*found.left_out, *others))


def _first(row: Row) -> Any:
    """Return the only cell of a row that is not empty, or an empty text if there are several."""
    filled = [cell for cell in row[1] if cell is not None]
    return filled[0] if len(filled) == 1 else ""


def _heading(rows: Sequence[Row]) -> int | None:
    """Return the index of the row with the names x, y and z, or None."""
    for index, (_, cells) in enumerate(rows[:_LOOKED_AT]):
        there = {name for name, _ in map(_among, cells)}
        if there.issuperset(AXES):
            return index
    return None


def _among(cell: Any) -> tuple[str, str | None]:
    """Return the name of a column in its heading, and its unit."""
    found = ColumnHeading.of(cell).among(_KEYS) if isinstance(cell, str) else None
    return found or ("", None)


def _of_rows(
    source: str, rows: Sequence[Row], comments: Iterable[Row], *, commas: bool
) -> NamedColumns:
    at = _heading(rows) or 0
    number, heading = rows[at][0], [*rows[at][1]]
    over = [*rows[at - 1][1]] if at else []
    heading += [None] * (len(over) - len(heading))
    # a column without a name in the row of headings may have one above
    named = [
        over[i] if cell in (None, "") and i < len(over) and _among(over[i])[0] else cell
        for i, cell in enumerate(heading)
    ]
    table = Table.of(source, [(number, named), *rows[at + 1 :]], comments, commas=commas)
    names = [i for i, cell in enumerate(named) if _among(cell)[0] == "point"]
    sides = _sides(over, len(named))
    columns: dict[str, list[list[int]]] = {}
    for i, cell in enumerate(named):
        if (axis := _among(cell)[0]) in AXES:
            columns.setdefault(sides[i], [[], [], []])[AXES.index(axis)].append(i)
    _check(source, named, names, columns)
    coordinates = {side: (x[0], y[0], z[0]) for side, (x, y, z) in columns.items()}
    read = {names[0], *(i for found in coordinates.values() for i in found)}
    left_out = [f"column {short(h.text)}" for i, h in enumerate(table.headings)
                if i not in read and h.text]  # fmt: skip
    return NamedColumns(
        table, names[0], coordinates, tuple(_units_above(rows[:at])), left_out=tuple(left_out)
    )


def _sides(over: Sequence[Any], count: int) -> list[str]:
    """Return the side above each column, 'left' or 'right'; empty if there is none."""
    sides, side = [], ""
    for i in range(count):
        word = str(over[i]).strip().lower() if i < len(over) else ""
        side = word if word in SIDES else side
        sides.append(side)
    return sides


def _check(
    source: str,
    heading: Sequence[Any],
    names: Sequence[int],
    columns: Mapping[str, Sequence[Sequence[int]]],
) -> None:
    """Refuse missing or repeated columns."""
    problems = []
    if len(names) != 1:
        problems.append(f"one column with the names is needed, called {' or '.join(_NAMES[:3])}.")
    problems += [
        f"one column {axis} is needed{side and f' below {side}'}, with its unit: {axis} [mm]."
        for side, found in (columns or {"": [[], [], []]}).items()
        for axis, those in zip(AXES, found, strict=True)
        if len(those) != 1
    ]
    if "" in columns and len(columns) > 1:
        problems.append("columns x, y and z below no side are beside those of a side. Keep one.")
    if problems:
        text = legible(", ".join(str(cell) for cell in heading if cell is not None))
        raise InputError([*problems, f"the first row is: {short(text, 500)}."], source)


def _units_above(rows: Sequence[Row]) -> Iterable[str]:
    """Yield the units of length above the names of the columns."""
    for _, cells in rows:
        texts = [str(cell) for cell in cells if cell is not None]
        for at, text in enumerate(texts[:-1]):
            if key(text.rstrip(":")) in _UNITS_ABOVE:
                yield from [
                    unit for words in texts[at + 1 :] if (unit := unit_of(words)) in LENGTHS
                ]


def _of_lotus(file: Path) -> NamedColumns | None:
    """Return the points of a text of Lotus Suspension Analysis; None for another text."""
    lines = text_of(file).splitlines()
    rows: list[Row] = []
    problems = []
    for number, line in enumerate(lines, 1):
        found = _LOTUS.fullmatch(line[:500])
        if found is None and _NAME_OF_LOTUS.search(line[:500]):
            problems.append(f"line {number}: three numbers are needed before POINT.")
        if found:
            name = found[6].strip() or f"POINT {found[4] or found[5]}"
            rows.append((number, [name, *found.group(1, 2, 3)]))
    if not rows:
        return None
    if problems:
        raise InputError(problems, str(file))
    units = [
        unit_of(found[1]) for line in lines if (found := _UNITS_OF_LOTUS.fullmatch(line[:100]))
    ]
    table = Table.of(str(file), [(0, ["point", *AXES]), *rows], commas=False)
    return NamedColumns(
        table,
        0,
        {"": (1, 2, 3)},
        tuple(unit for unit in units if unit in LENGTHS),
        REARWARD,
        (f"{len(lines) - len(rows)} lines without a point",),
    )
