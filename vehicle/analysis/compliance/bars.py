"""Twist of an anti-roll bar between free bodies: of two suspensions, or of a rigid axle."""

from dataclasses import dataclass

import numpy as np

from ....core.named_types import Array
from ....core.vectors import cross
from ...corner.corner import UP
from ...models.axle.bar import HalfBar
from .rigid_displacements import (
    Angles,
    BodyMeasures,
    RigidDisplacements,
    cross_matrix,
    second_by_rotation,
)


@dataclass(frozen=True)
class Foot:
    """The joint of a drop link on a body."""

    half: HalfBar
    body: int
    arm: Array  # from the centre of the body, (n, 3) [m]


@dataclass(frozen=True)
class Bars:
    """The twist of an anti-roll bar in closed form: the angle of the left half minus the right."""

    left: Foot
    right: Foot

    def at(self, places: RigidDisplacements) -> BodyMeasures:
        """Return the twist with derivatives [rad]; NaN where a drop link does not reach."""
        (one, first, bent), (other, second, also) = (
            _turned(foot, places) for foot in (self.left, self.right)
        )
        bend = np.zeros((len(one), 1, 12, 12))
        bend[:, 0, :6, :6], bend[:, 0, 6:, 6:] = bent, -also
        slope = np.concatenate([first, -second], axis=-1)[:, None]
        bodies = np.array([[self.left.body, self.right.body]])
        return BodyMeasures(bodies, (one - other)[:, None], slope, bend)


@dataclass(frozen=True)
class Inclinations:
    """The angle between a direction of a body and the horizontal plane, positive upward."""

    body: int
    direction: Array  # a unit vector, (n, 3)

    def at(self, places: RigidDisplacements) -> BodyMeasures:
        """Return the angle with derivatives [rad]."""
        upward = np.broadcast_to(UP, self.direction.shape)
        pair = np.array([[0, self.body]])
        sine = Angles(pair, upward[:, None], self.direction[:, None]).at(places)
        # by the chain rule, with the derivatives of asin
        square = 1.0 - sine.value**2
        slope = sine.slope / np.sqrt(square)[..., None]
        bend = sine.bend + sine.value[..., None, None] * (slope[..., :, None] * slope[..., None, :])
        bend /= np.sqrt(square)[..., None, None]
        return BodyMeasures(pair, np.arcsin(sine.value), slope, bend)


def _turned(foot: Foot, places: RigidDisplacements) -> tuple[Array, Array, Array]:
    """Return the angle of a half [rad], and its derivatives in six coordinates of the body."""
    arm = places.of(np.array([foot.body]), foot.arm[:, None])[:, 0]
    at = places.centers[:, foot.body] + arm
    turn = foot.half.turn(at)
    slope, bend = _by_foot(foot.half, at, turn)
    turning = -cross_matrix(arm)
    moving = np.concatenate([np.broadcast_to(np.eye(3), turning.shape), turning], axis=-1)
    by = np.einsum("nij,ni->nj", moving, slope)
    second = moving.mT @ bend @ moving
    second[:, 3:, 3:] += second_by_rotation(arm, slope)
    return turn, by, second


def _by_foot(half: HalfBar, foot: Array, turn: Array) -> tuple[Array, Array]:
    """Return the first and second derivatives of the angle of a half in the position of the foot.

    The length g = d d / 2 of the link d = T - F is constant: with T' and T'' by the angle phi,
    g_F = -d, g_FF = 1, g_phi = T' d, g_Fphi = -T', g_phiphi = T'' d + T' T'.
    """
    top = half.top_at(turn)
    link, first = top - foot, cross(np.broadcast_to(half.axis, top.shape), top - half.bush)
    second = cross(np.broadcast_to(half.axis, top.shape), first)
    by_turn = (first * link).sum(-1)[:, None]
    slope = link / by_turn
    mixed = first[..., :, None] * slope[..., None, :]
    curved = (second * link + first * first).sum(-1)[:, None, None]
    bend = mixed + mixed.mT - np.eye(3) - curved * slope[..., :, None] * slope[..., None, :]
    return slope, bend / by_turn[..., None]
