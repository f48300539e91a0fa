"""Step steer (ISO 7401, step input)."""

from typing import ClassVar, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from ....input.section import Flag, Positive
from ..car import DrivingCar
from ..drivers import OpenLoop
from ..responses import step_response
from ..result import HandlingResult
from ..steering import SteeringCourse, ramp
from .manoeuvre import Number, Progress
from .simulated import SteeredManoeuvre, greatest


class StepSteer(SteeredManoeuvre):
    """The steering wheel turns quickly to an angle, and is held there."""

    TITLE: ClassVar[str] = "step steer"

    manoeuvre: Literal["step_steer"] = Field(description="name of the manoeuvre")
    rate_deg_per_s: Positive = Field(
        default=400.0, description="rate of the steering wheel; the standard asks for 200 to 500"
    )
    ease_ms: Positive = Field(
        default=20.0, description="time in which the rate rises, and in which it falls again"
    )
    start_s: Positive = Field(default=0.5, description="time at which the steering wheel is turned")
    duration_s: Positive = Field(default=5.0, description="duration of the simulation")
    settled_s: Positive = Field(
        default=0.5,
        description="duration of the last part of the simulation; steady values are means over it",
    )
    holds_speed: Flag = Field(
        default=False, description="true: the speed is held; false: the torque of the drive is held"
    )

    def problems(self) -> list[str]:
        found = super().problems()
        if self.start_s + self.settled_s >= self.duration_s:
            found.append(
                f"duration_s = {self.duration_s:g} s: more than start_s + settled_s = "
                f"{self.start_s + self.settled_s:g} s is needed."
            )
        return found

    def run(self, car: DrivingCar, progress: Progress) -> HandlingResult:
        """Return response times, gains and overshoots, and the motion."""
        turns, straight = self.straight(car)
        before = straight.unknowns["steering_wheel"]
        amplitude, steady = self.amplitude(turns, straight)
        course = ramp(
            amplitude, np.deg2rad(self.rate_deg_per_s), start=self.start_s, ease=self.ease_ms / 1e3
        )
        torque = straight.unknowns["drive"]
        motion = self.simulated(
            car, straight, OpenLoop(course, before),
            self.pedals(car, torque, held=self.holds_speed), self.duration_s, progress=progress,
        )  # fmt: skip
        unstable = self.unstable(car, steady)
        numbers = self._numbers(motion, course, amplitude, unstable)
        return HandlingResult(self.judged(numbers), {"": motion})

    def _numbers(
        self, motion: xr.Dataset, course: SteeringCourse, amplitude: float, unstable: str
    ) -> dict[str, Number]:
        """Return its metrics, and name responses that are not steady at the end.

        A text describes the unstable steady motion; it is empty if there is none.
        """
        time, half = motion["time"].values, 0.5 * (course.start + course.end)
        settled = float(time[-1]) - self.settled_s
        found: dict[str, Number] = {
            "steering_wheel_step": (abs(amplitude), "step of the steering wheel angle", "rad"),
        }
        judged = {}
        for name, words, unit, per_angle in _JUDGED:
            one = step_response(time, motion[name].values, half, settled)
            judged[name] = one
            found |= {
                f"{name}_steady": (one.steady, f"steady {words}", unit),
                f"{name}_gain": (
                    one.change / amplitude, f"steady {words} by steering wheel angle", per_angle,
                ),
                f"{name}_response_time": (one.response_time, f"response time of {words}", "s"),
                f"{name}_peak_time": (one.peak_time, f"peak response time of {words}", "s"),
                f"{name}_overshoot": (one.overshoot, f"overshoot of {words}", "1"),
            }  # fmt: skip
        motion.attrs["not_valid"] += [unstable] if unstable else []
        advice = "Choose a lower speed" if unstable else "Raise duration_s, or steer less"
        motion.attrs["not_valid"] += [
            f"the {words} is not steady in the last {self.settled_s:g} s: it changes by "
            f"{100.0 * judged[name].drift:.0f} %. {advice}"
            for name, words, *_ in _JUDGED[:2]
            if not judged[name].drift < _DRIFT
        ]
        if self.lateral_acceleration_m_per_s2 and self.sense * judged["yaw_rate"].change < 0.0:
            motion.attrs["not_valid"].append(
                f"the car turns to the other side than {self.turn}. Choose a lower speed"
            )
        slip = float(np.mean(motion["sideslip_angle"].values[time >= settled]))
        found["sideslip_steady"] = (slip, "steady sideslip angle, positive to the left", "rad")
        peak = judged["yaw_rate"].peak_time
        found["tb_factor"] = (
            peak * abs(slip),
            "TB factor: peak response time of yaw times absolute steady sideslip", "rad s",
        )  # fmt: skip
        return found | greatest(motion)


# Largest change of steady responses within the last part of the simulation, as a part of them; on
# rough roads the mean of half of this part changes by some percent.
_DRIFT = 0.1
_JUDGED = (
    ("yaw_rate", "yaw velocity", "rad/s", "1/s"),
    ("lateral_acceleration", "lateral acceleration", "m/s^2", "m/(s^2 rad)"),
    ("roll_angle", "roll angle", "rad", "1"),
)
