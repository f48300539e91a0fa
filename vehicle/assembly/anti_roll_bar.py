"""An anti-roll bar, by what it does between two sides, to a rigid axle or between two parts."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..models.axle.bar import HalfBar

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Bar:
    """An anti-roll bar between two sides.

    Attributes
    ----------
    halves : tuple of HalfBar
        By side.
    rate : float
        Torque by the twist, the first half less the second one [N m/rad].
    free_twist : float
        The twist without a torque [rad].
    """

    halves: tuple[HalfBar, HalfBar]
    rate: float
    free_twist: float

    def torque(self, twist: Array) -> Array:
        """Return the torque at a twist [N m]."""
        found: Array = self.rate * (twist - self.free_twist)
        return found


@dataclass(frozen=True)
class RollBar:
    """An anti-roll bar, by what it does to a rigid axle.

    Attributes
    ----------
    body : str
        The axle.
    rate : float
        Moment by the inclination of what points left at design [N m/rad].
    """

    body: str
    rate: float

    def torque(self, twist: Array) -> Array:
        """Return the moment at an inclination [N m]."""
        found: Array = self.rate * twist
        return found


@dataclass(frozen=True)
class TwistBar:
    """What resists that one part turns against another, as the beam of a twist-beam axle.

    Attributes
    ----------
    first, second : str
        The parts.
    axis : ndarray, shape (3,)
        About which they turn against each other, chassis axes.
    rate : float
        Torque by the twist, the turn of the second part less that of the first one [N m/rad].
    twist_of : callable
        Takes the parts with rigid joints, returns their twist, (n,) [rad].
    """

    first: str
    second: str
    axis: Array
    rate: float
    twist_of: Callable[[Any], Array]

    def torque(self, twist: Array) -> Array:
        """Return the torque at a twist [N m]."""
        found: Array = self.rate * twist
        return found


AnyBar = Bar | RollBar | TwistBar
