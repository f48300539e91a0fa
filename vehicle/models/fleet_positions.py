"""Arm angles of many suspensions at once: as `arm_angles`, where nothing is in the way.

The reach of each is tabulated from its design position, as far as the heights ask for of the first,
and to its end for those whose table does not get there. Suspensions that do not get there even so,
or whose height is not met to rounding, are marked: those are for one by one.
"""

import numpy as np
from numpy.typing import NDArray

from .fleet import Fleet
from .positions import solve
from .reach import (
    ARM_STEPS,
    Branch,
    at_rest,
    branch,
    height_and_slope,
    margins_at,
    steps_covering,
    tabulated,
    way_of_rack,
)
from .swing import margins_stay

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


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
        Which suspensions reach all of them for sure.
    """
    design = fleet.design_state[..., 0]
    wanted = height_and_slope(fleet, design)[0] + travel
    angles = np.broadcast_to(design, wanted.shape).copy()
    found = _racks_get_there(fleet, rack)
    for at in np.unique(rack):
        same = np.flatnonzero(rack == at)
        heights = wanted[:, same]
        steps = steps_covering(
            branch(fleet.first, [at]).height, (heights[0].min(), heights[0].max())
        )
        rows, met = np.arange(len(wanted)), np.zeros(len(wanted), dtype=bool)
        for how_far, to_the_end in ((steps, False), ((ARM_STEPS, ARM_STEPS), True)):
            racks = np.full(rows.size, at)
            table = tabulated(fleet.of(rows), racks, how_far, to_the_end=to_the_end)
            within = np.flatnonzero(_covers(table, heights[rows]))
            some = rows[within]
            if some.size:
                part = solve(fleet.of(some), heights[some], racks[within], table.of(within))
                angles[np.ix_(some, same)], met[some] = part[0], (part[1] <= part[2]).all(axis=1)
            rows = np.delete(rows, within)
            if not rows.size:
                break
        found &= met
    angles[~found] = design[~found]
    return angles, found


def _covers(table: Branch, heights: Array) -> Flags:
    """Return which rows of a table have all heights, of a reach that is more than a point."""
    low, high = table.height[:, :1], table.height[:, -1:]
    return np.asarray(((heights >= low) & (heights <= high) & (low < high)).all(axis=1))


def _racks_get_there(fleet: Fleet, rack: Array) -> Flags:
    """Return the cars whose rack gets to both of its ends with the arm in its design position."""
    design = fleet.design_state[..., 0]
    there = np.ones(len(design), dtype=bool)
    for end in {float(rack.min()), float(rack.max())} - {0.0}:
        way = way_of_rack(end)
        angles = np.broadcast_to(design, (len(design), way.size))
        there &= margins_stay(margins_at(fleet, *at_rest(fleet, angles, way))).all(axis=1)
    return there
