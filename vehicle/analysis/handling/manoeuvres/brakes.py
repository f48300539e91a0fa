"""The base of manoeuvres with brakes."""

from typing import Annotated

import xarray as xr
from pydantic import Field

from .....core.errors import InputError
from .....core.units import KM_PER_H
from ....input.section import NonNegative, Positive, Remedy
from ....input.section import Number as Value
from ....models.car.car import Car
from ..car import DrivingCar
from ..subject import require_controls
from .manoeuvre import Number
from .simulated import UntilSpeed

# Slip below which a wheel counts as locked: it is -1 where a wheel stands still, and a tyre with
# relaxation reaches that after a distance.
_LOCKED = -0.99

_Pedal = Annotated[
    Value, Field(gt=0.0, le=1.0), Remedy("Enter 1 for the whole torque, 0.5 for half of it.")
]


class BrakingManoeuvre(UntilSpeed):
    """A manoeuvre with braking down to a speed."""

    until_km_per_h: Positive = Field(default=5.0, description="speed at which the manoeuvre ends")
    start_s: NonNegative = Field(default=0.5, description="time at which the brakes are applied")

    pedal: _Pedal | None = Field(
        default=None, description="position of the pedal; 1: the whole torque of the brakes"
    )
    deceleration_m_per_s2: Positive | None = Field(
        default=None,
        description="deceleration with unlocked wheels, instead of a pedal position",
    )
    rise_s: NonNegative = Field(default=0.2, description="time in which the torque rises")
    duration_s: Positive = Field(default=20.0, description="longest duration of the simulation")

    def problems(self) -> list[str]:
        return [*super().problems(), *self.one_of("pedal", "deceleration_m_per_s2")]

    def check(self, car: Car) -> None:
        require_controls(car, brakes=True)
        super().check(car)

    def pedal_of(self, car: DrivingCar) -> float:
        """Return the position of the pedal."""
        if self.pedal is not None:
            return self.pedal
        assert self.deceleration_m_per_s2 is not None
        most = car.brake_torque / (car.mass * (sum(car.radii) / len(car.radii)))
        by_grade = car.weight_along / car.mass
        found = (self.deceleration_m_per_s2 - by_grade) / most
        words = f"deceleration_m_per_s2 = {self.deceleration_m_per_s2:g} m/s^2: "
        if found > 1.0:
            problem = (
                f"{words}the brakes of this car have torque for {most + by_grade:.2f} m/s^2 at "
                "most. Choose less, or raise the torque in [brakes] of the car."
            )
            raise InputError([problem], self.TITLE)
        if found <= 0.0:
            problem = f"{words}the grade alone has {by_grade:.2f} m/s^2. Choose more."
            raise InputError([problem], self.TITLE)
        return found

    def locking(self, motion: xr.Dataset) -> dict[str, Number]:
        """Return the number of wheels that lock: the deceleration then is that of the tyres."""
        locked = (motion["slip"] < _LOCKED).any("time").sum()
        return {"locked_wheels": (float(locked), "number of wheels that lock", "1")}

    def refuse_without_end(self, motion: xr.Dataset) -> None:
        """Raise an error for a motion whose last speed is above that of its end."""
        last = float(motion["speed"][-1])
        if last > self.end_speed:
            problem = (
                f"until_km_per_h: after duration_s = {self.duration_s:g} s the speed is "
                f"{KM_PER_H * last:.1f} km/h. Raise duration_s, or brake more."
            )
            raise InputError([problem], self.TITLE)
