"""Datasets as files: CSV and Excel for people, netCDF, Parquet and MATLAB for programs.

CSV and Excel files have one line of names with units, such as ``camber [deg]``, and values in
display units. The others have SI units, all digits, and the description of every variable. All but
netCDF are flat tables: a variable over a dimension of names, such as the wheels of an axle, has a
column for each name, ``camber_left`` and ``camber_right``.
"""

import csv
import math
import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ..core.errors import InputError
from ..core.files import Paths, replacing
from ..core.legible import legible
from ..core.optional import require
from ..core.quantities import bracketed, display_of
from ..core.validator import Validator, shown
from . import matlab, workbook
from .columns import flat

_CSV_DIGITS = "%.9g"  # a micrometre in a kilometre
# First characters of texts that a spreadsheet may execute (OWASP, "CSV injection").
_FORMULAS = ("=", "+", "-", "@", "\t", "\r")
# A number smaller than this part of the largest in its column is a rounding error, shown as zero.
_ROUNDING = 1e-12
# Valid names of sheets in Excel.
_SHEET = re.compile(r"[^][:*?/\\'\x00-\x1f]{1,31}")
_NAMED = "1 to 31 characters are needed, and none of [ ] : * ? / \\ '"


def write(
    dataset: xr.Dataset,
    path: str | Path,
    *,
    force: bool = False,
    inputs: Paths = (),
    sheets: Mapping[str, xr.Dataset] | None = None,
) -> Path:
    """Write a dataset to a file, whose ending determines the format, and return its path.

    Parameters
    ----------
    dataset : xarray.Dataset
        Variables over one dimension or more.
    path : str or pathlib.Path
        ``.csv``, ``.xlsx`` (Excel), ``.nc`` (netCDF), ``.parquet`` or ``.mat`` (MATLAB).
    force : bool, optional
        Whether a file that kintrafo did not write is replaced, see `kintrafo.core.files`.
    inputs : iterable of str or pathlib.Path, optional
        Files that are never replaced.
    sheets : mapping of str to xarray.Dataset, optional
        Sheets of an Excel workbook by their names; by default `dataset` alone.

    Returns
    -------
    pathlib.Path
        The file, which appears only when it is complete.

    Raises
    ------
    InputError
        If the ending is not known, or the file must not or cannot be written; if the dataset has
        too many rows for a sheet of Excel.
    MissingPackageError
        If the format needs a package that is not installed.
    """
    with Validator("export") as given:
        given.dataset(dataset)
        if not given.failed and not dataset.data_vars:
            given.fail("dataset: it has no variables.")
        given.flag("force", force)
        given.paths("inputs", inputs)
        sheets = {"data": dataset} if sheets is None else sheets
        for name, sheet in given.mapping("sheets", sheets, "names and datasets").items():
            given.instance(f"sheets[{name!r}]", sheet, xr.Dataset, "an xarray.Dataset is needed")
            if not _SHEET.fullmatch(str(name)):
                given.fail(f"sheets: {shown(name)} is not a name of a sheet: {_NAMED}.")
        if sheets == {}:
            given.fail("sheets: one or more are needed.")
    ending = check_format(path)
    with replacing(path, force=force, inputs=inputs) as temporary:
        if ending == ".xlsx":
            frames = {name: _for_people(_legible(sheet)) for name, sheet in sheets.items()}
            workbook.write(frames, temporary)
        else:
            _WRITERS[ending](_legible(dataset), temporary)
    return Path(path)


def check_format(path: str | Path) -> str:
    """Return the ending of a file's name, such as ``".csv"``.

    Raises
    ------
    InputError
        If it is not the ending of a format of `write`.
    """
    with Validator("export") as given:
        given.path("path", path)
    ending = Path(path).suffix.lower()
    if ending not in _FORMATS:
        found = f"{ending} is not a format" if ending else "the name has no ending"
        problem = (
            f"{found} of data files. Use .csv, .xlsx (Excel), .nc (netCDF), .parquet or .mat "
            "(MATLAB)."
        )
        raise InputError([problem], str(path))
    if ending == ".parquet":
        require("pyarrow.parquet", purpose="Writing Parquet", extra="parquet")
    if ending == ".xlsx":
        require("openpyxl", purpose="Writing Excel files", extra="excel")
    return ending


def as_dict(dataset: xr.Dataset) -> dict[str, Any]:
    """Return a dataset as nested dictionaries of plain lists and texts, in SI units.

    Parameters
    ----------
    dataset : xarray.Dataset

    Returns
    -------
    dict
        ``coordinates`` and ``variables``, each by name: ``units``, ``long_name``, ``sign``,
        ``dimensions`` and ``values``. A variable over a dimension of names becomes a variable for
        each name.
    """
    with Validator("export") as given:
        given.dataset(dataset)
    table = flat(dataset)

    def described(data: xr.DataArray) -> dict[str, Any]:
        texts = {key: data.attrs.get(key, "") for key in ("units", "long_name", "sign")}
        return {**texts, "dimensions": list(data.dims), "values": data.values.tolist()}

    return {
        "coordinates": {str(name): described(data) for name, data in table.coords.items()},
        "variables": {str(name): described(data) for name, data in table.items()},
    }


def _frame(dataset: xr.Dataset) -> Any:
    """Return a data frame with one row for each point, coordinates first."""
    frame = dataset.to_dataframe(dim_order=list(dataset.sizes)).reset_index()
    scalars = [name for name in dataset.coords if name not in dataset.sizes]
    return frame[[*dataset.sizes, *scalars, *dataset.data_vars]]


def _for_people(dataset: xr.Dataset) -> Any:
    """Return a data frame in display units, which are part of the names of columns."""
    dataset = flat(dataset)
    frame = _frame(dataset)
    for name in frame.select_dtypes("number").columns:
        values = frame[name] * display_of(dataset[name].attrs).factor
        greatest = values[np.isfinite(values)].abs().max()
        # NaN stays NaN; infinite values do not count as the greatest
        frame[name] = values.mask(values.abs() <= _ROUNDING * greatest, 0.0)
    frame.columns = [bracketed(name, dataset[name].attrs) for name in frame.columns]
    return frame


def _write_csv(dataset: xr.Dataset, path: Path) -> None:
    """Write a table row by row, twice as fast as a data frame writes numbers of given digits."""
    frame = _for_people(dataset)
    columns = [_as_texts(frame[name]) for name in frame.columns]
    with path.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(map(_harmless, frame.columns))
        rows.writerows(zip(*columns, strict=True))


def _as_texts(column: Any) -> Iterable[Any]:
    """Return the values of a column as a CSV file has them; numbers that are missing are empty."""
    values: list[Any] = column.tolist()
    if column.dtype.kind == "f":
        return ("" if math.isnan(value) else _CSV_DIGITS % value for value in values)
    if column.dtype.kind in "iu":
        return values
    texts = {value: _harmless(str(value)) for value in set(column)}
    return map(texts.__getitem__, column)


def _harmless(text: str) -> str:
    """Return a text that no spreadsheet takes for a formula: a formula gets an apostrophe."""
    if not text.startswith(_FORMULAS) or not re.search(r"[\w(]", text):
        return text  # such as a dash for a missing value
    try:
        float(text)
    except ValueError:
        return f"'{text}"
    return text  # a number with its sign


def _legible(dataset: xr.Dataset) -> xr.Dataset:
    """Return a dataset whose texts every format can hold: names of files may be any bytes."""
    texts = {
        name: data.copy(data=[legible(str(text)) for text in data.values])
        for name, data in dataset.coords.items()
        if data.dtype.kind in "OU" and data.ndim == 1
    }
    return dataset.assign_coords(texts) if texts else dataset


def _write_parquet(dataset: xr.Dataset, path: Path) -> None:
    pyarrow = require("pyarrow", purpose="Writing Parquet", extra="parquet")
    parquet = require("pyarrow.parquet", purpose="Writing Parquet", extra="parquet")
    dataset = flat(dataset)
    frame = _frame(dataset)
    fields = [
        pyarrow.field(name, pyarrow.array(frame[name]).type, metadata=_texts(dataset[name].attrs))
        for name in frame.columns
    ]
    schema = pyarrow.schema(fields, metadata=_texts(dataset.attrs))
    columns = [np.asarray(frame[name]) for name in frame.columns]
    with path.open("wb") as file:  # pyarrow has no names that are not UTF-8
        parquet.write_table(pyarrow.Table.from_arrays(columns, schema=schema), file)


def _write_matlab(dataset: xr.Dataset, path: Path) -> None:
    dataset = flat(dataset)
    frame = _frame(dataset)
    described = {name: dataset[name].attrs for name in frame.columns}
    matlab.write(frame, described, dataset.attrs, path)


def _texts(attrs: dict[Any, Any]) -> dict[str, str]:
    return {str(name): str(value) for name, value in attrs.items()}


_WRITERS: dict[str, Callable[[xr.Dataset, Path], None]] = {
    ".csv": _write_csv,
    ".nc": lambda data, path: data.to_netcdf(path, engine="scipy", format="NETCDF3_64BIT"),
    ".parquet": _write_parquet,
    ".mat": _write_matlab,
}
_FORMATS = (*_WRITERS, ".xlsx")
