"""The car of a manoeuvre: its equations, the controls of the driver, the motion of its body."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ....core.named_types import Array
from ....systems.system import System
from ...assembly.car import CarAssembly
from ...assembly.controls import Controls
from ...models.car.equations import CarModel
from ...models.car.slope import LEVEL, Slope
from ...roads.road import Road
from ..loads.on_a_car import rack_force
from ..run import Run
from .body_motion import ReferencePoint
from .column import column_torque, column_twist
from .road_under import RoadUnder


@dataclass(frozen=True)
class DrivingCar:
    """A car that drives.

    Attributes
    ----------
    model : System
        Its equations of motion.
    rest : ndarray
        State at standstill.
    base : ndarray
        Inputs without those of the driver.
    controls : Controls
    motion : ReferencePoint
        The centre of gravity of the whole car at design, as a point of the body.
    wheels : sequence of str
        Names of the wheels: front ones first, the left one of an axle before the right one.
    spins : sequence of str
        Names of the angles of the wheels among the states.
    radii : sequence of float
        Rolling radii, a first guess in the search for steady motion [m].
    wheelbase : float
        [m]
    front : float
        Distance of the front wheel centres from the reference point at design, forward [m].
    mass : float
        Mass of the whole car [kg].
    steering_input : str
        The input that the steering wheel moves, whose rates are inputs, too.
    rack_state : str, optional
        The state that is the displacement of the rack on a compliant column; None if the rack
        follows the steering wheel.
    assembly : CarAssembly, optional
        The car with its linkages, for the forces in them.
    watched : callable, optional
        Called with each `Run` of the car.
    road : Road, optional
        The road on which it drives; level by default.
    slope : Slope, optional
        The slope of its road; level by default.
    """

    model: System
    rest: Array
    base: Array
    controls: Controls
    motion: ReferencePoint
    wheels: Sequence[str]
    spins: Sequence[str]
    radii: Sequence[float]
    wheelbase: float
    front: float
    mass: float
    steering_input: str = "rack_position"
    rack_state: str | None = None
    assembly: CarAssembly | None = None
    watched: Callable[[Run], None] | None = None
    road: Road | None = None
    slope: Slope = LEVEL

    @property
    def body(self) -> str:
        """The name of its body."""
        return self.motion.body

    @property
    def steered(self) -> tuple[str, ...]:
        """The wheels that are steered."""
        return tuple(wheel for wheel in self.wheels if wheel.startswith("front"))

    @property
    def brake_torque(self) -> float:
        """Torque of all brakes together at full pedal [N m]."""
        return float(np.abs(self._brakes).sum())

    def road_under(self) -> RoadUnder | None:
        """Return its road under the wheels from the start on; None for a level one."""
        if self.road is None:
            return None
        behind = [0.0 if wheel in self.steered else self.wheelbase for wheel in self.wheels]
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
    def _places(self) -> dict[str, int]:
        return {name: i for i, name in enumerate(self.model.input_names)}

    def inputs(
        self, angle: float, rate: float, acceleration: float, drive: float, brake: float
    ) -> Array:
        """Return the inputs of the equations.

        Parameters
        ----------
        angle, rate, acceleration : float
            Motion of the steering wheel, positive to the left [rad, rad/s, rad/s^2].
        drive : float
            Torque of all driven wheels together [N m].
        brake : float
            Torque of the brakes as a part of the greatest one.
        """
        found = self.base + drive * self._drive if drive else self.base.copy()
        if brake:
            found += brake * self._brakes
        for name, value in self.controls.rack(angle, rate, acceleration).items():
            found[self._places[name]] = value
        return found

    def steering_torque(self, angles: Array, states: Array, inputs: Array) -> Array | None:
        """Return the torque of the steering wheel, positive to the left, (n,) [N m].

        Its work is that of the prescribed motion of the rack, without friction; a steering column
        has its own friction and transmits its twist. The result is None for a car without linkages.

        Parameters
        ----------
        angles : ndarray, shape (n,)
            Angles of the steering wheel [rad].
        states, inputs : ndarray, shape (n, states) and (n, inputs)
        """
        if self.assembly is None:
            return None
        travel = self._travel(angles)
        column = self.assembly.car.column
        if column is not None:
            return column_torque(column, self.model, states, inputs, np.sign(travel))
        return rack_force(self.assembly, states, inputs) * travel

    def column_twist(self, angles: Array, states: Array, inputs: Array) -> Array | None:
        """Return the twist of the steering column, positive to the left, (n,) [rad].

        Arguments are as of `steering_torque`. The result is None for a rigid column, and for a car
        without linkages.
        """
        if self.rack_state is None or self.assembly is None:
            return None
        return column_twist(self.model, states, inputs, np.sign(self._travel(angles)))

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
            found[self._places[name]] = value
        return found
