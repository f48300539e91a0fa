"""Slowly increasing steer (FMVSS 126, 49 CFR 571.126, S7.6)."""

from contextlib import suppress
from typing import ClassVar, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from .....core.errors import InputError
from ....input.section import Positive
from ..car import DrivingCar
from ..circle import Turns
from ..drivers import Observation, OpenLoop
from ..result import HandlingResult
from ..steady import NoSteadyMotionError, Steady
from ..steering import ramp
from .manoeuvre import Progress
from .simulated import TurningManoeuvre, greatest

# Acceleration of gravity in the standard [m/s^2].
GRAVITY = 9.80665
# Range of lateral accelerations of the fitted angle, and that of the reference angle [g].
_FROM, _TO, _REFERENCE = 0.1, 0.375, 0.3
# Greatest part of the reference angle by which the steering wheel may be ahead of the car.
_LAG = 0.5
# Part of the greatest lateral acceleration of a steady turn near which more steering is no help.
_NEARLY = 0.95
# Fewest outputs of a fitted line.
_FEWEST = 5
_TURN = "a steady turn with {:g} g"


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
        turns, straight = self.straight(car)
        motion = self._swept(car, straight, progress)
        before = straight.unknowns["steering_wheel"]
        acceleration = self.sense * motion["lateral_acceleration"].values
        angle = self.sense * (motion["steering_wheel_angle"].values - before)
        within = (acceleration >= _FROM * GRAVITY) & (acceleration <= _TO * GRAVITY)
        if acceleration.max() < _TO * GRAVITY:
            keys = "speed_km_per_h, largest_deg or until_lateral_acceleration_m_per_s2"
            advice = self._unsteady(car, turns, straight) or f"Raise {keys}"
            most = abs(turns.reached)
            if _NEARLY * most < acceleration.max() and most < _TO * GRAVITY:
                advice = (
                    f"This car has no steady turn above {most:.2f} m/s^2 at this speed: its tyres "
                    "slide, or its steering ends. Choose another speed, or tyres with more friction"
                )
            problem = (
                f"the lateral acceleration reaches {acceleration.max():.2f} m/s^2 up to a steering "
                f"wheel angle of {np.rad2deg(angle[-1]):.0f} deg, and {_TO * GRAVITY:.2f} m/s^2 "
                f"are needed. {advice[0].upper()}{advice[1:]}."
            )
            raise InputError([problem], self.TITLE)
        if within.sum() < _FEWEST:
            problem = (
                f"output_step_ms = {self.output_step_ms:g} ms: the lateral acceleration passes the "
                f"range from {_FROM:g} g to {_TO:g} g within less than {_FEWEST} outputs. Choose a "
                "shorter step, or lower rate_deg_per_s."
            )
            raise InputError([problem], self.TITLE)
        slope, offset = np.polyfit(acceleration[within], angle[within], 1)
        reference = slope * _REFERENCE * GRAVITY + offset
        unsteady = self._unsteady(car, turns, straight, reference)
        motion.attrs["not_valid"] += [unsteady] if unsteady else []
        numbers = {
            "reference_angle": (
                reference, "steering wheel angle A at a lateral acceleration of 0.3 g", "rad",
            ),
            "steering_wheel_gradient": (
                slope, "change of the steering wheel angle by lateral acceleration", "rad s^2/m",
            ),
        }  # fmt: skip
        return HandlingResult(self.judged(numbers | greatest(motion)), {"": motion})

    def _unsteady(
        self, car: DrivingCar, turns: Turns, straight: Steady, reference: float = np.nan
    ) -> str:
        """Return why the car is far from steady turns, with advice; empty if it is not.

        A motion of the fitted range is unstable, or the reference angle is far from that of the
        steady turn.
        """
        steady = {"straight running": straight}
        with suppress(NoSteadyMotionError):
            for part in (_REFERENCE, _TO):
                steady[_TURN.format(part)] = turns.to(self.sense * part * GRAVITY)
        if unstable := self.unstable(car, steady):
            return unstable
        wheel = [each.unknowns["steering_wheel"] for each in steady.values()]
        angle = self.sense * (wheel[1] - wheel[0]) if len(wheel) > 1 else np.nan
        if abs(reference - angle) > _LAG * abs(reference):
            return (
                f"the steering wheel angle at 0.3 g is {np.rad2deg(reference):.3g} deg, and that "
                f"of the steady turn {np.rad2deg(angle):.3g} deg: the car lags behind the steering "
                "wheel. Lower rate_deg_per_s or the speed"
            )
        return ""

    def _swept(self, car: DrivingCar, straight: Steady, progress: Progress) -> xr.Dataset:
        """Return the motion alone."""
        course = ramp(
            self.sense * np.deg2rad(self.largest_deg),
            np.deg2rad(self.rate_deg_per_s),
            ease=self.ease_ms / 1e3,
        )
        most = self.until_lateral_acceleration_m_per_s2
        before: Observation | None = None

        def ended(seen: Observation) -> bool:
            nonlocal before
            change = 0.0 if before is None else seen.lateral_velocity - before.lateral_velocity
            before = seen
            acceleration = 1e3 * change / self.step_ms + seen.speed * seen.yaw_rate
            return self.sense * acceleration >= most

        return self.simulated(
            car, straight, OpenLoop(course, straight.unknowns["steering_wheel"]),
            self.holding(car, straight.unknowns["drive"]), course.end, until=ended,
            progress=progress,
        )  # fmt: skip
