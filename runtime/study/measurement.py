"""Roads, rack motions and actuator forces that were measured: reading them from CSV files."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.arguments import Arguments
from ..core.errors import InputError
from ..core.files import reason
from ..core.suggestions import nearest, suggestion
from ..simulation.interpolation import Between, Samples
from ..suspension.kinds import KINDS

Array = NDArray[np.float64]

_DELIMITERS = ("\t", ";", ",")
# Problems with single rows are listed up to this number.
_MOST_LISTED = 5


class _Column(NamedTuple):
    """What a column of a measurement means."""

    quantity: str
    factor: float  # to SI units


_COLUMNS = {
    "time_s": _Column("time", 1.0),
    "time_ms": _Column("time", 1e-3),
    "distance_m": _Column("distance", 1.0),
    "road_height_mm": _Column("road_height", 1e-3),
    "road_height_m": _Column("road_height", 1.0),
    "rack_position_mm": _Column("rack_position", 1e-3),
    "rack_position_m": _Column("rack_position", 1.0),
    **{f"{kind.NAMES.actuator}_N": _Column(kind.NAMES.actuator, 1.0) for kind in KINDS.values()},
}
_ABSCISSAE = ("time", "distance")


@dataclass(frozen=True)
class Measurement:
    """Inputs that were measured over time or along a road.

    Attributes
    ----------
    times : ndarray, shape (n,)
        Beginning with zero [s].
    values : dict
        Input name (``road_height``, ``rack_position``, that of the actuator) to samples of shape
        (n,), SI units.
    """

    times: Array
    values: dict[str, Array]

    @property
    def duration(self) -> float:
        """Last time [s]."""
        return float(self.times[-1])

    def inputs(self, between: Between = "monotone") -> dict[str, Samples]:
        """Return the samples as `kintrafo.simulate` takes them; `between` is that of `Samples`."""
        return {name: Samples(self.times, values, between) for name, values in self.values.items()}


def measured(path: str | Path, *, speed: float | None = None) -> Measurement:
    """Read inputs from a CSV file.

    The first line names the columns: ``time_s`` or ``time_ms``, or ``distance_m`` along the road;
    and at least one of ``road_height_mm``, ``rack_position_mm`` (also in ``_m``), and the force of
    the actuator by the name that the kind of suspension has for it: ``strut_force_N``,
    ``spring_actuator_N``. Columns are separated by commas, semicolons or tabs; with the latter two,
    decimals may have a comma. Times increase and are shifted to begin with zero; a time that is
    given twice is a jump. `kintrafo.Samples` says what is in between.

    Parameters
    ----------
    path : str or pathlib.Path
    speed : float, optional
        Speed at which a road that is given over the distance is driven on [m/s].

    Returns
    -------
    Measurement

    Raises
    ------
    InputError
        If the file cannot be used; with the lines that are wrong.
    """
    with Arguments("measured") as given:
        given.kind("path", path, (str, Path), "the path of a CSV file is needed")
        if speed is not None:
            given.number("speed", speed, "m/s", above=0.0)
    source = str(path)
    lines = _lines_of(Path(path))
    if not lines:
        raise InputError(["the file is empty. The first line names the columns."], source)
    delimiter = next((d for d in _DELIMITERS if d in lines[0][1]), ",")
    names = _cells(lines[0][1], delimiter)
    _check_names(names, source)
    table = _numbers(lines[1:], names, delimiter, source)
    columns = {
        _COLUMNS[name].quantity: table[:, i] * _COLUMNS[name].factor
        for i, name in enumerate(names)
        if name in _COLUMNS
    }
    times = _times(columns, [number for number, _ in lines[1:]], speed, source)
    values = {name: column for name, column in columns.items() if name not in _ABSCISSAE}
    return Measurement(times, values)


def _lines_of(path: Path) -> list[tuple[int, str]]:
    """Return the lines that hold something, with their numbers."""
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


def _check_names(names: list[str], source: str) -> None:
    known = [name for name in names if name in _COLUMNS]
    quantities = [_COLUMNS[name].quantity for name in known]
    problems = [
        f"column {name!r} is not known. {suggestion(name, _COLUMNS)}"
        for name in names
        if name not in _COLUMNS and _resembles(name)
    ]
    problems += [
        f"{quantity} stands in {quantities.count(quantity)} columns. Keep one of them."
        for quantity in dict.fromkeys(quantities)
        if quantities.count(quantity) > 1
    ]
    if not problems and sum(quantity in _ABSCISSAE for quantity in quantities) != 1:
        problems.append(
            f"one column time_s, time_ms or distance_m is needed; the first line has {names}."
        )
    if not problems and len(quantities) < 2:
        wanted = [n for n, column in _COLUMNS.items() if column.quantity not in _ABSCISSAE]
        hints = [nearest(name, wanted) for name in names if name not in _COLUMNS]
        hint = "".join(f" Did you mean {name}?" for name in hints if name)
        needed = f"one of the columns {', '.join(wanted)} is needed; there is {names}.{hint}"
        problems.append(needed)
    if problems:
        raise InputError(problems, source)


def _resembles(name: str) -> bool:
    """Tell whether a column that is not known was probably meant to be one that is."""
    return name.partition("_")[0].lower() in {known.partition("_")[0] for known in _COLUMNS}


def _cells(line: str, delimiter: str) -> list[str]:
    return [cell.strip().strip('"') for cell in line.split(delimiter)]


def _numbers(lines: list[tuple[int, str]], names: list[str], delimiter: str, source: str) -> Array:
    """Return the numbers of the known columns, and NaN for the others."""
    problems = []
    if len(lines) < 2:
        problems.append(f"rows of numbers: {len(lines)}; at least two are needed.")
    rows = []
    for number, line in lines:
        cells = _cells(line, delimiter)
        problem, values = _row(names, cells, delimiter)
        rows.append(values)
        if problem:
            problems.append(f"line {number} {problem}")
        if len(problems) > _MOST_LISTED:
            problems[_MOST_LISTED:] = ["and perhaps more lines."]
            break
    if problems:
        raise InputError(problems, source)
    return np.array(rows)


def _row(names: list[str], cells: list[str], delimiter: str) -> tuple[str, list[float]]:
    """Return what is wrong with a row, empty if nothing is, and its values."""
    if len(cells) != len(names):
        counts = f"has {len(cells)} values; the first line names {len(names)} columns."
        return f"{counts} Separate them alike.", []
    values = [
        _number(cell, delimiter) if name in _COLUMNS else math.nan
        for name, cell in zip(names, cells, strict=True)
    ]
    for name, cell, value in zip(names, cells, values, strict=True):
        if name in _COLUMNS and not math.isfinite(value):
            return f"has {name} = {cell!r}; a finite number is needed.", values
    return "", values


def _number(cell: str, delimiter: str) -> float:
    """Return the number in a cell; NaN where there is none."""
    if "_" in cell:  # Python's own way to group digits, and a slip of the pen in a file
        return math.nan
    try:
        return float(cell if delimiter == "," else cell.replace(",", "."))
    except ValueError:
        return math.nan


def _times(
    columns: dict[str, Array], lines: Sequence[int], speed: float | None, source: str
) -> Array:
    """Return times that begin with zero, or refuse them where they fall."""
    if "distance" in columns:
        if speed is None or not (math.isfinite(speed) and speed > 0.0):
            given = "none is given" if speed is None else f"{speed * 3.6:g} km/h is given"
            problem = f"a road over distance_m needs a speed of more than 0 km/h; {given}."
            raise InputError([problem], source)
        with np.errstate(over="ignore"):
            times = columns["distance"] / speed
    elif speed is not None:
        problem = "a speed is for a road over distance_m; this one is over time. Leave it out."
        raise InputError([problem], source)
    else:
        times = columns["time"]
    fall = np.flatnonzero(times[1:] < times[:-1])
    if fall.size:
        line = lines[int(fall[0]) + 1]
        name = "distance" if "distance" in columns else "time"
        problem = f"line {line}: the {name} falls. Sort the rows, each {name} once."
        raise InputError([problem], source)
    with np.errstate(over="ignore", invalid="ignore"):
        shifted: Array = times - times[0]
    if not np.all(np.isfinite(shifted)):
        problem = f"times from {times[0]:g} to {times[-1]:g} s are too far apart. Check the column."
        raise InputError([problem], source)
    if shifted[-1] == 0.0:
        raise InputError(["all rows have the same time. Check the column."], source)
    return shifted
