"""Contents of written CSV, Excel and Parquet files: numbers, texts, units."""

import csv
import math
import tempfile
from pathlib import Path

import numpy as np
import pyarrow.parquet
import xarray as xr
from kintrafo.datasets import export
from openpyxl import load_workbook

from ..attempts import WrongError

SHORT = 30
NUMBERS = (0.0, -0.0, 1e-300, 1e300, math.nan, math.inf, -math.inf, 5e-324, 1.0 / 3.0)
LABELS = (
    "car", "=1+1", "+1", "-", "-1", "-x", "@a", "'", '"', "a,b", "two\nlines", "tab\tand\rmore",
    "\x00", "日本", "x" * 400, "", " ", "=", "1e5", "nan", "\x1b[2J", "\x85", "_x000a_",
)  # fmt: skip
UNITS = {"m": ("mm", 1e3), "rad": ("deg", 180.0 / math.pi), "N": ("N", 1.0), "1": ("", 1.0)}


def attempt(random):
    """Write a dataset in all formats, and read each by the library of the format."""
    rows = int(random.integers(1, 6))
    labels = [LABELS[i] for i in random.permutation(len(LABELS))[:rows]]
    units = str(random.choice(list(UNITS)))
    values = random.normal(0.0, 1.0, rows)
    for row in range(rows):
        if random.random() < 0.4:
            values[row] = NUMBERS[random.integers(len(NUMBERS))]
    data = xr.Dataset(
        {"toe": ("car", values, {"units": units, "long_name": "toe", "sign": ""})},
        {"car": ("car", np.array(labels, dtype=object), {"long_name": "car"})},
    )
    with tempfile.TemporaryDirectory() as folder:
        paths = {ending: Path(folder, f"a{ending}") for ending in (".csv", ".xlsx", ".parquet")}
        for path in paths.values():
            export.write(data, path)
        _csv(paths[".csv"], labels, values, units)
        _excel(paths[".xlsx"], labels, values, units)
        _parquet(paths[".parquet"], labels, values, units)


def _csv(path, labels, values, units):
    with path.open(encoding="utf-8", newline="") as file:
        (head, *rows) = csv.reader(file)
    _heading(head[1], units)
    for label, value, (text, number) in zip(labels, values, rows, strict=True):
        if text[:1] in "=+-@\t\r" and len(text) > 1 and not _number(text):
            raise WrongError(f"a formula: {text!r}")
        if text.removeprefix("'") != _plain(label).removeprefix("'"):
            raise WrongError(f"{text!r} instead of {label!r}")
        if label == "-" and text != "-":
            raise WrongError(f"a stroke is {text!r}")
        _same(float(number or "nan"), value * UNITS[units][1], 1e-8, values * UNITS[units][1])


def _excel(path, labels, values, units):
    (sheet,) = load_workbook(path).worksheets
    # rows that are wholly empty at the end are none for this reader
    (head, *rows) = sheet.iter_rows(max_row=1 + len(labels))
    _heading(str(head[1].value), units)
    for label, value, (text, number) in zip(labels, values, rows, strict=True):
        if text.data_type not in ("s", "inlineStr", "n") or number.data_type == "f":
            raise WrongError(f"{text.value!r} is of the type {text.data_type}")
        if str(text.value or "") != _plain(label):
            raise WrongError(f"{text.value!r} instead of {label!r}")
        shown = math.nan if number.value is None else float(number.value)
        _same(shown, value * UNITS[units][1], 1e-15, values * UNITS[units][1])


def _parquet(path, labels, values, units):
    table = pyarrow.parquet.read_table(path)
    if table.schema.field("toe").metadata[b"units"].decode() != units:
        raise WrongError(f"units {table.schema.field('toe').metadata}")
    if table["car"].to_pylist() != [_plain(label) for label in labels]:
        raise WrongError(f"{table['car'].to_pylist()} instead of {labels}")
    found = np.array(table["toe"].to_numpy(zero_copy_only=False), dtype=float)
    if not np.array_equal(found, values, equal_nan=True):
        raise WrongError(f"{found} instead of {values}")


def _heading(text, units):
    shown = UNITS[units][0]
    if text != (f"toe [{shown}]" if shown else "toe"):
        raise WrongError(f"heading {text!r} of {units}")


def _plain(label):
    """Return a label as a file can hold it: what is no character is written in ASCII."""
    found = []
    for character in label:
        code = ord(character)
        if 0xDC80 <= code < 0xDD00:
            code -= 0xDC00
        hidden = code < 0x20 or 0x7F <= code < 0xA0 or 0xD800 <= ord(character) < 0xE000
        found.append(
            (f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}") if hidden else character
        )
    return "".join(found)


def _number(text):
    try:
        float(text)
    except ValueError:
        return False
    return True


def _same(found, expected, digits, column):
    finite = np.abs(column[np.isfinite(column)])
    greatest = float(finite.max()) if finite.size else 0.0
    # what is smaller than this part of its column is a rounding error, and a zero for people
    near = math.isclose(found, expected, rel_tol=digits, abs_tol=2e-12 * greatest)
    if not (near or (math.isnan(found) and math.isnan(expected))):
        raise WrongError(f"{found} instead of {expected}")
