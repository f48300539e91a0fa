"""Measured roads: two tracks of a table or of an OpenCRG file."""

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.errors import InputError
from ...core.legible import legible, short
from ...core.named_types import Array
from ...core.optional import require
from ...core.tables import read_table
from ...core.validator import Validator
from .road import MOST_POINTS, Road

if TYPE_CHECKING:
    from ...core.tables import Column, Table

_UNITS = {"distance": "m", "left_height": "m", "right_height": "m", "road_height": "m"}
_WORDS = "distance_m, and left_height_mm with right_height_mm, or road_height_mm"
_CRG = ".crg"


def read(path: str | Path, *, track: float = 1.5, spacing: float | None = None) -> Road:
    """Return the road of a file of measured heights.

    A table (CSV) has the columns ``distance_m``, and ``left_height_mm`` with ``right_height_mm`` or
    one ``road_height_mm`` for both tracks; units and spellings are those of
    `kintrafo.measurement.measured`. The road is linear between rows. An OpenCRG file (.crg) has a
    surface along a reference line, with a track on either side of it; PyOpenCRG, in the extra
    ``crg``, reads it. Its heights are relative to the mean of both tracks at their first points.

    Parameters
    ----------
    path : str or pathlib.Path
    track : float, optional
        Distance between the two tracks in an OpenCRG file [m].
    spacing : float, optional
        Distance along the road between two heights [m]; by default the smallest one of the file.

    Returns
    -------
    Road

    Raises
    ------
    InputError
        If the file cannot be read or has gaps, or the surface is narrower than the track.
    """
    with Validator("road") as given:
        given.path("path", path)
        track = given.number("track", track, "m", least=0.0)
        if spacing is not None:
            spacing = given.number("spacing", spacing, "m", above=0.0)
    of_crg = Path(path).suffix.lower() == _CRG
    distance, left, right = _surface(Path(path), track) if of_crg else _table(path)
    return _evenly(distance, left, right, spacing, str(path))


def _evenly(distance: Array, left: Array, right: Array, spacing: float | None, source: str) -> Road:
    """Return a road with equal spacing, by linear interpolation."""
    step = float(np.diff(distance).min()) if spacing is None else spacing
    length = float(distance[-1] - distance[0])
    count = round(length / step) + 1
    if not 4 <= count <= MOST_POINTS:
        problem = (
            f"{length:g} m at a spacing of {step:g} m are {count} points; 4 to {MOST_POINTS:,} "
            "are possible. Give a longer road, or another spacing."
        )
        raise InputError([problem], source)
    at = np.linspace(distance[0], distance[-1], count)
    tracks = [np.interp(at, distance, heights) for heights in (left, right)]
    words = f"the road of {legible(short(Path(source).name))}, {length:g} m"
    return Road(length / (count - 1), tracks[0], tracks[1], words)


def _table(path: str | Path) -> tuple[Array, Array, Array]:
    sheet = read_table(path)
    columns = sheet.columns(_UNITS)
    _check(sheet, columns)
    values = sheet.values_of(columns, _UNITS)
    distance = values["distance"]
    wrong = np.flatnonzero(np.diff(distance) <= 0.0)
    if wrong.size:
        line = sheet.rows[int(wrong[0]) + 1][0]
        problem = f"line {line}: the distance does not rise. Sort the rows, each distance once."
        raise InputError([problem], sheet.source)
    both = values.get("road_height")
    if both is not None:
        return distance, both, both
    return distance, values["left_height"], values["right_height"]


def _check(sheet: "Table", columns: "list[Column]") -> None:
    problems = sheet.problems_of(columns, _UNITS)
    wanted = ({"distance", "road_height"}, {"distance", "left_height", "right_height"})
    if {column.name for column in columns} not in wanted:
        problems.append(f"the columns {_WORDS} are needed; there is {sheet.names}.")
    if problems:
        raise InputError(problems, sheet.source)


def _surface(path: Path, track: float) -> tuple[Array, Array, Array]:
    crg = require("pyopencrg", purpose="Reading OpenCRG files", extra="crg")
    if not path.is_file():
        raise InputError(["There is no such file."], str(path))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of gaps: those under the tracks are refused below
            surface: Any = crg.read(str(path))
    except Exception as error:
        problem = f"PyOpenCRG cannot read it: {legible(str(error))}"
        raise InputError([problem], str(path)) from error
    aside = 0.5 * track
    low, high = float(surface.v_min), float(surface.v_max)
    if not low <= -aside <= aside <= high:
        problem = (
            f"a track of {1e3 * track:g} mm is from v = {-aside:g} m to {aside:g} m, and the "
            f"surface from {low:g} m to {high:g} m. Give a road that is wide enough."
        )
        raise InputError([problem], str(path))
    _refuse_gaps(surface, aside, path)
    distance = np.asarray(surface.u, dtype=float)
    left, right = (
        np.asarray(surface.uv_to_z(distance, np.full_like(distance, v)), dtype=float)
        for v in (aside, -aside)
    )
    begin = 0.5 * (left[0] + right[0])
    return distance, left - begin, right - begin


def _refuse_gaps(surface: Any, aside: float, path: Path) -> None:
    """Refuse gaps of the surface under the tracks."""
    v = np.asarray(surface.v, dtype=float)
    above = np.clip(np.searchsorted(v, (-aside, aside)), 1, v.size - 1)
    heights = np.asarray(surface.z, dtype=float)[:, np.concatenate([above - 1, above])]
    missing = np.flatnonzero(~np.isfinite(heights).all(axis=1))
    if missing.size:
        problem = (
            f"{missing.size} of {len(heights)} rows have no height (NaN) under a track of "
            f"{2e3 * aside:g} mm, the first at u = {float(surface.u[missing[0]]):g} m. Fill the "
            "gaps, as by PyOpenCRG's fill_nan, or give another track."
        )
        raise InputError([problem], str(path))
