"""Data of the page's script: samples on the grid, ranges and decimals."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from markupsafe import Markup

from ...core.named_types import Array
from ...pages.embedded import embedded
from ..assembly.quantity import displaced_by
from ..kinds import Suspension
from .accuracy import GridAccuracy
from .curves import CharacteristicCurve
from .encode import packed
from .grid import Grid, GridAxis
from .marks import Marks
from .motion import NoMotion, ReportedMotion, TimeCurve
from .plotted import decimals, full_range
from .poses import Poses

# Tyre of the drawing [m]; the radius of files without one.
TYRE_WIDTH = 0.205
TYRE_RADIUS = 0.3


class Look(NamedTuple):
    """Appearance of a curve, in its display unit."""

    shown: tuple[float, float]  # plotted range
    decimals: int  # number of decimals of written values
    error: float = 0.0  # greatest error of interpolated values


@dataclass(frozen=True)
class ReportSamples:
    """All samples of a report, on a grid."""

    grid: Grid
    poses: Poses
    curves: list[CharacteristicCurve]
    gaps: list[Array]  # open gaps of stops
    accuracy: GridAccuracy
    looks: dict[str, Look]  # by the key of a curve
    marks: Marks
    motion: ReportedMotion | NoMotion


def page_data(suspension: Suspension, samples: ReportSamples) -> Markup:
    """Return the data of the page as JSON that is safe inside an HTML element."""
    grid, drawn, motion = samples.grid, samples.curves, samples.motion
    stored = _stored_under(drawn)
    data = {
        "grid": {"travel": _axis(grid.travel), "rack": _axis(grid.rack)},
        "steering": displaced_by(suspension.steered_by).long_name,
        "points": {name: _on_grid(values, grid) for name, values in samples.poses.points.items()},
        "spin_axis": _on_grid(samples.poses.spin_axis, grid),
        "samples": {c.key: _on_grid(c.smooth, grid) for c in drawn if stored[c.key] == c.key},
        "gaps": [_on_grid(gap, grid) for gap in samples.gaps],
        "curves": [
            {
                "over": curve.over,
                "jumps": curve.jumps,
                "samples": stored[curve.key],
                "reciprocal": curve.reciprocal,
                "goals": [mark.described(curve) for mark in samples.marks.of.get(curve.key, ())],
                **_described(curve, samples.looks[curve.key]),
            }
            for curve in drawn
        ],
        "motion": _motion(motion) if isinstance(motion, ReportedMotion) else None,
        **_drawing(suspension, grid, samples.poses),
    }
    return embedded(data)


def _stored_under(drawn: list[CharacteristicCurve]) -> dict[str, str]:
    """Return the key of the curve with the same samples, by the key of each curve."""
    along = {curve.name: curve for curve in drawn if curve.over == "travel"}
    return {
        curve.key: twin.key
        # equal but for the rounding of two ways to compute them
        if (twin := along.get(curve.name)) is not None
        and np.allclose(curve.values, twin.values, rtol=1e-9, atol=1e-12, equal_nan=True)
        else curve.key
        for curve in drawn
    }


def _on_grid(values: Array, grid: Grid) -> dict[str, Any]:
    return packed(values, values[grid.travel.zero, grid.rack.zero])


def _motion(motion: ReportedMotion) -> dict[str, Any]:
    return {
        "time": _axis(motion.time),
        "travel": packed(motion.travel),
        "rack": packed(motion.rack),
        "spin": packed(motion.spin),
        "signals": [_time_curve(curve) for curve in motion.signals],
    }


def _time_curve(curve: TimeCurve) -> dict[str, Any]:
    low, high = (end * curve.factor for end in full_range(curve.values))
    words = _described(curve, Look((low, high), decimals(low, high, unit=curve.unit)))
    return {"over": "time", **words, **packed(curve.values)}


def _described(curve: CharacteristicCurve | TimeCurve, look: Look) -> dict[str, Any]:
    """Return unit, range and decimals of a curve."""
    return {
        "key": curve.key,
        "unit": curve.unit,
        "factor": curve.factor,
        "decimals": look.decimals,
        # the last decimal is not right to rounding
        "approximate": not look.error <= 0.5 * 10.0**-look.decimals,
        "range": look.shown,
        # a smaller range is drawn flat
        "least": 4.0 * max(10.0**-look.decimals, 2.0 * look.error),
    }


def _axis(axis: GridAxis) -> dict[str, float]:
    return {"first": axis.first, "step": axis.step, "count": axis.count}


def _drawing(suspension: Suspension, grid: Grid, sampled: Poses) -> dict[str, Any]:
    """Return further data of the 3D view: sizes, directions and the road [m]."""
    at_design = {
        name: values[grid.travel.zero, grid.rack.zero] for name, values in sampled.points.items()
    }
    parameters = suspension.parameters()
    steered = suspension.steered()
    rack = np.array([parameters[f"rack_axis_{c}"] if steered else 0.0 for c in "xyz"])
    x, y, z = at_design["wheel_center"]
    loaded = suspension.tyre_radius() or TYRE_RADIUS
    # without load, the tyre is larger by its compression at design
    radius = loaded + float(np.clip(parameters["tyre_free_height"] - z, 0.0, 0.2 * loaded))
    corners = np.array([*at_design.values(), [x, y, z + radius], [x, y, z - loaded]])
    low, high = corners.min(axis=0), corners.max(axis=0)
    return {
        "suspension": suspension.suspension,
        "steered": steered,
        "linkage": _linkage(suspension),
        "side_sign": suspension.vehicle.sign,
        "road_height": float(z) - loaded,
        "tyre": {"radius": radius, "width": TYRE_WIDTH},
        "on_rack": suspension.rack is not None,
        "rack_inward": (-suspension.vehicle.sign * np.sign(rack[1] or 1.0) * rack).tolist(),
        "middle": (0.5 * (low + high)).tolist(),
        "size": float(np.linalg.norm(high - low)),
    }


def _linkage(suspension: Suspension) -> dict[str, Any]:
    """Return the points of arms, spring, damper and steering axis."""
    drawing, points = suspension.drawing(), suspension.hardpoints
    return {
        "arms": [(*bearings, ball) for ball, bearings in points.ARMS.items()],
        "brackets": dict(drawing.brackets),
        "damper": drawing.damper._asdict(),
        "spring": drawing.spring._asdict(),
        "upright": drawing.upright,
        "steering_axis": points.STEERING_AXIS,
    }
