"""The car of an analysis of handling."""

from typing import Any

import numpy as np

from ...assembly.car import CarAssembly
from ...assembly.controls import Controls
from ...assembly.equilibrium import equilibrium
from ...assembly.of import car_assembly_of
from ...models.car.car import Car, center_of_gravity, masses
from .body_motion import ReferencePoint
from .car import DrivingCar


def car_that_drives(source: str, subject: Any) -> CarAssembly:
    """Return a car that drives as an assembly; an `InputError` if its body does not travel."""
    found = car_assembly_of(source, subject, _NEEDED)
    found.require_driving()
    return found


def driving_car(source: str, subject: Any) -> DrivingCar:
    """Return a car that drives, or its equations, for analyses of handling.

    An `InputError` is raised if the body is held or does not travel, a `PositionError` if the car
    does not rest on its wheels.
    """
    if isinstance(subject, DrivingCar):
        return subject
    found = car_that_drives(source, subject)
    rest = equilibrium(found.model)
    assert rest.inputs is not None
    car, state, base = found.car, np.asarray(rest), np.array(rest.inputs)
    center, axles = center_of_gravity(car), car.axle_positions
    return DrivingCar.at_rest(
        found,
        state,
        base,
        rest=state,
        base=base,
        controls=found.controls,
        motion=ReferencePoint(found.model.state_names, car.com, center),
        wheelbase=axles["front"] - axles["rear"],
        front=float(axles["front"] - center[0]),
        mass=sum(mass for mass, _ in masses(car)),
        rack_state=found.rack_state,
    )


def require_controls(car: Car, *, brakes: bool = False) -> None:
    """Raise an `InputError` if the files of a car have no steering or drive, or no brakes."""
    controls = Controls(car)
    controls.rack(0.0)
    controls.drive(0.0)
    if brakes:
        controls.brakes(0.0)


_NEEDED = (
    'a kintrafo.Car that drives, such as kintrafo.load("driving_car"), is needed; the body of a '
    "suspension or an axle alone is held"
)
