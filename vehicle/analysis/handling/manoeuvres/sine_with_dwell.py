"""Sine with dwell (FMVSS 126, 49 CFR 571.126, S5.2 and S7.9)."""

from typing import Any, ClassVar, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from .....core.named_types import Array
from ....input.section import Positive
from ..car import DrivingCar
from ..drivers import HeldTorque, OpenLoop
from ..responses import first_crossing
from ..result import HandlingResult, quantity
from ..steering import SteeringCourse, sine_with_dwell
from .manoeuvre import Progress
from .simulated import TurningManoeuvre, at_time
from .slowly_increasing_steer import SlowlyIncreasingSteer

# The first amplitude, the step, and the last one, in reference angles (S7.9.3, S7.9.4).
_FIRST, _STEP, _LAST = 1.5, 0.5, 6.5
# Limits of the last amplitude [deg].
_LEAST, _MOST = 270.0, 300.0
# Least amplitude with required lateral displacement, in reference angles (S5.2).
_REQUIRED = 5.0
# Angle at the beginning of steering (S7.11.8) [deg].
_BEGUN = 5.0
# Time of the lateral displacement after the beginning of steering [s].
_DISPLACED = 1.07
# Times of the yaw rate after the end of steering [s], and the allowed parts of its peak.
_YAW = ((1.0, 0.35), (1.75, 0.20))
# Required displacement of cars up to 3,500 kg and of heavier ones [m].
_FAR, _FAR_HEAVY, _HEAVY = 1.83, 1.52, 3500.0


class SineWithDwell(TurningManoeuvre):
    """One period of a sine with a dwell at its second peak, with growing amplitudes, coasting."""

    TITLE: ClassVar[str] = "sine with dwell"

    manoeuvre: Literal["sine_with_dwell"] = Field(description="name of the manoeuvre")
    frequency_Hz: Positive = Field(  # noqa: N815 (Hz is the hertz)
        default=0.7, description="frequency of the sine"
    )
    dwell_s: Positive = Field(default=0.5, description="time at the second peak")
    ease_ms: Positive = Field(
        default=20.0, description="time in which the rate of steering rises, and falls at the end"
    )
    reference_deg: Positive | None = Field(
        default=None,
        description="reference angle A; by default that of slowly increasing steer",
    )
    amplitudes_deg: tuple[Positive, ...] | None = Field(
        default=None, description="amplitudes, in place of those of the standard, 1.5 A and more"
    )

    def run(self, car: DrivingCar, progress: Progress) -> HandlingResult:
        """Return yaw rates after steering and lateral displacements, by amplitude, and motions."""
        _, straight = self.straight(car)
        reference, not_valid = self._reference(car, progress)
        amplitudes = np.asarray(self.amplitudes_deg or amplitudes_of(reference))
        begun = 0.0 if self.reference_deg is not None else _SHARE
        motions = []
        for i, amplitude in enumerate(amplitudes.tolist()):

            def done(part: float, before: int = i) -> None:
                progress(begun + (1.0 - begun) * (before + part) / amplitudes.size)

            course = sine_with_dwell(
                self.sense * np.deg2rad(amplitude), self.frequency_Hz, self.dwell_s,
                ease=self.ease_ms / 1e3,
            )  # fmt: skip
            motion = self.simulated(
                car, straight, OpenLoop(course, straight.unknowns["steering_wheel"]),
                HeldTorque(0.0, 0.0), course.end + _YAW[-1][0] + 0.25, progress=done,
            )  # fmt: skip
            motions.append((course, motion))
        numbers = [judge(motion, course, self.sense) for course, motion in motions]
        together = _together([motion for _, motion in motions], amplitudes)
        together.attrs["not_valid"] = not_valid + together.attrs["not_valid"]
        return HandlingResult(
            self._judged(numbers, amplitudes, reference, car.mass), {"": together}
        )

    def _reference(self, car: DrivingCar, progress: Progress) -> tuple[float, list[str]]:
        """Return the reference angle A [deg], and why it is not valid."""
        if self.reference_deg is not None:
            return self.reference_deg, []
        slow = SlowlyIncreasingSteer(
            manoeuvre="slowly_increasing_steer", speed_km_per_h=self.speed_km_per_h,
            turn=self.turn, step_ms=self.step_ms, output_step_ms=self.output_step_ms,
        )  # fmt: skip
        found = slow.run(car, lambda part: progress(_SHARE * part))
        not_valid = [f"{slow.TITLE}: {text}" for text in found.not_valid]
        return float(np.rad2deg(found.metrics["reference_angle"])), not_valid

    def _judged(
        self, numbers: list[dict[str, float]], amplitudes: Array, reference: float, mass: float
    ) -> xr.Dataset:
        least = _FAR if mass <= _HEAVY else _FAR_HEAVY
        rows = {name: np.array([one[name] for one in numbers]) for name in _DESCRIBED}
        required = amplitudes >= _REQUIRED * reference * (1.0 - 1e-9)
        stable = np.all([rows[f"yaw_rate_ratio_{_key(t)}"] <= most for t, most in _YAW], axis=0)
        responsive = (rows["lateral_displacement"] >= least) | ~required
        found: dict[str, Any] = {
            name: quantity("amplitude", rows[name], *described)
            for name, described in _DESCRIBED.items()
        }
        found["fulfilled"] = quantity(
            "amplitude", (stable & responsive).astype(float), "limits kept: 1 is yes", "1"
        )
        found["reference_angle"] = quantity(
            (), np.deg2rad(reference), "steering wheel angle A at 0.3 g", "rad"
        )
        found["required_displacement"] = quantity(
            (), least, "lateral displacement that is required from 5 A on", "m"
        )
        return xr.Dataset(found, {"amplitude": _axis(amplitudes)}, {"title": self.title})


# Part of the progress for slowly increasing steer.
_SHARE = 0.15


def _key(after: float) -> str:
    """Return a time after steering as a part of a name."""
    return f"{after:.2f}".replace(".", "_")


_DESCRIBED = {
    "yaw_rate_peak": ("greatest absolute yaw velocity after steering back", "rad/s"),
    **{
        f"yaw_rate_ratio_{_key(t)}": (f"yaw velocity {t:.2f} s after steering, over the peak", "1")
        for t, _ in _YAW
    },
    "lateral_displacement": (f"lateral displacement {_DISPLACED} s after the beginning", "m"),
    "greatest_sideslip_angle": ("greatest absolute sideslip angle", "rad"),
    "smallest_load": ("smallest load of a wheel", "N"),
}


def amplitudes_of(reference: float) -> list[float]:
    """Return the amplitudes of the standard, from the reference angle A [deg].

    Examples
    --------
    >>> amplitudes_of(60.0)
    [90.0, 120.0, 150.0, 180.0, 210.0, 240.0, 270.0, 300.0]
    """
    last = min(max(_LAST * reference, _LEAST), _MOST)
    count = int((last / reference - _FIRST) / _STEP + 1e-9)
    found = [reference * (_FIRST + _STEP * i) for i in range(max(count, 0) + 1)]
    found = [one for one in found if one < last * (1.0 - 1e-9)]
    return [*found, last]


def judge(motion: xr.Dataset, course: SteeringCourse, sense: int) -> dict[str, float]:
    """Return the metrics of one run; `sense` is 1 if steering begins to the left, else -1."""
    time = motion["time"].values
    steered = sense * (motion["steering_wheel_angle"] - motion["steering_wheel_angle"][0]).values
    beginning = first_crossing(time, steered, np.deg2rad(_BEGUN))
    back = -sense * motion["yaw_rate"].values
    reversed_at = float(time[np.argmax(steered < 0.0)]) if (steered < 0.0).any() else course.end
    peak = _first_peak(back[time >= reversed_at])
    found = {
        "yaw_rate_peak": peak,  # NaN if the car does not turn back
        "lateral_displacement": sense
        * (at_time(motion, "y", beginning + _DISPLACED) - float(motion["y"][0])),
        "greatest_sideslip_angle": float(np.abs(motion["sideslip_angle"]).max()),
        "smallest_load": float(motion["fz"].min()),
    }
    for after, _ in _YAW:
        later = -sense * at_time(motion, "yaw_rate", course.end + after)
        found[f"yaw_rate_ratio_{_key(after)}"] = later / peak
    return found


def _first_peak(values: Array) -> float:
    """Return the first positive local maximum, or else the greatest value; NaN if not positive."""
    inner = (values[1:-1] > 0.0) & (values[1:-1] >= values[:-2]) & (values[1:-1] > values[2:])
    places = np.flatnonzero(inner)
    found = float(values[1 + places[0]] if places.size else values.max())
    return found if found > 0.0 else np.nan


def _axis(amplitudes: Array) -> xr.Variable:
    return quantity("amplitude", np.deg2rad(amplitudes), "amplitude of the steering wheel", "rad")


def _together(motions: list[xr.Dataset], amplitudes: Array) -> xr.Dataset:
    """Return the motions with the further dimension ``amplitude``."""
    index = xr.DataArray(_axis(amplitudes), name="amplitude")
    found = xr.concat(motions, index, join="outer", combine_attrs="override")
    degrees = [f"{amplitude:g} deg" for amplitude in amplitudes]
    found.attrs["not_valid"] = [
        f"{words}: {text}"
        for words, motion in zip(degrees, motions, strict=True)
        for text in motion.attrs["not_valid"]
    ]
    return found
