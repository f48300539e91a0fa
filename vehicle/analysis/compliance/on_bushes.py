"""An assembly on bushes and on the road: its joints, and its equilibrium without other loads."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, Literal

import numpy as np

from ....core.named_types import Array
from ....core.quantities import display_of
from ....core.validator import Validator
from ...assembly import wheel
from ...assembly.assembly import Bushings, HeldAssembly
from ...assembly.load import Load, known
from ...assembly.part_poses import PartPoses
from ...assembly.quantity import TRAVEL, Quantity
from ...corner.bushes import RACK, Bush
from ...corner.corner import RoadWheel
from ...models.reach import PositionError
from ..characteristics.datasets import KNOWN
from ..loads.reactions import BalanceEquations
from .connections import GUIDE, Carried, CompliantJoints
from .equilibrium import LOADS, ElasticEquilibrium, ElasticState
from .flexibility import shared
from .linear import refuse_without_radius

Hardpoints = Literal["loaded", "relaxed"]

HARDPOINTS = {
    "loaded": "the joints are at the hardpoints under the static load at design",
    "relaxed": "the joints are at the hardpoints with relaxed bushes",
}
"""Meanings of the hardpoints of a file."""

WHEEL_LOAD = Quantity(
    "wheel_load", "N", "wheel load", "vertical force of the road", "positive upward"
)
CURVES: Mapping[Quantity, Callable[[RoadWheel], Array]] = {
    KNOWN["travel"][name]: formula
    for name, formula in {
        "toe": wheel.toe,
        "camber": wheel.camber,
        "half_track_change": wheel.half_track_change,
        "wheelbase_change": wheel.wheelbase_change,
    }.items()
}
"""Formulas of the position of a wheel, by quantity."""

RIGID = CompliantJoints({}, 0.0, {})


def softs_of(
    given: Validator, assembly: HeldAssembly, bushings: Any, hardpoints: Hardpoints
) -> dict[str, CompliantJoints]:
    """Return the compliant joints by the suffixes of their parts, or add errors."""
    if given.failed:
        return {}
    bushes = assembly.bushes(given, bushings)
    if not bushes.every and not bushes.rack and not given.failed:
        given.fail("bushings: one or more are needed.")
    refuse_without_radius(given, assembly)
    loaded = hardpoints == "loaded" and not given.failed
    carried = _carried_at_design(assembly, bushes) if loaded else {}
    return {
        suffix: CompliantJoints(
            {bush.point: bush for bush in own}, bushes.rack, carried.get(suffix, {})
        )
        for suffix, own in bushes.by_suffix.items()
    }


def _carried_at_design(assembly: HeldAssembly, bushes: Bushings) -> dict[str, Carried]:
    """Return the loads on the joints at design, with those by an anti-roll bar."""
    poses = assembly.poses(assembly.at_travel(np.zeros(1)))
    torque = assembly.bar_torque(poses)[:, None]
    pulled = {
        suffix: [replace(o, force=torque * o.force, moment=torque * o.moment) for o in units]
        for suffix, units in assembly.bar_loads(poses).items()
    }
    found = {
        suffix: dict(carried_at(own, pulled.get(suffix, ()), bushes.by_suffix[suffix]))
        for suffix, own in poses.items()
    }
    if len(found) > 1 and all(GUIDE in own for own in found.values()):
        # all tie rods act on one rack
        both = sum((own[GUIDE] for own in found.values()), np.zeros(6))
        found = {suffix: own | {GUIDE: both} for suffix, own in found.items()}
    return {**found}


def carried_at(
    poses: PartPoses, pulled: Sequence[Load] = (), bushes: Sequence[Bush] = ()
) -> Carried:
    """Return the loads on the joints at design, the first position, with the wheel on the road.

    Further loads pull at the parts; the energy of bushes decides statically indeterminate loads.
    """
    equations = BalanceEquations(poses)
    every = shared(equations, equations.solve(equations.applied([*known(poses), *pulled])), bushes)
    found = {
        (joint.first, joint.second, point): at_points[which]
        for joint, at_points in zip(equations.joints, every, strict=True)
        for which, point in enumerate(joint.at)
    }
    if poses.rack_axis is None:  # without a rack in its guide
        return found
    # the guide of the rack has the load of the tie rod
    return found | {GUIDE: found[RACK, "tie_rod", "tie_rod_inner"]}


def on_joints(
    assembly: HeldAssembly,
    poses: Mapping[str, PartPoses],
    softs: Mapping[str, CompliantJoints] | None = None,
) -> ElasticEquilibrium:
    """Return the equilibrium of an assembly on compliant joints, by default on rigid ones."""
    sides = [(own, softs[suffix] if softs else RIGID) for suffix, own in poses.items()]
    return ElasticEquilibrium(sides, assembly.bar)


def gives_way(softs: Mapping[str, CompliantJoints]) -> bool:
    """Return whether any bush or the rack is compliant."""
    return any(
        soft.rack or any(bush.gives_way for bush in soft.bushes.values()) for soft in softs.values()
    )


def on_bushes(suspension: ElasticEquilibrium, state: ElasticState, side: int = 0) -> RoadWheel:
    """Return a wheel at its position on the bushes."""
    center, axis = suspension.center(state.places, side), suspension.axis(state.places, side)
    return replace(suspension.wheels[side], center=center, axis=axis)


def at_height(
    suspension: ElasticEquilibrium, along: Array, over: Quantity = TRAVEL
) -> ElasticState:
    """Return the equilibria on the road without another load; positions are for messages."""
    nothing = np.zeros((*suspension.start.road.shape, LOADS))
    base = suspension.under(nothing, "height", suspension.start)
    if not base.found.all():
        shown = display_of(over.attributes())
        at = ", ".join(f"{shown.factor * a:.4g} {shown.units}" for a in along[~base.found][:3])
        raise PositionError(
            f"no stable equilibrium was found at a {over.long_name} of {at}: the bushes do not "
            "hold the linkage there. Make them stiffer, or leave out that position."
        )
    if words := suspension.overstretched(base):
        raise PositionError(
            f"without another load {words}. Make it stiffer, or correct loads and springs."
        )
    return base


def place_of_beam(suspension: ElasticEquilibrium, state: ElasticState) -> dict[str, Array]:
    """Return steer angle and middle of the line through two wheel centres, (n,) [rad], [m]."""
    left, right = (suspension.center(state.places, which) for which in (0, 1))
    line, middle = left - right, 0.5 * (left + right)
    start = np.mean([wheel.design_center for wheel in suspension.wheels], axis=0)
    return {
        "axle_steer": np.arctan2(-line[:, 0], line[:, 1]),
        "axle_lateral": middle[:, 1] - start[1],
        "axle_longitudinal": middle[:, 0] - start[0],
    }
