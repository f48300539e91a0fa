"""Poses of a suspension over wheel travel and rack displacement."""

from dataclasses import dataclass

import numpy as np

from ...core.named_types import Array
from ..models.model import Model
from ..models.points import hardpoints
from ..models.positions import PositionError, arm_angles, design_height, travel_range
from ..models.reach import at_rest
from .grid import Grid, GridAxis

TRAVEL = 0.100  # to either side of the design position, within the reach [m]
TRAVEL_STEP = 0.005  # [m]
RACK = 0.060  # to either side of its middle position, within the reach [m]
RACK_STEP = 0.0025  # about one degree of steering [m]

# Equal columns for a suspension without a rack, as many as a cubic needs.
_STILL = GridAxis.around_zero(-2.0 * RACK_STEP, 2.0 * RACK_STEP, RACK_STEP)
# Margin to the end of the reach, where the path of the wheel turns back [m].
_MARGIN = 0.002


@dataclass(frozen=True)
class Poses:
    """Positions of the moving points, and the axis of the wheel."""

    points: dict[str, Array]  # positions of hardpoints by name, chassis axes, (..., 3) [m]
    # unit vector along the axis of the wheel, pointing left at zero camber and toe, (..., 3)
    spin_axis: Array


def reachable_grid(model: Model) -> Grid:
    """Return the grid of usual travel and rack displacement within the reach of a suspension.

    A `PositionError` is raised if a small rectangle around the design position is out of reach.
    """
    design = design_height(model)
    if not model.suspension.steered():
        travel = _travel(travel_range(model).height, design)
        if travel is not None:
            return Grid(travel, _STILL)
        raise PositionError(
            f"the wheel cannot travel {TRAVEL_STEP * 1e3:g} mm up and down, so there is nothing to "
            "report. Check the hardpoints of the arm."
        )
    for rack in np.arange(RACK, 0.5 * RACK_STEP, -RACK_STEP):
        ends = _common_reach(model, float(rack))
        if ends is None:
            continue
        travel = _travel(ends, design)
        if travel is not None:
            return Grid(travel, GridAxis.around_zero(-float(rack), float(rack), RACK_STEP))
    raise PositionError(
        f"the wheel cannot travel {TRAVEL_STEP * 1e3:g} mm up and down with the rack "
        f"{RACK_STEP * 1e3:g} mm to either side, so there is nothing to report. Check the "
        "lengths of tie rod, arms and strut."
    )


def _travel(ends: tuple[float, float], design: float) -> GridAxis | None:
    """Return the usual travel within a reach of the wheel; None if it is too small."""
    low, high = max(ends[0] - design + _MARGIN, -TRAVEL), min(ends[1] - design - _MARGIN, TRAVEL)
    if low < -TRAVEL_STEP and high > TRAVEL_STEP:
        return GridAxis.around_zero(low, high, TRAVEL_STEP)
    return None


def _common_reach(model: Model, rack: float) -> tuple[float, float] | None:
    """Return the range of wheel heights with the rack at zero and at either side of it."""
    try:
        reaches = [travel_range(model, r).height for r in (-rack, 0.0, rack)]
    except PositionError:
        return None
    return max(low for low, _ in reaches), min(high for _, high in reaches)


def racks_of(model: Model, columns: Array) -> Array:
    """Return the rack displacement in each column of the grid; zeros without a rack."""
    return columns if model.suspension.steered() else np.zeros_like(columns)


def poses(model: Model, travel: Array, rack: Array) -> Poses:
    """Return poses at every combination of travels (n,) and rack displacements (m,), (n, m, 3)."""
    heights, rack = design_height(model) + travel[:, None], racks_of(model, rack)
    states, inputs = at_rest(model, arm_angles(model, heights, rack), rack)
    points = hardpoints(model, states, inputs)
    parameters = model.suspension.parameters()
    axis = np.array([parameters[f"spin_axis_{c}"] for c in "xyz"])
    rotations = model.evaluate("orientations", states, inputs)
    carrier = rotations[..., model.equations.BODIES.index(model.suspension.carrier), :, :]
    return Poses({name: np.array(p) for name, p in points.items()}, carrier @ axis)
