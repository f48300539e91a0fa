"""What the page's script reads: samples on the grid, and how to show them."""

import json
from typing import Any

import numpy as np

from ..input.suspension import Suspension
from .curves import Curve
from .encode import packed
from .grid import Axis, Grid
from .motion import Motion, NoMotion, TimeCurve
from .plotted import decimals, shown_range
from .poses import Poses

# Of the drawing only [m]; the radius where the data do not tell it.
TYRE_WIDTH = 0.205
TYRE_RADIUS = 0.3


def page_data(
    suspension: Suspension,
    grid: Grid,
    sampled: Poses,
    drawn: list[dict[str, Any]],
    motion: Motion | NoMotion,
) -> str:
    """Return the data of the page as JSON that may stand inside of an HTML element.

    Parameters
    ----------
    suspension : Suspension
    grid : Grid
    sampled : Poses
        On the grid.
    drawn : list of dict
        Characteristics, each as `curve_data` returns it.
    motion : Motion or NoMotion

    Returns
    -------
    str
    """
    data = {
        "grid": {"travel": _axis(grid.travel), "rack": _axis(grid.rack)},
        "points": {
            name: packed(values, values[grid.travel.zero, grid.rack.zero])
            for name, values in sampled.points.items()
        },
        "spin_axis": packed(sampled.spin_axis, sampled.spin_axis[grid.travel.zero, grid.rack.zero]),
        "curves": drawn,
        "motion": _motion(motion) if isinstance(motion, Motion) else None,
        **_drawing(suspension, grid, sampled),
    }
    # "</" inside of a string would end the element that holds the data
    return json.dumps(data, ensure_ascii=False, allow_nan=False).replace("</", "<\\/")


def curve_data(curve: Curve, grid: Grid, shown: tuple[float, float], places: int) -> dict[str, Any]:
    """Return one characteristic as the page's script takes it.

    Parameters
    ----------
    curve : Curve
    grid : Grid
    shown : tuple of float
        Values between which it is plotted, in SI units.
    places : int
        Decimals with which it is written.

    Returns
    -------
    dict
    """
    design = curve.values[grid.travel.zero, grid.rack.zero]
    low, high = sorted(end * curve.factor for end in shown)
    words = {"over": curve.over, **_shown(curve, (low, high), places)}
    return words | packed(curve.values, design)


def _motion(motion: Motion) -> dict[str, Any]:
    return {
        "time": _axis(motion.time),
        "travel": packed(motion.travel),
        "rack": packed(motion.rack),
        "spin": packed(motion.spin),
        "signals": [_time_curve(curve) for curve in motion.signals],
    }


def _time_curve(curve: TimeCurve) -> dict[str, Any]:
    low, high = (end * curve.factor for end in shown_range(curve.values))
    words = {"over": "time", **_shown(curve, (low, high), decimals(low, high))}
    return words | packed(curve.values)


def _shown(curve: Curve | TimeCurve, shown: tuple[float, float], places: int) -> dict[str, Any]:
    """Return how a curve is drawn and written."""
    return {
        "key": curve.key,
        "unit": curve.unit,
        "factor": curve.factor,
        "decimals": places,
        "range": shown,
        # what hardly changes in the digits that are written is drawn flat
        "least": 4.0 * 10.0**-places,
    }


def _axis(axis: Axis) -> dict[str, float]:
    return {"first": axis.first, "step": axis.step, "count": axis.count}


def _drawing(suspension: Suspension, grid: Grid, sampled: Poses) -> dict[str, Any]:
    """Return what the 3D view needs besides: sizes, directions and the road, in metres."""
    at_design = {
        name: values[grid.travel.zero, grid.rack.zero] for name, values in sampled.points.items()
    }
    parameters = suspension.parameters()
    rack = np.array([parameters[f"rack_axis_{c}"] for c in "xyz"])
    x, y, z = at_design["wheel_center"]
    loaded = suspension.tyre_radius() or TYRE_RADIUS
    # free of force, the tyre is larger by what it is compressed at design
    radius = loaded + float(np.clip(parameters["tyre_free_height"] - z, 0.0, 0.2 * loaded))
    corners = np.array([*at_design.values(), [x, y, z + radius], [x, y, z - loaded]])
    low, high = corners.min(axis=0), corners.max(axis=0)
    return {
        "side_sign": suspension.vehicle.sign,
        "road_height": float(z) - loaded,
        "tyre": {"radius": radius, "width": TYRE_WIDTH},
        "strut_length": float(np.linalg.norm(at_design["strut_top"] - at_design["ball_joint"])),
        "rack_inward": (-suspension.vehicle.sign * np.sign(rack[1] or 1.0) * rack).tolist(),
        "middle": (0.5 * (low + high)).tolist(),
        "size": float(np.linalg.norm(high - low)),
    }
