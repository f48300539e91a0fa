"""Straight running at constant speed, for roads with heights and slopes."""

from typing import ClassVar, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from ....input.section import Positive
from ..car import DrivingCar
from ..result import HandlingResult
from .manoeuvre import Number, Progress
from .simulated import SimulatedManoeuvre, greatest


class Straight(SimulatedManoeuvre):
    """A car runs straight ahead, the steering wheel held, with a driver that holds the speed."""

    TITLE: ClassVar[str] = "straight running"
    SLOPES: ClassVar[bool] = True

    manoeuvre: Literal["straight"] = Field(description="name of the manoeuvre")
    duration_s: Positive = Field(default=10.0, description="duration of the simulation")

    def run(self, car: DrivingCar, progress: Progress) -> HandlingResult:
        """Return torques, accelerations and loads of the wheels, and the motion."""
        _, straight = self.straight(car)
        pushes = self.holding(car, straight.unknowns["drive"])
        motion = self.with_held_wheel(car, straight, pushes, self.duration_s, progress=progress)
        numbers: dict[str, Number] = {
            "drive_torque": (
                straight.unknowns["drive"], "torque of all driven wheels at the beginning", "N m"
            ),
            "steering_wheel_angle": (
                straight.unknowns["steering_wheel"],
                "angle of the held steering wheel, positive to the left", "rad",
            ),
        }  # fmt: skip
        if "steering_torque" in motion:
            torque = float(motion["steering_torque"][0])
            numbers["steering_torque"] = (
                torque, "torque of the steering wheel at the beginning, positive to the left", "N m"
            )  # fmt: skip
        numbers |= self._over_the_road(motion) if "road" in motion else {}
        return HandlingResult(self.judged(numbers), {"": motion})

    @staticmethod
    def _over_the_road(motion: xr.Dataset) -> dict[str, Number]:
        """Return the effects of the heights of a road."""
        vertical, others = motion["vertical_acceleration"].values, greatest(motion)
        return {
            "rms_vertical_acceleration": (
                float(np.sqrt(np.mean(vertical**2))), "RMS of the vertical acceleration", "m/s^2"
            ),
            "greatest_vertical_acceleration": (
                float(np.abs(vertical).max()), "greatest absolute vertical acceleration", "m/s^2"
            ),
            "greatest_load": (float(motion["fz"].max()), "greatest load of a wheel", "N"),
            **{name: others[name] for name in ("smallest_load", "greatest_roll_angle")},
        }  # fmt: skip
