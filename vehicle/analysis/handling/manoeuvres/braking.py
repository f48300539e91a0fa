"""Braking in a straight line (after ISO 21994, without an anti-lock system)."""

from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from ..car import DrivingCar
from ..drivers import Braking
from ..responses import first_crossing
from ..result import HandlingResult
from .brakes import BrakingManoeuvre
from .manoeuvre import Number, Progress
from .simulated import greatest


class StraightBraking(BrakingManoeuvre):
    """A car brakes straight ahead, with the steering wheel held."""

    TITLE: ClassVar[str] = "braking in a straight line"
    SLOPES: ClassVar[bool] = True

    manoeuvre: Literal["braking"] = Field(description="name of the manoeuvre")

    def run(self, car: DrivingCar, progress: Progress) -> HandlingResult:
        """Return the braking distance and decelerations, and the motion."""
        _, straight = self.straight(car)
        end = self.end_speed
        pushes = Braking(straight.unknowns["drive"], self.pedal_of(car), self.start_s, self.rise_s)
        motion = self.held(car, straight, pushes, self.duration_s, progress)
        self.refuse_without_end(motion)
        time, speed, x = (motion[name].values for name in ("time", "speed", "x"))
        begun = float(np.interp(self.start_s, time, x))
        slowed = first_crossing(time, -speed, -end)
        high, low = 0.8 * self.speed, max(0.1 * self.speed, end)
        between = np.interp([first_crossing(time, -speed, -v) for v in (high, low)], time, x)
        numbers: dict[str, Number] = {
            "braking_distance": (
                float(np.interp(slowed, time, x)) - begun, "braking distance", "m",
            ),
            "braking_time": (slowed - self.start_s, "time of braking", "s"),
            "mean_deceleration": (
                (high**2 - low**2) / (2.0 * float(between[1] - between[0])),
                "mean fully developed deceleration", "m/s^2",
            ),
            "lateral_deviation": (
                float(np.abs(motion["y"] - motion["y"][0]).max()), "greatest lateral deviation", "m"
            ),
            "greatest_pitch_angle": (
                float(motion["pitch_angle"].max()), "greatest pitch angle, positive nose down",
                "rad",
            ),
            "greatest_slip": (
                float(-motion["slip"].min()), "greatest braking slip of a wheel", "1"
            ),
        }  # fmt: skip
        numbers |= self.locking(motion) | greatest(motion)
        return HandlingResult(self.judged(numbers), {"": motion})
