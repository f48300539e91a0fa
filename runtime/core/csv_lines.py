"""Lines and cells of CSV files, as spreadsheets and loggers write them."""

import csv
import re
from pathlib import Path

from .errors import InputError
from .files import reason

_DELIMITERS = ("\t", ";", ",")


def lines_of(path: Path) -> list[tuple[int, str]]:
    """Return the lines that hold something, with their numbers; comments begin with a hash.

    Raises
    ------
    InputError
        If the file cannot be read, or is not UTF-8.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        problem = f"the file cannot be read: {reason(error)}"
        raise InputError([problem], str(path)) from None
    except UnicodeDecodeError:
        problem = "the file is not text in UTF-8. Save it as CSV with UTF-8 encoding."
        raise InputError([problem], str(path)) from None
    numbered = enumerate(text.splitlines(), start=1)
    return [(number, line) for number, line in numbered if line.strip() and line[0] != "#"]


def delimiter_of(heading: str) -> str:
    """Return what separates the columns: a tab, a semicolon or a comma, outside of quotes."""
    outside_quotes = re.sub(r'"[^"]*"', "", heading)
    return next((mark for mark in _DELIMITERS if mark in outside_quotes), ",")


def cells_of(line: str, delimiter: str) -> list[str]:
    """Return the cells of a line."""
    try:
        (cells,) = csv.reader([line], delimiter=delimiter, skipinitialspace=True)
    except (csv.Error, ValueError):  # a cell without end
        cells = line.split(delimiter)
    return [cell.strip() for cell in cells]
