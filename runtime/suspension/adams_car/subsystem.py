"""A suspension's subsystem of Adams/Car, as it stands in its file.

In Adams/Car x points rearward, y to the right and z up. Rows for both sides have the coordinates of
the left one.
"""

import math
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, NamedTuple, TypeVar

from ...core.errors import InputError
from ...core.legible import legible, short
from ...core.teim_orbit import Block, read_blocks

Point = tuple[float, float, float]
Side = Literal["left", "right"]
_Value = TypeVar("_Value", float, Point)

ANGLES = {"camber_angle": "camber_deg", "toe_angle": "toe_deg"}
"""What is read of the parameters, with the keys of ``[wheel]``: the signs are the same."""

_MILLIMETRES = {
    **dict.fromkeys(("mm", "millimeter", "millimetre"), 1.0),
    **dict.fromkeys(("cm", "centimeter", "centimetre"), 10.0),
    **dict.fromkeys(("m", "meter", "metre"), 1000.0),
    **dict.fromkeys(("in", "inch"), 25.4),
    **dict.fromkeys(("ft", "foot"), 304.8),
}
_DEGREES = {
    **dict.fromkeys(("deg", "degree", "degrees"), 1.0),
    **dict.fromkeys(("rad", "radian", "radians"), math.degrees(1.0)),
}
_SYMMETRIES = ("left/right", "left", "right", "single")
_POINT_COLUMNS = ["hardpoint_name", "symmetry", "x_value", "y_value", "z_value"]
_ANGLE_COLUMNS = ["parameter_name", "symmetry", "type", "value"]
# What says nothing of the car.
_FORMAL = ("mdi_header", "subsystem_header", "units", "plugins", "solver_settings", "hardpoint")
_NUMBER = re.compile(r"[-+]?(\d++\.?\d*+|\.\d++)([eEdD][-+]?\d++)?")


@dataclass(frozen=True)
class Subsystem:
    """What the file of a suspension's subsystem has.

    Attributes
    ----------
    source : str
        The file.
    template : str
        What it was made from; empty if the file does not say.
    points : dict
        By name in lower case and symmetry ('left/right', 'left', 'right' or 'single') the
        coordinates, in mm and in the axes of Adams/Car.
    angles : dict
        By name and side camber_angle and toe_angle, in degrees; those that the file has.
    others : tuple of str
        What else there is, and is not read.
    """

    source: str
    template: str
    points: dict[str, dict[str, Point]]
    angles: dict[str, dict[str, float]]
    others: tuple[str, ...]

    def side(self, name: str, side: Side) -> Point | None:
        """Return a hardpoint of a side in ISO axes (x forward, y left, z up) [mm].

        Returns
        -------
        tuple of float or None
            None if the file does not have it for this side.
        """
        rows = self.points[name]
        own = rows.get(side)
        mirrored = own is None and side == "right"
        found = rows.get("left/right") if own is None else own
        if found is None:
            return None
        x, y, z = found
        # the sum makes no zero negative
        return -x + 0.0, (y if mirrored else -y) + 0.0, z

    def angle(self, name: str, side: Side) -> float | None:
        """Return an angle of a side [deg]; None if the file does not have it."""
        rows = self.angles.get(name, {})
        return rows.get(side, rows.get("left/right"))


def read(path: str | Path) -> Subsystem:
    """Read the subsystem of a suspension.

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
        If it cannot be read, is no subsystem of a suspension, or is not clear; with all problems.
    """
    source = str(path)
    blocks = read_blocks(path)
    values = _Values(blocks, source)
    _refuse_others(values)
    scale = _unit(values, "length", "mm", _MILLIMETRES)
    problems: list[str] = []
    points: dict[str, dict[str, Point]] = {}
    for row in _rows(blocks, "hardpoint", _POINT_COLUMNS, problems):
        x, y, z = (scale * _number(cell) for cell in row.others)
        _put(points, row, (x, y, z), problems)
    parameters = list(_rows(blocks, "parameter", _ANGLE_COLUMNS, problems))
    of_angles = [row for row in parameters if row.name in ANGLES]
    turn = _unit(values, "angle", "degrees", _DEGREES) if of_angles else 1.0
    angles: dict[str, dict[str, float]] = {}
    for row in of_angles:
        _put(angles, row, turn * _number(row.others[-1]), problems)
    if not points and not problems:
        problems.append("there are no rows in a block [HARDPOINT].")
    if problems:
        raise InputError(problems, source)
    template = shown(values.one("subsystem_header", "template_name"))
    left_out = dict.fromkeys(row.name for row in parameters if row.name not in ANGLES)
    others = [f"parameters {', '.join(map(shown, left_out))}"] if left_out else []
    return Subsystem(source, template, points, angles, (*others, *_others(blocks)))


def shown(text: str) -> str:
    """Return a text of a file as it can be printed, and not more of it than one reads."""
    return short(legible(text))


class _Values:
    """The values of keys, each of which may be said once."""

    def __init__(self, blocks: Iterable[Block], source: str) -> None:
        self.source = source
        self._found: dict[tuple[str, str], list[str]] = {}
        for block in blocks:
            for key, value in block.values():
                self._found.setdefault((block.name, key), []).append(value)

    def one(self, block: str, key: str) -> str:
        """Return a value; empty if there is none. Refuse it if there are two."""
        found = list(dict.fromkeys(self._found.get((block, key), ())))
        if len(found) > 1:
            told = " and ".join(repr(shown(value)) for value in found)
            problem = f"[{block.upper()}] {key.upper()} is {told}. Keep one of them."
            raise InputError([problem], self.source)
        return found[0] if found else ""


def _refuse_others(values: _Values) -> None:
    """Refuse what is no subsystem of a suspension."""
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


def _unit(values: _Values, key: str, usual: str, known: Mapping[str, float]) -> float:
    """Return how many of our units one of the file's is."""
    given = values.one("units", key)
    if given.lower() in known:
        return known[given.lower()]
    told = f"is {shown(given)!r}, which is not known" if given else "is missing"
    problem = f"[UNITS] {key.upper()} {told}. Write {key.upper()} = '{usual}', or: " + ", ".join(
        name for name in known if name != usual
    )
    raise InputError([f"{problem}."], values.source)


class _Row(NamedTuple):
    """A row of a table: what it names, for which side, the other cells, and the line."""

    name: str
    symmetry: str
    others: list[str]
    number: int


def _rows(
    blocks: Iterable[Block], name: str, usual: list[str], problems: list[str]
) -> Iterator[_Row]:
    """Yield the rows of the blocks of a name that are right, and say what is wrong with others."""
    for block in blocks:
        if block.name != name:
            continue
        columns = block.columns() or usual
        if sorted(columns) != sorted(usual):
            problems.append(
                f"line {block.number}: the columns of [{name.upper()}] are "
                f"{shown(', '.join(columns))}; they must be {', '.join(usual)}."
            )
            continue
        order = [columns.index(column) for column in usual]
        for number, text, cells in block.rows():
            if [cell.lower() for cell in cells or ()] == columns:
                continue  # the names of the columns, without their braces
            wrong = _problem_of(cells, order, name)
            if cells is None or wrong:
                problems.append(f"line {number}: {wrong}: {shown(text)}")
                continue
            first, symmetry, *others = (cells[i] for i in order)
            yield _Row(first.lower(), symmetry.lower(), others, number)


def _problem_of(cells: list[str] | None, order: list[int], name: str) -> str:
    """Say what is wrong with a row; nothing if it is right."""
    if cells is None:
        return "a quote is not closed"
    if len(cells) != len(order):
        return f"{len(cells)} values instead of {len(order)}"
    if cells[order[1]].lower() not in _SYMMETRIES:
        return f"symmetry is {shown(cells[order[1]])!r}; it can be {', '.join(_SYMMETRIES)}"
    of_numbers = order[2:] if name == "hardpoint" else order[-1:]
    if name == "parameter" and cells[order[0]].lower() not in ANGLES:
        return ""
    wrong = [cells[i] for i in of_numbers if not math.isfinite(_number(cells[i]))]
    return f"{shown(wrong[0])!r} is no number" if wrong else ""


def _put(rows: dict[str, dict[str, _Value]], row: _Row, value: _Value, problems: list[str]) -> None:
    """Take the value of a row, unless there is one for the same side."""
    there: dict[str, _Value] = rows.setdefault(row.name, {})
    both = {"left/right", "single"} & {*there, row.symmetry}
    if row.symmetry in there or (there and both):
        sides = " and ".join((*there, row.symmetry))
        problems.append(
            f"line {row.number}: {shown(row.name)} is there twice, as {sides}. Keep one of them."
        )
    else:
        there[row.symmetry] = value


def _number(cell: str) -> float:
    """Return the number in a cell; NaN where there is none."""
    if not _NUMBER.fullmatch(cell):
        return math.nan
    return float(re.sub("[dD]", "e", cell))


def _others(blocks: Iterable[Block]) -> list[str]:
    """Return what blocks there are that are not read, with what they are of."""
    found: dict[str, list[str]] = {}
    for block in blocks:
        if block.name not in (*_FORMAL, "parameter"):
            names = [value for key, value in block.values() if key == "usage"]
            found.setdefault(block.name, []).extend(names)
    return [
        " ".join([f"[{shown(name.upper())}]", ", ".join(map(shown, names))]).strip()
        for name, names in found.items()
    ]
