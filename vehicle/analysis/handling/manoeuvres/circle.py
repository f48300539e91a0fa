"""Steady-state circular driving (ISO 4138), without a simulation."""

from typing import ClassVar, Literal

from pydantic import Field

from ....input.section import NonNegative, Positive, Section
from ..car import DrivingCar
from ..circle import steady_turns
from ..result import HandlingResult
from ..steady import SteadyCondition
from .manoeuvre import Progress


class Circle(Section):
    """Steady turns of one speed or one radius, up to the greatest lateral acceleration."""

    TITLE: ClassVar[str] = "steady-state circle"
    CURVES: ClassVar[tuple[str, ...]] = ("",)
    TRAVELS: ClassVar[bool] = False

    manoeuvre: Literal["circle"] = Field(description="which manoeuvre this is")
    speed_km_per_h: NonNegative | None = Field(
        default=None, description="constant speed; either this or radius_m"
    )
    radius_m: Positive | None = Field(default=None, description="constant radius")
    turn: Literal["left", "right"] = Field(default="left", description='"left" or "right"')
    step_m_per_s2: Positive = Field(default=0.25, description="step of the lateral acceleration")

    def problems(self) -> list[str]:
        """Say what cannot be."""
        if (self.speed_km_per_h is None) == (self.radius_m is None):
            return ["speed_km_per_h, radius_m: give one of the two."]
        if self.speed_km_per_h == 0.0:
            problem = (
                "speed_km_per_h = 0 km/h: a car that does not move is on no circle. Enter more "
                "than 0 km/h, or radius_m."
            )
            return [problem]
        return []

    def run(self, car: DrivingCar, progress: Progress) -> HandlingResult:
        """Return gradients, and curves by lateral acceleration."""
        sense = 1 if self.turn == "left" else -1
        if self.radius_m is not None:
            first = SteadyCondition("curvature", sense / self.radius_m)
        else:
            first = SteadyCondition("speed", (self.speed_km_per_h or 0.0) / 3.6)
        return steady_turns(car, first, sense=sense, step=self.step_m_per_s2, progress=progress)
