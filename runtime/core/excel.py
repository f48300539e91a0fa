"""The contents of the sheets of an Excel workbook, within limits."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from zipfile import BadZipFile, ZipFile

from .errors import InputError
from .files import reason
from .optional import require
from .reading import MIB, MOST_OF_DATA

ROWS, COLUMNS = 1_048_576, 16_384
"""Most rows and columns of a sheet of Excel, the heading included (limits of the file format)."""

_MOST_ROWS, _MOST_COLUMNS = 10_000, 256
_MOST_SHEETS = 100
_LONGEST = 32_767  # characters of a cell, in Excel
_MOST_UNPACKED = 32 * MIB  # texts that repeat are packed to a thousandth


@dataclass(frozen=True)
class Page:
    """A sheet: its name, whether it is hidden, and its rows with their numbers.

    A cell is a number, a text, a truth value, a time, or None; that of a formula its last value.
    """

    name: str
    hidden: bool
    rows: list[tuple[int, list[Any]]]


def pages_of(file: Path) -> list[Page]:
    """Return the sheets of a workbook without empty rows.

    Raises `InputError` if it cannot be read, or a cell is beyond the limits of rows and columns;
    `MissingPackageError`.
    """
    require("openpyxl", purpose="Reading Excel files", extra="excel")
    from openpyxl import load_workbook  # noqa: PLC0415 (an extra)

    _refuse_large(file)
    try:
        book = load_workbook(file, read_only=True, data_only=True, keep_links=False)
        try:
            return [
                Page(sheet.title, sheet.sheet_state != "visible", list(_rows(sheet, file)))
                for sheet in book.worksheets[:_MOST_SHEETS]
            ]
        finally:
            book.close()
    except InputError:
        raise
    except OSError as error:
        raise InputError([f"the file cannot be read: {reason(error)}"], str(file)) from None
    except Exception:  # noqa: BLE001 (a damaged workbook raises any error)
        raise InputError([_NO_WORKBOOK], str(file)) from None


_NO_WORKBOOK = "the file is not a readable Excel workbook. Save it as .xlsx or .csv."


def _refuse_large(file: Path) -> None:
    """Refuse a workbook that is too large, packed or unpacked."""
    try:
        packed = file.stat().st_size
        with ZipFile(file) as archive:
            # an upper bound of the unpacked size
            unpacked = sum(member.file_size for member in archive.infolist())
    except OSError as error:
        raise InputError([f"the file cannot be read: {reason(error)}"], str(file)) from None
    except (BadZipFile, ValueError, NotImplementedError):
        raise InputError([_NO_WORKBOOK], str(file)) from None
    if packed > MOST_OF_DATA or unpacked > _MOST_UNPACKED:
        problem = (
            f"the workbook has more than {MOST_OF_DATA // MIB} MiB, or "
            f"{_MOST_UNPACKED // MIB} MiB once it is unpacked. Copy the table into a new one."
        )
        raise InputError([problem], str(file))


def _rows(sheet: Any, file: Path) -> Iterator[tuple[int, list[Any]]]:
    """Yield the rows that are not empty; refuse a row or cell beyond the limits."""
    sheet.reset_dimensions()  # the size that a file states may be wrong
    held = 0
    for number, cells in enumerate(sheet.iter_rows(values_only=True), 1):
        if number > ROWS:
            raise InputError([_NO_WORKBOOK], str(file))
        filled = [i for i, cell in enumerate(cells) if cell is not None]
        if not filled:
            continue
        held += 1
        if held > _MOST_ROWS or number > _MOST_ROWS or filled[-1] >= _MOST_COLUMNS:
            raise InputError([_stray(sheet.title, number, filled[-1])], str(file))
        if any(isinstance(cell, str) and len(cell) > _LONGEST for cell in cells):
            problem = f"sheet {sheet.title}, row {number}: a text is longer than Excel has them."
            raise InputError([problem], str(file))
        yield number, list(cells)


def _stray(title: str, row: int, column: int) -> str:
    from openpyxl.utils import get_column_letter  # noqa: PLC0415 (an extra)

    return (
        f"sheet {title}: there is a value in cell {get_column_letter(column + 1)}{row}; a table "
        f"may have {_MOST_ROWS} rows and {_MOST_COLUMNS} columns. Delete that cell, or copy "
        "the table into a new workbook."
    )
