"""Courses of inputs that doors draw, with their rates in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Sine:
    """An oscillation about zero.

    Attributes
    ----------
    size : float
        Its amplitude, as of a road [m].
    pace : float
        Its angular frequency [rad/s].
    """

    size: float
    pace: float

    def __call__(self, time):
        return float(self.size * np.sin(self.pace * time))

    def rate(self, time):
        """Return the slope over time [m/s]."""
        return float(self.size * self.pace * np.cos(self.pace * time))

    def second_rate(self, time):
        """Return the curvature over time [m/s^2]."""
        return -(self.pace**2) * self(time)


AT_REST = Sine(0.0, 0.0)
