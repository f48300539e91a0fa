"""The range of wheel travel: the arm angles on the branch of the design position.

From the design position the arm is swung either way until a loop cannot close or the wheel centre
turns back. In between, the height of the wheel centre is a monotonic function of the arm angle, so
that every height within the range has exactly one position. `swing` ensures that no fold between
two evaluated angles is missed.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.errors import KintrafoError
from ...core.named_types import Array, ArrayLike
from ...core.validator import Validator
from ...systems.system import System
from .attitudes import Attitudes, attitudes_at, iterates
from .model import Model
from .swing import GOAL, UNRESOLVED, PlacesAlong, march, margins_stay, resolved

# Step of the evaluated arm angles [rad], up to a right angle from design.
ARM_STEP = np.deg2rad(2.0)
ARM_STEPS = 45
# Distance of the range from its limit [rad]. The margins are then some 1e-13 m^2, clear of their
# rounding, and the wheel is less than a nanometre from its last position.
_CLEARANCE = 1e-12
# The same with loops solved by iteration: where its straight path passes a point at which branches
# meet by less than some 1e-10 rad, roundings decide on which side.
_CLEARANCE_OF_ITERATION = 1e-9
# Rounding of lengths from the same numbers [m].
_LENGTH = 1e-12
_CHUNK = 500  # racks that are evaluated together, to bound the memory
_KEPT = 8  # cached tables, of so many racks each
_PROBES = 9  # racks that show which part of the range is of interest

_RACK_STEP = 0.002  # step of the rack from its middle to its position [m]
_MOST_RACK_STEPS = 1000

Ends = tuple[Array, NDArray[np.int64]]
"""The last angles within the range [rad], and the limits there, as in `_look`; (rows,) each."""

_TURNS_BACK = -1
_REASONS = {
    _TURNS_BACK: "the wheel centre turns back there",
    GOAL: "the arm has swung by a right angle",
    UNRESOLVED: "positions beyond it are not connected with it, or cannot be distinguished in "
    "double precision",
}


class PositionError(KintrafoError, ValueError):
    """A position that the suspension cannot reach, or no equilibrium within its travel."""


@dataclass(frozen=True)
class AngleRange:
    """The range of arm angles in which the wheel height changes monotonically, about design.

    Attributes
    ----------
    arm_angle : tuple of float
        Arm angles at the lowest and at the highest wheel position [rad].
    height : tuple of float
        Lowest and highest height of the wheel centre: its z in chassis axes [m]. Less the height at
        design it is the wheel travel.
    lower_limit, upper_limit : str
        The reasons for the ends of the range.
    """

    arm_angle: tuple[float, float]
    height: tuple[float, float]
    lower_limit: str
    upper_limit: str


def travel_range(model: Model, rack_position: float = 0.0) -> AngleRange:
    """Return the range of arm angles and wheel heights that is reached from the design position.

    Parameters
    ----------
    model : Model
    rack_position : float, optional
        Displacement of the rack [m].

    Returns
    -------
    AngleRange
        Its ends are the last positions before the limits, to 1e-12 rad of the arm angle, or to 1e-9
        rad with loops solved by iteration.

    Raises
    ------
    PositionError
        If the rack cannot be there with the arm in its design position.

    Examples
    --------
    >>> from kintrafo import Model, travel_range
    >>> reach = travel_range(Model("reference_car"))
    >>> [round(1e3 * height, 1) for height in reach.height]
    [-65.6, 615.9]
    """
    with Validator("travel_range") as given:
        given.instance("model", model, Model, Model.NEEDED)
        rack_position = given.number("rack_position", rack_position, "m")
    return _range(model, float(rack_position))


@lru_cache(maxsize=_KEPT)
def _range(model: Model, rack_position: float) -> AngleRange:
    """Return the range, cached: a request for one position at rest is followed by others."""
    racks = np.array([rack_position])
    _refuse_racks(model, racks)
    (low, low_limits), (high, high_limits) = _ends(model, racks)
    heights, _ = height_and_slope(model, np.append(low, high), rack_position)
    return AngleRange(
        (float(low[0]), float(high[0])),
        (float(heights[0]), float(heights[1])),
        _in_words(model, int(low_limits[0])),
        _in_words(model, int(high_limits[0])),
    )


def _ends(model: Model, racks: Array) -> tuple[Ends, Ends]:
    """Return the lower and the upper ends of the range, cached for each displacement of the rack.

    Those of many displacements take hardly longer than those of one.
    """
    known = _known_ends(model)
    if len(known) > _KEPT * _CHUNK:
        known.clear()
    new = [rack for rack in dict.fromkeys(racks.tolist()) if rack not in known]
    if new:
        (low, low_limits), (high, high_limits) = ends_of(model, np.array(new))
        known.update(zip(new, zip(low, low_limits, high, high_limits, strict=True), strict=True))
    of_racks = [known[rack] for rack in racks.tolist()]
    low, low_limits, high, high_limits = map(np.array, zip(*of_racks, strict=True))
    return (low, low_limits), (high, high_limits)


@lru_cache(maxsize=_KEPT)
def _known_ends(_model: Model) -> dict[float, tuple[float, int, float, int]]:
    """Return where the ends of a model are kept."""
    return {}


class Branch(NamedTuple):
    """Table of arm angles and wheel heights over the range, for several racks or models."""

    # falling [rad]; the last one is repeated if the range ends earlier, (rows, points)
    angle: Array
    height: Array  # height of the wheel centre, rising, (rows, points) [m]
    slope: Array  # derivative with respect to the angle, (rows, points) [m/rad]

    def of(self, rows: NDArray[np.int64]) -> "Branch":
        """Return some of its rows."""
        return Branch(*(values[rows] for values in self))


def branch(
    model: Model,
    rack_positions: ArrayLike,
    *,
    covering: tuple[float, float] | None = None,
    to_the_end: bool = False,
) -> Branch:
    """Return the table of the range for each rack position, (racks,) [m].

    `covering` are the lowest and the highest wheel height of interest [m]: tables of many racks end
    near them, by an estimate from a few of the racks. The heights of the table show its actual
    ends. With `to_the_end` the ends of the range are located, as by `travel_range`; otherwise the
    table ends a few degrees before them, where the height gets steep, and is computed much faster.

    Raises `PositionError` if the rack cannot be there with the arm in its design position.
    """
    racks = np.asarray(rack_positions, dtype=np.float64)
    steps = ARM_STEPS, ARM_STEPS
    if covering is not None and racks.size > _CHUNK:
        steps = _steps_to(model, racks, covering)
    chunks = [
        _tabulated(model, racks[i : i + _CHUNK].tobytes(), steps, to_the_end=to_the_end)
        for i in range(0, racks.size, _CHUNK)
    ]
    return Branch(*map(np.concatenate, zip(*chunks, strict=True)))


def _steps_to(model: Model, racks: Array, covering: tuple[float, float]) -> tuple[int, int]:
    """Return the steps from design, down and up, that some of the racks need, and one more."""
    some = np.quantile(racks, np.linspace(0.0, 1.0, _PROBES), method="nearest")
    _refuse_racks(model, some)
    whole = tabulated(model, some, (ARM_STEPS, ARM_STEPS), None)
    return steps_covering(whole.height, covering)


def steps_covering(height: Array, covering: tuple[float, float]) -> tuple[int, int]:
    """Return the steps from design, down and up, that cover some heights, and one more."""
    below = (height[:, ARM_STEPS::-1] > covering[0]).sum(axis=1).max()
    above = (height[:, ARM_STEPS:] < covering[1]).sum(axis=1).max()
    return min(int(below) + 1, ARM_STEPS), min(int(above) + 1, ARM_STEPS)


@lru_cache(maxsize=_KEPT)
def _tabulated(model: Model, racks: bytes, steps: tuple[int, int], *, to_the_end: bool) -> Branch:
    """Return a table, cached: a report requests the same racks at a hundred heights."""
    own = np.frombuffer(racks)
    _refuse_racks(model, own)
    return tabulated(model, own, steps, _ends(model, own) if to_the_end else None)


def tabulated(
    model: Model, racks: Array, steps: tuple[int, int], ends: tuple[Ends, Ends] | None
) -> Branch:
    """Return the table of the range for numbers of steps of the arm, down and up, see `branch`.

    Without its ends it ends before them.
    """
    grid = model.design_state[..., 0] - ARM_STEP * np.arange(-steps[0], steps[1] + 1)
    grid = np.broadcast_to(grid, (racks.size, grid.shape[-1]))
    seen = _look(model, grid, racks[:, None])
    if ends is None:
        return _connected(grid, seen, steps[0])
    low, high = (angles[:, None] for angles, _ in ends)
    at_low, at_high = (height_and_slope(model, end, racks[:, None]) for end in (low, high))
    inside = (grid < low) & (grid > high)
    height, slope = (
        np.where(inside, own, np.where(grid >= low, lower, upper))
        for own, lower, upper in zip((seen.height, seen.slope), at_low, at_high, strict=True)
    )
    return Branch(np.clip(grid, high, low), height, slope)


def _connected(grid: Array, seen: PlacesAlong, design: int) -> Branch:
    """Return the part of a grid that is connected with design, its ends repeated."""
    fine = resolved(np.array(-ARM_STEP), seen)
    down = np.logical_and.accumulate(fine[:, :design][:, ::-1], axis=1).sum(axis=1)
    up = np.logical_and.accumulate(fine[:, design:], axis=1).sum(axis=1)
    inner = np.clip(np.arange(grid.shape[1]), design - down[:, None], design + up[:, None])
    own = (np.take_along_axis(each, inner, axis=1) for each in (grid, seen.height, seen.slope))
    return Branch(*own)


def at_rest(
    model: Model, arm_angle: ArrayLike, rack_position: ArrayLike = 0.0, *, arm_rate: float = 0.0
) -> tuple[Array, Array]:
    """Return states and inputs with zero rates, except that of the arm [rad/s].

    Arm angles [rad] and rack positions [m] broadcast.
    """
    angles, racks = np.broadcast_arrays(np.asarray(arm_angle, float), rack_position)
    names = model.state_names
    states = np.broadcast_to(model.design_state, (*angles.shape, len(names))).copy()
    inputs = np.zeros((*angles.shape, len(model.input_names)))
    states[..., names.index(model.names.arm)] = angles
    states[..., names.index(f"{model.names.arm}_rate")] = arm_rate
    if model.free_rack:
        states[..., names.index(model.names.rack)] = racks
    elif model.suspension.steered():
        inputs[..., model.input_names.index("rack_position")] = racks
    elif racks.any():
        at = 1e3 * float(racks.flat[np.abs(racks).argmax()])
        model.suspension.refuse_without_rack(f"displacement of the rack = {at:g} mm")
    return states, inputs


def height_and_slope(
    model: Model, arm_angle: ArrayLike, rack_position: ArrayLike = 0.0
) -> tuple[Array, Array]:
    """Return height [m] of the wheel centre and its exact derivative by the arm angle [m/rad].

    Arm angles [rad] and rack positions [m] broadcast.
    """
    # velocities are linear in the rates: that at unit rate is the derivative
    states, inputs = at_rest(model, arm_angle, rack_position, arm_rate=1.0)
    signals = model.signals(states, inputs)
    return signals["wheel_center_z"], signals["wheel_velocity"]


def ends_of(model: Model, racks: Array) -> tuple[Ends, Ends]:
    """Return the lower and the upper ends of the range for displacements of the rack, (rows,), m.

    The model may be a batch with a model per rack.
    """
    return _ends_towards(model, racks, +1.0), _ends_towards(model, racks, -1.0)


def _ends_towards(model: Model, racks: Array, direction: float) -> Ends:
    """Return the ends of the range in one direction of the arm, 1 or -1, the sign of its rotation.

    The model is one, or a batch with a model per rack. Results are the last angles within the range
    [rad], and the limits there, as in `_look`, (rows,) each.
    """
    angles = model.design_state[..., 0] + direction * ARM_STEP * np.arange(ARM_STEPS + 1)
    angles = np.broadcast_to(angles, (racks.size, ARM_STEPS + 1))
    seen = _look(model, angles, racks[:, None])
    fine = np.logical_and.accumulate(resolved(np.array(direction * ARM_STEP), seen), axis=1)
    last = fine.sum(axis=1)
    ends = angles[np.arange(racks.size), last]
    limits = np.where(seen.usable[:, 0], GOAL, seen.limit[:, 0])
    rows = np.flatnonzero((last < ARM_STEPS) & seen.usable[:, 0])
    ends[rows], limits[rows] = march(
        lambda places, which: _look(model.of(rows[which]), places, racks[rows[which], None]),
        ends[rows],
        angles[rows, -1],
        ARM_STEP,
    )

    def usable(places: Array) -> NDArray[np.bool_]:
        return _look(model, places[:, None], racks[:, None]).usable[:, 0]

    clearance = _CLEARANCE_OF_ITERATION if iterates(model.equations) else _CLEARANCE
    return _clear_of(usable, clearance, ends, limits, angles[:, 0], direction), limits


def _clear_of(
    usable: Callable[[Array], NDArray[np.bool_]],
    clearance: float,
    ends: Array,
    limits: NDArray[np.int64],
    design: Array,
    direction: float,
) -> Array:
    """Return the last angles within the range, clear of its limits.

    If roundings make the angle not `usable`, the clearance is multiplied by ten.
    """
    # not past the design position, which is the end for a wheel that turns back at once
    swung = direction * (ends - design)
    clear = np.where((swung > clearance) & (limits != GOAL), ends - direction * clearance, ends)
    refused = (limits != GOAL) & (swung > clearance) & ~usable(clear)
    while refused.any():
        clearance *= 10.0
        farther = np.where(swung > clearance, ends - direction * clearance, design)
        clear = np.where(refused, farther, clear)
        refused &= (swung > clearance) & ~usable(clear)
    return clear


def refuse_beyond(model: System, state: Array, inputs: Array) -> None:
    """Raise a `PositionError` for a state of rest at which a length is beyond its limit."""
    signals = model.signals(state, inputs)
    passed = [one for one in model.allowed_lengths() if float(one.left(signals)) < -_LENGTH]
    if passed:
        message = (
            f"it would come to rest where {' and '.join(one.beyond for one in passed)}: give it "
            "stops that hold it before, or correct loads, springs or that length."
        )
        raise PositionError(message)


def _look(model: Model, angles: Array, racks: Array) -> PlacesAlong:
    """Return whether the loops close and the wheel rises with the arm.

    The limit of a position that is not usable is the index of a margin, or `_TURNS_BACK`; the
    margins of lengths that the file allows follow those of the equations.
    """
    states, inputs = at_rest(model, angles, racks, arm_rate=1.0)
    margins = margins_at(model, states, inputs)
    # a NaN after a failed guard must not pass
    closes = np.asarray((margins > 0.0).all(axis=-1))
    signals, stand = _where_it_closes(model, states, inputs, closes)
    allowed = [np.where(closes, one.left(signals), 1.0) for one in model.allowed_lengths()]
    margins = np.concatenate([margins, *(left[..., None] for left in allowed)], axis=-1)
    failed = ~(margins > 0.0)
    fine = ~failed.any(axis=-1)
    # the arm's angle falls as the wheel rises (Eq. 6)
    limits = np.where(fine, _TURNS_BACK, failed.argmax(axis=-1))
    heights, slopes = signals["wheel_center_z"], signals["wheel_velocity"]
    return PlacesAlong(fine & (slopes < 0.0), limits, heights, slopes, margins, stand)


def _where_it_closes(
    model: Model, states: Array, inputs: Array, closes: NDArray[np.bool_]
) -> tuple[dict[str, Array], Attitudes]:
    """Return signals and attitudes; if loops do not close, those of an angle at which they do.

    They are NaN in rows without such an angle. The angles of `states` are set to those evaluated.
    """
    some = np.flatnonzero(closes.any(axis=1))
    if not closes.all():
        angles = states[..., model.state_names.index(model.names.arm)]
        instead = np.take_along_axis(angles, closes.argmax(axis=1)[:, None], axis=1)
        angles[...] = np.where(closes, angles, instead)
    if some.size == len(closes):
        return model.signals(states, inputs), attitudes_at(model, states, inputs)
    part, states, inputs = model.of(some), states[some], inputs[some]

    def in_rows(own: Array) -> Array:
        whole = np.full((len(closes), *own.shape[1:]), np.nan)
        whole[some] = own
        return whole

    signals = {name: in_rows(own) for name, own in part.signals(states, inputs).items()}
    return signals, Attitudes(*map(in_rows, attitudes_at(part, states, inputs)))


def margins_at(model: Model, states: Array, inputs: Array) -> Array:
    """Return the margins, which are positive within the range."""
    margins = model.evaluate("margins", states, inputs)
    # except guards of angles on which no position depends, such as the azimuth of a vertical shaft
    acting = {guard for guards in model.equations.ACTING_GUARDS.values() for guard in guards}
    margins[..., [guard not in acting for guard in range(margins.shape[-1])]] = 1.0
    return margins


def _in_words(model: Model, limit: int) -> str:
    if limit < 0:
        return _REASONS[limit]
    closing: list[str] = [meaning for _, meaning in model.equations.GUARDS]
    return [*closing, *(one.meaning for one in model.allowed_lengths())][limit]


def _refuse_racks(model: Model, racks: Array) -> None:
    """Refuse rack positions that are out of reach with the arm in its design position."""
    seen = _look(model, model.design_state[:1], racks[:, None])
    closes = (seen.margins[:, 0] > 0.0).all(axis=-1)
    first, limit = -1, -1
    if not closes.all():
        first = int(np.flatnonzero(~closes)[0])
        limit = int(seen.limit[first, 0])
    else:
        for side in (racks.argmin(), racks.argmax()):
            way = way_of_rack(float(racks[side]))
            margins = margins_at(model, *at_rest(model, model.design_state[0], way))
            blocked = ~margins_stay(margins)
            if blocked.any():
                place = int(blocked.argmax())
                first, limit = int(side), int(margins[place : place + 2].min(axis=0).argmin())
    if first < 0:
        return
    message = (
        f"the rack cannot be at {racks[first] * 1e3:g} mm with the suspension in its design "
        f"position: {_in_words(model, limit)}. Choose a smaller displacement."
    )
    raise PositionError(message)


def way_of_rack(rack: float) -> Array:
    """Return positions between the middle of the rack and its displacement [m]."""
    count = min(2 + int(abs(rack) / _RACK_STEP), _MOST_RACK_STEPS)
    return np.linspace(0.0, rack, 1 + count)
