"""The base of manoeuvres with an amplitude of the steering wheel."""

import numpy as np
from pydantic import Field

from ....input.section import Positive
from ..circle import Turns
from ..steady import Steady
from .simulated import TurningManoeuvre


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
        """Return the problems of the values together."""
        found = super().problems()
        if (self.lateral_acceleration_m_per_s2 is None) == (self.steering_wheel_deg is None):
            found.append("lateral_acceleration_m_per_s2, steering_wheel_deg: give one of the two.")
        return found

    def amplitude(self, turns: Turns, straight: Steady) -> float:
        """Return the steering wheel angle relative to straight running, positive left [rad]."""
        wanted = self.lateral_acceleration_m_per_s2
        if wanted is None:
            return float(self.sense * np.deg2rad(self.steering_wheel_deg or 0.0))
        turn = self.turned(turns, "lateral_acceleration_m_per_s2", wanted)
        return float(turn.unknowns["steering_wheel"] - straight.unknowns["steering_wheel"])
