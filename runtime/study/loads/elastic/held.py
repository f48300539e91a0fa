"""A suspension on its bushes, as a caller describes them, held by the road at some heights."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ....assembly.load import Load, known
from ....assembly.poses import Assembled, Poses
from ....assembly.quantity import TRAVEL, Quantity
from ....core.arguments import Arguments
from ....core.quantities import display_of
from ....suspension.bushes import RACK, Bush, described_bushings, softness_of_rack
from ....suspension.corner import RoadWheel
from ....suspension.model import Model
from ....suspension.positions import arm_angles, design_height
from ....suspension.reach import PositionError, at_rest
from ..flexibility import shared
from ..reactions import Equations
from .connections import GUIDE, Carried, Soft
from .equilibrium import LOADS, Equilibrium, State

Array = NDArray[np.float64]
Hardpoints = Literal["loaded", "relaxed"]

HARDPOINTS = {
    "loaded": "the hardpoints are where the joints are under the static load at design",
    "relaxed": "the hardpoints are where the joints are with relaxed bushes",
}
"""What the hardpoints of a file mean."""


def soft_of(given: Arguments, model: Model, bushings: Any, hardpoints: Hardpoints) -> Soft:
    """Read what gives way, and what it carries at the hardpoints."""
    if given.refused:
        return Soft({}, 0.0, {})
    described = described_bushings(given, bushings, model.suspension.bushings)
    bushes = model.suspension.bushes(given, described)
    rack = softness_of_rack(given, described)
    if not bushes and not rack and not given.refused:
        given.refuse("bushings: one or more are needed.")
    if model.suspension.tyre_radius() is None:
        given.refuse("[tyre] radius_mm is needed: where the road touches the wheel.")
    loaded = hardpoints == "loaded" and not given.refused
    carried = carried_at(at_design(model), bushes=bushes) if loaded else {}
    return Soft({bush.point: bush for bush in bushes}, rack, carried)


def gives_way(soft: Soft) -> bool:
    """Tell whether anything moves that rigid joints hold."""
    return bool(soft.rack or any(bush.gives_way for bush in soft.bushes.values()))


def at_design(model: Model) -> Poses:
    """Return where the joints are at design."""
    return Poses.of(model, *at_rest(model, arm_angles(model, [design_height(model)])))


def carried_at(
    poses: Assembled, pulled: Sequence[Load] = (), bushes: Sequence[Bush] = ()
) -> Carried:
    """Return what the joints carry at design, the first position, the wheel held by the road.

    Parameters
    ----------
    poses : Assembled
    pulled : sequence of Load, optional
        What else acts on the parts.
    bushes : sequence of Bush, optional
        Those that share what statics does not decide: the force along the axis of an arm, and what
        holds parts more often than they move.
    """
    equations = Equations(poses)
    unknowns = equations.solve(equations.applied([*known(poses), *pulled]))
    every = shared(equations, unknowns, bushes)
    found = {
        (joint.first, joint.second, point): at_points[which]
        for joint, at_points in zip(equations.joints, every, strict=True)
        for which, point in enumerate(joint.at)
    }
    if poses.rack_axis is None:
        return found
    # the guide of the rack holds what the tie rod does to it
    return found | {GUIDE: found[RACK, "tie_rod", "tie_rod_inner"]}


def suspension_on(model: Model, travels: Array, rack: float, soft: Soft) -> Equilibrium:
    """Return a suspension on its bushes at some travels."""
    angles = arm_angles(model, design_height(model) + travels, rack)
    return Equilibrium([(Poses.of(model, *at_rest(model, angles, rack)), soft)])


def on_bushes(suspension: Equilibrium, state: State, side: int = 0) -> RoadWheel:
    """Return a wheel where it is on the bushes."""
    center, axis = suspension.center(state.places, side), suspension.axis(state.places, side)
    return replace(suspension.wheels[side], center=center, axis=axis)


def at_height(suspension: Equilibrium, along: Array, over: Quantity = TRAVEL) -> State:
    """Return the equilibria on the road without another load.

    Parameters
    ----------
    suspension : Equilibrium
    along : ndarray, shape (n,)
        Where that is, for messages.
    over : Quantity, optional
        What that counts.
    """
    nothing = np.zeros((*suspension.start.road.shape, LOADS))
    base = suspension.under(nothing, "height", suspension.start)
    if not base.found.all():
        shown = display_of(over.attributes())
        at = ", ".join(f"{shown.factor * a:.4g} {shown.units}" for a in along[~base.found][:3])
        problem = (
            f"no equilibrium that lasts was found at a {over.long_name} of {at}: the bushes do not "
            "hold the linkage there. Make them stiffer, or leave that out."
        )
        raise PositionError(problem)
    if words := suspension.overstretched(base):
        problem = f"without another load {words}. Make it stiffer, or correct loads and springs."
        raise PositionError(problem)
    return base
