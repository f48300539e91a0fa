"""Bases of simulated manoeuvres: common keys of their files, and steady starts."""

from collections.abc import Callable, Mapping
from typing import Any, ClassVar, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from .....core.errors import InputError
from .....core.named_types import Array
from .....core.units import KM_PER_H
from ....input.section import Positive
from ....models.car.slope import Slope
from ..car import DrivingCar
from ..circle import Turns
from ..driven import MOST_SAMPLES, Sampling, driven, runs_straight
from ..drivers import Fixed, HeldTorque, Observation, Pushes, SpeedHeld, Steers
from ..result import quantity
from ..steady import NoSteadyMotionError, Steady, SteadyCondition
from .manoeuvre import Manoeuvre, Number, Progress

# Approximate time in which a driver halves a deviation from the speed [s].
_PATIENCE = 1.0
# Growth rate above which a motion is unstable; that of a stable car is zero to rounding, since the
# equations do not depend on position and yaw angle [1/s].
_GROWTH = 1e-3
# More than the duration of manoeuvres whose files have none [s].
_USUAL_DURATION = 60.0


class SimulatedManoeuvre(Manoeuvre):
    """A manoeuvre that begins straight ahead or in a steady turn, and is simulated."""

    speed_km_per_h: Positive = Field(description="speed at the beginning")
    step_ms: Positive = Field(default=1.0, description="sampling time of the driver")
    output_step_ms: Positive = Field(default=5.0, description="time between two outputs")

    def problems(self) -> list[str]:
        found = super().problems()
        ratio = self.output_step_ms / self.step_ms
        if abs(ratio - round(ratio)) > 1e-9 * ratio or ratio < 1.0:
            found.append(
                f"output_step_ms = {self.output_step_ms:g} ms: a multiple of step_ms = "
                f"{self.step_ms:g} ms is needed."
            )
        samples = 1e3 * getattr(self, "duration_s", 0.0) / self.step_ms
        if samples > MOST_SAMPLES:
            found.append(
                f"step_ms = {self.step_ms:g} ms: {samples:.3g} samples in all, and at most "
                f"{MOST_SAMPLES:.3g} are allowed."
            )
        return found

    @property
    def speed(self) -> float:
        """Speed at the beginning [m/s]."""
        return self.speed_km_per_h / KM_PER_H

    @property
    def greatest_distance(self) -> float:
        return self.speed * float(getattr(self, "duration_s", _USUAL_DURATION))

    @property
    def sense(self) -> int:
        """1 for turns to the left, -1 to the right."""
        return 1

    @property
    def samples(self) -> Sampling:
        """The sampling of the simulation."""
        return Sampling(self.step_ms / 1e3, round(self.output_step_ms / self.step_ms))

    @property
    def title(self) -> str:
        """The manoeuvre in a few words, with its speed."""
        return f"{self.TITLE}, {self.speed_km_per_h:g} km/h"

    def straight(self, car: DrivingCar) -> tuple[Turns, Steady]:
        """Return the branch of turns from straight running, and straight running."""
        turns = Turns(car, SteadyCondition("speed", self.speed), self.sense)
        try:
            return turns, turns.begin(0.0)
        except NoSteadyMotionError:
            begin = f"speed_km_per_h = {self.speed_km_per_h:g} km/h:"
            problem = (
                f"{begin} this car does not run straight ahead at this speed. Choose a lower one."
            )
            # a car that hardly runs straight on a level road needs a lower speed
            steepest = Slope(*(float(np.trunc(1e3 * part) / 1e3) for part in turns.slope))
            if any(steepest):
                problem = (
                    f"{begin} at this speed the tyres of this car carry it straight ahead up to "
                    f"about {steepest.words}, and the road has {car.slope.words}. Choose less "
                    "slope."
                )
            raise InputError([problem], self.TITLE) from None

    def turned(self, turns: Turns, key: str, acceleration: float) -> Steady:
        """Return the steady turn with the lateral acceleration [m/s^2] of a key of the file."""
        try:
            return turns.to(self.sense * acceleration)
        except NoSteadyMotionError:
            problem = (
                f"{key} = {acceleration:g} m/s^2: the tyres of this car carry no steady turn above "
                f"{abs(turns.reached):.2f} m/s^2 at {self.speed_km_per_h:g} km/h. Choose less."
            )
            raise InputError([problem], self.TITLE) from None

    def unstable(self, car: DrivingCar, motions: Mapping[str, Steady]) -> str:
        """Return which steady motion, by its description, is unstable; empty if none is."""
        for words, each in motions.items():
            growth = float(car.model.eigenvalues(each.state, each.inputs).real.max())
            if growth > _GROWTH:
                return (
                    f"at {self.speed_km_per_h:g} km/h {words} is unstable (growth rate "
                    f"{growth:.2g} 1/s), as of an oversteering car above its critical speed. "
                    "Choose a lower speed"
                )
        return ""

    def holding(self, car: DrivingCar, torque: float) -> SpeedHeld:
        """Return a driver that holds the speed, with the torque of straight running [N m]."""
        radius = float(np.mean(car.radii))
        return SpeedHeld(self.speed, torque, car.mass * radius / _PATIENCE, 2.0 * _PATIENCE)

    def pedals(self, car: DrivingCar, torque: float, *, held: bool) -> Pushes:
        """Return a driver that holds the speed, or the torque of the drive."""
        return self.holding(car, torque) if held else HeldTorque(torque, torque)

    def simulated(
        self,
        car: DrivingCar,
        start: Steady,
        steers: Steers,
        pushes: Pushes,
        duration: float,
        *,
        until: Callable[[Observation], bool] | None = None,
        progress: Progress | None = None,
    ) -> xr.Dataset:
        """Return the motion from a steady one, with the title of the manoeuvre."""
        found = driven(
            car, start.state, steers, pushes, duration, samples=self.samples, until=until,
            progress=progress,
        )  # fmt: skip
        found.attrs["title"] = self.title
        return found

    def with_held_wheel(
        self,
        car: DrivingCar,
        start: Steady,
        pushes: Pushes,
        duration: float,
        *,
        until: Callable[[Observation], bool] | None = None,
        progress: Progress | None = None,
    ) -> xr.Dataset:
        """Return the motion from a steady one, the steering wheel held.

        It is not valid if a car that leaves its straight path on a level road is unstable.
        """
        steers = Fixed(start.unknowns["steering_wheel"])
        motion = self.simulated(
            car, start, steers, pushes, duration, until=until, progress=progress
        )
        if not (any(car.slope) or runs_straight(motion)):
            unstable = self.unstable(car, {"the steady motion at the beginning": start})
            motion.attrs["not_valid"] += [unstable] if unstable else []
        return motion

    def judged(self, numbers: dict[str, Number]) -> xr.Dataset:
        """Return its metrics, with the title of the manoeuvre."""
        found = {
            name: quantity((), np.float64(value), meaning, unit)
            for name, (value, meaning, unit) in numbers.items()
        }
        return xr.Dataset(found, attrs={"title": self.title})


class TurningManoeuvre(SimulatedManoeuvre):
    """A manoeuvre in which the car turns to a side."""

    turn: Literal["left", "right"] = Field(
        default="left", description="side to which the car turns first"
    )

    @property
    def sense(self) -> int:
        return 1 if self.turn == "left" else -1


class SteeredManoeuvre(TurningManoeuvre):
    """A manoeuvre whose steering wheel angle is given, or follows from a lateral acceleration."""

    lateral_acceleration_m_per_s2: Positive | None = Field(
        default=None,
        description="lateral acceleration of the steady turn whose steering wheel angle is used",
    )
    steering_wheel_deg: Positive | None = Field(
        default=None, description="steering wheel angle, in place of a lateral acceleration"
    )

    def problems(self) -> list[str]:
        keys = "lateral_acceleration_m_per_s2", "steering_wheel_deg"
        return [*super().problems(), *self.one_of(*keys)]

    def amplitude(self, turns: Turns, straight: Steady) -> tuple[float, dict[str, Steady]]:
        """Return the steering wheel angle relative to straight running, positive left [rad].

        The steady motions whose angles are known follow, by their descriptions.
        """
        known, wanted = {"straight running": straight}, self.lateral_acceleration_m_per_s2
        if wanted is None:
            return float(self.sense * np.deg2rad(self.steering_wheel_deg or 0.0)), known
        turn = self.turned(turns, "lateral_acceleration_m_per_s2", wanted)
        known["the steady turn with lateral_acceleration_m_per_s2"] = turn
        angle = turn.unknowns["steering_wheel"] - straight.unknowns["steering_wheel"]
        return float(angle), known


class UntilSpeed(SimulatedManoeuvre):
    """A manoeuvre that ends at a speed."""

    SLOWS: ClassVar[bool] = True
    """Whether the end speed is less than the speed at the beginning."""

    until_km_per_h: Positive = Field(description="speed at which the manoeuvre ends")

    def problems(self) -> list[str]:
        found = super().problems()
        first, last = self.speed_km_per_h, self.until_km_per_h
        if first <= last if self.SLOWS else first >= last:
            found.append(
                f"until_km_per_h = {last:g} km/h: "
                f"{'less' if self.SLOWS else 'more'} than speed_km_per_h = "
                f"{first:g} km/h is needed."
            )
        return found

    @property
    def end_speed(self) -> float:
        """Speed at which it ends [m/s]."""
        return self.until_km_per_h / KM_PER_H

    @property
    def greatest_distance(self) -> float:
        return super().greatest_distance * max(1.0, self.end_speed / self.speed)

    def held(
        self, car: DrivingCar, start: Steady, pushes: Pushes, duration: float, progress: Progress
    ) -> xr.Dataset:
        """Return the motion with the steering wheel held, to the end speed or for a duration."""

        def ended(seen: Observation) -> bool:
            return seen.speed <= self.end_speed if self.SLOWS else seen.speed >= self.end_speed

        return self.with_held_wheel(car, start, pushes, duration, until=ended, progress=progress)


def greatest(motion: xr.Dataset) -> dict[str, Number]:
    """Return the extremes of a motion, common metrics of manoeuvres."""

    def size(name: str) -> float:
        return float(np.abs(motion[name]).max())

    return {
        "greatest_lateral_acceleration": (
            size("lateral_acceleration"), "greatest absolute lateral acceleration", "m/s^2",
        ),
        "greatest_yaw_rate": (size("yaw_rate"), "greatest absolute yaw velocity", "rad/s"),
        "greatest_roll_angle": (size("roll_angle"), "greatest absolute roll angle", "rad"),
        "greatest_sideslip_angle": (
            size("sideslip_angle"), "greatest absolute sideslip angle", "rad",
        ),
        "smallest_load": (float(motion["fz"].min()), "smallest load of a wheel", "N"),
    }  # fmt: skip


def place_from(motion: xr.Dataset, origin: Array) -> None:
    """Make the position of a motion relative to an origin on the road, (2,) [m]."""
    for name, value in zip(("x", "y"), origin.tolist(), strict=True):
        motion[name] = motion[name].copy(data=motion[name].values - value)


def at_time(motion: xr.Dataset, name: str, time: float) -> float:
    """Return the value of a curve at a time, linear between outputs; NaN after the last one."""
    found: Any = np.interp(time, motion["time"].values, motion[name].values, right=np.nan)
    return float(found)
