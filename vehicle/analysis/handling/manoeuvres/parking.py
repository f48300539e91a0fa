"""Parking: the torque of the steering wheel of a stationary car.

The torque has two parts. Steering lifts and leans the car: this part follows exactly from the
linkages, by the states of rest over the angle. The tyres also turn on the road: the Magic Formula
tyres here have no turn slip, so a law of friction describes this part. A circular contact under the
inflation pressure p (R. S. Sharp and R. Granger, Proc. IMechE D 217, 2003) slides with the moment

    M = 2/3 mu F_z sqrt(F_z / (pi p))

which the moment approaches exponentially as the wheel turns on the road (P. R. Dahl, 1968).
"""

from typing import Annotated, ClassVar, Literal, NamedTuple

import numpy as np
import xarray as xr
from pydantic import Field
from scipy.interpolate import CubicSpline

from .....core.errors import InputError, KintrafoError
from .....core.named_types import Array
from ....assembly.by_wheel import WHEEL, wheel_coordinate
from ....assembly.equilibrium import equilibrium
from ....input.section import Number, Positive, Remedy
from ..car import OF_STEERING, STEERED_INPUT, DrivingCar
from ..driven import OF_DRIVER, OF_WHEELS, STEER
from ..result import HandlingResult, quantity
from .manoeuvre import Manoeuvre, Progress

ALONG = "steering_wheel_angle"

# Most steps to a side, whose states of rest take seconds.
_MOST_STEPS = 1000

# From tyres of karts to those of trucks; values in bar are outside.
_Pressure = Annotated[
    Number, Field(ge=20.0, le=2000.0), Remedy("Check the unit of the value: 2.3 bar are 230 kPa.")
]
_Friction = Annotated[
    Number, Field(ge=0.0, le=3.0), Remedy("Enter a coefficient: about 0.8 on dry asphalt.")
]

_DESCRIBED = {
    "steering_torque": OF_STEERING["steering_torque"],
    "lifting_torque": ("torque of the steering wheel that lifts the car and leans it", "N m"),
    "friction_torque": ("torque of the steering wheel that turns the tyres on the road", "N m"),
    "steering_friction_torque": (
        "torque of the steering wheel by the friction of rack and steering column", "N m",
    ),
}  # fmt: skip
_OF_WHEELS = {
    "steer": STEER,
    "fz": OF_WHEELS["fz"],
    "mz": ("moment of the wheel on the road as it turns, positive to the left", "N m"),
}
_GREATEST = {
    "steering_torque": "absolute torque of the steering wheel",
    "lifting_torque": "absolute lifting torque",
    "friction_torque": "absolute friction torque of the tyres",
    "steering_friction_torque": "absolute friction torque of rack and steering column",
}


class _Column(NamedTuple):
    """The steering column in slow motion; a rigid one without friction has zeros."""

    compliance: float = 0.0  # twist by torque [rad/(N m)]
    # torques by friction of the rack, which twist the column, and of the column itself [N m]
    at_rack: float = 0.0
    at_wheel: float = 0.0

    @classmethod
    def of(cls, car: DrivingCar) -> "_Column":
        """Return the column of a car."""
        assert car.assembly is not None  # a car from a file has linkages
        column = car.assembly.car.column
        if column is None:
            return cls()
        travel = abs(car.controls.rack(0.0, 1.0)["rack_velocity"])
        return cls(1.0 / column.rate(), column.rack_friction_N * travel, column.friction_Nm)

    @property
    def rubs(self) -> bool:
        """Whether there is friction."""
        return self.at_rack + self.at_wheel > 0.0


class Parking(Manoeuvre):
    """The steering wheel of a stationary car turns slowly from side to side."""

    TITLE: ClassVar[str] = "parking"
    TRAVELS: ClassVar[bool] = False

    manoeuvre: Literal["parking"] = Field(description="name of the manoeuvre")
    largest_deg: Positive = Field(
        default=360.0,
        description="greatest steering wheel angle, to both sides; a steering column twists "
        "further by the friction",
    )
    step_deg: Positive = Field(
        default=5.0,
        description="step of the steering wheel angle, at most a quarter of largest_deg",
    )
    friction: _Friction = Field(
        default=0.8,
        description="friction coefficient of a tyre that turns on the road; 0: no friction",
    )
    pressure_kPa: _Pressure = Field(  # noqa: N815 (Pa is the pascal)
        default=230.0, description="inflation pressure of the steered tyres"
    )
    twist_deg: Positive = Field(
        default=4.0,
        description="rotation of a wheel after which its moment is 63 % of that in sliding",
    )

    def problems(self) -> list[str]:
        found = super().problems()
        least, most = self.largest_deg / _MOST_STEPS, 0.25 * self.largest_deg
        if not least <= self.step_deg <= most:
            step = f"step_deg = {self.step_deg:g} deg"
            found.append(f"{step}: {least:g} to {most:g} deg are allowed.")
        return found

    def run(self, car: DrivingCar, progress: Progress) -> HandlingResult:
        """Return the torque over the angle, and the greatest one."""
        count = int(np.ceil(self.largest_deg / self.step_deg))
        angles = np.deg2rad(self.largest_deg) * np.arange(-count, count + 1) / count
        steer, loads, lifting = self._at_rest(car, angles, progress)
        column = _Column.of(car)
        pinion = angles - lifting * column.compliance
        slopes = CubicSpline(pinion, steer, axis=-1)(pinion, 1)
        # from the middle to the left, to the right and to the left again; where it turns back, a
        # rack with friction rests at one position
        rows = np.arange(angles.size)
        first = 0 if column.rubs else 1
        path = np.concatenate([rows[count:], rows[::-1][first:], rows[first:]])
        towards = np.repeat([1.0, -1.0, 1.0], [count + 1, *2 * [angles.size - first]])
        moments = self.moments(steer[:, path], loads[:, path])
        rubbing = (moments * slopes[:, path]).sum(axis=0)
        at_rack = lifting[path] + rubbing + column.at_rack * towards
        values = {
            "steering_torque": at_rack + column.at_wheel * towards,
            "lifting_torque": lifting[path],
            "friction_torque": rubbing,
        }
        if column.rubs:
            values["steering_friction_torque"] = (column.at_rack + column.at_wheel) * towards
        curves = {name: quantity(ALONG, each, *_DESCRIBED[name]) for name, each in values.items()}
        of_wheels = {"steer": steer[:, path], "fz": loads[:, path], "mz": moments}
        for name, words in _OF_WHEELS.items():
            curves[name] = quantity((WHEEL, ALONG), of_wheels[name], *words)
        coordinates = {
            ALONG: quantity(ALONG, pinion[path] + at_rack * column.compliance, *OF_DRIVER[ALONG]),
            WHEEL: wheel_coordinate(car.front_wheels),
        }
        title = f"{self.TITLE}, stationary"
        found = xr.Dataset(curves, coordinates, {"title": title})
        metrics = {
            f"greatest_{name}": quantity((), np.abs(values[name]).max(), f"greatest {words}", "N m")
            for name, words in _GREATEST.items()
            if name in values
        }
        return HandlingResult(xr.Dataset(metrics, attrs={"title": title}), {"": found})

    def moments(self, steer: Array, loads: Array) -> Array:
        """Return the friction moments of wheels on the road, positive left, (wheels, n) [N m].

        Steer angles [rad] follow one another, from relaxed contacts, under vertical forces [N].
        """
        radii = np.sqrt(loads / (np.pi * 1e3 * self.pressure_kPa))
        sliding = 2.0 / 3.0 * self.friction * loads * radii
        share = np.zeros_like(steer)
        turned = np.diff(steer, axis=-1)
        kept = np.exp(-np.abs(turned) / np.deg2rad(self.twist_deg))
        for i in range(turned.shape[-1]):
            towards = np.sign(turned[:, i])
            share[:, i + 1] = towards + (share[:, i] - towards) * kept[:, i]
        return share * sliding

    def _at_rest(
        self, car: DrivingCar, angles: Array, progress: Progress
    ) -> tuple[Array, Array, Array]:
        """Return steer angles and loads of the steered wheels, (wheels, n), and the torque, (n,).

        The tyres have no forces along the road.
        """
        assert car.assembly is not None  # a car from a file has linkages
        racks = car.controls.rack(angles)[STEERED_INPUT]
        states, inputs = [], []
        for i, (angle, rack) in enumerate(zip(angles.tolist(), racks.tolist(), strict=True)):
            try:
                rest = equilibrium(car.assembly.model, rack_position=rack)
            except KintrafoError as error:
                problem = (
                    f"largest_deg = {self.largest_deg:g} deg: at a steering wheel angle of "
                    f"{np.rad2deg(angle):.1f} deg the car has no equilibrium: {error}. "
                    "Choose a smaller angle."
                )
                raise InputError([problem], self.TITLE) from None
            assert rest.inputs is not None
            states.append(np.asarray(rest))
            inputs.append(np.asarray(rest.inputs))
            progress((i + 1) / angles.size)
        torque = car.of_steering(angles, np.array(states), np.array(inputs))["steering_torque"]
        signals = car.model.evaluate("signals", np.array(states), np.array(inputs))
        steer, loads = (signals[:, car.signal_rows(n, car.front_wheels)].T for n in ("steer", "fz"))
        return steer, loads, torque
