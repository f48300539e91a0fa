"""Arm angles of many suspensions at once: as `arm_angles`, where nothing is in the way.

The reach is tabulated for each from its design position, as `reach` does, as far as the heights ask
for; whose steps do not get there goes on to the end of the reach. Who does not get there even so,
or whose height is not met to rounding, is told; whoever asks goes through those one by one.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .attitudes import Attitudes, attitudes, attitudes_at
from .fleet import Fleet
from .reach import ARM_STEP, ARM_STEPS, branch, clear_of, clearance_of, margins_at, way_of_rack
from .reach import at_rest as rest_of
from .swing import Seen, march, margins_stay, resolved

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

# As of `positions`: heights that are missed by less are met [m], and roundings of the arm's angle.
_ROUNDING, _ROUNDINGS = 1e-12, 8.0
_NEWTON_STEPS = 8
_EPSILON = float(np.finfo(np.float64).eps)


class _Table(NamedTuple):
    """Arm angles of each, heights of the wheel centre, which rise, and slopes; (count, places)."""

    angle: Array
    height: Array
    slope: Array


def fleet_angles(fleet: Fleet, travel: Array, rack: Array) -> tuple[Array, Flags]:
    """Return the arm angles at which the wheel centres have travelled so far from design.

    Parameters
    ----------
    fleet : Fleet
    travel, rack : ndarray, shape (positions,)
        Wheel travel, and displacement of the rack [m].

    Returns
    -------
    angles : ndarray, shape (count, positions)
        [rad]; those of design where they are not found.
    found : ndarray of bool, shape (count,)
        Who reaches all of them for sure.
    """
    design = fleet.design_state[..., 0]
    wanted = _signals(fleet, design, 0.0)["wheel_center_z"] + travel
    angles = np.broadcast_to(design, wanted.shape).copy()
    found = _racks_get_there(fleet, rack)
    racks = np.unique(rack)
    firsts = branch(fleet.first, racks).height
    for at, first in zip(racks, firsts, strict=True):
        same = np.flatnonzero(rack == at)
        part, met = _at_rack(fleet, wanted[:, same], float(at), first)
        angles[:, same] = part
        found &= met
    angles[~found] = design[~found]
    return angles, found


def _at_rack(fleet: Fleet, wanted: Array, rack: float, first: Array) -> tuple[Array, Flags]:
    """Return the angles at one position of the rack, and who reaches all heights."""
    design = fleet.design_state[..., 0]
    down, up = _steps(wanted[0], first)
    grid = design - ARM_STEP * np.arange(-down, up + 1)
    seen = _look(fleet, grid, rack)
    fine = resolved(np.array(-ARM_STEP), seen)
    before = np.logical_and.accumulate(fine[:, :down][:, ::-1], axis=1).sum(axis=1)
    after = np.logical_and.accumulate(fine[:, down:], axis=1).sum(axis=1)
    inner = np.clip(np.arange(grid.shape[1]), down - before[:, None], down + after[:, None])
    table = _Table(
        *(np.take_along_axis(values, inner, axis=1) for values in (grid, seen.height, seen.slope))
    )
    at_design = seen.usable[:, down]
    below, above = wanted.min(axis=1) < table.height[:, 0], wanted.max(axis=1) > table.height[:, -1]
    table = _to_the_ends(fleet, table, (below & at_design, above & at_design), rack)
    covered = (wanted >= table.height[:, :1]) & (wanted <= table.height[:, -1:])
    reaches = at_design & covered.all(axis=1) & (table.height[:, 0] < table.height[:, -1])
    start, low, high = _between(table, wanted)
    angles = np.broadcast_to(design, wanted.shape).copy()
    some = np.flatnonzero(reaches)
    if some.size:
        ends = low[some], high[some]
        angles[some], reaches[some] = _newton(fleet.of(some), start[some], ends, wanted[some], rack)
    return angles, reaches


def _steps(wanted: Array, height: Array) -> tuple[int, int]:
    """Return how many steps of the arm the first needs, or goes, down and up, and one more."""
    goes = np.diff(height) > 0.0  # a table repeats its ends
    below = min((height[ARM_STEPS::-1] > wanted.min()).sum(), goes[:ARM_STEPS].sum())
    above = min((height[ARM_STEPS:] < wanted.max()).sum(), goes[ARM_STEPS:].sum())
    return min(max(int(below), 1) + 1, ARM_STEPS), min(max(int(above), 1) + 1, ARM_STEPS)


def _look(fleet: Fleet, angles: Array, rack: float) -> Seen:
    """Return what there is at some angles of each; see `reach`."""
    margins = margins_at(fleet, *rest_of(fleet, angles, rack))
    closes = np.asarray((margins > 0.0).all(axis=-1))
    signals, stand = _where_it_closes(fleet, closes, angles, rack)
    allowed = fleet.allowed_lengths()
    left = np.ones((*angles.shape, len(allowed)))
    for column, one in enumerate(allowed):
        left[..., column] = one.left(signals)
    margins = np.concatenate([margins, left], axis=-1)
    fine = (margins > 0.0).all(axis=-1)
    slopes = signals["wheel_velocity"]
    nothing = np.zeros(angles.shape, dtype=np.int64)
    heights = signals["wheel_center_z"]
    return Seen(fine & (slopes < 0.0), nothing, heights, slopes, margins, stand)


def _where_it_closes(
    fleet: Fleet, closes: Flags, angles: Array, rack: float
) -> tuple[dict[str, Array], Attitudes]:
    """Return signals and attitudes; where loops do not close, those of a place where they do."""
    at = closes.argmax(axis=1)[:, None]
    some = np.flatnonzero(closes.any(axis=1))
    there = np.where(closes, angles, np.take_along_axis(angles, at, axis=1))[some]
    whole = {name: np.zeros(angles.shape) for name in fleet.signal_names}
    if not some.size:
        return whole, attitudes(fleet, angles[..., None], None, closes)
    part = fleet.of(some)
    rest = rest_of(part, there, rack, arm_rate=1.0)
    for name, values in part.signals(*rest).items():
        whole[name][some] = values
    stand = []
    for values in attitudes_at(part, *rest):
        stand.append(np.full((*angles.shape, values.shape[-1]), np.nan))
        stand[-1][some] = values
    return whole, Attitudes(*stand)


def _signals(fleet: Fleet, angles: Array, rack: float) -> dict[str, Array]:
    return fleet.signals(*rest_of(fleet, angles, rack, arm_rate=1.0))


def _to_the_ends(fleet: Fleet, table: _Table, short: tuple[Flags, Flags], rack: float) -> _Table:
    """Return a table with the ends of the reach, down and up, of those for whom it is too short.

    Of the others these are the ends of the table again.
    """
    low, high = (
        _end(fleet, _Table(*(values[:, end, None] for values in table)), rows, direction, rack)
        for end, rows, direction in ((0, short[0], 1.0), (-1, short[1], -1.0))
    )
    return _Table(*(np.concatenate(parts, axis=1) for parts in zip(low, table, high, strict=True)))


def _end(fleet: Fleet, last: _Table, short: Flags, direction: float, rack: float) -> _Table:
    """Return the ends of the reach one way of some, as `reach` finds them, and of others the last.

    Parameters
    ----------
    fleet : Fleet
    last : _Table
        One place for each: up to there the arm swings for sure.
    short : ndarray of bool
        Who goes on from there.
    direction : float
        Which way the arm swings.
    rack : float
        [m].
    """
    rows = np.flatnonzero(short)
    if not rows.size:
        return last
    design = fleet.design_state[rows, 0, 0]
    ends, limits = march(
        lambda places, which: _look(fleet.of(rows[which]), places, rack),
        last.angle[rows, 0],
        design + direction * ARM_STEP * ARM_STEPS,
        ARM_STEP,
    )

    def usable(places: Array) -> Flags:
        return _look(fleet.of(rows), places[:, None], rack).usable[:, 0]

    clearance = clearance_of(fleet)
    ends = clear_of(usable, clearance, ends, limits, design, direction)[:, None]
    seen = _look(fleet.of(rows), ends, rack)
    found = _Table(*(values.copy() for values in last))
    for values, there in zip(found, (ends, seen.height, seen.slope), strict=True):
        values[rows] = there
    return found


def _between(table: _Table, wanted: Array) -> tuple[Array, Array, Array]:
    """Return where a cubic between neighbours of a table has some heights, and the neighbours."""
    angle, height, slope = table
    right = np.clip((height[:, None, :] < wanted[..., None]).sum(axis=-1), 1, height.shape[1] - 1)
    low, high = (np.take_along_axis(angle, i, axis=1) for i in (right - 1, right))
    at_low, at_high = (np.take_along_axis(height, i, axis=1) for i in (right - 1, right))
    by_low, by_high = (np.take_along_axis(slope, i, axis=1) for i in (right - 1, right))
    with np.errstate(all="ignore"):  # of those that are not found
        rise = at_high - at_low
        part = (wanted - at_low) / rise
        first, last = rise / by_low, rise / by_high
        change = high - low
        bend, twist = 3.0 * change - 2.0 * first - last, first + last - 2.0 * change
        start = low + part * (first + part * (bend + part * twist))
        inside = (start <= low) & (start >= high)
        return np.where(inside, start, 0.5 * (low + high)), low, high


def _newton(
    fleet: Fleet, start: Array, ends: tuple[Array, Array], wanted: Array, rack: float
) -> tuple[Array, Flags]:
    """Solve for the angles, each by its own steps; tell who has come to all of them."""
    angles, found = start.copy(), start.copy()
    error = np.full(start.shape, np.inf)
    slopes = np.ones(start.shape)
    rows = np.arange(len(start))
    for _ in range(_NEWTON_STEPS):
        if not rows.size:
            break
        some = fleet.of(rows)
        signals = _signals(some, angles[rows], rack)
        excess = signals["wheel_center_z"] - wanted[rows]
        slopes[rows] = signals["wheel_velocity"]
        better = np.abs(excess) < error[rows]
        found[rows] = np.where(better, angles[rows], found[rows])
        error[rows] = np.where(better, np.abs(excess), error[rows])
        with np.errstate(all="ignore"):
            step = excess / slopes[rows]
        # a step that leads out of its bracket is one for those who look more closely
        angles[rows] = np.clip(angles[rows] - step, ends[1][rows], ends[0][rows])
        moving = np.abs(step) > 4.0 * _EPSILON * np.abs(angles[rows])
        rows = rows[(moving & (excess != 0.0)).any(axis=1)]
    most = _ROUNDING + _ROUNDINGS * np.spacing(np.abs(found)) * np.abs(slopes)
    return found, np.asarray((error <= most).all(axis=1))


def _racks_get_there(fleet: Fleet, rack: Array) -> Flags:
    """Tell whose rack gets to both of its ends with the arm in its design position."""
    design = fleet.design_state[..., 0]
    there = np.ones(len(design), dtype=bool)
    for end in {float(rack.min()), float(rack.max())} - {0.0}:
        way = way_of_rack(end)
        angles = np.broadcast_to(design, (len(design), way.size))
        there &= margins_stay(margins_at(fleet, *rest_of(fleet, angles, way))).all(axis=1)
    return there
