"""Anti-roll bars as rotational springs between two sides, axle and body, or two parts."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ...core.named_types import Array
from ..models.axle.bar import HalfBar


@dataclass(frozen=True)
class _Elastic:
    rate: float  # torque, or moment, per twist [N m/rad]

    def torque(self, twist: Array) -> Array:
        """Return the torque, or the moment, at a twist [N m]."""
        return self.rate * twist


@dataclass(frozen=True)
class Bar(_Elastic):
    """An anti-roll bar between two sides: its twist is the first half's angle less the second's."""

    halves: tuple[HalfBar, HalfBar]  # by side
    free_twist: float  # the twist without a torque [rad]

    def torque(self, twist: Array) -> Array:
        return super().torque(twist - self.free_twist)


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
