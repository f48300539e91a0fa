"""Tables of users, with names and units in any usual form: CSV files, rows of spreadsheets.

Every table is read by the same rules. Capitals, blanks, hyphens and underscores in names do not
matter. The unit of a column follows its name, ``wheel travel [mm]``, ``Wheel Travel (mm)``
or ``wheel_travel_mm``; or it is in a row of units below the names; or in a comment line,
``# units: mm, deg``, for all columns of such quantities. Contradictory units are refused.
"""

import csv
import math
import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .errors import InputError
from .legible import legible, short
from .named_types import Array
from .reading import MOST_OF_MEASUREMENTS, text_of
from .units import in_si

Row = tuple[int, list[Any]]

_DELIMITERS = ("\t", ";", ",")
_MOST_LISTED = 5  # problems with single rows
_MOST_ROWS, _MOST_COLUMNS = 5_000_000, 1000
_BRACKETS = re.compile(r"(.*?)\s*(?:\[([^\[\]]*)\]|\(((?:[^()]|\([^()]*\))*)\))\s*")
_BETWEEN = re.compile(r"[\s_,/]+(?:in\s+)?")
_STROKE_OR_NUMBER = re.compile(r"[\[(]?[\d.,eE+\s-]*[\])]?")
_NUMBER = re.compile(r"[+-]?(?=[.,]?\d)\d*[.,]?\d*(?:[eE][+-]?\d+)?")
# a comment line that states units
_STATES = re.compile(
    r"\W*(?:all\s+)?(?:(?:units?|lengths?|coordinates?|dimensions?|points?|values?|everything)\s*)?"
    r"(?:(?:are|is|given|measured|stated)\s+)*(?:in\s+|(?<=\w)\s*[:=])(.*)",
    re.IGNORECASE,
)


def key(name: str) -> str:
    """Return a form of a name that is the same for all spellings.

    Examples
    --------
    >>> key("Lower Arm-Front") == key("lower_arm_front") == key("LowerArmFront")
    True
    """
    return re.sub(r"[\W_]+", "", name.casefold())


class ColumnHeading(NamedTuple):
    """A cell of the first row: its text, the name of the column, and its unit or None."""

    text: str
    label: str
    unit: str | None

    @classmethod
    def of(cls, cell: Any) -> "ColumnHeading":
        """Return the heading in a cell of the first row."""
        text = legible(" ".join(str("" if cell is None else cell).split()))
        found = _BRACKETS.fullmatch(text) if len(text) < 500 else None
        if found is None or not found[1]:
            return cls(text, text, None)
        return cls(text, found[1], found[3] if found[2] is None else found[2])

    def among(self, known: Mapping[str, str]) -> tuple[str, str | None] | None:
        """Return the known name, by its key, and the unit of this column; None if unknown."""
        name = known.get(key(self.label))
        if name or self.unit is not None:
            return (name, self.unit) if name else None
        for between in _BETWEEN.finditer(self.label[:200]):
            name = known.get(key(self.label[: between.start()]))
            unit = self.label[between.end() :].replace("_per_", "/").replace("_", " ")
            if name and unit and in_si(unit)[0]:
                return name, unit
        return None


class Column(NamedTuple):
    """A column of a known name."""

    name: str
    at: int  # index of the column
    unit: str | None  # as it is in the table; None where there is none


@dataclass(frozen=True)
class Table:
    """Rows below the names of columns."""

    source: str  # origin, for messages
    headings: tuple[ColumnHeading, ...]
    rows: list[Row]  # cells of each row, with the number of its line
    # units in the row of units, one for each column; None where it has none
    units: tuple[str | None, ...]
    stated: tuple[str, ...]  # units that comment lines state for all columns
    commas: bool  # whether numbers may have decimal commas

    @classmethod
    def of(
        cls, source: str, rows: Sequence[Row], comments: Iterable[Row] = (), *, commas: bool = False
    ) -> "Table":
        """Return the table of one row or more, of which the first names the columns.

        Rows have a number and cells; `comments` are the cells of comment lines, without the hash.
        """
        (_, names), *others = rows
        if len(names) > _MOST_COLUMNS:
            problem = f"the first line has {len(names)} columns; {_MOST_COLUMNS} are the most."
            raise InputError([problem], source)
        headings = tuple(map(ColumnHeading.of, names))
        units: list[str | None] = [None] * len(headings)
        if others and (row := _units_row(others[0][1], len(headings))):
            units, others = row, others[1:]
        stated: list[str] = []
        for number, cells in comments:
            if len(headings) > 1 < len(cells) and (row := _units_row(cells, len(headings))):
                units = [one or other for one, other in zip(units, row, strict=True)]
            else:
                stated += _stated(source, number, ", ".join(map(str, cells)))
        return cls(source, headings, others, tuple(units), tuple(stated), commas)

    @property
    def names(self) -> list[str]:
        """Texts of the first row."""
        return [heading.text for heading in self.headings]

    def columns(self, known: Iterable[str]) -> list[Column]:
        """Return the columns with known names, in the order of the table, each with its unit."""
        by_key = {key(name): name for name in known}
        return [
            Column(found[0], i, self.units[i] if found[1] is None else found[1])
            for i, heading in enumerate(self.headings)
            if (found := heading.among(by_key))
        ]

    def problems_of(self, columns: Sequence[Column], units: Mapping[str, str]) -> list[str]:
        """Return errors of repeated columns, and of units that do not fit the SI units of names."""
        names = [column.name for column in columns]
        repeated = [
            f"{name} is in {names.count(name)} columns. Keep one of them."
            for name in dict.fromkeys(names)
            if names.count(name) > 1
        ]
        found = [self.unit_problem(column, units[column.name]) for column in columns]
        return repeated + [problem for problem in found if problem]

    def values_of(
        self, columns: Sequence[Column], units: Mapping[str, str], may_be_empty: Sequence[int] = ()
    ) -> dict[str, Array]:
        """Return the numbers of columns by name, in the SI units of the names; see `numbers`."""
        table = self.numbers([column.at for column in columns], may_be_empty)
        return {
            column.name: table[:, at] * in_si(self.unit_for(column, units[column.name]) or "")[1]
            for at, column in enumerate(columns)
        }

    def without(self, columns: Iterable[Column]) -> list[ColumnHeading]:
        """Return the headings of all other columns."""
        read = {column.at for column in columns}
        return [heading for i, heading in enumerate(self.headings) if i not in read]

    def unit_problem(self, column: Column, unit: str) -> str:
        """Return why a column's unit does not fit a quantity in an SI unit; empty if it does."""
        given, heading = self.unit_for(column, unit), self.headings[column.at]
        if in_si(given or "")[0] != unit:
            return (
                f"column {short(heading.text)!r}: the unit {short(given or '(none)')} does not fit "
                f"{column.name}, which is in {unit} or a display unit of it."
            )
        elsewhere = [self.units[column.at], *self.stated]
        others = [o for o in elsewhere if o is not None and _contradicts(o, given or "")]
        if others:
            return (
                f"column {short(heading.text)!r} is in {given}, and a row of units or a comment "
                f"has {others[0]}. Keep one of them."
            )
        return ""

    def unit_for(self, column: Column, unit: str) -> str | None:
        """Return the unit of a column: its own, or the one a comment states for this SI unit."""
        if column.unit is not None:
            return column.unit
        return next((stated for stated in self.stated if in_si(stated)[0] == unit), None)

    def numbers(self, wanted: Sequence[int], may_be_empty: Collection[int] = ()) -> Array:
        """Return the numbers of some columns, shape (rows, wanted).

        Columns are given by their indices. In those of `may_be_empty` a cell that is empty or
        infinite becomes NaN. Raises `InputError` with the lines that are wrong.
        """
        problems = []
        if len(self.rows) < 2:
            problems.append(f"rows of numbers: {len(self.rows)}; at least two are needed.")
        values = np.full((len(self.rows), len(wanted)), math.nan)
        for row, (line, cells) in enumerate(self.rows):
            problem = self._fill(values[row], cells, wanted, may_be_empty)
            if problem:
                problems.append(f"line {line} {problem}")
            if len(problems) > _MOST_LISTED:
                problems[_MOST_LISTED:] = ["and perhaps more lines."]
                break
        problems += self.mixed_marks(wanted)
        if problems:
            raise InputError(problems, self.source)
        return values

    def mixed_marks(self, wanted: Collection[int]) -> list[str]:
        """Return a message if numbers have points and commas; one may separate thousands."""
        if not self.commas:
            return []
        marks = {
            mark
            for _, cells in self.rows
            for i in wanted
            if i < len(cells)
            for mark in ",."
            if mark in str(cells[i])
        }
        if len(marks) < 2:
            return []
        return [
            "numbers have points and commas: use one of them, for decimals, none for thousands."
        ]

    def number(self, cell: Any) -> float:
        """Return the number in a cell; NaN where there is none."""
        if isinstance(cell, bool):
            return math.nan
        if isinstance(cell, int | float):
            return float(cell) if abs(cell) < 1e300 else math.inf
        text = str("" if cell is None else cell).strip()
        if "_" in text:  # `float` accepts it between digits; in a file it is a mistake
            return math.nan
        try:
            return float(text.replace(",", ".") if self.commas else text)
        except ValueError:
            return math.nan

    def _fill(
        self,
        row: Array,
        cells: Sequence[Any],
        wanted: Sequence[int],
        may_be_empty: Collection[int],
    ) -> str:
        """Put the numbers of a row into an array; return a message, empty if nothing is wrong."""
        if len(cells) != len(self.headings):
            counts = f"has {len(cells)} values; the first line names {len(self.headings)} columns."
            return f"{counts} Separate them alike."
        for at, i in enumerate(wanted):
            value = self.number(cells[i])
            nothing = i in may_be_empty and (cells[i] == "" or math.isinf(value))
            if not (math.isfinite(value) or nothing):
                name, cell = short(self.headings[i].text), short(legible(str(cells[i])))
                return f"has {name} = {cell!r}; a finite number is needed."
            row[at] = value if math.isfinite(value) else math.nan
        return ""


def csv_rows(
    path: str | Path, most: int = MOST_OF_MEASUREMENTS
) -> tuple[list[Row], list[Row], bool]:
    """Return the rows of a CSV file, its comment lines, and whether decimals may have commas.

    Columns are separated by tabs, semicolons or commas; comments begin with a hash. Raises
    `InputError` if the file cannot be read, is too large, is not UTF-8 or separates its columns by
    blanks.
    """
    lines = [
        (number, line)
        for number, line in enumerate(text_of(Path(path), most).splitlines(), start=1)
        if line.strip()
    ]
    plain = [(number, line) for number, line in lines if line[0] != "#"]
    if len(lines) > _MOST_ROWS:
        problem = f"the file has {len(lines)} lines; {_MOST_ROWS} are the most. Give a part of it."
        raise InputError([problem], str(path))
    delimiter = _delimiter_of(plain[0][1]) if plain else ","
    if len(plain) > 1 and _by_blanks(plain[0][1], plain[1][1]):
        problem = (
            "blanks separate the columns. Separate them by commas, semicolons or tabs, in the "
            "first line too."
        )
        raise InputError([problem], str(path))
    rows: list[Row] = [(number, _cells_of(line, delimiter)) for number, line in plain]
    remarks: list[Row] = [
        (number, _cells_of(line.lstrip("#"), delimiter)) for number, line in lines if line[0] == "#"
    ]
    return rows, remarks, delimiter != ","


def read_table(path: str | Path) -> Table:
    """Return the table of a CSV file, whose first line names the columns; refuse an empty one."""
    rows, comments, commas = csv_rows(path)
    if not rows:
        raise InputError(["the file is empty. The first line names the columns."], str(path))
    return Table.of(str(path), rows, comments, commas=commas)


def _delimiter_of(heading: str) -> str:
    """Return the delimiter of columns, outside of quotes: a tab, a semicolon or a comma."""
    outside_quotes = re.sub(r'"[^"]*"', "", heading)
    return next((mark for mark in _DELIMITERS if mark in outside_quotes), ",")


def _by_blanks(heading: str, line: str) -> bool:
    """Return whether the heading has no delimiter, and the line below it several numbers."""
    words = re.split(r"[;,]?\s+", line.strip())
    numbers = [word for word in words if _NUMBER.fullmatch(word)]
    return len(numbers) > 1 and not any(mark in heading for mark in _DELIMITERS)


def _cells_of(line: str, delimiter: str) -> list[Any]:
    """Return the cells of a line."""
    try:
        (cells,) = csv.reader([line], delimiter=delimiter, skipinitialspace=True)
    except (csv.Error, ValueError):  # a cell without end
        cells = line.split(delimiter)
    return [cell.strip() for cell in cells]


def _units_row(cells: Sequence[Any], count: int) -> list[str | None] | None:
    """Return the units of a row that has nothing else, one for each column; else None."""
    texts = ["" if cell is None else str(cell).strip() for cell in cells]
    texts += [""] * (count - len(texts))
    if len(texts) != count or not any(_names_unit(text) for text in texts):
        return None
    units = [text.strip("[]() ") for text in texts]
    if not all(_names_unit(unit) or unit.lower() in ("", "-", "unit", "units") for unit in units):
        return None
    return [unit if _names_unit(unit) or unit == "-" else None for unit in units]


def _names_unit(text: str) -> bool:
    """Return whether a text is a unit, and neither a number nor a dash."""
    return len(text) < 40 and not _STROKE_OR_NUMBER.fullmatch(text) and bool(in_si(text)[0])


def _stated(source: str, number: int, comment: str) -> Iterator[str]:
    """Yield the units that a comment line states for all columns."""
    found = _STATES.fullmatch(comment[:500])
    pieces = re.split(r"[,;]|\band\b", found[1] if found else comment[:500])
    units = [piece.strip(" .[]()") for piece in pieces]
    if all(map(_names_unit, units)):
        yield from units
    elif found and re.match(r"\W*(all\s+)?units?\s*[:=]", comment, re.IGNORECASE):
        problem = (
            f"line {number}: the comment {short(legible(comment.strip()))!r} has units that are "
            "not known. Write them as # units: mm, deg."
        )
        raise InputError([problem], source)


def _contradicts(one: str, other: str) -> bool:
    (unit, factor), (other_unit, other_factor) = in_si(one), in_si(other)
    return bool(unit) and unit == other_unit and factor != other_factor
