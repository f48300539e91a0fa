"""Cells of Excel workbooks with hardpoints: types, formulas, stray cells, sheets."""

import re
import tempfile
from datetime import UTC, datetime, timedelta
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile

from kintrafo.core.errors import InputError
from kintrafo.vehicle.files.point_table import read_points
from openpyxl import Workbook, load_workbook

from .. import mutations
from ..attempts import RawError, WrongError

SHORT = 60
SECONDS = 10.0
NAMES = ("ball_joint", "Arm Front", "strut_top", "own point", "=1+1", "x" * 300, "two\nlines")
CELLS = (
    True, False, 0, -1, 10**30, 1e300, 5e-324, "", " ", "1.5", "1,5", "x", "nan", "inf", "#DIV/0!",
    "#REF!", "=A1+1", "=1/0", "'1", "1_0", datetime(2026, 1, 1, tzinfo=UTC).replace(tzinfo=None),
    timedelta(hours=3), None, "y" * 32_000,
)  # fmt: skip
STRAYS = ("XFD1048576", "A1048576", "XFD1", "IV20", "F9", "A60", "AA3", "E10000", "IW2")
UNITS = {"mm": "mm", "in": "in", "Meters": "m", "(ft)": "ft", "[cm]": "cm"}


def attempt(random):
    """Save a workbook, and compare what is taken with what another reader of it finds."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "points.xlsx")
        points, unit, broken = _saved(random, path)
        if broken and random.random() < 0.3:
            _damaged(random, path)
        sheet = "other" if random.random() < 0.05 else None
        broken = broken or sheet is not None
        try:
            found = read_points(path, sheet=sheet)
        except InputError as error:
            if str(path) not in str(error) or len(str(error)) > 2100 * (len(error.problems) + 1):
                raise RawError(str(error)[:500]) from error
            if not broken:
                raise WrongError(f"{points}: {error}") from error
            raise
        _check(path, found)
    if not broken and (found.points, found.unit) != (points, unit):
        raise WrongError(f"{found} instead of {points}")


def _saved(random, path):
    """Save a workbook; return its points, its unit, and whether something is wrong with it."""
    book = Workbook()
    sheet = book.active
    sheet.title = "points"
    told, unit = list(UNITS.items())[random.integers(len(UNITS))]
    above = int(random.integers(0, 4))
    for _ in range(above):
        sheet.append(["a title", None, "another"] if random.random() < 0.5 else [None])
    sheet.append(["Point", *(f"{axis} [{told.strip('[]()')}]" for axis in "xyz")])
    points = {}
    for name in random.permutation(NAMES[:4])[: random.integers(1, 5)]:
        place = random.normal(0.0, 300.0, 3).round(int(random.integers(0, 5)))
        points[str(name)] = tuple((place + 0.0).tolist())
        sheet.append([str(name), *place.tolist()])
        if random.random() < 0.2:
            sheet.append([])
    if random.random() < 0.3:
        sheet.merge_cells("F1:H3")
    if random.random() < 0.3:
        other = book.create_sheet("other")
        other.append(["nothing", "x", 1])
        other.sheet_state = "hidden" if random.random() < 0.5 else "visible"
    broken = random.random() < 0.7
    if broken:
        _slip(random, book, sheet, above)
    book.save(path)
    return points, unit, broken


def _slip(random, book, sheet, above):
    how = random.random()
    if how < 0.5:
        row, column = above + random.integers(1, 5), random.integers(1, 6)
        sheet.cell(int(row), int(column)).value = CELLS[random.integers(len(CELLS))]
    elif how < 0.7:
        sheet[STRAYS[random.integers(len(STRAYS))]] = CELLS[random.integers(len(CELLS))]
    elif how < 0.8:
        sheet.append([NAMES[random.integers(len(NAMES))], 1, 2, 3])
    elif how < 0.9:
        again = book.copy_worksheet(sheet)
        again.sheet_state = "hidden" if random.random() < 0.5 else "visible"
    else:
        sheet.merge_cells("A1:C8")


def _damaged(random, path):
    """Change a member of the archive, or the archive."""
    if random.random() < 0.3:
        path.write_bytes(mutations.bytes_of(random, path.read_bytes()))
        return
    with ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    name = str(random.choice([n for n in members if "sheet" in n or "Strings" in n]))
    text = members[name]
    if random.random() < 0.5:
        far = str(random.choice(["1048576", "1048577", "99999999999999", "0", "-1", "x"]))
        text = re.sub(rb'r="\d+"', f'r="{far}"'.encode(), text, count=int(random.integers(1, 3)))
    else:
        text = mutations.bytes_of(random, text)
    with ZipFile(path, "w", ZIP_DEFLATED) as archive:
        for other, content in members.items():
            archive.writestr(other, text if other == name else content)


def _check(path, found):
    """Each point stands in a row, by the reader of whole workbooks."""
    book = load_workbook(path, data_only=True)
    rows = [
        [cell for cell in row if cell is not None]
        for sheet in book.worksheets
        for row in sheet.iter_rows(max_row=60, max_col=30, values_only=True)
    ]
    for name, place in found.points.items():
        if not any(_is_row(row, name, place) for row in rows):
            raise WrongError(f"{name} {place} stands in no row")


def _is_row(row, name, place):
    numbers = []
    for cell in row:
        try:
            numbers.append(float(cell))
        except (TypeError, ValueError):
            continue
    words = [re.sub(r"\W+", "", str(cell)) for cell in row]
    # a control character is written as Python would, \x0a
    named = re.sub(r"\W+", "", name.replace("\\x0a", "")) in [w.replace("x0a", "") for w in words]
    return named and set(place) <= set(numbers)
