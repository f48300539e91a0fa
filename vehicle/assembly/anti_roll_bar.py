"""An anti-roll bar, by what it does between two sides or to a rigid axle."""

from dataclasses import dataclass

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
