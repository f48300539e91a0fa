"""Acceleration in a straight line."""

from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from .....core.errors import InputError
from .....core.units import KM_PER_H
from ....input.section import NonNegative, Positive
from ..car import DrivingCar
from ..drivers import HeldTorque
from ..responses import first_crossing
from ..result import HandlingResult
from .manoeuvre import Number, Progress
from .simulated import UntilSpeed, greatest


class Acceleration(UntilSpeed):
    """A car accelerates straight ahead with a constant torque of the drive, up to a speed."""

    TITLE: ClassVar[str] = "acceleration"
    SLOPES: ClassVar[bool] = True
    SLOWS: ClassVar[bool] = False

    manoeuvre: Literal["acceleration"] = Field(description="name of the manoeuvre")
    torque_Nm: Positive = Field(  # noqa: N815 (N m is the unit)
        description="torque of all driven wheels together"
    )
    until_km_per_h: Positive = Field(default=100.0, description="speed at which the manoeuvre ends")
    rise_s: NonNegative = Field(default=0.2, description="time in which the torque rises")
    duration_s: Positive = Field(default=60.0, description="longest duration of the simulation")

    def run(self, car: DrivingCar, progress: Progress) -> HandlingResult:
        """Return time, distance and greatest acceleration, and the motion."""
        _, straight = self.straight(car)
        end = self.end_speed
        pushes = HeldTorque(straight.unknowns["drive"], self.torque_Nm, 0.0, self.rise_s)
        motion = self.held(car, straight, pushes, self.duration_s, progress)
        time, speed, x = (motion[name].values for name in ("time", "speed", "x"))
        if speed[-1] < end:
            problem = (
                f"until_km_per_h = {self.until_km_per_h:g} km/h: after duration_s = "
                f"{self.duration_s:g} s the speed is {KM_PER_H * speed[-1]:.1f} km/h. Raise "
                "torque_Nm or duration_s, or choose less."
            )
            raise InputError([problem], self.TITLE)
        reached = first_crossing(time, speed, end)
        numbers: dict[str, Number] = {
            "acceleration_time": (reached, "time", "s"),
            "acceleration_distance": (float(np.interp(reached, time, x)) - x[0], "distance", "m"),
            "greatest_acceleration": (
                float(motion["longitudinal_acceleration"].max()), "greatest acceleration", "m/s^2",
            ),
            "greatest_slip": (float(motion["slip"].max()), "greatest slip of a wheel", "1"),
            "greatest_pitch_angle": (
                float(-motion["pitch_angle"].min()), "greatest pitch angle, positive nose up", "rad"
            ),
        }  # fmt: skip
        return HandlingResult(self.judged(numbers | greatest(motion)), {"": motion})
