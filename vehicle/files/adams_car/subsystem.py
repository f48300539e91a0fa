"""The file of a suspension's subsystem of Adams/Car.

In Adams/Car x points rearward, y to the right and z up. Rows for both sides have the coordinates of
the left one.
"""

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, TypeVar

from ....core.errors import InputError
from ...input.teim_orbit import FileBlock, read_blocks
from ...input.teim_values import DEGREES, MILLIMETRES, Values, number, shown, unit_of
from ..fitting import Point, Side

_Value = TypeVar("_Value", float, Point)

ANGLES = {"camber_angle": "camber_deg", "toe_angle": "toe_deg"}
"""The parameters that are read, with the keys of ``[wheel]``, whose signs are the same."""

_SYMMETRIES = ("left/right", "left", "right", "single")
_SPRINGS = ("nspring_assembly", "spring_assembly")
# Keys by block that are read elsewhere, or are irrelevant. Rows of the last two are read.
_FORMAL: Mapping[str, tuple[str, ...]] = {
    "mdi_header": ("file_type", "file_version", "file_format"),
    "subsystem_header": ("template_name", "major_role", "minor_role", "timestamp", "header_size"),
    "units": ("length", "force", "angle", "mass", "time"),
    "hardpoint": (),
    "parameter": (),
}
_SILENT = ("plugins", "solver_settings")


@dataclass(frozen=True)
class Subsystem:
    """Contents of the file of a suspension's subsystem.

    Attributes
    ----------
    source : str
        The file.
    template : str
        Its template; empty if not known.
    points : dict
        Coordinates in the axes of Adams/Car [mm], by name in lower case and symmetry
        ('left/right', 'left', 'right' or 'single').
    angles : dict
        camber_angle and toe_angle [deg], by name and side, if the file has them.
    springs : tuple of dict
        The keys of its springs, in lower case, and their values.
    length_unit : float
        Unit of length of the file [mm].
    force_unit : str
        Unit of force of the file, such as ``"newton"``.
    others : tuple of str
        Descriptions of data that are not read.
    """

    source: str
    template: str
    points: dict[str, dict[str, Point]]
    angles: dict[str, dict[str, float]]
    springs: tuple[dict[str, str], ...]
    length_unit: float
    force_unit: str
    others: tuple[str, ...]

    def side(self, name: str, side: Side) -> Point | None:
        """Return a hardpoint of a side in ISO axes (x forward, y left, z up) [mm].

        Parameters
        ----------
        name : str
            As in the file.
        side : {'left', 'right'}

        Returns
        -------
        tuple of float or None
            None if the file does not have the hardpoint for this side.
        """
        rows = self.points[name]
        own = rows.get(side)
        mirrored = own is None and side == "right"
        found = rows.get("left/right") if own is None else own
        if found is None:
            return None
        x, y, z = found
        # the sum avoids negative zeros
        return -x + 0.0, (y if mirrored else -y) + 0.0, z

    def angle(self, name: str, side: Side) -> float | None:
        """Return an angle of a side [deg]; None if the file does not have it.

        Parameters
        ----------
        name, side
            As for `side`.
        """
        rows = self.angles.get(name, {})
        return rows.get(side, rows.get("left/right"))


def read(path: str | Path) -> Subsystem:
    """Return the contents of an Adams/Car subsystem of a suspension.

    Parameters
    ----------
    path : str or pathlib.Path
        A text file in the TeimOrbit format; its name usually ends in ``.sub``.

    Returns
    -------
    Subsystem

    Raises
    ------
    InputError
        If it cannot be read, is not a subsystem of a suspension, or is ambiguous; with all
        problems.
    """
    source = str(path)
    blocks = read_blocks(path)
    values = Values(blocks, source)
    _refuse_others(values)
    scale = unit_of(values, "length", "mm", MILLIMETRES)
    problems: list[str] = []
    points: dict[str, dict[str, Point]] = {}
    for row in _rows(blocks, _POINTS, problems):
        x, y, z = (scale * number(cell) for cell in row.others)
        _put(points, row, (x, y, z), problems)
    of_angles = [r for r in _rows(blocks, _PARAMETERS, problems) if r.name in ANGLES]
    turn = unit_of(values, "angle", "degrees", DEGREES) if of_angles else 1.0
    angles: dict[str, dict[str, float]] = {}
    for row in of_angles:
        _put(angles, row, turn * number(row.others[-1]), problems)
    problems += [text for block in blocks if block.name in _SPRINGS for text in _twice(block)]
    if not points and not problems:
        problems.append("there are no rows in a block [HARDPOINT].")
    if problems:
        raise InputError(problems, source)
    template = shown(values.one("subsystem_header", "template_name"))
    springs = tuple(dict(block.values()) for block in blocks if block.name in _SPRINGS)
    force_unit = values.one("units", "force")
    others = (*_other_parameters(blocks), *_others(blocks))
    return Subsystem(source, template, points, angles, springs, scale, force_unit, others)


def _refuse_others(values: Values) -> None:
    """Refuse other files than a subsystem of a suspension."""
    for block, key, wanted in (
        ("mdi_header", "file_type", "sub"),
        ("subsystem_header", "major_role", "suspension"),
    ):
        found = values.one(block, key)
        if found and found.lower() != wanted:
            problem = (
                f"[{block.upper()}] {key.upper()} is {shown(found)!r}; only the file of a "
                f"suspension's subsystem can be read, in which it is {wanted!r}."
            )
            raise InputError([problem], values.source)


class _Row(NamedTuple):
    """A row of a table: its name, side, other cells, and line number."""

    name: str
    symmetry: str
    others: list[str]
    line: int


class _Table(NamedTuple):
    """A table of a kind of block: its columns, and the number of its last columns with numbers.

    If it has words, rows without any of them are not read.
    """

    block: str
    columns: tuple[str, ...]
    numbers: int
    words: tuple[str, ...] = ()


_POINTS = _Table("hardpoint", ("hardpoint_name", "symmetry", "x_value", "y_value", "z_value"), 3)
_PARAMETERS = _Table("parameter", ("parameter_name", "symmetry", "type", "value"), 1, (*ANGLES,))


def _rows(blocks: Iterable[FileBlock], table: _Table, problems: list[str]) -> Iterator[_Row]:
    """Yield the valid rows of a table, and add the problems of others to a list."""
    for block in blocks:
        if block.name != table.block:
            continue
        columns = block.columns() or [*table.columns]
        if any(columns.count(column) != 1 for column in table.columns):
            problems.append(
                f"line {block.number}: the columns of [{block.name.upper()}] are "
                f"{shown(', '.join(columns))}; they must be {', '.join(table.columns)}."
            )
            continue
        order = [columns.index(column) for column in table.columns]
        for line, text, cells in block.rows():
            if [cell.lower() for cell in cells or ()] == columns:
                continue  # the names of the columns, without their braces
            if table.words and not any(word in text.lower() for word in table.words):
                continue
            wrong = _problem_of(cells, len(columns), order, table.numbers)
            if cells is None or wrong:
                problems.append(f"line {line}: {wrong}: {shown(text)}")
                continue
            first, symmetry, *others = (cells[i] for i in order)
            yield _Row(first.lower(), symmetry.lower(), others, line)


def _problem_of(cells: list[str] | None, count: int, order: list[int], numbers: int) -> str:
    """Return the problem of a row, or an empty text."""
    if cells is None:
        return "a quote is not closed"
    if len(cells) != count:
        return f"{len(cells)} values instead of {count}"
    if cells[order[1]].lower() not in _SYMMETRIES:
        return f"symmetry is {shown(cells[order[1]])!r}; it can be {', '.join(_SYMMETRIES)}"
    wrong = [cells[i] for i in order[-numbers:] if not math.isfinite(number(cells[i]))]
    return f"{shown(wrong[0])!r} is not a number" if wrong else ""


def _other_parameters(blocks: Iterable[FileBlock]) -> list[str]:
    """Return the parameters that are not read, with their values."""
    rows = [row for block in blocks if block.name == _PARAMETERS.block for row in block.rows()]
    return [
        f"parameter {shown(' '.join(cells or [text]))}"
        for _, text, cells in rows
        if not (cells and cells[0].lower() in (*ANGLES, _PARAMETERS.columns[0]))
    ]


def _twice(block: FileBlock) -> list[str]:
    """Return the problems of keys that a block has more than once."""
    counts = Counter(key for key, _ in block.values())
    return [
        f"line {block.number}: {shown(key.upper())} is given {count} times in "
        f"[{shown(block.name.upper())}]. Keep one of them."
        for key, count in counts.items()
        if count > 1
    ]


def _put(rows: dict[str, dict[str, _Value]], row: _Row, value: _Value, problems: list[str]) -> None:
    """Add the value of a row, or a problem if there is one for the same side already."""
    there: dict[str, _Value] = rows.setdefault(row.name, {})
    both = {"left/right", "single"} & {*there, row.symmetry}
    if row.symmetry in there or (there and both):
        sides = " and ".join((*there, row.symmetry))
        problems.append(
            f"line {row.line}: {shown(row.name)} is given twice, as {sides}. Keep one of them."
        )
    else:
        there[row.symmetry] = value


def _others(blocks: Iterable[FileBlock]) -> list[str]:
    """Return descriptions of unread data of blocks, with keys, rows and values."""
    found = []
    for block in blocks:
        if block.name in (*_SILENT, *_SPRINGS):
            continue
        known = _FORMAL.get(block.name)
        unread = [pair for pair in block.values() if pair[0] not in (known or ())]
        words = [f"{shown(key.upper())} = {shown(value)}" for key, value in unread]
        if known is None:
            words += [shown(" ".join(cells or [text])) for _, text, cells in block.rows()]
        if words or known is None:
            found.append(f"[{shown(block.name.upper())}] {', '.join(words)}".strip())
    return found
