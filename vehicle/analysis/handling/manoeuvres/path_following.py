"""Driving along a path through points."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from .....core.named_types import Array
from ....input.section import Number, Positive
from ..car import DrivingCar
from ..drivers import Observation
from ..paths import Path
from ..result import HandlingResult
from .double_lane_change import Driver
from .manoeuvre import Number as Judged
from .manoeuvre import Progress
from .simulated import SimulatedManoeuvre, greatest, place_from


class PathFollowing(SimulatedManoeuvre):
    """A driver follows a path at constant speed."""

    TITLE: ClassVar[str] = "path following"

    manoeuvre: Literal["path_following"] = Field(description="name of the manoeuvre")
    x_m: tuple[Number, ...] = Field(
        default=(), description="points of the path, along the road; the car begins at the origin"
    )
    y_m: tuple[Number, ...] = Field(
        default=(), description="points of the path, across the road, positive to the left"
    )
    driver: Driver = Field(default_factory=Driver, description="the driver")
    duration_s: Positive = Field(default=120.0, description="longest duration of the simulation")

    def wanted_path(self) -> Array:
        path = Path(np.array([self.x_m, self.y_m]).T)
        return np.array([path.at(along) for along in np.linspace(0.0, path.length, _DRAWN)])

    def problems(self) -> list[str]:
        found = super().problems()
        if len(self.x_m) != len(self.y_m):
            found.append(
                f"x_m has {len(self.x_m)} values, y_m {len(self.y_m)}: equal numbers are needed."
            )
        elif len(self.x_m) < _FEWEST:
            found.append(
                f"x_m, y_m: {len(self.x_m)} points: the driver has no path. {_FEWEST} or more are "
                "needed."
            )
        elif (np.hypot(np.diff(self.x_m), np.diff(self.y_m)) <= 0.0).any():
            found.append("x_m, y_m: two points that follow each other are the same. Remove one.")
        return found

    def run(self, car: DrivingCar, progress: Progress) -> HandlingResult:
        """Return the distances of the car from the path, and the motion."""
        turns, straight = self.straight(car)
        origin = car.motion.reference[:2]
        path = Path(np.array([self.x_m, self.y_m]).T)
        here = Path(path.points + origin)
        steers = self.driver.along(here, turns, straight)

        def ended(seen: Observation) -> bool:
            del seen
            return steers.along >= here.length

        motion = self.simulated(
            car, straight, steers, self.holding(car, straight.unknowns["drive"]), self.duration_s,
            until=ended, progress=progress,
        )  # fmt: skip
        place_from(motion, origin)
        offsets = path.offsets(motion["x"].values, motion["y"].values)
        numbers: dict[str, Judged] = {
            "time": (float(motion["time"][-1]), "time", "s"),
            "greatest_deviation": (
                float(np.abs(offsets).max()), "greatest distance from the path", "m"
            ),
            "rms_deviation": (
                float(np.sqrt(np.mean(offsets**2))), "root mean square of that distance", "m"
            ),
        }  # fmt: skip
        motion.attrs["not_valid"] += self._lost(motion, offsets, here.length - steers.along)
        return HandlingResult(self.judged(numbers | greatest(motion)), {"": motion})

    def _lost(self, motion: xr.Dataset, offsets: Array, left: float) -> Iterator[str]:
        """Yield the reasons why a car does not follow the path, of which a distance is left [m]."""
        time, seen = motion["time"].values, self.speed * self.driver.preview_s
        away = np.flatnonzero(np.abs(offsets) > seen)
        if away.size:
            yield (
                f"the car leaves the path: from {time[away[0]]:.2f} s on it is farther from it "
                f"than the driver looks ahead, {seen:.3g} m. Choose a lower speed"
            )
        elif left > 0.0:
            yield (
                f"after {time[-1]:.6g} s the car is {left:.3g} m before the end of the path. "
                "Raise duration_s"
            )


# Least number of points of a path, and number of points of its picture.
_FEWEST, _DRAWN = 4, 400
