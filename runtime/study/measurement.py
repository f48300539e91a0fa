"""Roads, rack motions and forces that were measured: reading them from CSV files."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.arguments import Arguments
from ..core.errors import InputError
from ..core.suggestions import nearest, suggestion
from ..simulation.interpolation import Between, Samples
from ..suspension.kinds import KINDS
from ..suspension.wheel_loads import UNITS
from .csv_columns import Sheet

Array = NDArray[np.float64]


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
    **{f"{name}_{unit.replace(' ', '')}": _Column(name, 1.0) for name, unit in UNITS.items()},
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
    ``spring_actuator_N``; and what acts on the wheel of a model with ``wheel_loads``:
    ``contact_force_x_N`` and so on, ``center_force_x_N``, ``wheel_moment_x_Nm``,
    ``shaft_torque_Nm``, ``hub_torque_Nm``. Columns are separated by commas, semicolons or tabs;
    with the latter two, decimals may have a comma. Times increase and are shifted to begin with
    zero; a time that is given twice is a jump. `kintrafo.Samples` says what is in between.

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
    sheet = Sheet.read(Path(path))
    _check_names(sheet.names, sheet.source)
    table = sheet.numbers(_COLUMNS)
    columns = {
        _COLUMNS[name].quantity: table[:, i] * _COLUMNS[name].factor
        for i, name in enumerate(sheet.names)
        if name in _COLUMNS
    }
    times = _times(columns, sheet.line_numbers, speed, sheet.source)
    values = {name: column for name, column in columns.items() if name not in _ABSCISSAE}
    return Measurement(times, values)


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
