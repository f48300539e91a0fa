"""Loads on the rack between suspensions and chassis."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...core.named_types import Array
from ..kinds import Suspension
from .load import RACK, Load
from .part_poses import wrench_about

STEERING = "steering"
"""The name of the actuation of a rack along its axis."""

_OF_GUIDE = "the moment of the rack's guide is about the inner end of the tie rod"

STILL = np.zeros(3)


@dataclass(frozen=True)
class BodyPose:
    """The pose of a part in equilibrium, in n positions."""

    center: Array  # reference point of its moments, (n, 3) [m]
    turned: Array  # rotation from design, (n, 3, 3)

    @classmethod
    def unturned(cls, center: Array) -> "BodyPose":
        """Return the pose of a part whose own axes are those of the chassis."""
        return cls(center, np.broadcast_to(np.eye(3), (*center.shape, 3)))


def rules_of(suspension: Suspension) -> tuple[str, ...]:
    """Return the assumptions that resolve the statical indeterminacy of one suspension."""
    of_guide = () if suspension.rack is None else (_OF_GUIDE,)
    return (*suspension.structure().rules, *of_guide)


def on_the_rack(
    axis: Array, loads: Sequence[Load], point: str
) -> tuple[list[Load], dict[str, BodyPose]]:
    """Return the loads on a rack and on the chassis, and the pose of the rack.

    The steering acts along the `axis`, a unit vector, the guide otherwise. `loads` are all others;
    those of tie rods on the rack define its position. `point` is the name of the middle between the
    tie rods, about which the moments are.
    """
    rods = [o.at for o in loads if o.part == RACK and o.by not in ("gravity", "inertia")]
    middle = np.mean(rods, axis=0)
    wrench = sum_of(loads, RACK, middle)
    along = (wrench[:, :3] @ axis)[:, None] * axis
    steering = Load(RACK, point, STEERING, -along, STILL, middle)
    guide = Load(RACK, point, "chassis", along - wrench[:, :3], -wrench[:, 3:], middle)
    reaction = replace(steering, part="chassis", force=along)
    held = [steering, reaction, *on_both(RACK, "chassis", guide)]
    return held, {RACK: BodyPose.unturned(middle)}


def on_both(one: str, other: str, load: Load) -> list[Load]:
    """Return a load of one part by another, and its opposite."""
    back = replace(load, part=other, by=one, force=-load.force, moment=-load.moment)
    return [load, back]


def sum_of(loads: Sequence[Load], part: str, about: Array) -> Array:
    """Return force and moment of the loads on a part about a point, (n, 6)."""
    own = [wrench_about(about, o.at, o.force, o.moment) for o in loads if o.part == part]
    return np.sum(np.broadcast_arrays(*own, np.zeros((len(about), 6))), axis=0)
