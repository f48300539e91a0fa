"""A suspension on its bushes, as a caller describes them, held by the road at some heights."""

from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ....core.arguments import Arguments
from ....core.errors import InputError
from ....suspension.bushes import RACK, described_bushings, softness_of_rack
from ....suspension.corner import Corner
from ....suspension.model import Model
from ....suspension.positions import arm_angles, design_height
from ....suspension.reach import at_rest
from ...characteristics.from_model import corner
from ..poses import Poses
from ..reactions import Equations, known
from .connections import GROUND, Soft
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
    carried = _carried_at_design(model) if loaded else {}
    return Soft({bush.point: bush for bush in bushes}, rack, carried)


def gives_way(soft: Soft) -> bool:
    """Tell whether anything moves that rigid joints hold."""
    return bool(soft.rack or any(bush.gives_way for bush in soft.bushes.values()))


def _carried_at_design(model: Model) -> dict[tuple[str, str, str], Array]:
    """Return what the joints carry at design with the wheel held by the road."""
    angles = arm_angles(model, [design_height(model)])
    poses = Poses.of(model, *at_rest(model, angles))
    equations = Equations(poses)
    unknowns = equations.solve(equations.applied(known(poses)))
    found = {
        (joint.first, joint.second, point): at_points[0, which, :, 0]
        for joint, at_points in zip(
            equations.joints, equations.at_joints(unknowns[..., None]), strict=True
        )
        for which, point in enumerate(joint.at)
    }
    if not model.suspension.steered():
        return found
    # the guide of the rack holds what the tie rod does to it
    on_tie_rod = found[RACK, "tie_rod", "tie_rod_inner"]
    return found | {(GROUND, RACK, "tie_rod_inner"): on_tie_rod}


def suspension_on(
    model: Model, travels: Array, rack: float, soft: Soft
) -> tuple[Equilibrium, Corner]:
    """Return a suspension on its bushes at some travels, and its corner with rigid joints."""
    angles = arm_angles(model, design_height(model) + travels, rack)
    poses = Poses.of(model, *at_rest(model, angles, rack))
    return Equilibrium([(poses, soft)]), corner(model, angles, rack)


def at_height(suspension: Equilibrium, travels: Array) -> State:
    """Return the equilibria on the road without another load."""
    nothing = np.zeros((*suspension.start.road.shape, LOADS))
    base = suspension.under(nothing, "height", suspension.start)
    if not base.found.all():
        at = ", ".join(f"{1e3 * t:.4g} mm" for t in travels[~base.found][:3])
        problem = (
            f"no equilibrium that lasts was found at a wheel travel of {at}: the bushes do not "
            "hold the linkage there. Make them stiffer, or leave that out."
        )
        raise InputError([problem], "bushings")
    return base
