"""The road under the wheels of a car that drives, by the distance that the car has travelled."""

import math
from collections.abc import Sequence

import numpy as np
from scipy.interpolate import CubicSpline

from ....core.named_types import Array
from ...models.sides import SIDES
from ...roads.road import Road


class RoadUnder:
    """Heights of a road under the wheels of a car, at the samples of a simulation.

    Both tracks of the road follow the path of the car: a wheel is on the track of its side, at the
    distance that the reference point has travelled, less the distance of the wheel behind the front
    wheels [m]. A car that stops and rolls back returns along its path. Between two samples heights
    change linearly. The front wheels begin `Road.lead` before the start of the road.
    """

    def __init__(
        self, road: Road, wheels: Sequence[str], behind: Sequence[float], input_names: Sequence[str]
    ) -> None:
        names = list(input_names)
        self._sides = []
        for side in SIDES:
            own = [i for i, wheel in enumerate(wheels) if wheel.endswith(f"_{side}")]
            heights = [names.index(f"{wheels[i]}_road_height") for i in own]
            rates = [names.index(f"{wheels[i]}_road_velocity") for i in own]
            back = np.array([behind[i] for i in own])
            self._sides.append((road.over_distance(side), back, heights, rates))
        self._travelled = -road.lead
        self._speed: float | None = None  # below zero while the car rolls back
        self._sense, self._last = 1.0, (0.0, 0.0)  # of its motion, and its last velocity but zero
        self._reached: list[Array] = [
            self._at(spline, back, 0.0) for spline, back, *_ in self._sides
        ]

    def advance(self, inputs: Array, velocity: tuple[float, float], step: float) -> None:
        """Set the heights, and their rates up to the next sample, in the inputs of a step [s].

        The velocity is that of the reference point, along and across the heading [m/s].
        """
        if self._last[0] * velocity[0] + self._last[1] * velocity[1] < 0.0:
            self._sense = -self._sense
        if any(velocity):
            self._last = velocity
        speed = self._sense * math.hypot(*velocity)
        if self._speed is not None:
            self._travelled += 0.5 * (self._speed + speed) * step
        self._speed = speed
        for i, (spline, back, heights, rates) in enumerate(self._sides):
            now, then = self._reached[i], self._at(spline, back, speed * step)
            inputs[heights], inputs[rates] = now, (then - now) / step
            self._reached[i] = then

    def _at(self, spline: CubicSpline, back: Array, ahead: float) -> Array:
        """Return the heights under the wheels of a side after a further distance [m]."""
        return spline(np.clip(self._travelled + ahead - back, *spline.x[[0, -1]]))
