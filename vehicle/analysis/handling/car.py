"""The car of a manoeuvre: its equations, the controls of the driver, the motion of its body."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ....core.named_types import Array
from ...assembly.car import CarAssembly
from ...assembly.controls import RACK, Controls
from ...models.car.equations import CarModel
from ...models.car.slope import LEVEL, Slope
from ...roads.road import Road
from ..loads.on_a_car import rack_force
from ..run import MovingCar, Run
from .body_motion import ReferencePoint
from .road_under import RoadUnder

STEERED_INPUT = "rack_position"
"""The input that the steering wheel moves, whose rates are inputs, too."""
OF_STEERING = {
    "steering_torque": ("torque of the steering wheel, positive to the left", "N m"),
    "column_twist": (
        "twist of the steering column, positive with the steering wheel to the left", "rad",
    ),
}  # fmt: skip
"""Meaning and unit."""


@dataclass(frozen=True, kw_only=True)
class DrivingCar(MovingCar):
    """A car that drives; its radii are a first guess in the search for steady motion."""

    rest: Array  # state at standstill
    base: Array  # inputs without those of the driver
    controls: Controls
    # the centre of gravity of the whole car at design, as a point of the body
    motion: ReferencePoint
    wheelbase: float  # [m]
    # distance of the front wheel centres from the reference point at design, forward [m]
    front: float
    mass: float  # mass of the whole car [kg]
    # the state that is the displacement of the rack on a compliant column; None if the rack follows
    # the steering wheel
    rack_state: str | None = None
    watched: Callable[[Run], None] | None = None  # called with each `Run` of the car
    road: Road | None = None  # the road on which it drives; level by default
    slope: Slope = LEVEL  # the slope of its road; level by default

    @property
    def front_wheels(self) -> tuple[str, ...]:
        """The wheels of the front axle, which are steered."""
        return tuple(wheel for wheel in self.wheels if wheel.startswith("front"))

    @property
    def brake_torque(self) -> float:
        """Torque of all brakes together at full pedal [N m]."""
        return float(np.abs(self._brakes).sum())

    def road_under(self) -> RoadUnder | None:
        """Return its road under the wheels from the start on; None for a level one."""
        if self.road is None:
            return None
        behind = [0.0 if wheel in self.front_wheels else self.wheelbase for wheel in self.wheels]
        return RoadUnder(self.road, self.wheels, behind, self.model.input_names)

    def on_slope(self, slope: Slope) -> "DrivingCar":
        """Return the car on a road with a slope, from the same rest on a level one."""
        assert self.assembly is not None
        car = self.assembly.car
        model = CarModel(car, slope=slope)
        return replace(self, model=model, assembly=CarAssembly(car, model), slope=slope)

    @property
    def weight_along(self) -> float:
        """The component of its weight that slows it down on a slope, positive uphill [N]."""
        gravity = self.model.parameters["gravity"]
        return self.mass * gravity * float(self.slope.upward[0])

    def signal_rows(self, what: str, wheels: Sequence[str]) -> list[int]:
        """Return the indices of a signal of some wheels."""
        return [self.model.signal_names.index(f"{wheel}_{what}") for wheel in wheels]

    @cached_property
    def _rack(self) -> list[int]:
        return [self.model.input_names.index(name) for name in RACK]

    def inputs(
        self, angle: float, rate: float, acceleration: float, drive: float, brake: float
    ) -> Array:
        """Return the inputs of the equations.

        The motion of the steering wheel is positive to the left [rad, rad/s, rad/s^2]; the drive is
        the torque of all driven wheels together [N m], the brake a part of the greatest torque.
        """
        found = self.base + drive * self._drive if drive else self.base.copy()
        if brake:
            found += brake * self._brakes
        found[self._rack] = self.controls.rack_at(angle, rate, acceleration)
        return found

    def of_steering(self, angles: Array, states: Array, inputs: Array) -> dict[str, Array]:
        """Return the quantities of `OF_STEERING` at angles of the steering wheel [rad], each (n,).

        The work of the torque is that of the prescribed motion of the rack, without friction; that
        at a steering column twists the column, and overcomes the friction on the side of the
        steering wheel. A rigid column has no twist, and a car without linkages neither.
        """
        if self.assembly is None:
            return {}
        travel, column = self._travel(angles), self.assembly.car.column
        if column is None:
            return {"steering_torque": rack_force(self.assembly, states, inputs) * travel}
        # 1 where the rack moves in its positive direction as the steering wheel turns left
        sense = np.sign(travel)
        twisting = sum(
            self.model.signal(f"front_column_{law}_moment", states, inputs)
            for law in ("spring", "damper")
        )
        velocity = inputs[:, self.model.input_names.index("rack_velocity")]
        smoothed = velocity / np.hypot(velocity, column.friction_velocity_m_per_s)
        return {
            "steering_torque": sense * (twisting + column.friction_Nm * smoothed),
            "column_twist": -sense * self.model.signal("front_column_angle", states, inputs),
        }

    def _travel(self, angles: Array) -> Array:
        """Return the travel of the rack per angle of the steering wheel at its angles [m/rad]."""
        return self.controls.rack(angles, np.ones_like(angles))["rack_velocity"]

    @cached_property
    def _drive(self) -> Array:
        """The inputs of a torque of 1 N m."""
        return self._by_name(self.controls.drive(1.0))

    @cached_property
    def _brakes(self) -> Array:
        """The inputs of the full pedal."""
        return self._by_name(self.controls.brakes(1.0))

    def _by_name(self, values: Mapping[str, float]) -> Array:
        found = np.zeros_like(self.base)
        for name, value in values.items():
            found[self.model.input_names.index(name)] = value
        return found
