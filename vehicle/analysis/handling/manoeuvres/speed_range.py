"""Straight running over a range of speeds, without a simulation."""

from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from .....core.units import KM_PER_H
from ....input.section import Positive
from ..car import DrivingCar
from ..result import HandlingResult
from ..straight import straight_running
from .manoeuvre import Manoeuvre, Progress

_MOST = 1000  # speeds


class SpeedRange(Manoeuvre):
    """Straight running over a range of speeds, and the response to small steering angles."""

    TITLE: ClassVar[str] = "straight running over a range of speeds"
    TRAVELS: ClassVar[bool] = False

    manoeuvre: Literal["speed_range"] = Field(description="name of the manoeuvre")
    from_km_per_h: Positive = Field(default=20.0, description="first speed")
    to_km_per_h: Positive = Field(default=250.0, description="last speed")
    step_km_per_h: Positive = Field(default=5.0, description="step of the speeds")

    def problems(self) -> list[str]:
        found = super().problems()
        first, last, step = self.from_km_per_h, self.to_km_per_h, self.step_km_per_h
        if not first + step <= last <= first + _MOST * step:
            found.append(
                f"to_km_per_h = {last:g} km/h: {first + step:g} to {first + _MOST * step:g} km/h "
                "are allowed with this first speed and this step."
            )
        return found

    def run(self, car: DrivingCar, progress: Progress) -> HandlingResult:
        """Return curves by speed, and the speed of the greatest gain or the critical one."""
        count = int((self.to_km_per_h - self.from_km_per_h) / self.step_km_per_h + 1e-9)
        speeds = self.from_km_per_h + self.step_km_per_h * np.arange(count + 1, dtype=np.float64)
        return straight_running(car, speeds / KM_PER_H, progress=progress)
