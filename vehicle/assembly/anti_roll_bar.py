"""Anti-roll bars as rotational springs between two sides, axle and body, or two parts."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ...core.named_types import Array
from ..models.axle.bar import HalfBar


@dataclass(frozen=True)
class _Elastic:
    rate: float

    def torque(self, twist: Array) -> Array:
        """Return the torque, or the moment, at a twist [N m]."""
        found: Array = self.rate * twist
        return found


@dataclass(frozen=True)
class Bar(_Elastic):
    """An anti-roll bar between two sides.

    Attributes
    ----------
    rate : float
        Torque per twist, the angle of the first half less that of the second one [N m/rad].
    halves : tuple of HalfBar
        By side.
    free_twist : float
        The twist without a torque [rad].
    """

    halves: tuple[HalfBar, HalfBar]
    free_twist: float

    def torque(self, twist: Array) -> Array:
        """Return the torque at a twist [N m]."""
        return super().torque(twist - self.free_twist)


@dataclass(frozen=True)
class RollBar(_Elastic):
    """An anti-roll bar between a rigid axle and the body.

    Attributes
    ----------
    rate : float
        Moment per inclination of the axle's lateral axis [N m/rad].
    body : str
        The axle.
    """

    body: str


@dataclass(frozen=True)
class TwistBar(_Elastic):
    """A rotational spring between two parts, such as the beam of a twist-beam axle.

    Attributes
    ----------
    rate : float
        Torque per twist, the rotation of the second part less that of the first one [N m/rad].
    first, second : str
        The parts.
    axis : ndarray, shape (3,)
        Axis of their relative rotation, chassis axes.
    twist_of : callable
        Takes the parts with rigid joints, returns their twist, (n,) [rad].
    """

    first: str
    second: str
    axis: Array
    twist_of: Callable[[Any], Array]


AnyBar = Bar | RollBar | TwistBar
