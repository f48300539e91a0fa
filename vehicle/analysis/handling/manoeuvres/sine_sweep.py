"""Sine sweep (ISO 7401, continuous sinusoidal input)."""

from typing import Any, ClassVar, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from .....core.named_types import Array
from .....datasets.columns import AS_COLUMNS
from ....input.section import Positive
from ..car import DrivingCar
from ..drivers import HeldTorque, OpenLoop
from ..responses import frequency_response, steering_response
from ..result import HandlingResult, quantity
from ..steady import Steady
from ..steering import sine_sweep
from .manoeuvre import Number, Progress
from .simulated import SteeredManoeuvre, greatest

_SOURCES = ("simulated", "linear")


class SineSweep(SteeredManoeuvre):
    """Sinusoidal steering with increasing frequency."""

    TITLE: ClassVar[str] = "sine sweep"
    CURVES: ClassVar[tuple[str, ...]] = ("", "_response")

    manoeuvre: Literal["sine_sweep"] = Field(description="name of the manoeuvre")
    lowest_Hz: Positive = Field(  # noqa: N815 (Hz is the hertz)
        default=0.2, description="first frequency"
    )
    highest_Hz: Positive = Field(  # noqa: N815 (Hz is the hertz)
        default=4.0, description="last frequency"
    )
    duration_s: Positive = Field(default=30.0, description="duration of the steering")
    settle_s: Positive = Field(
        default=4.0, description="time after the steering, in which the motion of the car decays"
    )
    ease_ms: Positive = Field(
        default=100.0,
        description="time in which the rate of steering rises at first, and falls at the end",
    )
    frequency_step_Hz: Positive = Field(  # noqa: N815 (Hz is the hertz)
        default=0.05, description="step of the curves"
    )

    def problems(self) -> list[str]:
        found = super().problems()
        if self.highest_Hz <= self.lowest_Hz:
            found.append(
                f"highest_Hz = {self.highest_Hz:g} Hz: more than lowest_Hz = {self.lowest_Hz:g} Hz "
                "is needed."
            )
        if self.output_step_ms * self.highest_Hz > _COARSE:
            found.append(
                f"output_step_ms = {self.output_step_ms:g} ms: at most "
                f"{_COARSE / self.highest_Hz:.3g} ms is allowed, 20 outputs in a period."
            )
        return found

    def run(self, car: DrivingCar, progress: Progress) -> HandlingResult:
        """Return gains and phases by frequency, simulated and linear, and the motion."""
        turns, straight = self.straight(car)
        before = straight.unknowns["steering_wheel"]
        amplitude, _ = self.amplitude(turns, straight)
        course = sine_sweep(
            amplitude, (self.lowest_Hz, self.highest_Hz), self.duration_s, ease=self.ease_ms / 1e3
        )
        torque = straight.unknowns["drive"]
        motion = self.simulated(
            car, straight, OpenLoop(course, before), HeldTorque(torque, torque),
            course.end + self.settle_s, progress=progress,
        )  # fmt: skip
        unstable = self.unstable(car, {"straight running": straight})
        motion.attrs["not_valid"] += [*([unstable] if unstable else []), *_unsettled(motion)]
        curves = self._by_frequency(car, straight, motion)
        return HandlingResult(
            self.judged(_numbers(curves, amplitude) | greatest(motion)),
            {"": motion, "_response": curves},
        )

    def _by_frequency(self, car: DrivingCar, straight: Steady, motion: xr.Dataset) -> xr.Dataset:
        step = self.frequency_step_Hz
        count = int((self.highest_Hz - self.lowest_Hz) / step + 1e-9)
        frequency = self.lowest_Hz + step * np.arange(count + 1, dtype=np.float64)
        linear = steering_response(car, straight, frequency)
        time = motion["time"].values

        def moved(name: str) -> Array:
            values: Array = motion[name].values
            return values - values[0]

        over = ("source", "frequency")
        found: dict[str, Any] = {}
        for name, (words, unit) in _FOLLOWING.items():
            simulated = frequency_response(
                time, moved("steering_wheel_angle"), moved(name), frequency
            )
            both = np.stack([simulated, linear[name]])
            found[f"{name}_gain"] = quantity(over, np.abs(both), f"gain of {words}", unit)
            found[f"{name}_phase"] = quantity(
                over, np.unwrap(np.angle(both)), f"phase of {words}, positive leading", "rad"
            )
        axis = ("frequency", frequency, {"units": "Hz", "long_name": "frequency"})
        title = f"{self.title}: response to the steering wheel"
        sources = ("source", list(_SOURCES), {"long_name": "source"} | AS_COLUMNS)
        return xr.Dataset(found, {"frequency": axis, "source": sources}, {"title": title})


# Largest motion at the end, as a part of the greatest one; rough roads leave some percent.
_LEFT = 0.1
# 20 outputs in a period [ms Hz].
_COARSE = 50.0
_FOLLOWING = {
    "yaw_rate": ("yaw velocity", "1/s"),
    "lateral_acceleration": ("lateral acceleration", "m/(s^2 rad)"),
    "roll_angle": ("roll angle", "1"),
    "sideslip_angle": ("sideslip angle", "1"),
}


def _unsettled(motion: xr.Dataset) -> list[str]:
    """Return a text for each motion that does not end as it began."""
    found = []
    for name in ("yaw_rate", "sideslip_angle"):
        moved = np.abs(motion[name].values - motion[name].values[0])
        if not moved[-1] <= _LEFT * moved.max():
            found.append(
                f"at the end the {_FOLLOWING[name][0]} is {100.0 * moved[-1] / moved.max():.0f} % "
                "of its greatest one, and responses by frequency need a car that runs straight "
                "again. Raise settle_s, steer less, or lower the speed"
            )
    return found


def _numbers(curves: xr.Dataset, amplitude: float) -> dict[str, Number]:
    frequency = curves["frequency"].values
    found: dict[str, Number] = {
        "steering_wheel_amplitude": (abs(amplitude), "amplitude of the steering wheel", "rad")
    }
    for name, words, unit in (
        ("yaw_rate", "yaw velocity", "1/s"),
        ("lateral_acceleration", "lateral acceleration", "m/(s^2 rad)"),
    ):
        gain, phase = (
            curves[f"{name}_{what}"].sel(source=_SOURCES[0]).values for what in ("gain", "phase")
        )
        top = int(np.argmax(gain))
        one = float(np.interp(1.0, frequency, phase))
        found |= {
            f"{name}_gain_low": (gain[0], f"gain of {words} at the lowest frequency", unit),
            f"{name}_gain_peak": (gain[top], f"greatest gain of {words}", unit),
            f"{name}_peak_frequency": (
                frequency[top], f"frequency of the greatest gain of {words}", "Hz",
            ),
            f"{name}_delay": (-one / (2.0 * np.pi), f"delay of {words} at 1 Hz", "s"),
        }  # fmt: skip
    return found
