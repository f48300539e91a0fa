"""Datasets as sheets of an Excel workbook: numbers as numbers, and texts that are never formulas.

The same data give the same bytes: the time of writing is not in the file.
"""

import math
import shutil
from collections.abc import Iterable, Mapping
from datetime import datetime
from pathlib import Path
from typing import Any
from zipfile import ZIP_DEFLATED, ZipFile

from ..core.archives import EARLIEST, undated
from ..core.errors import InputError
from ..core.excel import COLUMNS, ROWS
from ..core.legible import legible
from ..core.optional import require

_WIDEST = 60  # characters of a column: longer texts are cut by the next cell
_MEASURED = 200  # rows that determine the width of a column


def write(frames: Mapping[str, Any], path: Path) -> None:
    """Write data frames, by names of sheets, each with a heading that stays in sight.

    Raises `InputError` if a sheet cannot hold that many rows or columns; `MissingPackageError`.
    """
    require("openpyxl", purpose="Writing Excel files", extra="excel")
    from openpyxl import Workbook  # noqa: PLC0415 (an extra)
    from openpyxl.writer.excel import ExcelWriter  # noqa: PLC0415 (an extra)

    for name, frame in frames.items():
        _check(name, *frame.shape)
    book = Workbook(write_only=True)
    book.properties.creator = "kintrafo"
    book.properties.created = book.properties.modified = datetime(*EARLIEST)  # noqa: DTZ001 (a date without a zone)
    for name, frame in frames.items():
        _fill(book.create_sheet(name), frame)
    with path.open("wb") as file, _Timeless(file, "w", ZIP_DEFLATED) as archive:
        ExcelWriter(book, archive).write_data()


def _check(name: str, rows: int, columns: int) -> None:
    if rows + 1 > ROWS or columns > COLUMNS:
        problem = (
            f"a sheet of Excel holds {ROWS - 1} rows of {COLUMNS} columns, and {name} has {rows} "
            f"of {columns}. Use .csv, .nc (netCDF) or .parquet."
        )
        raise InputError([problem], "export")


def _fill(sheet: Any, frame: Any) -> None:
    from openpyxl.cell import WriteOnlyCell  # noqa: PLC0415 (an extra)
    from openpyxl.styles import Font  # noqa: PLC0415 (an extra)
    from openpyxl.utils import get_column_letter  # noqa: PLC0415 (an extra)

    bold = Font(bold=True)

    def text(words: object) -> Any:
        cell = WriteOnlyCell(sheet, legible(str(words)))
        cell.data_type = "s"  # a text, even if it looks like a formula
        return cell

    heading = [text(name) for name in frame.columns]
    for cell in heading:
        cell.font = bold
    sheet.freeze_panes = "A2"
    last = get_column_letter(len(heading))
    sheet.auto_filter.ref = f"A1:{last}{len(frame) + 1}"
    for i, name in enumerate(frame.columns, 1):
        sheet.column_dimensions[get_column_letter(i)].width = _width(name, frame[name])
    sheet.append(heading)
    columns = [_cells(frame[name], text) for name in frame.columns]
    for row in zip(*columns, strict=True):
        sheet.append(row)
    sheet.close()


def _width(name: object, column: Any) -> float:
    """Return the width of a column in characters: numbers need about twelve."""
    texts = column[:_MEASURED] if column.dtype.kind == "O" else ["x" * 12]
    return 2.0 + min(_WIDEST, max(len(str(text)) for text in (name, *texts)))


def _cells(column: Any, text: Any) -> Iterable[Any]:
    """Return a column as cells of a sheet; NaN becomes an empty cell."""
    values = column.to_numpy()
    if values.dtype.kind in "iub":
        return list(values.tolist())
    if values.dtype.kind != "f":
        return (text(value) if value != "" else None for value in values)
    # infinite numbers become texts
    return (
        value if math.isfinite(value) else None if math.isnan(value) else text(value)
        for value in values.tolist()
    )


class _Timeless(ZipFile):
    """An archive whose members all have the same date."""

    def writestr(self, zinfo_or_arcname: Any, data: Any, *_: Any, **__: Any) -> None:
        """Add a member of given content."""
        super().writestr(undated(str(zinfo_or_arcname), ZIP_DEFLATED), data)

    def write(self, filename: Any, arcname: Any = None, *_: Any, **__: Any) -> None:
        """Add a file as a member."""
        member = undated(str(arcname), ZIP_DEFLATED)
        with Path(filename).open("rb") as source, self.open(member, "w") as target:
            shutil.copyfileobj(source, target)
