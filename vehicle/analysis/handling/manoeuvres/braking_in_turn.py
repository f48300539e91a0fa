"""Braking in a turn (ISO 7975), open loop."""

from typing import ClassVar, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from .....core.errors import InputError
from ....input.section import Positive
from ..car import DrivingCar
from ..circle import Turns
from ..drivers import Braking
from ..result import HandlingResult
from ..steady import NoSteadyMotionError, Steady, SteadyCondition
from .brakes import BrakingManoeuvre
from .manoeuvre import Number, Progress
from .simulated import TurningManoeuvre, at_time, greatest

# Time of the comparison after the start of braking [s].
_AFTER = 1.0


class BrakingInTurn(BrakingManoeuvre, TurningManoeuvre):
    """A car brakes in a steady turn, with the steering wheel held."""

    TITLE: ClassVar[str] = "braking in a turn"

    manoeuvre: Literal["braking_in_turn"] = Field(description="name of the manoeuvre")
    radius_m: Positive = Field(default=100.0, description="radius of the steady turn")

    def run(self, car: DrivingCar, progress: Progress) -> HandlingResult:
        """Return metrics of the motion relative to the steady turn, and the motion."""
        turn = self._steady(car)
        pushes = Braking(turn.unknowns["drive"], self.pedal_of(car), self.start_s, self.rise_s)
        motion = self.held(car, turn, pushes, self.duration_s, progress)
        self.refuse_without_end(motion)
        numbers = self._numbers(motion) | self.locking(motion) | greatest(motion)
        return HandlingResult(self.judged(numbers), {"": motion})

    def _steady(self, car: DrivingCar) -> Steady:
        """Return the turn at the beginning."""
        acceleration = self.speed**2 / self.radius_m
        turns = Turns(car, SteadyCondition("curvature", self.sense / self.radius_m), self.sense)
        try:
            turns.begin(min(1.0, acceleration))
            return turns.to_speed(self.speed)
        except NoSteadyMotionError:
            problem = (
                f"speed_km_per_h = {self.speed_km_per_h:g} km/h on radius_m = {self.radius_m:g} m "
                f"is {acceleration:.2f} m/s^2, and the tyres of this car carry no steady turn "
                f"above {abs(turns.reached):.2f} m/s^2. Choose a lower speed or a larger radius."
            )
            raise InputError([problem], self.TITLE) from None

    def _numbers(self, motion: xr.Dataset) -> dict[str, Number]:
        begun, later = self.start_s, self.start_s + _AFTER
        time = motion["time"].values
        speed = at_time(motion, "speed", later)
        of_circle = self.sense * speed / self.radius_m
        braked = (time >= begun) & (time <= later)
        slip = motion["sideslip_angle"].values
        before = at_time(motion, "sideslip_angle", begun)
        yaw = self.sense * motion["yaw_rate"].values
        first = self.sense * at_time(motion, "yaw_rate", begun)
        x, y = (at_time(motion, name, later) for name in ("x", "y"))
        return {
            "initial_lateral_acceleration": (
                at_time(motion, "lateral_acceleration", begun),
                "lateral acceleration of the steady turn", "m/s^2",
            ),
            "mean_deceleration": (
                at_time(motion, "speed", begun) - speed, "mean deceleration in 1 s of braking",
                "m/s^2",
            ),
            "yaw_rate_over_circle": (
                at_time(motion, "yaw_rate", later) / of_circle,
                "yaw velocity after 1 s, over that of the circle at the speed then", "1",
            ),
            "lateral_acceleration_over_circle": (
                at_time(motion, "lateral_acceleration", later) / (of_circle * speed),
                "lateral acceleration after 1 s, over that of the circle at the speed then", "1",
            ),
            "yaw_rate_peak": (
                float(yaw[braked].max()) / first,
                "greatest yaw velocity within 1 s, over that of the steady turn", "1",
            ),
            "sideslip_change": (
                self.sense * (at_time(motion, "sideslip_angle", later) - before),
                "change of the sideslip angle in 1 s, positive out of the turn", "rad",
            ),
            "greatest_sideslip_change": (
                float(np.abs(slip[braked] - before).max()),
                "greatest absolute change of the sideslip angle within 1 s", "rad",
            ),
            "path_deviation": (
                self._outside(motion, begun, x, y),
                "distance from the circle after 1 s, positive outside", "m",
            ),
        }  # fmt: skip

    def _outside(self, motion: xr.Dataset, begun: float, x: float, y: float) -> float:
        """Return the distance of a point from the circle of the steady turn, outward [m]."""
        course = at_time(motion, "yaw_angle", begun) + at_time(motion, "sideslip_angle", begun)
        out = self.sense * self.radius_m
        cx = at_time(motion, "x", begun) - out * np.sin(course)
        cy = at_time(motion, "y", begun) + out * np.cos(course)
        return float(np.hypot(x - cx, y - cy) - self.radius_m)
