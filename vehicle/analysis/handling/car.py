"""What handling asks of a car: its equations, what the driver works, and how its body moves."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ....core.named_types import Array
from ....systems.system import System
from ...assembly.car import CarAssembly
from ...assembly.controls import Controls
from ..loads.on_a_car import rack_force
from ..run import Run
from .body_motion import ReferencePoint


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
        Inputs that the driver does not work.
    controls : Controls
    motion : ReferencePoint
        Of the centre of gravity of the whole car at design, as a point of the body.
    wheels : sequence of str
        Their names: front ones first, the left one of an axle before the right one.
    spins : sequence of str
        The angles of the wheels among the states.
    radii : sequence of float
        Rolling radii, by which a search for steady motion begins [m].
    wheelbase : float
        [m]
    front : float
        How far the front wheel centres are in front of the reference point at design [m].
    mass : float
        Of the whole car [kg].
    steering_input : str
        The input that the steering wheel moves; its rates are inputs, too.
    assembly : CarAssembly, optional
        The car with its linkages, for the forces in them.
    watched : callable, optional
        Called with each `Run` of it.
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
    assembly: CarAssembly | None = None
    watched: Callable[[Run], None] | None = None

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
        """Torque of all brakes together with the pedal down [N m]."""
        return float(np.abs(self._brakes).sum())

    def signal_rows(self, what: str, wheels: Sequence[str]) -> list[int]:
        """Return the places of a signal of some wheels."""
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
            Of the steering wheel, positive to the left [rad, rad/s, rad/s^2].
        drive : float
            Torque of all driven wheels together [N m].
        brake : float
            Part of the greatest torque of the brakes.
        """
        found = self.base + drive * self._drive if drive else self.base.copy()
        if brake:
            found += brake * self._brakes
        for name, value in self.controls.rack(angle, rate, acceleration).items():
            found[self._places[name]] = value
        return found

    def steering_torque(self, angles: Array, states: Array, inputs: Array) -> Array | None:
        """Return the torque of the steering wheel, positive to the left, (n,) [N m].

        Its work is that of the prescribed motion of the rack, without friction. The result is None
        for a car without linkages.

        Parameters
        ----------
        angles : ndarray, shape (n,)
            Of the steering wheel [rad].
        states, inputs : ndarray, shape (n, states) and (n, inputs)
        """
        if self.assembly is None:
            return None
        travel: Array = self.controls.rack(angles, np.ones_like(angles))["rack_velocity"]
        return rack_force(self.assembly, states, inputs) * travel

    @cached_property
    def _drive(self) -> Array:
        """Inputs of a torque of 1 N m."""
        return self._by_name(self.controls.drive(1.0))

    @cached_property
    def _brakes(self) -> Array:
        """Inputs with the pedal down."""
        return self._by_name(self.controls.brakes(1.0))

    def _by_name(self, values: Mapping[str, float]) -> Array:
        found = np.zeros_like(self.base)
        for name, value in values.items():
            found[self._places[name]] = value
        return found
