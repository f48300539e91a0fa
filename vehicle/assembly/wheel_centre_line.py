"""The line through the wheel centres of an axle: its inclination, and the rate of this.

A roll of the body is the inclination of this line to the body's x-y plane, relative to that at
design.
"""

from dataclasses import dataclass

import numpy as np

from ...core.named_types import Array, ArrayLike
from ..models.axle import Axle
from ..models.model import Model
from ..models.points import carried, carried_velocity
from ..models.positions import arm_angles, design_height
from ..models.reach import at_rest
from ..models.sides import LEFT, RIGHT

_CENTER = "wheel_center"


@dataclass(frozen=True)
class WheelCentreLine:
    """The line in n positions of both wheels."""

    across: Array  # from the right wheel centre to the left one, (n, 3) [m]
    # derivative with respect to opposite travel of the wheels, the right one upward, (n, 3) [1]
    rate: Array
    design: Array  # as `across`, at design, (3,) [m]

    @classmethod
    def at(
        cls, axle: Axle, left: ArrayLike, right: ArrayLike, rack: float = 0.0
    ) -> "WheelCentreLine":
        """Return the line at travels of both wheels and a displacement of the rack [m].

        Raises `PositionError` if a wheel cannot be there.
        """
        (one, fast), (other, also) = (
            _center(axle.models[side], np.asarray(travel, float), rack)
            for side, travel in ((LEFT, left), (RIGHT, right))
        )
        design = [axle.sides[side].hardpoints.metres(_CENTER) for side in (LEFT, RIGHT)]
        return cls(one - other, -fast - also, design[0] - design[1])

    @property
    def roll(self) -> Array:
        """The roll angle of the body, positive with its right side down, (n,) [rad]."""
        return _inclination(self.design) - _inclination(self.across)

    @property
    def roll_rate(self) -> Array:
        """The derivative of the roll angle with respect to opposite travel, (n,) [rad/m]."""
        return -inclination_rate(self.across, self.rate)


def inclination_rate(along: Array, rate: Array) -> Array:
    """Return the rate of a vector's inclination to the x-y plane, from the vector's rate [rad]."""
    level = np.hypot(along[..., 0], along[..., 1])
    spread = (along[..., :2] * rate[..., :2]).sum(-1) / level
    return (level * rate[..., 2] - along[..., 2] * spread) / (level**2 + along[..., 2] ** 2)


def _inclination(along: Array) -> Array:
    return np.arctan2(along[..., 2], np.hypot(along[..., 0], along[..., 1]))


def _center(model: Model, travel: Array, rack: float) -> tuple[Array, Array]:
    """Return a wheel centre at travels [m], and its derivative with respect to them, (n, 3)."""
    angles = arm_angles(model, design_height(model) + travel, rack)
    states, inputs = at_rest(model, angles, rack, arm_rate=1.0)
    body = model.suspension.carrier
    at_design = model.suspension.hardpoints.metres(_CENTER)
    place = carried(model, {_CENTER: (body, at_design)}, states, inputs)[_CENTER]
    velocity = carried_velocity(model, body, place, states, inputs)
    return place, velocity / velocity[..., 2:]
