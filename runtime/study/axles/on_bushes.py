"""Both sides of an axle on their bushes, as a caller describes them, held by the road."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ...assembly.anti_roll_bar import Bar
from ...assembly.axle_coupling import SIDES, pull_of_bar, torque_of_bar
from ...assembly.pair import Pair
from ...assembly.poses import Poses
from ...core.arguments import Arguments
from ...suspension.axle import Axle
from ...suspension.axle.axle import LEFT, RIGHT
from ...suspension.bushes import Bush, softness_of_rack
from ...suspension.corner import Array
from ...suspension.positions import arm_angles, design_height
from ...suspension.reach import at_rest
from ..loads.elastic.connections import GUIDE, Soft
from ..loads.elastic.equilibrium import Equilibrium
from ..loads.elastic.held import Hardpoints, at_design, carried_at
from .compliance import described_of

RIGID = Soft({}, 0.0, {})


def softs_of(
    given: Arguments, axle: Axle, bushings: Any, hardpoints: Hardpoints
) -> dict[str, Soft]:
    """Read what gives way on both sides, and what it carries at the hardpoints."""
    if given.refused:
        return dict.fromkeys(SIDES, RIGID)
    described = described_of(given, axle, bushings)
    bushes = {side: axle.sides[side].bushes(given, described[side]) for side in SIDES}
    rack = softness_of_rack(given, described[axle.bar_side])
    if not any(bushes.values()) and not rack and not given.refused:
        given.refuse("bushings: one or more are needed.")
    if any(side.tyre_radius() is None for side in axle.sides.values()):
        given.refuse("[tyre] radius_mm is needed: where the road touches the wheel.")
    loaded = hardpoints == "loaded" and not given.refused
    carried = _carried_at_design(axle, bushes) if loaded else {side: {} for side in SIDES}
    return {
        side: Soft({bush.point: bush for bush in bushes[side]}, rack, carried[side])
        for side in SIDES
    }


def _carried_at_design(
    axle: Axle, bushes: Mapping[str, Sequence[Bush]]
) -> dict[str, dict[tuple[str, str, str], Array]]:
    """Return what the joints of both sides carry at design, with what the bar does there."""
    poses = {side: at_design(axle.models[side]) for side in SIDES}
    pulled: dict[str, list[Any]] = {side: [] for side in SIDES}
    if axle.halves:
        torque = torque_of_bar(axle, {f"_{side}": at for side, at in poses.items()})
        pulled = {side: [pull_of_bar(axle, side, poses[side], torque)] for side in SIDES}
    found = {side: dict(carried_at(poses[side], pulled[side], bushes[side])) for side in SIDES}
    if axle.steered():
        # one rack, on which both tie rods pull
        both = found[LEFT][GUIDE] + found[RIGHT][GUIDE]
        found = {side: own | {GUIDE: both} for side, own in found.items()}
    return found


def axle_on(pair: Pair, racks: Array, softs: dict[str, Soft]) -> Equilibrium:
    """Return an axle on its bushes where it is with rigid joints.

    Parameters
    ----------
    pair : Pair
    racks : ndarray, shape (n,)
        Displacements of the rack there [m].
    softs : dict of str to Soft
        By side.
    """
    axle, sides = pair.axle, []
    for side in SIDES:
        model = axle.models[side]
        angles = arm_angles(model, design_height(model) + pair.travel[side], racks)
        sides.append((Poses.of(model, *at_rest(model, angles, racks)), softs[side]))
    bar = None
    if axle.bar is not None:
        halves = axle.halves[LEFT], axle.halves[RIGHT]
        bar = Bar(halves, axle.bar.rate(), axle.bar.free_twist())
    return Equilibrium(sides, bar)


def levers(suspension: Equilibrium, state: Any) -> Array:
    """Return how far the contacts are to the left of the middle of the car, (n, 2) [m]."""
    return np.stack([suspension.contact(state.places, i)[:, 1] for i in range(len(SIDES))], axis=1)
