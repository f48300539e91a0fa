"""Hardpoints as a table of a spreadsheet: reading one into an input file, and writing one.

A table has a row for each point, with its name and three coordinates; the first row names the
columns, ``point, x [mm], y [mm], z [mm]``. CSV, Excel and the texts of some programs are read.
"""

import csv
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import tomlkit

from ...core.errors import InputError
from ...core.files import Paths, refuse, replacing, write_text
from ...core.legible import legible, short
from ...core.suggestions import nearest
from ...core.tables import key
from ...core.units import LENGTHS, in_si, length_in, unit_of
from ...core.validator import Validator
from ..data import find
from ..kinds import Suspension
from ..models.sides import SIDES
from .point_names import known, listed, matched
from .point_rows import AXES, NamedColumns, found_in
from .vehicle_axes import axes_of

ENDINGS = (".csv", ".tsv", ".txt", ".xlsx")
"""The endings of the names of tables."""

_OTHER_PROGRAMS = (
    "Save it as one of them. Of OptimumK its Excel export is read, and of Lotus Suspension "
    "Analysis (.shk) the text with its points. Of Adams/Car: kintrafo import."
)
_MOST_POINTS = 10_000
_MOST_HINTS = 20

Point = tuple[float, float, float]


@dataclass(frozen=True)
class PointTable:
    """Contents of a table of hardpoints.

    Attributes
    ----------
    source : str
        The file.
    unit : str
        A unit of length: mm, m, in and so on.
    points : dict
        Coordinates in this unit and in axes of ISO 8855 (x forward, y left, z up), by the names in
        the table; of the left side, if the table has both.
    right : dict, optional
        Those of the right side, if the table has both.
    axes : str
        Directions of x, y and z in the table.
    left_out : tuple of str
        Unread columns and sheets.
    """

    source: str
    unit: str
    points: dict[str, Point]
    right: dict[str, Point] | None = None
    axes: str = "forward left up"
    left_out: tuple[str, ...] = ()


@dataclass(frozen=True)
class Merged:
    """An input file into which a table was read.

    Attributes
    ----------
    text : str
        The new file, with the comments of the old one.
    read : dict of str to str
        The hardpoints that come from the table: their names in it, by those of kintrafo.
    kept : tuple of str
        Hardpoints that are not in the table, and have the values of the old file.
    left_out : tuple of str
        Rows of the table that are not hardpoints.
    missing : tuple of str
        The required ones of `kept`.
    """

    text: str
    read: dict[str, str]
    kept: tuple[str, ...]
    left_out: tuple[str, ...]
    missing: tuple[str, ...] = field(default=(), kw_only=True)


def read_points(
    path: str | Path,
    *,
    unit: str | None = None,
    axes: str | None = None,
    left_handed: bool = False,
    sheet: str | None = None,
) -> PointTable:
    """Return the contents of a table of hardpoints.

    The unit of x, y and z is in the first row, in a row of units or a comment line
    (`kintrafo.core.tables`), or above the table. A table may have coordinates of both sides, below
    ``Left`` and ``Right``. The points of a text of Lotus Suspension Analysis are read, too.

    Parameters
    ----------
    path : str or pathlib.Path
        A file ``.csv``, ``.tsv`` or ``.txt`` (commas, semicolons or tabs), or ``.xlsx``.
    unit : str, optional
        The unit of a table without one: mm, cm, m, in or ft.
    axes : str, optional
        Directions of x, y and z: ``"rearward right up"``. By default those of ISO 8855, forward
        left up; in a text of Lotus Suspension Analysis rearward right up.
    left_handed : bool, optional
        Whether these axes are left-handed.
    sheet : str, optional
        The sheet of a workbook; by default the only one with hardpoints that is not hidden.

    Returns
    -------
    PointTable

    Raises
    ------
    InputError
        If it cannot be read; with all wrong rows.
    MissingPackageError
        If the package for Excel is not installed.
    """
    with Validator("read_points") as given:
        given.path("path", path)
        for name, text in {"unit": unit, "axes": axes, "sheet": sheet}.items():
            if text is not None:
                given.text(name, text)
        given.flag("left_handed", left_handed)
    file = Path(path)
    if file.suffix.lower() not in ENDINGS:
        problem = f"a table of hardpoints ends in {' or '.join(ENDINGS)}. {_OTHER_PROGRAMS}"
        raise InputError([problem], str(path))
    found = found_in(file, sheet)
    turned = axes_of(found.axes if axes is None else axes, left_handed=left_handed)
    length = _unit(found, unit)
    sides = {
        side: {name: turned.point(place) for name, place in _points(found, columns).items()}
        for side, columns in found.coordinates.items()
    }
    first = next(iter(sides)) if SIDES[0] not in sides else SIDES[0]
    right = sides.get(SIDES[1]) if first != SIDES[1] else None
    return PointTable(str(path), length, sides[first], right, turned.words, found.left_out)


def _unit(found: NamedColumns, given: str | None) -> str:
    """Return the common unit of x, y and z; refuse several, or none."""
    table = found.table
    read = {index for columns in found.coordinates.values() for index in columns}
    columns = [column for column in table.columns(AXES) if column.at in read]
    stated = [text for text in (*table.stated, *found.above) if in_si(text)[0] == "m"]
    every = {unit_of(text) or text for text in [*(c.unit for c in columns), *stated] if text}
    if not (stated or given) and len({column.unit is None for column in columns}) == 2:
        every.add("none")
    lengths = [column for column in columns if in_si(column.unit or "")[0] == "m"]
    problems = [problem for c in lengths if (problem := table.unit_problem(c, "m"))]
    wanted = None if given is None else unit_of(given)
    if given is not None and wanted not in LENGTHS:
        problems.append(f"unit {given!r} is not a length. There are {', '.join(LENGTHS)}.")
    elif wanted and every - {wanted}:
        problems.append(f"the unit of the table is {', '.join(sorted(every))}, and not {wanted}.")
    elif not (every or wanted):
        problems.append(
            f"x, y and z have no unit; {', '.join(LENGTHS)} can be read. Write x [mm], or give it: "
            "--unit mm (unit=)."
        )
    elif not every <= LENGTHS.keys() or (len(every) > 1 and not problems):
        words = short(", ".join(sorted(every)))
        problems.append(
            f"the unit of x, y and z must be {', '.join(LENGTHS)}, the same for all; it is {words}."
        )
    if problems:
        raise InputError(problems, table.source)
    return wanted or every.pop()


def _points(found: NamedColumns, columns: Iterable[int]) -> dict[str, Point]:
    """Return the points of one side by name, in the axes of the table."""
    table, columns = found.table, [*columns]
    points: dict[str, Point] = {}
    spelt: dict[str, str] = {}
    problems = table.mixed_marks(columns)
    if len(table.rows) > _MOST_POINTS:
        problems.append(f"there are {len(table.rows)} rows; {_MOST_POINTS} are the most.")
    for number, cells in table.rows[:_MOST_POINTS]:
        name, *values = (cells[i] if i < len(cells) else None for i in (found.name, *columns))
        name = legible(str("" if name is None else name).strip())
        x, y, z = map(table.number, values)
        if not name:
            if any(value not in (None, "") for value in values):
                problems.append(f"row {number} has no name. Give it one, or leave the row out.")
        elif not all(map(math.isfinite, (x, y, z))):
            problems.append(f"row {number}, {short(name)}: {_no_point(values)}")
        elif key(name) in spelt:
            other = spelt[key(name)]
            same = "is" if other == name else f"and {short(other)} are the same point,"
            problems.append(f"row {number}: {short(name)} {same} given twice. Keep one of them.")
        else:
            points[name] = (x, y, z)
            spelt[key(name)] = name
    if not points and not problems:
        problems.append("there are no points below the names of the columns.")
    if problems:
        raise InputError(problems, table.source)
    return points


def _no_point(values: Iterable[Any]) -> str:
    text = ", ".join(repr("" if v is None else short(legible(str(v)), 30)) for v in values)
    formula = " A formula needs a value that Excel has saved." if None in [*values] else ""
    return f"three numbers are needed, not {text}.{formula}"


def merged(
    table: PointTable,
    file: str | Path,
    *,
    mirrored: bool = False,
    names: Mapping[str, str] | None = None,
) -> Merged:
    """Return the text of an input file with the hardpoints of a table.

    Parameters
    ----------
    table : PointTable
    file : str or pathlib.Path
        The file whose points are replaced; or the name of a packaged data set.
    mirrored : bool, optional
        Whether the table is of the other side of the car.
    names : mapping of str to str, optional
        Names of hardpoints in the table, by their names in kintrafo. Names of kintrafo, Adams/Car,
        OptimumK and Lotus Suspension Analysis are known.

    Returns
    -------
    Merged

    Raises
    ------
    InputError
        If the data are not valid, no row is a hardpoint, or a row is ambiguous.
    """
    with Validator("merged") as given:
        given.instance("table", table, PointTable, "a result of read_points is needed")
        given.flag("mirrored", mirrored)
        called = given.mapping("names", names or {}, "hardpoints and their names there")
    old = Suspension.load(file)
    points = _of_side(table, old.vehicle.side, mirrored=mirrored)
    read = matched(points, old.suspension, called, table.source)
    left_out = [name for name in points if name not in read.values()]
    required = old.hardpoints.names()
    if left_out and read.keys().isdisjoint(required):
        every = known(old.suspension)
        hints = {n: nearest(n, every) for n in left_out[:_MOST_HINTS]}
        near = ", ".join(f"{n} (is it {hint}?)" for n, hint in hints.items() if hint)
        problem = (
            f"none of its rows is a hardpoint that every {old.TITLE} has: "
            f"{near or listed(left_out)}. "
            f"Known are: {', '.join(every)}. Assign the names of the table: --name "
            f"{every[0]}={short(left_out[0])} (names=)."
        )
        raise InputError([problem], table.source)
    document = tomlkit.parse(find(file).read_text(encoding="utf-8-sig"))
    put_points(
        document,
        {
            key: (x, -y if mirrored else y, z)
            for key, (x, y, z) in ((key, points[name]) for key, name in read.items())
        },
        table.unit,
    )
    if not mirrored:
        _refuse_other_side(old, document["hardpoints"], read, table)
    text = tomlkit.dumps(document)
    source = (
        f"{file} with the points of {table.source} (unit {table.unit}; x, y, z: {table.axes}; "
        "other axes by --axes)"
    )
    Suspension.from_dict(tomlkit.parse(text).unwrap(), source=source)
    kept = tuple(name for name in old.hardpoints.given() if name not in read)
    missing = tuple(name for name in required if name not in read)
    return Merged(text, read, kept, tuple(left_out), missing=missing)


def _of_side(table: PointTable, side: str, *, mirrored: bool) -> dict[str, Point]:
    """Return the points of a side of the car."""
    if table.right is None:
        return table.points
    if mirrored:
        problem = "the table has both sides. Leave --mirror (mirrored=True) out."
        raise InputError([problem], table.source)
    return table.right if side == "right" else table.points


def put_points(document: Any, points: Mapping[str, Iterable[float]], unit: str) -> None:
    """Put hardpoints with a unit into the text of an input file, in the unit of the file."""
    section = document["hardpoints"]
    for name, point in points.items():
        # the sum avoids negative zeros
        section[name] = [length_in(value, unit, section["unit"]) + 0.0 for value in point]


def _refuse_other_side(
    old: Suspension, section: Any, read: Iterable[str], table: PointTable
) -> None:
    """Refuse points that are all on the other side of the car."""
    moved = [(float(section[name][1]), float(getattr(old.hardpoints, name)[1])) for name in read
             if getattr(old.hardpoints, name) is not None]  # fmt: skip
    if moved and all(new * before < 0.0 for new, before in moved):
        remedy = (
            "Mirror them: --mirror (mirrored=True)."
            if table.right is None
            else "Interchange Left and Right in the table, or give its axes: --axes (axes=)."
        )
        problem = (
            f"all of its points are on the other side of the car, and the file is of the "
            f"{old.vehicle.side} side. {remedy}"
        )
        raise InputError([problem], table.source)


def write_merged(
    found: Merged, path: str | Path, *, force: bool = False, inputs: Paths = ()
) -> Path:
    """Write an input file into which a table was read, and return its path.

    Parameters
    ----------
    found : Merged
        Result of `merged`.
    path, force, inputs
        File to write, which ends in ``.toml``; whether a file that kintrafo did not write is
        replaced; files that are never replaced.

    Raises
    ------
    InputError
        If the file must not or cannot be written.
    """
    with Validator("write_merged") as given:
        given.instance("found", found, Merged, "a result of merged is needed")
    refuse([path], force=force, inputs=inputs, endings=[".toml"])
    return write_text(path, found.text, force=force, inputs=inputs)


def write_points(
    suspension: Suspension, path: str | Path, *, force: bool = False, inputs: Paths = ()
) -> Path:
    """Write the hardpoints of a suspension as a table for `read_points`, and return its path.

    Parameters
    ----------
    suspension : Suspension
    path : str or pathlib.Path
        A name that ends in ``.csv``.
    force : bool, optional
        Whether a file that kintrafo did not write is replaced, see `kintrafo.core.files`.
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
    with Validator("write_points") as given:
        given.instance("suspension", suspension, Suspension, "a kintrafo.Suspension is needed")
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


def doubts(found: Merged) -> str:
    """Return a note on rows whose names may be those of missing hardpoints, or an empty text.

    There is no doubt if every row is a hardpoint, or every required hardpoint is in the table.
    """
    with Validator("doubts") as given:
        given.instance("found", found, Merged, "a result of merged is needed")
    if not (found.left_out and found.missing):
        return ""
    rows = len(found.left_out) + len(found.read)
    return (
        f"{len(found.left_out)} of {rows} rows are not hardpoints: {listed(found.left_out)}; and "
        f"{listed(found.missing)} stay as in the file. If a row is one of them, assign it: --name "
        f"{found.missing[0]}={short(found.left_out[0])} (names=)."
    )


def as_words(found: Merged, table: PointTable | None = None) -> Mapping[str, str]:
    """Return descriptions of values that were read, kept and left out, by subject.

    Parameters
    ----------
    found : Merged
        Result of `merged`.
    table : PointTable, optional
        Result of `read_points`; adds its unit, its axes, and its unread columns.
    """
    with Validator("as_words") as given:
        given.instance("found", found, Merged, "a result of merged is needed")
        if table is not None:
            given.instance("table", table, PointTable, "a result of read_points is needed")
    read = (n if n == called else f"{n} (from {called})" for n, called in found.read.items())
    said = {
        "read": ", ".join(read),
        "as in the file": ", ".join(found.kept),
        "no hardpoints": ", ".join(found.left_out),
    }
    if table is not None:
        said["unit and axes of the table"] = f"{table.unit}; x, y, z: {table.axes}"
        said["not read"] = ", ".join(table.left_out)
    return {head: text for head, text in said.items() if text}
