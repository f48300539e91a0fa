"""Numbers by columns from CSV files, as spreadsheets and loggers write them."""

import math
from collections.abc import Container
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..core.csv_lines import cells_of, delimiter_of, lines_of
from ..core.errors import InputError

Array = NDArray[np.float64]

# Problems with single rows are listed up to this number.
_MOST_LISTED = 5


@dataclass(frozen=True)
class Sheet:
    """A CSV file whose first line names the columns.

    Attributes
    ----------
    source : str
        Where it comes from, for messages.
    names : list of str
        What the first line has.
    """

    source: str
    names: list[str]
    _lines: list[tuple[int, str]]
    _delimiter: str

    @classmethod
    def read(cls, path: Path) -> "Sheet":
        """Read a file. Columns are separated by commas, semicolons or tabs.

        Raises
        ------
        InputError
            If there is nothing to be read.
        """
        lines = lines_of(path)
        if not lines:
            problem = "the file is empty. The first line names the columns."
            raise InputError([problem], str(path))
        delimiter = delimiter_of(lines[0][1])
        return cls(str(path), cells_of(lines[0][1], delimiter), lines[1:], delimiter)

    @property
    def line_numbers(self) -> list[int]:
        """The lines of the rows."""
        return [number for number, _ in self._lines]

    def numbers(self, known: Container[str], may_be_empty: Container[str] = ()) -> Array:
        """Return the numbers of known columns, and NaN for the others.

        Parameters
        ----------
        known : container of str
            Columns that are read.
        may_be_empty : container of str, optional
            Those of them in which a cell may have nothing, or what is infinite: NaN.

        Raises
        ------
        InputError
            With the lines that are wrong.
        """
        problems = []
        if len(self._lines) < 2:
            problems.append(f"rows of numbers: {len(self._lines)}; at least two are needed.")
        rows = []
        for number, line in self._lines:
            problem, values = self._row(cells_of(line, self._delimiter), known, may_be_empty)
            rows.append(values)
            if problem:
                problems.append(f"line {number} {problem}")
            if len(problems) > _MOST_LISTED:
                problems[_MOST_LISTED:] = ["and perhaps more lines."]
                break
        problems += self._marks(known)
        if problems:
            raise InputError(problems, self.source)
        return np.array(rows)

    def _marks(self, known: Container[str]) -> list[str]:
        """Refuse numbers with points and with commas: one of them may be that of thousands."""
        if self._delimiter == ",":
            return []
        columns = [i for i, name in enumerate(self.names) if name in known]
        cells = [cells_of(line, self._delimiter) for _, line in self._lines]
        text = "".join(row[i] for row in cells for i in columns if i < len(row))
        if not ("," in text and "." in text):
            return []
        return [
            "numbers have points and commas: write one of them, for decimals, and no thousands."
        ]

    def _row(
        self, cells: list[str], known: Container[str], may_be_empty: Container[str]
    ) -> tuple[str, list[float]]:
        """Return what is wrong with a row, empty if nothing is, and its values."""
        if len(cells) != len(self.names):
            counts = f"has {len(cells)} values; the first line names {len(self.names)} columns."
            return f"{counts} Separate them alike.", []
        values = [
            self._number(cell) if name in known else math.nan
            for name, cell in zip(self.names, cells, strict=True)
        ]
        for name, cell, value in zip(self.names, cells, values, strict=True):
            nothing = name in may_be_empty and (not cell or math.isinf(value))
            if name in known and not (math.isfinite(value) or nothing):
                return f"has {name} = {cell!r}; a finite number is needed.", values
        return "", [value if math.isfinite(value) else math.nan for value in values]

    def _number(self, cell: str) -> float:
        """Return the number in a cell; NaN where there is none."""
        if "_" in cell:  # Python's own way to group digits, and a slip of the pen in a file
            return math.nan
        try:
            return float(cell if self._delimiter == "," else cell.replace(",", "."))
        except ValueError:
            return math.nan
