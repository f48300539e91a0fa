"""The wheel of a corner, and its mirror image for measures of both wheels."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...core.named_types import Array
from ..corner.corner import Corner
from .two_wheels import SteerableWheels
from .wheel import steer, toe


@dataclass(frozen=True)
class MirroredCorner(SteerableWheels):
    """A corner in n positions."""

    corner: Corner
    # returns the other wheel over the rack: the mirror image of the corner
    mirrored: Callable[[], Corner]
    # returns the corner with the rack in its middle, at the same height; None if that is out of
    # reach
    straight: Callable[[], Corner | None]

    @cached_property
    def corners(self) -> dict[str, Corner]:
        """The corner, by the name of its wheel."""
        return {"left" if self.corner.vehicle.side > 0.0 else "right": self.corner}

    @cached_property
    def _both(self) -> tuple[Corner, Corner]:
        other = self.mirrored()
        return (self.corner, other) if self.corner.vehicle.side > 0.0 else (other, self.corner)

    @property
    def left(self) -> Corner:
        """The left wheel."""
        return self._both[0]

    @property
    def right(self) -> Corner:
        """The right wheel."""
        return self._both[1]

    @cached_property
    def design_track(self) -> Array:
        """The distance of the wheel centres at design [m]."""
        return 2.0 * abs(self.corner.design_center[..., 1])

    @cached_property
    def per_turn(self) -> float | None:
        """Rack travel for one turn of the steering wheel [m]."""
        return self.corner.vehicle.travel_per_turn

    @cached_property
    def turned(self) -> tuple[Array, Array]:
        """Steer angles without static toe, the left wheel first [rad].

        NaN if the wheel cannot be straight ahead at this height.
        """
        straight = self.straight()
        # toe-in steers the left wheel to the right, and the right one to the left
        static = np.nan if straight is None else toe(straight)
        return steer(self.left) + static, steer(self.right) - static
