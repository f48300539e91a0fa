"""Measured roads, rack motions and forces from CSV files."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ...core.named_types import Array
from ...core.suggestions import nearest, suggestion
from ...core.tables import Table, read_table
from ...core.units import KM_PER_H
from ...core.validator import Validator
from ...simulation.interpolation import Between, Samples
from ..corner.wheel_loads import UNITS
from ..kinds import KINDS

_UNITS = {
    "time": "s",
    "distance": "m",
    "road_height": "m",
    "rack_position": "m",
    **{kind.NAMES.actuator: "N" for kind in KINDS.values()},
    **UNITS,
}
_SHOWN = {"time": ("s", "ms"), "road_height": ("mm", "m"), "rack_position": ("mm", "m")}
_COLUMNS = {
    f"{name}_{shown.replace(' ', '')}": name
    for name, unit in _UNITS.items()
    for shown in _SHOWN.get(name, (unit,))
}
"""Names of columns in usual units, and their quantities."""
_ABSCISSAE = ("time", "distance")


@dataclass(frozen=True)
class Measurement:
    """Inputs measured over time or along a road.

    Attributes
    ----------
    times : ndarray, shape (n,)
        Beginning with zero [s].
    values : dict
        Input name (``road_height``, ``rack_position``, that of the actuator) to samples of shape
        (n,), SI units.
    left_out : tuple of str
        Columns that were not read.
    """

    times: Array
    values: dict[str, Array]
    left_out: tuple[str, ...] = ()

    @property
    def duration(self) -> float:
        """Last time [s]."""
        return float(self.times[-1])

    def inputs(self, between: Between = "monotone") -> dict[str, Samples]:
        """Return the samples as `kintrafo.simulate` takes them; for `between` see `Samples`."""
        return {name: Samples(self.times, values, between) for name, values in self.values.items()}


def measured(path: str | Path, *, speed: float | None = None) -> Measurement:
    """Return measured inputs of a simulation from a CSV file.

    The first line has the names of the columns: ``time_s``, ``time_ms`` or ``distance_m`` along the
    road; and one or more of ``road_height_mm``, ``rack_position_mm`` (also in ``_m``), the force of
    the actuator by its name in the kind of suspension (``strut_force_N``, ``spring_actuator_N``),
    and loads on the wheel of a model with ``wheel_loads``: ``contact_force_x_N`` and so on,
    ``center_force_x_N``, ``wheel_moment_x_Nm``, ``shaft_torque_Nm``, ``hub_torque_Nm``. Other usual
    units and spellings, such as ``Road height [in]``, are described in `kintrafo.core.tables`.
    Columns are separated by commas, semicolons or tabs; with the latter two, decimals may have a
    comma. Times increase, and are shifted to begin with zero; a repeated time is a jump.
    `kintrafo.Samples` describes the interpolation.

    Parameters
    ----------
    path : str or pathlib.Path
    speed : float, optional
        Speed of the car, which turns distances along the road into times [m/s]; needed with
        ``distance_m`` only.

    Returns
    -------
    Measurement

    Raises
    ------
    InputError
        If the file cannot be used; the message has the wrong lines.
    """
    with Validator("measured") as given:
        given.instance("path", path, (str, Path), "the path of a CSV file is needed")
        if speed is not None:
            given.number("speed", speed, "m/s", above=0.0)
    sheet = read_table(path)
    columns = sheet.columns(_UNITS)
    _check(sheet)
    values = sheet.values_of(columns, _UNITS)
    times = _times(values, [line for line, _ in sheet.rows], speed, sheet.source)
    left_out = tuple(heading.text for heading in sheet.without(columns))
    values = {name: column for name, column in values.items() if name not in _ABSCISSAE}
    return Measurement(times, values, left_out)


def _check(sheet: Table) -> None:
    columns = sheet.columns(_UNITS)
    names = [column.name for column in columns]
    others = sheet.without(columns)
    problems = [
        f"column {heading.text!r} is not known. {suggestion(heading.label, _COLUMNS)}"
        for heading in others
        if _resembles(heading.label)
    ]
    problems += sheet.problems_of(columns, _UNITS)
    if not problems and sum(name in _ABSCISSAE for name in names) != 1:
        problems.append(
            f"one column time_s, time_ms or distance_m is needed; the first line has {sheet.names}."
        )
    if not problems and len(names) < 2:
        wanted = [n for n, name in _COLUMNS.items() if name not in _ABSCISSAE]
        hints = [nearest(heading.label, wanted) for heading in others]
        hint = "".join(f" Did you mean {name}?" for name in hints if name)
        needed = f"one of the columns {', '.join(wanted)} is needed; there is {sheet.names}.{hint}"
        problems.append(needed)
    if problems:
        raise InputError(problems, sheet.source)


def _resembles(name: str) -> bool:
    """Return whether an unknown column begins like a known one, as a misspelt one does."""
    first = re.split(r"[\W_]", name.strip(), maxsplit=1)[0].lower()
    return first in {known.partition("_")[0] for known in _UNITS}


def _times(
    columns: dict[str, Array], lines: Sequence[int], speed: float | None, source: str
) -> Array:
    """Return times that begin with zero [s], or raise an `InputError` if they decrease."""
    if "distance" in columns:
        if speed is None or not (math.isfinite(speed) and speed > 0.0):
            given = "none is given" if speed is None else f"{speed * KM_PER_H:g} km/h is given"
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
