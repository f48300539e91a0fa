"""Coast down: deceleration without drive."""

from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from .....core.errors import InputError
from .....core.units import KM_PER_H
from ....input.section import Positive
from ..car import DrivingCar
from ..drivers import HeldTorque
from ..responses import first_crossing
from ..result import HandlingResult
from .manoeuvre import Number, Progress
from .simulated import UntilSpeed


class CoastDown(UntilSpeed):
    """A car runs straight ahead without drive, down to a speed."""

    TITLE: ClassVar[str] = "coast down"
    SLOPES: ClassVar[bool] = True

    manoeuvre: Literal["coast_down"] = Field(description="name of the manoeuvre")
    until_km_per_h: Positive = Field(default=60.0, description="speed at which the manoeuvre ends")
    duration_s: Positive = Field(default=300.0, description="longest duration of the simulation")

    def run(self, car: DrivingCar, progress: Progress) -> HandlingResult:
        """Return time, distance and driving resistance, and the motion."""
        _, straight = self.straight(car)
        end = self.end_speed
        motion = self.held(car, straight, HeldTorque(0.0, 0.0), self.duration_s, progress)
        time, speed, x = (motion[name].values for name in ("time", "speed", "x"))
        if speed[-1] > end:
            reason = (
                "downhill. Choose less grade, or raise duration_s."
                if car.weight_along < 0.0
                else "by little or no resistance. Give the car [air] and tyres with rolling "
                "resistance, or raise duration_s."
            )
            problem = (
                f"until_km_per_h = {self.until_km_per_h:g} km/h: after duration_s = "
                f"{self.duration_s:g} s the speed is {KM_PER_H * speed[-1]:.1f} km/h, {reason}"
            )
            raise InputError([problem], self.TITLE)
        reached = first_crossing(time, -speed, -end)
        settled = time > _SETTLED - 1e-6  # rounding of the time
        if settled.sum() < _FEWEST:
            problem = (
                f"until_km_per_h = {self.until_km_per_h:g} km/h: reached after {reached:.2f} s. "
                f"The resistance follows from {_FEWEST} outputs or more after the first "
                f"{_SETTLED:g} s. Choose a lower speed."
            )
            raise InputError([problem], self.TITLE)
        # F = constant + by_square v^2, with the mass of the wheels: a least-squares fit
        slowing = car.mass * -np.gradient(speed, time)
        by_square, constant = np.polyfit(speed[settled] ** 2, slowing[settled], 1)
        numbers: dict[str, Number] = {
            "coast_down_time": (reached, "time", "s"),
            "coast_down_distance": (float(np.interp(reached, time, x)) - x[0], "distance", "m"),
            "resistance_constant": (
                constant, "constant part of the driving resistance, as mass times deceleration", "N"
            ),
            "resistance_by_square": (
                by_square, "part of the driving resistance by the square of the speed", "N s^2/m^2"
            ),
        }  # fmt: skip
        return HandlingResult(self.judged(numbers), {"": motion})


# Time after which the springs have settled [s].
_SETTLED = 1.0
# Least number of outputs after it.
_FEWEST = 20
