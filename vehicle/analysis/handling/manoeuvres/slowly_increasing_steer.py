"""Slowly increasing steer (FMVSS 126, 49 CFR 571.126, S7.6)."""

from typing import ClassVar, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from .....core.errors import InputError
from ....input.section import Positive
from ..car import DrivingCar
from ..drivers import Observation, OpenLoop
from ..result import HandlingResult
from ..steering import ramp
from .manoeuvre import Progress
from .simulated import TurningManoeuvre, greatest

# Acceleration of gravity in the standard [m/s^2].
GRAVITY = 9.80665
# Range of lateral accelerations of the fitted angle, and that of the reference angle [g].
_FROM, _TO, _REFERENCE = 0.1, 0.375, 0.3


class SlowlyIncreasingSteer(TurningManoeuvre):
    """The steering wheel turns slowly at constant speed, up to a lateral acceleration."""

    TITLE: ClassVar[str] = "slowly increasing steer"

    manoeuvre: Literal["slowly_increasing_steer"] = Field(description="name of the manoeuvre")
    rate_deg_per_s: Positive = Field(default=13.5, description="rate of the steering wheel")
    ease_ms: Positive = Field(default=100.0, description="time in which the rate rises")
    until_lateral_acceleration_m_per_s2: Positive = Field(
        default=5.4, description="lateral acceleration at which the manoeuvre ends"
    )
    largest_deg: Positive = Field(
        default=360.0, description="steering wheel angle at which the manoeuvre ends at the latest"
    )

    def run(self, car: DrivingCar, progress: Progress) -> HandlingResult:
        """Return the steering wheel angle at 0.3 g, and the motion."""
        _, straight = self.straight(car)
        motion = self.swept(car, progress)
        before = straight.unknowns["steering_wheel"]
        acceleration = self.sense * motion["lateral_acceleration"].values
        angle = self.sense * (motion["steering_wheel_angle"].values - before)
        within = (acceleration >= _FROM * GRAVITY) & (acceleration <= _TO * GRAVITY)
        if acceleration.max() < _TO * GRAVITY:
            problem = (
                f"the lateral acceleration reaches {acceleration.max():.2f} m/s^2 up to a steering "
                f"wheel angle of {np.rad2deg(angle[-1]):.0f} deg, and {_TO * GRAVITY:.2f} m/s^2 "
                "are needed. Raise speed_km_per_h, largest_deg or "
                "until_lateral_acceleration_m_per_s2."
            )
            raise InputError([problem], self.TITLE)
        slope, offset = np.polyfit(acceleration[within], angle[within], 1)
        reference = slope * _REFERENCE * GRAVITY + offset
        numbers = {
            "reference_angle": (
                reference, "steering wheel angle A at a lateral acceleration of 0.3 g", "rad",
            ),
            "steering_wheel_gradient": (
                slope, "change of the steering wheel angle by lateral acceleration", "rad s^2/m",
            ),
        }  # fmt: skip
        return HandlingResult(self.judged(numbers | greatest(motion)), {"": motion})

    def swept(self, car: DrivingCar, progress: Progress) -> xr.Dataset:
        """Return the motion alone."""
        _, straight = self.straight(car)
        course = ramp(
            self.sense * np.deg2rad(self.largest_deg),
            np.deg2rad(self.rate_deg_per_s),
            ease=self.ease_ms / 1e3,
        )
        most = self.until_lateral_acceleration_m_per_s2

        def ended(seen: Observation) -> bool:
            return self.sense * seen.speed * seen.yaw_rate >= most

        return self.simulated(
            car, straight, OpenLoop(course, straight.unknowns["steering_wheel"]),
            self.holding(car, straight.unknowns["drive"]), course.end, until=ended,
            progress=progress,
        )  # fmt: skip
