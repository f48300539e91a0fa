"""The base of manoeuvres that end at a speed."""

from typing import ClassVar

from pydantic import Field

from .....core.units import KM_PER_H
from ....input.section import Positive
from ..drivers import Observation
from .simulated import SimulatedManoeuvre


class UntilSpeed(SimulatedManoeuvre):
    """A manoeuvre that ends at a speed."""

    SLOWS: ClassVar[bool] = True
    """Whether the end speed is less than the speed at the beginning."""

    until_km_per_h: Positive = Field(description="speed at which it ends")

    def problems(self) -> list[str]:
        """Return the problems of the values together."""
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
        """The distance that the car travels at most, from its greatest speed and duration [m]."""
        return super().greatest_distance * max(1.0, self.end_speed / self.speed)

    def ended(self, seen: Observation) -> bool:
        """Return whether the car has reached the end speed."""
        return seen.speed <= self.end_speed if self.SLOWS else seen.speed >= self.end_speed
