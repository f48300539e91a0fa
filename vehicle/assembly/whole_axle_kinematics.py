"""An axle that one file describes, at many positions: how its wheels are, and what springs do.

Lengths of springs, and their forces, are differentiated by the equations themselves: velocities at
unit rates of the two coordinates that move the wheels up and down are first derivatives, and the
derivatives of these are second ones.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..corner.corner import Array, Vehicle
from ..input.spring_table import rate_at
from ..input.units import in_metres
from ..models.sides import LEFT, RIGHT, SIDES
from ..models.whole_axle import WholeAxle, of_side
from ..models.whole_axle_model import WholeAxleModel
from .wheel import lowest_point, lowest_point_rate

SENSE = {LEFT: 1.0, RIGHT: -1.0}
"""Where a wheel is along the axle, in half tracks to the left."""


@dataclass(frozen=True)
class WholeAxleKinematics(ABC):
    """Such an axle at rest in many positions, of shape (n,).

    Attributes
    ----------
    model : WholeAxleModel
    states : ndarray, shape (n, states)
    """

    model: WholeAxleModel
    states: Array

    @property
    def axle(self) -> Any:
        """The axle."""
        return self.model.axle

    @property
    def end(self) -> str:
        """At which end of the vehicle it is."""
        found: str = self.axle.end
        return found

    @cached_property
    def vehicles(self) -> tuple[Vehicle, ...]:
        """What the vehicle adds, the left wheel first."""
        return tuple(vehicle_of(self.axle, side) for side in SIDES)

    @abstractmethod
    def wheel_center(self, side: str) -> Array:
        """Return the centre of a wheel [m], (n, 3)."""

    @property
    def heave(self) -> Array:
        """The height of the middle between the wheels above design [m], (n,)."""
        heights = [self.wheel_center(side)[:, 2] for side in SIDES]
        height: Array = 0.5 * sum(heights) - self.axle.center[2]
        return height

    @abstractmethod
    def _spin_axis(self, side: str) -> Array:
        """Return the spin axis of a wheel, which points left, (n, 3)."""

    @abstractmethod
    def carrier_turning(self, side: str, by: str) -> Array:
        """Return the angular velocity of what carries a wheel per unit of a coordinate, (n, 3)."""

    @abstractmethod
    def center_velocity(self, side: str, by: str) -> Array:
        """Return the velocity of the centre of a wheel per unit of a coordinate, (n, 3)."""

    def contact(self, side: str) -> Array:
        """Return the lowest point of a wheel as a thin disc [m], (n, 3)."""
        radius = self.axle.tyre_radius()
        assert radius is not None
        return lowest_point(self.wheel_center(side), self._spin_axis(side), radius)

    def contact_rate(self, side: str, by: str) -> Array:
        """Return how fast this point goes per unit of a coordinate, (n, 3)."""
        radius = self.axle.tyre_radius()
        assert radius is not None
        velocity = self.center_velocity(side, by)
        turning = self.carrier_turning(side, by)
        return lowest_point_rate(velocity, self._spin_axis(side), turning, radius)

    # -- its springs ----------------------------------------------------------------------------

    @cached_property
    def _signals(self) -> dict[str, Array]:
        return self.model.signals(self.states)

    @cached_property
    def _at_unit_rate(self) -> dict[str, tuple[dict[str, Array], dict[str, Array]]]:
        """Signals at unit rates of both coordinates, and their derivatives by both, (n, 2)."""
        found = {}
        for by in self.model.COORDINATES:
            states = self.states.copy()
            states[:, self.model.state_names.index(f"{by}_rate")] = 1.0
            slopes = self.model.evaluate("signals_jacobian", states)[..., :2]
            by_name = dict(zip(self.model.signal_names, np.moveaxis(slopes, -2, 0), strict=True))
            found[by] = self.model.signals(states), by_name
        return found

    def signal(self, name: str) -> Array:
        """Return a signal of the equations at rest."""
        return self._signals[name]

    def compression(self, part: str, by: str) -> Array:
        """Return how a spring or a damper is compressed per unit of a coordinate."""
        signals, _ = self._at_unit_rate[by]
        return -signals[f"{part}_velocity"]

    @cached_property
    def of_springs(self) -> tuple[Array, Array]:
        """What springs and stops do by both coordinates, (n, 2), and its derivatives, (n, 2, 2)."""
        forces = [self._virtual_work(f"{side}_{part}", force) for side, part, force in _SPRINGS]
        work, slopes = zip(*forces, strict=True)
        return np.sum(work, axis=0), np.sum(slopes, axis=0)

    @property
    @abstractmethod
    def bar(self) -> Array:
        """The stiffness of what couples the wheels, (n, 2, 2) [N/m], the left one first."""

    @property
    @abstractmethod
    def springs(self) -> Array:
        """The stiffness of springs and stops at both wheels, (n, 2, 2) [N/m]."""

    def growth(self, path: str) -> Array:
        """Return how the length of a spring or a damper grows by both coordinates, (n, 2)."""
        rates = [self._at_unit_rate[by][0][f"{path}_velocity"] for by in self.model.COORDINATES]
        return np.stack(rates, -1)

    def rate_of_stops(self, side: str) -> Array:
        """Return the rate of the stops beside a damper, along it, (n,) [N/m]."""
        path = f"{side}_damper"
        growth, slopes = self.growth(path), self._at_unit_rate[self.model.COORDINATES[0]][1]
        changes = slopes[f"{path}_bump_stop_force"] + slopes[f"{path}_rebound_stop_force"]
        rate: Array = -(changes * growth).sum(-1) / (growth * growth).sum(-1)
        return rate

    def rate_of_spring(self, side: str) -> Array:
        """Return the rate of a spring, along it, (n,) [N/m]."""
        parameters = of_side(self.model.parameters, side)
        return rate_at(parameters, self._signals[f"{side}_spring_length"])

    def _virtual_work(self, path: str, force: str) -> tuple[Array, Array]:
        """Return what a force along a path does by both coordinates, and its derivatives."""
        acting, growth = self._signals[force], self.growth(path)
        bends = [self._at_unit_rate[by][1][f"{path}_velocity"] for by in self.model.COORDINATES]
        changes = self._at_unit_rate[self.model.COORDINATES[0]][1][force]
        work = acting[:, None] * growth
        slopes_of_work = growth[..., :, None] * changes[..., None, :]
        return work, slopes_of_work + acting[:, None, None] * np.stack(bends, -2)


def vehicle_of(axle: WholeAxle, side: str) -> Vehicle:
    """Return what the vehicle adds to a wheel, in SI units."""
    tyre, given = axle.tyre, axle.vehicle
    lengths = given.wheelbase_mm, given.center_of_gravity_height_mm
    wheelbase, height = (None if n is None else in_metres(n, "mm") for n in lengths)
    front = axle.end == "front"
    return Vehicle(
        side=SENSE[side],
        tyre_radius=axle.tyre_radius(),
        tyre_rate=tyre.rate_N_per_m,
        tyre_lateral_rate=tyre.lateral_rate_N_per_m,
        tyre_longitudinal_rate=tyre.longitudinal_rate_N_per_m,
        wheelbase=wheelbase,
        center_of_gravity_height=height,
        front_brake_share=given.front_brake_share,
        front=True if front else None,
        rear=None if front else True,
        steered=None,
    )


_SPRINGS = tuple(
    (side, part, f"{side}_{part}_{force}")
    for side in SIDES
    for part, force in (
        ("spring", "spring_force"),
        ("damper", "bump_stop_force"),
        ("damper", "rebound_stop_force"),
    )
)
