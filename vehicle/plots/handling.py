"""Curves of manoeuvres over time, lateral acceleration or frequency, and paths between cones."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib import colormaps, rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ...core.files import Paths
from ...core.named_types import Array
from ...core.quantities import displayed, heading_of, long_name, names_in_words
from ...pictures.curves import draw, named_values, varying
from ...pictures.figures import BLUE, ORANGE, STYLE, save, written_plainly
from ..assembly.by_wheel import WHEEL

# The drawn curves by their axis, in their order, if they exist and vary.
_SHOWN: Mapping[str, tuple[str, ...]] = {
    "time": (
        "steering_wheel_angle", "steering_torque", "lateral_acceleration", "yaw_rate",
        "sideslip_angle", "roll_angle", "speed", "longitudinal_acceleration", "pitch_angle", "fz",
    ),
    "lateral_acceleration": (
        "steering_wheel_angle", "steering_torque", "steer_angle", "understeer_gradient",
        "sideslip_angle", "roll_angle", "drive_torque", "slip_angle", "fz", "fy",
    ),
    "steering_wheel_angle": (
        "steering_torque", "lifting_torque", "friction_torque", "mz", "steer", "fz",
    ),
    "speed": (
        "yaw_rate_gain", "lateral_acceleration_gain", "understeer_gradient", "sideslip_gradient",
        "roll_gradient", "steering_torque_gradient", "drive_torque", "growth",
    ),
    "frequency": (
        "yaw_rate_gain", "lateral_acceleration_gain", "sideslip_angle_gain", "yaw_rate_phase",
        "lateral_acceleration_phase", "sideslip_angle_phase",
    ),
}  # fmt: skip
# Curves over time that come first on a road with heights.
_ON_A_ROAD = ("road", "vertical_acceleration")
_SIDESLIP = "sideslip_angle"
# Curves without larger values, in display units, are rounding: steering torque straight ahead.
_ROUNDING = 1e-6
_COLUMNS = 3
# Least drawn width of a path [m].
_LEAST = 2.0
# Time between two outlines of the car [s].
_BETWEEN = 0.5
# Width of the picture of a path, and its greatest height [in].
_WIDE, _HIGH = 10.0, 7.0


def write_curves(
    dataset: xr.Dataset,
    path: str | Path,
    *,
    title: str = "",
    force: bool = False,
    inputs: Paths = (),
) -> Path:
    """Write the main curves of a manoeuvre."""
    along = _along(dataset)
    # the first dimension is the axis; several runs are lines
    shown, names = for_print(dataset.transpose(along, ...), along), first_names(dataset)
    with rc_context(STYLE):
        drawn = draw(shown, names, title=title, alone=False, columns=_COLUMNS)
        return save(drawn, path, force=force, inputs=inputs)


def first_names(dataset: xr.Dataset) -> list[str]:
    """Return the names of the main curves of a manoeuvre, in their order."""
    moving = {str(name) for name in varying(dataset)}
    further = _ON_A_ROAD if "road" in dataset else ()
    there = [name for name in (*further, *_SHOWN[_along(dataset)]) if name in moving]
    return [name for name in there if np.nanmax(np.abs(displayed(dataset[name]))) > _ROUNDING]


def _along(dataset: xr.Dataset) -> str:
    return next(name for name in _SHOWN if name in dataset.dims)


def for_print(dataset: xr.Dataset, along: str) -> xr.Dataset:
    """Return curves with the names of wheels in words, and a sideslip angle without jumps."""
    if WHEEL in dataset.dims:
        dataset = dataset.assign_coords({WHEEL: names_in_words(dataset[WHEEL])})
    if along == "time" and _SIDESLIP in dataset:
        angle = dataset[_SIDESLIP]
        turned = np.unwrap(angle.values, axis=angle.get_axis_num(along))
        dataset = dataset.assign({_SIDESLIP: angle.copy(data=turned)})
    return dataset


def write_path(
    motion: xr.Dataset,
    path: str | Path,
    *,
    cones: xr.Dataset | None = None,
    wanted: Array | None = None,
    title: str = "",
    force: bool = False,
    inputs: Paths = (),
) -> Path:
    """Write the path of the reference point of a car in one run or several, and cones, if any."""
    with rc_context(STYLE):
        x, y = (np.atleast_2d(displayed(motion[name])) for name in ("x", "y"))
        spans = [float(np.nanmax(values) - np.nanmin(values)) + 1.0 for values in (x, y)]
        equal = spans[1] * _WIDE > 0.3 * _HIGH * spans[0]
        height = min(max(_WIDE * spans[1] / spans[0] + 1.2, 3.0), _HIGH) if equal else 3.4
        figure = Figure(figsize=(_WIDE, height), layout="constrained")
        axes = figure.subplots()
        scale = colormaps["viridis"]
        colours = [scale(0.9 * i / (len(x) - 1)) for i in range(len(x))] if len(x) > 1 else [BLUE]
        lines = [
            axes.plot(row_x, row_y, color=colour)[0]
            for row_x, row_y, colour in zip(x, y, colours, strict=True)
        ]
        if wanted is not None and wanted.size:
            axes.plot(*wanted.T, "--", color=ORANGE, linewidth=1.0, label="path to follow")
            lines[0].set_label("car")
            axes.legend(fontsize=8, loc="best")
        if len(lines) > 1:
            _name_runs(axes, lines, motion)
        low, high = axes.get_ylim()
        if high - low < _LEAST:
            middle = 0.5 * (low + high)
            axes.set_ylim(middle - 0.5 * _LEAST, middle + 0.5 * _LEAST)
        if cones is not None:
            _draw_car(axes, motion, cones.attrs)
            _draw_cones(axes, cones)
        if equal:
            axes.set_aspect("equal", adjustable="datalim")
        axes.set_xlabel(heading_of(motion["x"]))
        stretched = "" if equal else ", stretched"
        axes.set_ylabel(f"{heading_of(motion['y'])}\n{motion['y'].attrs['sign']}{stretched}")
        figure.suptitle(title, fontsize=11)
        return save(written_plainly(figure), path, force=force, inputs=inputs)


def _name_runs(axes: Axes, lines: Sequence[Line2D], motion: xr.Dataset) -> None:
    """Draw a legend with the names of some runs."""
    runs = motion[next(str(name) for name in motion["x"].dims if name != "time")]
    names = named_values(runs)
    axes.legend(
        [lines[i] for i in names], list(names.values()), title=long_name(runs), loc="best",
        fontsize=8, title_fontsize=8,
    )  # fmt: skip


def _draw_car(axes: Axes, motion: xr.Dataset, size: Mapping[str, float]) -> None:
    """Draw the outline of the car at equal times."""
    front, half = size["car_front"], 0.5 * size["car_width"]
    back = front - size["car_length"]
    around = np.array([[front, half], [back, half], [back, -half], [front, -half], [front, half]])
    time = motion["time"].values
    for at in np.arange(time[0], time[-1], _BETWEEN):
        x, y, yaw = (
            float(np.interp(at, time, motion[name].values)) for name in ("x", "y", "yaw_angle")
        )
        c, s = np.cos(yaw), np.sin(yaw)
        corners = around @ np.array([[c, s], [-s, c]]) + [x, y]
        axes.plot(*corners.T, color="#999999", linewidth=0.8)


def _draw_cones(axes: Axes, cones: xr.Dataset) -> None:
    hit = ~(cones["clearance"].values > 0.0)
    x, y = (displayed(cones[name]) for name in ("x", "y"))
    axes.plot(x[~hit], y[~hit], "^", color=ORANGE, markersize=5, label="cones")
    if hit.any():
        axes.plot(x[hit], y[hit], "x", color="black", markersize=7, label="touched, or not passed")
    axes.legend(fontsize=8, loc="best")
