"""Straight running at constant speed, for roads with heights."""

from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from ....input.section import Positive
from ..car import DrivingCar
from ..drivers import Fixed
from ..result import HandlingResult
from .manoeuvre import Number, Progress
from .simulated import SimulatedManoeuvre, greatest


class Straight(SimulatedManoeuvre):
    """A car runs straight ahead, the steering wheel held, with a driver that holds the speed."""

    TITLE: ClassVar[str] = "straight running"

    manoeuvre: Literal["straight"] = Field(description="which manoeuvre this is")
    duration_s: Positive = Field(default=10.0, description="duration of the simulation")

    def run(self, car: DrivingCar, progress: Progress) -> HandlingResult:
        """Return accelerations and loads of the wheels, and the motion."""
        _, straight = self.straight(car)
        motion = self.simulated(
            car, straight, Fixed(straight.unknowns["steering_wheel"]),
            self.holding(car, straight.unknowns["drive"]), self.duration_s, progress=progress,
        )  # fmt: skip
        vertical = motion["vertical_acceleration"].values
        numbers: dict[str, Number] = {
            "rms_vertical_acceleration": (
                float(np.sqrt(np.mean(vertical**2))), "RMS of the vertical acceleration", "m/s^2"
            ),
            "greatest_vertical_acceleration": (
                float(np.abs(vertical).max()), "greatest vertical acceleration, in size", "m/s^2"
            ),
            "greatest_load": (float(motion["fz"].max()), "greatest load of a wheel", "N"),
        }  # fmt: skip
        others = greatest(motion)
        numbers |= {name: others[name] for name in ("smallest_load", "greatest_roll_angle")}
        return HandlingResult(self.judged(numbers), {"": motion})
