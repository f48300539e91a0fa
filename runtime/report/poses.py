"""The poses of a suspension over wheel travel and rack displacement."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..hardpoints import hardpoints
from ..model import Model
from ..positions import PositionError, travel_range
from .grid import Axis, Grid

Array = NDArray[np.float64]

TRAVEL = 0.100  # to either side of the design position, where the mechanism reaches [m]
TRAVEL_STEP = 0.0025  # [m]
RACK = 0.060  # to either side of its middle position, where the mechanism reaches [m]
RACK_STEP = 0.005  # [m]

# What the wheel must keep from the end of its reach, where its path turns back [m].
_MARGIN = 0.002
_NEWTON_STEPS = 50


@dataclass(frozen=True)
class Poses:
    """Where the moving points are, and where the wheel points.

    Attributes
    ----------
    points : dict
        Name of a hardpoint to its positions in chassis axes [m], shape (..., 3).
    spin_axis : ndarray, shape (..., 3)
        Unit vector along the axis of the wheel, pointing left at zero camber and toe.
    """

    points: dict[str, Array]
    spin_axis: Array


def reachable_grid(model: Model) -> Grid:
    """Return a grid of which the suspension reaches every point.

    Parameters
    ----------
    model : Model

    Returns
    -------
    Grid
        As much of the usual travel and rack displacement as the mechanism allows.

    Raises
    ------
    PositionError
        If even a small rectangle around the design position is out of reach.
    """
    design = design_height(model)
    for rack in np.arange(RACK, 0.5 * RACK_STEP, -RACK_STEP):
        ends = _common_reach(model, float(rack))
        if ends is None:
            continue
        low = max(ends[0] - design + _MARGIN, -TRAVEL)
        high = min(ends[1] - design - _MARGIN, TRAVEL)
        if low < -TRAVEL_STEP and high > TRAVEL_STEP:
            return Grid(
                Axis.around_zero(low, high, TRAVEL_STEP),
                Axis.around_zero(-float(rack), float(rack), RACK_STEP),
            )
    message = (
        f"the wheel cannot travel {TRAVEL_STEP * 1e3:g} mm up and down with the rack "
        f"{RACK_STEP * 1e3:g} mm to either side, so there is nothing to report. Check the "
        "lengths of tie rod and strut."
    )
    raise PositionError(message)


def _common_reach(model: Model, rack: float) -> tuple[float, float] | None:
    """Return the wheel heights that are reached with the rack at, and at either side of, zero."""
    try:
        reaches = [travel_range(model, r).height for r in (-rack, 0.0, rack)]
    except PositionError:
        return None
    return max(low for low, _ in reaches), min(high for _, high in reaches)


def design_height(model: Model) -> float:
    """Return the height of the wheel centre at design [m]."""
    return float(model.signal("wheel_center_z", model.design_state))


def poses(model: Model, travel: Array, rack: Array) -> Poses:
    """Compute poses at every combination of travels and rack displacements.

    Parameters
    ----------
    model : Model
    travel : ndarray, shape (n,)
        Wheel travel [m].
    rack : ndarray, shape (m,)
        Rack displacement [m].

    Returns
    -------
    Poses
        Arrays of shape (n, m, 3).
    """
    states, inputs = _states(model, travel, rack)
    points = hardpoints(model, states, inputs)
    parameters = model.suspension.parameters()
    axis = np.array([parameters[f"spin_axis_{c}"] for c in "xyz"])
    rotations = model.evaluate("orientations", states, inputs)
    knuckle = rotations[..., model.equations.BODIES.index("knuckle"), :, :]
    return Poses({name: np.array(p) for name, p in points.items()}, knuckle @ axis)


def _states(model: Model, travel: Array, rack: Array) -> tuple[Array, Array]:
    """Return states of rest and inputs, by Newton's method on all of them at once."""
    shape = (travel.size, rack.size)
    wanted = design_height(model) + np.broadcast_to(travel[:, None], shape)
    states = np.broadcast_to(model.design_state, (*shape, model.design_state.size)).copy()
    inputs = np.zeros((*shape, len(model.input_names)))
    if model.free_rack:
        states[..., model.state_names.index("beta9")] = rack
    else:
        inputs[..., model.input_names.index("rack_position")] = rack
    # with the arm turning at 1 rad/s, the wheel's velocity is its height's derivative by the angle
    turning = states.copy()
    turning[..., model.state_names.index("beta1_rate")] = 1.0
    for _ in range(_NEWTON_STEPS):
        turning[..., 0] = states[..., 0]
        signals = model.signals(turning, inputs)
        step = (signals["wheel_center_z"] - wanted) / signals["wheel_velocity"]
        # a tenth of a radian at most, so that a start far away does not jump over the reach
        states[..., 0] -= np.clip(step, -0.1, 0.1)
        if np.abs(step).max() < 1e-14:
            break
    return states, inputs
