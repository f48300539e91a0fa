"""The car that a function of this folder is given."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ....core.validator import Validator
from ...assembly.car import CarAssembly
from ...assembly.equilibrium import equilibrium
from ...assembly.of import assembly_of
from ...models.axle.axle import Axle
from ...models.car.car import Car, center_of_gravity, masses
from ...models.car.equations import CarModel
from .body_motion import BodyMotion
from .car import DrivingCar


def driving_car(source: str, subject: Any) -> DrivingCar:
    """Return a car that drives, or its equations, as handling sees it.

    Raises
    ------
    InputError
        If it is none: if its body is held, or does not travel.
    PositionError
        If it does not rest on its wheels.
    """
    if isinstance(subject, DrivingCar):
        return subject
    with Validator(source) as given:
        given.instance("subject", subject, (Car, CarModel, CarAssembly), _NEEDED)
    found = assembly_of(subject)
    assert isinstance(found, CarAssembly)
    found.require_driving()
    rest = equilibrium(found.model)
    assert rest.inputs is not None
    car, names = found.car, found.model.state_names
    center = center_of_gravity(car)
    heights = found.model.signals(rest)
    front = np.mean([car.wheel_centers[wheel][0] for wheel in found.wheels[:2]])
    rear = np.mean([car.wheel_centers[wheel][0] for wheel in found.wheels[2:]])
    return DrivingCar(
        model=found.model,
        rest=np.asarray(rest),
        base=np.array(rest.inputs),
        controls=_Controls(found),
        motion=BodyMotion(names, car.com, center),
        wheels=found.wheels,
        spins=tuple(found.names_of(wheel).spin for wheel in found.wheels),
        radii=tuple(float(heights[f"{wheel}_wheel_center_z"]) for wheel in found.wheels),
        wheelbase=float(front - rear),
        front=float(front - center[0]),
        mass=sum(mass for mass, _ in masses(car)),
    )


class _Controls:
    """The controls of a car, the motion of whose rack is asked for at every sample.

    Parameters
    ----------
    assembly : CarAssembly
    """

    def __init__(self, assembly: CarAssembly) -> None:
        self._own = assembly.controls
        self.brakes, self.drive = self._own.brakes, self._own.drive
        # which side it steers to is found once, with the checks
        self._zero = self._own.rack(0.0)["rack_position"]
        self._slope = self._own.rack(0.0, 1.0)["rack_velocity"]
        front = assembly.car.axles["front"]
        self._curve = front.steering if isinstance(front, Axle) else None

    def rack(
        self, angle: float, rate: float = 0.0, acceleration: float = 0.0
    ) -> Mapping[str, float]:
        """Return the motion of the rack, by that of the steering wheel."""
        position, slope, bend = self._zero + self._slope * angle, self._slope, 0.0
        if self._curve is not None:
            at = np.asarray(angle)
            position = float(self._curve.rack(at))
            slope = float(self._curve.travel_per_turn(at)) / (2.0 * np.pi)
            bend = float(self._curve.bend(at))
        return {
            "rack_position": position,
            "rack_velocity": slope * rate,
            "rack_acceleration": slope * acceleration + bend * rate * rate,
        }


_NEEDED = (
    'a kintrafo.Car that drives, such as kintrafo.load("driving_car"), is needed; the body of a '
    "suspension or an axle by itself is held"
)
