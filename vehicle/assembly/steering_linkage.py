"""Loads on the steering of an axle: a rack, or a Pitman arm, alone or with relay rod and idler."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...core.named_types import Array
from ...core.quantities import variable
from ...core.vectors import cross, directions
from ..corner.corner import UP
from ..input.pitman_arm import RELAY_ROD, PitmanArmSection, PitmanLinkage
from ..input.vehicle import Steering
from .coupling import STEERING, STILL, BodyPose, on_both, on_the_rack, sum_of
from .load import RACK, Load
from .part_poses import PartPoses

if TYPE_CHECKING:
    import xarray as xr

ARM, IDLER = "pitman_arm", "idler_arm"


def on_the_steering(
    poses: PartPoses, loads: Sequence[Load], point: str
) -> tuple[list[Load], dict[str, BodyPose]]:
    """Return the loads on a rack, or on a Pitman arm and its linkage; none where nothing steers.

    `poses` are those of one side or of a whole axle, `loads` all others, among them those of tie
    rods; `point` is the name of the middle of a rack between the tie rods.
    """
    if poses.rack_axis is not None:
        return on_the_rack(poses.rack_axis, loads, point)
    if IDLER in poses.turned:
        return on_the_linkage(poses, loads)
    return on_the_arm(poses, loads) if ARM in poses.turned else ([], {})


def steering_force(poses: PartPoses, loads: Sequence[Load]) -> Array:
    """Return the force of the steering along the position of the rack, (n,) [N].

    It is the force on a rack along its axis, or the moment of the Pitman arm over its length.
    `poses` are those of one side or of a whole axle; `loads` have those of both tie rods.
    """
    if poses.rack_axis is None:
        gear = poses.steering_gear
        held, _ = on_the_steering(poses, loads, "")
        (moment,) = (one.moment for one in held if one.part == ARM and one.by == STEERING)
        return np.asarray(moment @ gear.direction_of(ARM) / gear.length())
    axis = poses.rack_axis
    others = [load.force @ axis for load in loads if load.part == RACK]
    return np.asarray(-sum(others, np.zeros(len(poses.states))))


def steering_of(
    gear: Steering | PitmanArmSection, over: str, found: "xr.Dataset"
) -> "dict[str, xr.Variable]":
    """Return the force of the steering by name, and the moment of a Pitman arm.

    `over` is the dimension of the positions, and `found` has the loads.
    """
    (row,) = np.flatnonzero(found["part"].isin((RACK, ARM)) & (found["by"] == STEERING))
    if not isinstance(gear, PitmanArmSection):
        force = found["force"].values[:, row] @ gear.direction()
        words = "force of the steering on the rack along its axis"
        return {"rack_force": variable(over, force, words, "N")}
    moment = found["moment"].values[:, row] @ gear.direction_of(ARM)
    words = "moment of the steering on the Pitman arm about its axis"
    per_length = f"{words}, over the length of the arm"
    return {
        "rack_force": variable(over, moment / gear.length(), per_length, "N"),
        "pitman_moment": variable(over, moment, words, "N m"),
    }


def on_the_arm(poses: PartPoses, loads: Sequence[Load]) -> tuple[list[Load], dict[str, BodyPose]]:
    """Return the loads on a Pitman arm that moves a drag link, and on the chassis.

    `poses` are those of the steered axle; `loads` are all others, with that of the drag link.
    """
    gear = poses.steering_gear
    pivot = np.broadcast_to(gear.metres("pivot"), poses.points["pitman_ball"].shape)
    held = _on_its_pivot(ARM, loads, pivot, gear.direction_of(ARM))
    return held, {ARM: BodyPose(pivot, poses.turned[ARM])}


def on_the_linkage(
    poses: PartPoses, loads: Sequence[Load]
) -> tuple[list[Load], dict[str, BodyPose]]:
    """Return the loads on the steering linkage and on the chassis, and the poses of its parts.

    `poses` are those of a suspension that the linkage steers; `loads` are all others, with those of
    tie rods on the relay rod. The relay rod is in equilibrium under the tie rods, a force and a
    moment across the axes of its universal joint at the Pitman arm, and a force of the idler arm
    that has no moment about its axis. The bearing of each arm takes force and moment at its pivot,
    and the steering the moment of the Pitman arm about its axis.
    """
    gear = poses.steering_gear
    ball, idler_ball = (poses.points[name] for name in ("pitman_ball", "idler_ball"))
    pivots = {
        part: np.broadcast_to(gear.metres(name), ball.shape)
        for part, name in ((ARM, "pivot"), (IDLER, "idler_pivot"))
    }
    wrench = sum_of(loads, RELAY_ROD, ball)
    tangent = cross(gear.direction_of(IDLER), idler_ball - pivots[IDLER])
    pull, moment = _on_the_rod(wrench, idler_ball - ball, tangent, _across_the_joint(gear, poses))
    by_arm = Load(RELAY_ROD, "pitman_ball", ARM, -wrench[:, :3] - pull, moment, ball)
    by_idler = Load(RELAY_ROD, "idler_ball", IDLER, pull, STILL, idler_ball)
    held = [*on_both(RELAY_ROD, ARM, by_arm), *on_both(RELAY_ROD, IDLER, by_idler)]
    for part, pivot in pivots.items():
        held += _on_its_pivot(part, held, pivot, gear.direction_of(part))
    places = {
        part: BodyPose(center, poses.turned[part])
        for part, center in ((RELAY_ROD, ball), *pivots.items())
    }
    return held, places


def _across_the_joint(gear: PitmanLinkage, poses: PartPoses) -> Array:
    """Return the direction across both axes of the joint of the relay rod at the Pitman arm."""
    rod = gear.metres("idler_ball") - gear.metres("ball")
    first = poses.turned[ARM] @ UP
    second = poses.turned[RELAY_ROD] @ cross(rod, UP)
    return directions(cross(first, second))


def _on_the_rod(wrench: Array, rod: Array, tangent: Array, across: Array) -> tuple[Array, Array]:
    """Return the force of the idler arm on the relay rod, and the moment of the Pitman arm on it.

    With all moments about the joint at the Pitman arm, ``rod x force + moment + applied = 0``,
    where the moment is along `across` and the force at right angles to `tangent`. `wrench` is the
    applied force [N] and moment [N m], (n, 6); `rod` leads from that joint to the one at the idler
    arm [m], `tangent` is that of the circle of the idler arm's ball, and `across` is across both
    axes of the joint, (n, 3) each.
    """

    def dot(first: Array, second: Array) -> Array:
        return np.sum(first * second, axis=-1, keepdims=True)

    moment: Array = -dot(wrench[:, 3:], rod) / dot(across, rod) * across
    aside = cross(rod, wrench[:, 3:] + moment) / dot(rod, rod)
    force: Array = aside - dot(aside, tangent) / dot(rod, tangent) * rod
    return force, moment


def _on_its_pivot(part: str, loads: Sequence[Load], pivot: Array, axis: Array) -> list[Load]:
    """Return the loads of an arm's bearing, and of the steering about its axis, at its pivot."""
    wrench = sum_of(loads, part, pivot)
    force, moment = -wrench[:, :3], -wrench[:, 3:]
    point = "pitman_pivot" if part == ARM else "idler_pivot"
    if part == IDLER:  # its moment about the axis is rounding
        return on_both(part, "chassis", Load(part, point, "chassis", force, moment, pivot))
    about = (moment @ axis)[:, None] * axis
    steering = Load(part, point, STEERING, STILL, about, pivot)
    reaction = Load("chassis", point, STEERING, STILL, -about, pivot)
    bearing = Load(part, point, "chassis", force, moment - about, pivot)
    return [steering, reaction, *on_both(part, "chassis", bearing)]
