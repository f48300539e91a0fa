"""Positions of a suspension, or of a batch of them, at given wheel heights."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...core.errors import InputError
from ...core.named_types import Array, ArrayLike
from ...core.validator import Validator
from ...systems.state import State
from ..input.vehicle import TyreSection
from .model import Model
from .model_batch import ModelBatch
from .reach import (
    ARM_STEPS,
    AngleRange,
    Branch,
    PositionError,
    at_rest,
    branch,
    ends_of,
    height_and_slope,
    margins_at,
    steps_covering,
    tabulated,
    travel_range,
    way_of_rack,
)
from .swing import margins_stay

__all__ = [
    "AngleRange",
    "PositionError",
    "arm_angles",
    "design_height",
    "road_under_load",
    "state_at_height",
    "travel_range",
]


# Newton's method needs five steps if the height is smooth; after this number every other step
# halves the bracket, which is two degrees at first.
_NEWTON_STEPS = 10
_MOST_STEPS = 120
# Tolerance of heights at the ends of the range, and of heights that are met [m].
_ROUNDING = 1e-12
# Further tolerance, in roundings of the arm's angle.
_ROUNDINGS = 8.0
_EPSILON = float(np.finfo(np.float64).eps)


def design_height(model: Model) -> float:
    """Return the height of the wheel centre at the design position [m]."""
    with Validator("design_height") as given:
        given.instance("model", model, Model, Model.NEEDED)
    return float(model.signal("wheel_center_z", model.design_state))


def arm_angles(model: Model, height: ArrayLike, rack_position: ArrayLike = 0.0) -> Array:
    """Return the arm angles at which the wheel centre has given heights.

    Parameters
    ----------
    model : Model
    height : array_like
        Heights of the wheel centre: its z in chassis axes [m].
    rack_position : array_like, optional
        Displacements of the rack [m]; broadcast with the heights.

    Returns
    -------
    ndarray
        Arm angles [rad], of the broadcast shape. The heights are met to rounding.

    Raises
    ------
    PositionError
        If a height is out of reach; the message states the range. Or if it cannot be met because of
        rounding beside a dead point.
    InputError
        If a value is not finite.

    Examples
    --------
    >>> from kintrafo import Model, arm_angles
    >>> model = Model("reference_car")
    >>> (model.design_state[0] - arm_angles(model, [0.3, 0.325])).round(9).tolist()
    [0.0, 0.068123601]
    """
    with Validator("positions") as given:
        given.instance("model", model, Model, Model.NEEDED)
        heights = given.array("height", height, "m", empty=True)
        racks = given.array("rack_position", rack_position, "m", empty=True)
        try:
            heights, racks = np.broadcast_arrays(heights, racks)
        except ValueError:
            given.fail(
                f"height and rack_position have the shapes {heights.shape} and {racks.shape}, "
                "which do not broadcast. Give one of them as a single number."
            )
    if heights.size == 0:
        return np.empty(heights.shape)
    distinct, index = np.unique(racks.ravel(), return_inverse=True)
    table = branch(model, distinct, covering=(float(heights.min()), float(heights.max())))
    if _beyond(heights.ravel(), table, index).any():
        table = branch(model, distinct, to_the_end=True)
    _refuse_out_of_reach(model, heights.ravel(), distinct[index], table, index)
    within = np.clip(heights.ravel(), table.height[index, 0], table.height[index, -1])
    found, error, most = solve(model, within[:, None], distinct[index], table.of(index))
    _refuse_missed(within, distinct[index], error[:, 0], most[:, 0])
    return found.reshape(heights.shape)


def arm_angles_of_batch(
    batch: ModelBatch, travel: Array, rack: Array
) -> tuple[Array, NDArray[np.bool_]]:
    """Return the arm angles of a batch at given wheel travels, (count, positions) [rad].

    Travels and displacements of the rack have the shape (positions,) [m]. The range of each
    suspension is tabulated from its design position up to the heights of the first one, and to its
    end if this table does not cover its heights. The second result, (count,), is whether a
    suspension certainly reaches all travels. Others, whose heights are out of reach or not met to
    rounding, have the angles at design and are computed one by one.
    """
    design = batch.design_state[..., 0]
    wanted = height_and_slope(batch, design)[0] + travel
    angles = np.broadcast_to(design, wanted.shape).copy()
    found = _racks_reach(batch, rack)
    for at in np.unique(rack):
        same = np.flatnonzero(rack == at)
        heights = wanted[:, same]
        steps = steps_covering(
            branch(batch.first, [at]).height, (heights[0].min(), heights[0].max())
        )
        rows, met = np.arange(len(wanted)), np.zeros(len(wanted), dtype=bool)
        for how_far, to_the_end in ((steps, False), ((ARM_STEPS, ARM_STEPS), True)):
            part, racks = batch.of(rows), np.full(rows.size, at)
            table = tabulated(part, racks, how_far, ends_of(part, racks) if to_the_end else None)
            within = np.flatnonzero(_covers(table, heights[rows]))
            some = rows[within]
            if some.size:
                at_heights, off, most = solve(
                    batch.of(some), heights[some], racks[within], table.of(within)
                )
                angles[np.ix_(some, same)], met[some] = at_heights, (off <= most).all(axis=1)
            rows = np.delete(rows, within)
            if not rows.size:
                break
        found &= met
    angles[~found] = design[~found]
    return angles, found


def _covers(table: Branch, heights: Array) -> NDArray[np.bool_]:
    """Return whether rows of a table cover all heights, with a range of more than a point."""
    low, high = table.height[:, :1], table.height[:, -1:]
    return np.asarray(((heights >= low) & (heights <= high) & (low < high)).all(axis=1))


def _racks_reach(batch: ModelBatch, rack: Array) -> NDArray[np.bool_]:
    """Return whether the rack of each reaches both ends with the arm at design, (count,)."""
    design = batch.design_state[..., 0]
    valid = np.ones(len(design), dtype=bool)
    for end in {float(rack.min()), float(rack.max())} - {0.0}:
        way = way_of_rack(end)
        angles = np.broadcast_to(design, (len(design), way.size))
        valid &= margins_stay(margins_at(batch, *at_rest(batch, angles, way))).all(axis=1)
    return valid


def state_at_height(
    model: Model, height: float, *, rack_position: float = 0.0, spin_rate: float = 0.0
) -> State:
    """Return the state with zero rates at which the wheel centre has a given height.

    Parameters
    ----------
    model : Model
    height : float
        Height of the wheel centre: its z in chassis axes [m].
    rack_position : float, optional
        Displacement of the rack [m].
    spin_rate : float, optional
        Rate of the wheel relative to the knuckle, positive rolling forward [rad/s].

    Returns
    -------
    State
        The state, with zero rates except that of the wheel's spin. It contains the position of the
        rack as an input, for every function that takes a state and inputs.

    Raises
    ------
    PositionError
        If the height is out of reach; the message states the range.

    Examples
    --------
    >>> from kintrafo import Model, state_at_height
    >>> model = Model("reference_car")
    >>> state = state_at_height(model, 0.325)
    >>> round(float(model.design_state[0] - state[0]), 10)
    0.068123601
    """
    with Validator("state_at_height") as given:
        given.instance("model", model, Model, Model.NEEDED)
        height = given.number("height", height, "m")
        rack_position = given.number("rack_position", rack_position, "m")
        spin_rate = given.number("spin_rate", spin_rate, "rad/s")
    angle = float(arm_angles(model, height, rack_position))
    state, inputs = at_rest(model, angle, rack_position)
    state[model.state_names.index(f"{model.names.spin}_rate")] = spin_rate
    return State.of(state, inputs, model.names_of_states)


def road_under_load(
    model: Model, wheel_load: float, state: ArrayLike, inputs: ArrayLike | None = None
) -> Array:
    """Return the height of the road under a wheel at rest for a given load.

    Parameters
    ----------
    model : Model
    wheel_load : float
        Vertical force of the road on the wheel, positive up [N].
    state, inputs : array_like
        One or many states, over leading dimensions, and their inputs, SI units.

    Returns
    -------
    ndarray
        Heights for the input ``road_height``, of the shape of the leading dimensions [m].

    Raises
    ------
    InputError
        If the load is not a finite number of 0 N or more, or the tyre has no stiffness.
    """
    with Validator("wheel load") as given:
        given.instance("model", model, Model, Model.NEEDED)
        advice = "A road only pushes."
        wheel_load = given.number("wheel_load", wheel_load, "N", least=0.0, advice=advice)
    height: Array = model.signal("wheel_center_z", state, inputs)
    return road_below(height, model.suspension.tyre, wheel_load)


def road_below(height: Array, tyre: TyreSection, load: float) -> Array:
    """Return the height of the road for a load of the tyre, from heights of the wheel centre [m].

    A tyre without stiffness raises an `InputError`.
    """
    values = tyre.parameters()
    if values["tyre_rate"] == 0.0:
        problem = (
            "[tyre] rate_N_per_m = 0 N/m: a tyre without stiffness carries no load. Enter its rate."
        )
        raise InputError([problem], "wheel load")
    return height + load / values["tyre_rate"] - values["tyre_free_height"]


def _beyond(heights: Array, table: Branch, index: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Return whether heights are outside of the table."""
    too_low: NDArray[np.bool_] = heights < table.height[index, 0] - _ROUNDING
    too_high: NDArray[np.bool_] = heights > table.height[index, -1] + _ROUNDING
    return too_low | too_high


def _refuse_out_of_reach(
    model: Model, heights: Array, racks: Array, table: Branch, index: NDArray[np.int64]
) -> None:
    beyond = _beyond(heights, table, index)
    if not beyond.any():
        return
    # the farthest height, which a caller recognises as the end of its range
    worst = np.abs(heights[beyond] - design_height(model)).argmax()
    height, rack = float(heights[beyond][worst]), float(racks[beyond][worst])
    reach = travel_range(model, rack)
    ends = _rounded_inward(reach.height)
    travels = _rounded_inward([end - design_height(model) for end in reach.height])
    held = f" with the rack at {rack * 1e3:g} mm" if model.suspension.steered() else ""
    message = (
        f"wheel height {1e3 * height:.6g} mm is out of reach: from {ends[0]:.2f} mm "
        f"({reach.lower_limit}) to {ends[1]:.2f} mm ({reach.upper_limit}){held}; that is "
        f"{travels[0]:+.2f} mm to {travels[1]:+.2f} mm of wheel travel from design. "
        "Choose a height within this range."
    )
    raise PositionError(message)


def _rounded_inward(ends: Sequence[float]) -> tuple[float, float]:
    """Return a range in whole hundredths of a millimetre that lies within the given one [m]."""
    low, high = (1e5 * end for end in ends)
    return math.ceil(low) / 100.0, math.floor(high) / 100.0


def solve(model: Model, heights: Array, racks: Array, table: Branch) -> tuple[Array, Array, Array]:
    """Return arm angles [rad] at heights within a table of the range, with errors and tolerances.

    The results, (rows, positions) as the heights of the wheel centre [m], are the angles, the
    errors of the heights, and their tolerances by rounding [m]. The model is one, or a batch with a
    model per row, with a displacement of the rack, (rows,) [m].

    Newton's method with the exact slope starts from a cubic between neighbours of the table, and
    falls back on halving the bracket: beside a dead point the height is not a smooth function of
    the angle, and Newton's step may leave the bracket there.
    """
    angle, ends, at_ends, slopes = _brackets(heights, table)
    low, high = ends
    errors = np.abs(at_ends - heights)
    lower = errors[0] <= errors[1]
    found: Array = np.where(lower, low, high)
    error, slope = errors.min(axis=0), np.where(lower, slopes[0], slopes[1])
    # at an end of the bracket, such as design, Newton's step leaves it by a rounding
    rows = np.flatnonzero((error > np.spacing(np.abs(heights))).any(axis=1))
    for count in range(_MOST_STEPS):
        if rows.size == 0:
            break
        at = angle[rows]
        height, by_angle = height_and_slope(model.of(rows), at, racks[rows, None])
        excess = height - heights[rows]
        better = np.abs(excess) < error[rows]
        for whole, new in ((found, at), (error, np.abs(excess)), (slope, by_angle)):
            whole[rows] = np.where(better, new, whole[rows])
        # the height rises as the angle falls
        low[rows] = np.where(excess <= 0.0, at, low[rows])
        high[rows] = np.where(excess >= 0.0, at, high[rows])
        newton = at - excess / by_angle
        halve = (newton > low[rows]) | (newton < high[rows])
        if count >= _NEWTON_STEPS:
            halve |= count % 2 == 0
        angle[rows] = np.where(halve, 0.5 * (low[rows] + high[rows]), newton)
        moving = np.abs(angle[rows] - at) > 4.0 * _EPSILON * np.abs(at)
        rows = rows[((excess != 0.0) & moving).any(axis=1)]
    return found, error, _ROUNDING + _ROUNDINGS * np.spacing(np.abs(found)) * np.abs(slope)


def _brackets(heights: Array, table: Branch) -> tuple[Array, Array, Array, Array]:
    """Return angles at heights by a cubic, and angles, heights and slopes of the neighbours."""
    points = table.height.shape[1]
    right = np.clip((table.height[:, None] < heights[..., None]).sum(axis=-1), 1, points - 1)
    ends, at_ends, slopes = (
        np.stack([np.take_along_axis(values, i, axis=1) for i in (right - 1, right)])
        for values in (table.angle, table.height, table.slope)
    )
    with np.errstate(all="ignore"):  # an end is repeated, and its slope may be zero
        rise, change = at_ends[1] - at_ends[0], ends[1] - ends[0]
        part = (heights - at_ends[0]) / rise
        first, last = rise / slopes
        bend, twist = 3.0 * change - 2.0 * first - last, first + last - 2.0 * change
        start = ends[0] + part * (first + part * (bend + part * twist))
        inside = (start <= ends[0]) & (start >= ends[1])
    return np.where(inside, start, 0.5 * (ends[0] + ends[1])), ends, at_ends, slopes


def _refuse_missed(heights: Array, racks: Array, error: Array, most: Array) -> None:
    """Refuse heights that are not met to rounding."""
    missed = ~(error <= most)
    if not missed.any():
        return
    first = int(missed.argmax())
    message = (
        f"wheel height {heights[first] * 1e3:.6g} mm with the rack at {racks[first] * 1e3:g} mm is "
        f"missed by {error[first] * 1e3:.2g} mm: rounding moves the wheel by that much so near to "
        "a dead point. Choose another height, or correct the hardpoints."
    )
    raise PositionError(message)
