"""The steering axis of a wheel: a line through two hardpoints, or a screw axis.

If the knuckle turns about two points (a wishbone's ball joints, a strut's mount), the axis is the
line through them. Links of which no two meet have no such points: the axis is then the screw axis
of the knuckle's velocity when the rack moves and the spring keeps its length. For links that meet
in ball joints this is the line through them, if the spring acts on one of the links.

Sources: W. Matschinsky, Road Vehicle Suspensions, Professional Engineering Publishing, 2000
(steering axes of multi-link suspensions); screw axes: O. Bottema and B. Roth, Theoretical
Kinematics, North-Holland, 1979.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...core.named_types import Array
from ..corner.corner import CarrierMotion

# Half the distance of the two points that represent a screw axis [m].
_HALF = 0.1
# Step of the arm's angle in differences of fourth order [rad]: their error is some 1e-4^4 of the
# axis, and that of rounding 1e-16 / 1e-4.
_STEP = 1e-3
_WEIGHTS = {-2: 1.0 / 12.0, -1: -8.0 / 12.0, 1: 8.0 / 12.0, 2: -1.0 / 12.0}


@dataclass(frozen=True)
class AxisOfPoints:
    """A line through two points."""

    # points, the upper one above the lower, (..., 3) [m]
    lower: Array
    upper: Array
    # derivative of the vector from the lower to the upper one with respect to wheel travel, (...,
    # 3) [1]
    rate: Array


class AxisOfTheScrew:
    """The screw axis of a motion; only requested values are computed.

    `ends` takes a further rotation of the arm [rad] and returns the lower and the upper point;
    `rise` is the derivative of wheel travel with respect to the arm's angle [m/rad].
    """

    def __init__(self, ends: Callable[[float], tuple[Array, Array]], rise: Array) -> None:
        self._ends, self._rise = ends, rise

    @cached_property
    def _both(self) -> tuple[Array, Array]:
        return self._ends(0.0)

    @property
    def lower(self) -> Array:
        """The lower point, (..., 3) [m]."""
        return self._both[0]

    @property
    def upper(self) -> Array:
        """The upper point, (..., 3) [m]."""
        return self._both[1]

    @cached_property
    def rate(self) -> Array:
        """Derivative of the vector between the points with respect to wheel travel, (..., 3)."""
        rate = np.zeros_like(self.lower)
        for by, weight in _WEIGHTS.items():
            low, high = self._ends(by * _STEP)
            rate += weight / _STEP * (high - low)
        return rate / self._rise[..., None]


def of_the_screw(center: Array, steering: CarrierMotion) -> tuple[Array, Array]:
    """Return two points on the axis of a motion, the lower and the upper one, (..., 3) [m].

    `center` is the wheel centre [m], `steering` the motion of the wheel carrier with the spring's
    length fixed.
    """
    nearest = steering.axis_nearest(center)
    along = steering.turning / np.linalg.norm(steering.turning, axis=-1, keepdims=True)
    upward = np.where(along[..., 2:] < 0.0, -along, along)
    return nearest - _HALF * upward, nearest + _HALF * upward
