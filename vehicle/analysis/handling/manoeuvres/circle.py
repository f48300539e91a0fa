"""Steady-state circular driving (ISO 4138), without a simulation."""

import math
from typing import ClassVar, Literal

from pydantic import Field

from .....core.units import KM_PER_H
from ....input.section import NonNegative, Positive
from ..car import DrivingCar
from ..circle import steady_turns
from ..result import HandlingResult
from ..steady import SteadyCondition
from .manoeuvre import Manoeuvre, Progress


class Circle(Manoeuvre):
    """Steady turns at constant speed, radius or steering wheel angle, up to the limit of tyres."""

    TITLE: ClassVar[str] = "steady-state circle"
    TRAVELS: ClassVar[bool] = False

    manoeuvre: Literal["circle"] = Field(description="name of the manoeuvre")
    speed_km_per_h: NonNegative | None = Field(
        default=None, description="constant speed; or else radius_m or steering_wheel_deg"
    )
    radius_m: Positive | None = Field(default=None, description="constant radius")
    steering_wheel_deg: Positive | None = Field(
        default=None, description="constant angle of the steering wheel"
    )
    turn: Literal["left", "right"] = Field(default="left", description='"left" or "right"')
    step_m_per_s2: Positive = Field(default=0.25, description="step of the lateral acceleration")

    def problems(self) -> list[str]:
        if several := self.one_of("speed_km_per_h", "radius_m", "steering_wheel_deg"):
            return several
        if self.speed_km_per_h == 0.0:
            problem = (
                "speed_km_per_h = 0 km/h: a car that does not move is on no circle. Enter more "
                "than 0 km/h, or radius_m."
            )
            return [problem]
        return super().problems()

    def run(self, car: DrivingCar, progress: Progress) -> HandlingResult:
        """Return gradients, and curves by lateral acceleration."""
        sense = 1 if self.turn == "left" else -1
        if self.radius_m is not None:
            first = SteadyCondition("curvature", 1.0 / self.radius_m)
        elif self.steering_wheel_deg is not None:
            first = SteadyCondition("steering_wheel", math.radians(self.steering_wheel_deg))
        else:
            first = SteadyCondition("speed", (self.speed_km_per_h or 0.0) / KM_PER_H)
        return steady_turns(
            car, first.turned(sense), sense=sense, step=self.step_m_per_s2, progress=progress
        )
