"""Anti-roll bars as rotational springs between two sides, axle and body, or two parts.

Of a bar between two sides also its loads, with its drop links.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...core.named_types import Array
from ...core.vectors import cross
from ..models.axle import Axle
from ..models.axle.bar import HalfBar
from ..models.points import carried
from ..models.sides import SENSE, SIDES
from .coupling import STILL, BodyPose, on_both, sum_of
from .load import Load
from .part_poses import CornerParts


@dataclass(frozen=True)
class _Elastic:
    rate: float  # torque, or moment, per twist [N m/rad]

    free_twist = 0.0  # the twist without a torque [rad]

    def torque(self, twist: Array) -> Array:
        """Return the torque, or the moment, at a twist [N m]."""
        return self.rate * (twist - self.free_twist)


@dataclass(frozen=True)
class Bar(_Elastic):
    """An anti-roll bar between two sides: its twist is the first half's angle less the second's."""

    halves: tuple[HalfBar, HalfBar]  # by side
    free_twist: float


@dataclass(frozen=True)
class RollBar(_Elastic):
    """An anti-roll bar between a rigid axle and the body, whose twist is the axle's inclination."""

    body: str  # the axle


@dataclass(frozen=True)
class TwistBar(_Elastic):
    """A rotational spring between two parts, such as the beam of a twist-beam axle.

    Its twist is the rotation of the second part less that of the first one.
    """

    first: str
    second: str
    axis: Array  # of their relative rotation, chassis axes, (3,)
    twist_of: Callable[[Any], Array]  # returns the twist of parts with rigid joints, (n,) [rad]


AnyBar = Bar | RollBar | TwistBar


BAR, LINK = "anti_roll_bar", "drop_link"

_OF_BAR = "two bearings of an anti-roll bar share the force along it equally"
_OF_RACK = "the housing of the rack holds it in the middle between the tie rods"


def rules_of(axle: Axle) -> tuple[str, ...]:
    """Return the assumptions that resolve the statical indeterminacy of bar and rack."""
    of_bar, of_rack = (_OF_BAR,) * bool(axle.halves), (_OF_RACK,) * (axle.right.rack is not None)
    return (*of_bar, *of_rack)


def turn_of_half(axle: Axle, side: str, poses: CornerParts) -> tuple[Array, Array]:
    """Return the foot of a drop link, (n, 3) [m], and the angle of its half, (n,) [rad]."""
    half = axle.halves[side]
    places = {"foot": (half.body, half.foot)}
    foot = carried(poses.model, places, poses.states, poses.inputs)["foot"]
    return foot, half.turn(foot)


def pull_of_bar(axle: Axle, side: str, poses: CornerParts, torque: Array | float = 1.0) -> Load:
    """Return the pull of the drop link of a side for a torque of the bar, against its twist."""
    foot, turn = turn_of_half(axle, side, poses)
    half = axle.halves[side]
    direction, lever = half.lever(foot, turn)
    force = (-SENSE[side] * torque / lever)[:, None] * direction
    return Load(half.body, "link_foot", LINK, force, np.zeros(3), foot)


def on_the_bar(
    axle: Axle, poses: Mapping[str, Any], loads: Sequence[Load]
) -> tuple[list[Load], dict[str, BodyPose]]:
    """Return the loads on the anti-roll bar and its drop links, and on the chassis; their poses.

    `poses` are `CornerParts` of both sides, by suffix; `loads` are all others, including those of
    the drop links on the sides. A drop link carries a force along it. The deflected bar is a body
    on two bearings at its bushes: forces across the line through them follow from the balance of
    forces and moments. If the halves turn about other axes than this line, each bearing carries
    half of the moment about it.
    """
    found, places = [], {}
    for side in SIDES:
        (pull,) = (load for load in loads if load.by == f"{LINK}_{side}")
        _, turn = turn_of_half(axle, side, poses[f"_{side}"])
        top = axle.halves[side].top_at(turn)
        link, point = f"{LINK}_{side}", f"link_top_{side}"
        foot = replace(pull, part=link, by=pull.part, force=-pull.force)
        found += [foot, *on_both(link, BAR, Load(link, point, BAR, pull.force, STILL, top))]
        places[link] = BodyPose.unturned(pull.at)
    bushes = [np.broadcast_to(axle.halves[s].bush, top.shape) for s in SIDES]
    middle = np.mean(bushes, axis=0)
    bearings = _on_bearings(bushes, sum_of(found, BAR, middle))
    for side, bush, wrench in zip(SIDES, bushes, bearings, strict=True):
        load = Load(BAR, f"bar_bush_{side}", "chassis", wrench[:, :3], wrench[:, 3:], bush)
        found += on_both(BAR, "chassis", load)
    return found, places | {BAR: BodyPose.unturned(middle)}


def _on_bearings(bushes: list[Array], wrench: Array) -> tuple[Array, Array]:
    """Return the wrenches of two bearings on a bar, from force and moment about their middle."""
    force, moment = wrench[:, :3], wrench[:, 3:]
    apart = bushes[0] - bushes[1]
    square = (apart * apart).sum(-1, keepdims=True)
    # couple of forces across the line: apart x pair = -moment, except its part about the line
    pair = cross(apart, moment) / square
    about = (moment * apart).sum(-1, keepdims=True) / square * apart
    left, right = (
        np.concatenate([sign * pair - 0.5 * force, -0.5 * about], -1) for sign in (1, -1)
    )
    return left, right
