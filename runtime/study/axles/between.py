"""What both sides of an axle load: the anti-roll bar with its drop links, and the rack."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ...core.vectors import cross, unit_vector
from ...suspension.axle import Axle
from ...suspension.axle.axle import LEFT, RIGHT
from ...suspension.corner import Array
from ...suspension.points import carried
from ..loads.dataset import Place
from ..loads.poses import Poses, wrench_about
from ..loads.reactions import Load

SIDES = (LEFT, RIGHT)
BAR, LINK, RACK, STEERING = "anti_roll_bar", "drop_link", "rack", "steering"

_OF_BAR = "two bearings of an anti-roll bar share the force along it equally"
_OF_RACK = "the housing of the rack holds it in the middle between the tie rods"


def rules_of(axle: Axle) -> tuple[str, ...]:
    """Return what decides where statics alone does not."""
    return (_OF_BAR, _OF_RACK) if axle.steered() else (_OF_BAR,)


def turn_of_half(axle: Axle, side: str, poses: Poses) -> tuple[Array, Array]:
    """Return the foot of a drop link, (n, 3) [m], and the angle of its half, (n,) [rad]."""
    half = axle.halves[side]
    places = {"foot": (half.body, half.foot)}
    foot = carried(poses.model, places, poses.states, poses.inputs)["foot"]
    return foot, half.turn(foot)


def pull_of_bar(axle: Axle, side: str, poses: Poses, torque: Array | float = 1.0) -> Load:
    """Return what a torque of the bar does on a side: against more twist of it."""
    foot, turn = turn_of_half(axle, side, poses)
    half = axle.halves[side]
    direction, lever = half.lever(foot, turn)
    sense = {LEFT: -1.0, RIGHT: 1.0}[side]
    force = (sense * torque / lever)[:, None] * direction
    return Load(half.body, "link_foot", LINK, force, np.zeros(3), foot)


def torque_of_bar(axle: Axle, poses: Mapping[str, Poses]) -> Array:
    """Return the torque of the bar, positive with the left half turned the farther, (n,) [N m]."""
    assert axle.bar is not None
    left, right = (turn_of_half(axle, side, poses[f"_{side}"])[1] for side in SIDES)
    torque: Array = axle.bar.rate() * (left - right - axle.bar.free_twist())
    return torque


class Between:
    """Adds to the loads of both sides those of what is between them.

    Parameters
    ----------
    axle : Axle

    Notes
    -----
    A drop link carries a force along it. The bar, bent as it is, is a body on two bearings at its
    bushes: forces across the line through them follow from the balance of forces and moments. Where
    the halves turn about axes that are not on this line, a moment about it is left, half at each.
    """

    def __init__(self, axle: Axle) -> None:
        self.axle = axle

    def __call__(
        self, poses: Mapping[str, Poses], loads: list[Load]
    ) -> tuple[list[Load], dict[str, Place]]:
        """Return all loads, and where bar, links and rack are; see `kintrafo.study.loads`."""
        rack, places = self._rack(loads) if self.axle.steered() else ([], {})
        if self.axle.halves:
            bar, of_bar = self._bar(poses, loads)
            rack, places = [*bar, *rack], of_bar | places
        return [*loads, *rack], places

    def _bar(
        self, poses: Mapping[str, Poses], loads: list[Load]
    ) -> tuple[list[Load], dict[str, Place]]:
        found, places = [], {}
        for side in SIDES:
            (pull,) = (load for load in loads if load.by == f"{LINK}_{side}")
            _, turn = turn_of_half(self.axle, side, poses[f"_{side}"])
            top = self.axle.halves[side].top_at(turn)
            link, point = f"{LINK}_{side}", f"link_top_{side}"
            foot = replace(pull, part=link, by=pull.part, force=-pull.force)
            found += [foot, *_both(link, BAR, Load(link, point, BAR, pull.force, _NONE, top))]
            places[link] = _at(pull.at)
        bushes = [np.broadcast_to(self.axle.halves[s].bush, top.shape) for s in SIDES]
        middle = np.mean(bushes, axis=0)
        bearings = _on_bearings(bushes, _sum(found, BAR, middle))
        for side, bush, wrench in zip(SIDES, bushes, bearings, strict=True):
            load = Load(BAR, f"bar_bush_{side}", "chassis", wrench[:, :3], wrench[:, 3:], bush)
            found += _both(BAR, "chassis", load)
        return found, places | {BAR: _at(middle)}

    def _rack(self, loads: list[Load]) -> tuple[list[Load], dict[str, Place]]:
        """Return what holds the rack: along it the steering, in all else its housing."""
        own = [load for load in loads if load.part == RACK]
        middle = np.mean([load.at for load in own], axis=0)
        wrench = _sum(own, RACK, middle)
        axis = unit_vector(self.axle.right.rack.axis)
        along = (wrench[:, :3] @ axis)[:, None] * axis
        steering = Load(RACK, "rack_middle", STEERING, -along, _NONE, middle)
        across = along - wrench[:, :3]
        housing = Load(RACK, "rack_middle", "chassis", across, -wrench[:, 3:], middle)
        reaction = replace(steering, part="chassis", force=along)
        return [steering, reaction, *_both(RACK, "chassis", housing)], {RACK: _at(middle)}


_NONE = np.zeros(3)


def _both(one: str, other: str, load: Load) -> list[Load]:
    """Return a load of one part by another, and its opposite."""
    back = replace(load, part=other, by=one, force=-load.force, moment=-load.moment)
    return [load, back]


def _at(center: Array) -> Place:
    """Return a part whose own axes are those of the chassis."""
    return Place(center, np.broadcast_to(np.eye(3), (*center.shape, 3)))


def _sum(loads: list[Load], part: str, about: Array) -> Array:
    """Return force and moment of the loads on a part about a point, (n, 6)."""
    own = [wrench_about(about, o.at, o.force, o.moment) for o in loads if o.part == part]
    total: Array = np.sum(own, axis=0)
    return total


def _on_bearings(bushes: list[Array], wrench: Array) -> tuple[Array, Array]:
    """Return what two bearings exert on a bar under a force and a moment about their middle."""
    force, moment = wrench[:, :3], wrench[:, 3:]
    apart = bushes[0] - bushes[1]
    square = (apart * apart).sum(-1, keepdims=True)
    # couple of forces across the line: apart x pair = -moment, but for what is about the line
    pair = cross(apart, moment) / square
    about = (moment * apart).sum(-1, keepdims=True) / square * apart
    left, right = (
        np.concatenate([sign * pair - 0.5 * force, -0.5 * about], -1) for sign in (1, -1)
    )
    return left, right
