"""Double lane change between cones (ISO 3888-1 and ISO 3888-2)."""

from collections.abc import Callable
from itertools import pairwise
from typing import ClassVar, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from .....core.errors import InputError
from ....input.section import Flag, NonNegative, Number, Positive, Section
from ....input.units import in_metres
from ....models.car.car import Car
from ..car import DrivingCar
from ..circle import Turns, steering_ratio
from ..drivers import HeldTorque, Observation, PathFollower
from ..paths import Lane, Path, through
from ..responses import steering_response
from ..result import HandlingResult, quantity
from ..steady import Steady
from .manoeuvre import Number as Judged
from .manoeuvre import Progress
from .simulated import TurningManoeuvre, greatest, place_from

# Lateral acceleration of the turn that gives the driver's steering characteristic [m/s^2].
_GENTLE = 0.5
# Frequency of steering in a lane change, at which the delay of the car is computed [Hz].
_SWERVING = 0.5
# The simulation ends after this multiple of the usual time.
_PATIENT = 2.0
# Greatest distance of the cones of a lane [m].
_SPACING = 3.0


class LaneSection(Section):
    """A lane between cones. Its width is a part of that of the car, and more."""

    start_m: NonNegative = Field(description="distance of its beginning from the first cones")
    length_m: Positive = Field(description="length")
    width_of_car: Positive = Field(description="width, as a multiple of the width of the car")
    width_more_m: NonNegative = Field(description="addition to this product")
    least_width_m: NonNegative = Field(default=0.0, description="least width")
    beside_m: Number | None = Field(
        default=None,
        description="distance of its near edge from the far edge of the first lane; by default "
        "shifted_m applies",
    )
    shifted_m: Number = Field(
        default=0.0,
        description="distance of its edge from the same edge of the first lane, towards the side "
        "of the change",
    )


class Driver(Section):
    """The driver that follows the path through the lanes."""

    preview_s: Positive = Field(default=0.45, description="preview time of the driver")
    anticipation_s: NonNegative | None = Field(
        default=None,
        description="compensated delay of arms and car; by default that of the arms, and that of "
        "the lateral acceleration at 0.5 Hz by the linear equations",
    )
    bandwidth_Hz: Positive = Field(  # noqa: N815 (Hz is the hertz)
        default=4.0, description="natural frequency of the arms"
    )
    largest_deg: Positive = Field(default=360.0, description="largest steering wheel angle")
    fastest_deg_per_s: Positive = Field(
        default=800.0, description="largest rate of the steering wheel"
    )

    def along(self, path: Path, turns: Turns, straight: Steady) -> PathFollower:
        """Return the driver on a path, with the steering characteristic and delay of the car.

        `turns` are steady turns of the car at the speed of the manoeuvre.
        """
        anticipation = self.anticipation_s
        if anticipation is None:
            of_arms = 1.0 / (np.pi * self.bandwidth_Hz)
            anticipation = max(of_arms + _delay(turns.car, straight), 0.0)
        return PathFollower(
            path, _knowing(turns, straight), self.preview_s, anticipation, self.bandwidth_Hz,
            np.deg2rad(self.largest_deg), np.deg2rad(self.fastest_deg_per_s),
        )  # fmt: skip


class DoubleLaneChange(TurningManoeuvre):
    """A driver steers a car through lanes between cones."""

    TITLE: ClassVar[str] = "double lane change"
    CURVES: ClassVar[tuple[str, ...]] = ("", "_cones")

    manoeuvre: Literal["double_lane_change"] = Field(description="name of the manoeuvre")
    car_width_mm: Positive = Field(description="width of the car, without mirrors")
    car_length_mm: Positive = Field(description="length of the car")
    front_overhang_mm: NonNegative = Field(
        description="distance of the front end of the car from the front wheel centres"
    )
    lanes: dict[str, LaneSection] = Field(description="the lanes between cones, by name, in order")
    driver: Driver = Field(default_factory=Driver, description="the driver")
    before_m: Positive = Field(default=30.0, description="straight road before the first cones")
    after_m: Positive = Field(default=30.0, description="straight road behind the last cones")
    holds_speed: Flag = Field(
        default=True, description="true: the speed is held; false: the car coasts from the start"
    )

    @property
    def title(self) -> str:
        """The manoeuvre in a few words, with its speed; a car that coasts avoids an obstacle."""
        words = self.TITLE if self.holds_speed else "obstacle avoidance"
        return f"{words}, {self.speed_km_per_h:g} km/h"

    def problems(self) -> list[str]:
        found = super().problems()
        if len(self.lanes) < 2:
            found.append(
                f"lanes: {len(self.lanes)} given: the driver has no path. Two or more are needed, "
                "such as [lanes.first]."
            )
        ends = [(n, one.start_m, one.start_m + one.length_m) for n, one in self.lanes.items()]
        for (name, _, end), (other, start, _) in pairwise(ends):
            if start < end:
                found.append(
                    f"lanes.{other} start_m = {start:g} m: {end:g} m or more is needed, where "
                    f"lanes.{name} ends."
                )
        narrow = [n for n, one in self.lanes.items() if self._width(one) <= self._car_width]
        found += [f"lanes.{n}: it is narrower than the car, car_width_mm." for n in narrow]
        return found

    def check(self, car: Car) -> None:
        """Raise an error for a car that cannot drive it, or exceeds the dimensions in the file."""
        super().check(car)
        centers = np.array([car.wheel_centers[wheel] for wheel in car.wheels])
        track = float(2.0 * np.abs(centers[:, 1]).max())
        wheelbase = float(np.ptp(centers[:, 0]))
        overhang, length = self.front_overhang_mm, self.car_length_mm
        problems = []
        if self._car_width < track:
            problems.append(
                f"car_width_mm = {self.car_width_mm:g} mm: the wheel centres of this car are "
                f"{1e3 * track:g} mm apart. Enter the width of the car, without mirrors."
            )
        if length - overhang < 1e3 * wheelbase:
            problems.append(
                f"car_length_mm = {length:g} mm: with front_overhang_mm = {overhang:g} mm the car "
                f"ends in front of its rear wheel centres, {1e3 * wheelbase:g} mm behind the front "
                "ones. Enter the length of the car."
            )
        if problems:
            raise InputError(problems, self.TITLE)

    @property
    def _car_width(self) -> float:
        return in_metres(self.car_width_mm, "mm")

    def _width(self, lane: LaneSection) -> float:
        return max(lane.width_of_car * self._car_width + lane.width_more_m, lane.least_width_m)

    def placed(self) -> dict[str, Lane]:
        """Return the lanes along the road, the first one in its middle."""
        first = self._width(next(iter(self.lanes.values())))
        found = {}
        for name, lane in self.lanes.items():
            width = self._width(lane)
            near = -0.5 * first + lane.shifted_m
            if lane.beside_m is not None:
                near = 0.5 * first + lane.beside_m
            edges = sorted((self.sense * near, self.sense * (near + width)))
            found[name] = Lane(lane.start_m, lane.start_m + lane.length_m, *edges)
        return found

    def run(self, car: DrivingCar, progress: Progress) -> HandlingResult:
        """Return the distances of the car from the cones, and the motion."""
        turns, straight = self.straight(car)
        lanes = self.placed()
        reach = car.front + in_metres(self.front_overhang_mm, "mm")
        # the front of the car starts at this distance before the first cones
        origin = car.motion.reference[:2] + np.array([self.before_m + reach, 0.0])
        path = through(list(lanes.values()), before=self.before_m + reach, after=self.after_m)
        end = list(lanes.values())[-1].end
        length = in_metres(self.car_length_mm, "mm")
        torque = straight.unknowns["drive"]

        def ended(seen: Observation) -> bool:
            return seen.x - float(origin[0]) + reach - length >= end

        steers = self.driver.along(Path(path.points + origin), turns, straight)
        way = end + self.before_m + length
        motion = self.simulated(
            car, straight, steers,
            self.holding(car, torque) if self.holds_speed else HeldTorque(torque, 0.0),
            _PATIENT * way / self.speed, until=ended, progress=progress,
        )  # fmt: skip
        place_from(motion, origin)
        cones = self._cones(motion, lanes, (reach, length))
        numbers = self._numbers(motion, cones, path)
        return HandlingResult(self.judged(numbers), {"": motion, "_cones": cones})

    def _cones(
        self, motion: xr.Dataset, lanes: dict[str, Lane], reaches: tuple[float, float]
    ) -> xr.Dataset:
        """Return the cones, and the distance of the side of the car from each.

        Attributes are the size of the car, and its length in front of the reference point [m].
        """
        rows = [
            (name, x, side, y)
            for name, lane in lanes.items()
            for side, y in ((1.0, lane.left), (-1.0, lane.right))
            for x in np.linspace(lane.start, lane.end, 1 + int(np.ceil(lane.length / _SPACING)))
        ]
        names, x, side, y = (np.array(column) for column in zip(*rows, strict=True))
        yaw = motion["yaw_angle"].values[:, None]
        dx, dy = x - motion["x"].values[:, None], y - motion["y"].values[:, None]
        ahead = np.cos(yaw) * dx + np.sin(yaw) * dy
        left = np.cos(yaw) * dy - np.sin(yaw) * dx
        front, length = reaches
        beside = (ahead <= front) & (ahead >= front - length)
        free = np.where(beside, side * left - 0.5 * self._car_width, np.inf).min(axis=0)
        free = np.where(np.isfinite(free), free, np.nan)
        found = {
            "x": quantity("cone", x, "position along the road", "m"),
            "y": quantity("cone", y, "position across the road, positive to the left", "m"),
            "clearance": quantity("cone", free, "distance of the side of the car", "m"),
            "lane": ("cone", names),
        }
        size = {"car_front": front, "car_length": length, "car_width": self._car_width}
        return xr.Dataset(found, attrs={"title": f"{self.title}: cones"} | size)

    def _numbers(self, motion: xr.Dataset, cones: xr.Dataset, path: Path) -> dict[str, Judged]:
        free = cones["clearance"].values
        x, speed = motion["x"].values, motion["speed"].values
        offsets = path.offsets(x, motion["y"].values)
        rate = np.gradient(motion["steering_wheel_angle"].values, motion["time"].values)
        found: dict[str, Judged] = {
            "cones_hit": (
                float(np.sum(~(free > 0.0))), "cones that the car touches, or never passes", "1"
            ),
            "clearance": (float(np.nanmin(free)), "smallest distance from a cone", "m"),
            "entry_speed": (float(np.interp(0.0, x, speed)), "speed at the first cones", "m/s"),
            "exit_speed": (float(speed[-1]), "speed behind the last cones", "m/s"),
            "greatest_deviation": (
                float(np.abs(offsets).max()), "greatest distance from the path", "m",
            ),
            "greatest_steering_wheel_angle": (
                float(np.abs(motion["steering_wheel_angle"]).max()),
                "greatest absolute steering wheel angle", "rad",
            ),
            "greatest_steering_wheel_rate": (
                float(np.abs(rate).max()), "greatest absolute rate of the steering wheel", "rad/s",
            ),
        }  # fmt: skip
        return found | greatest(motion)


def _knowing(turns: Turns, straight: Steady) -> Callable[[float], float]:
    """Return a function of speed: the steering wheel angle by curvature of a gentle turn [rad m].

    Its part by understeer grows with the square of the speed.
    """
    turn = turns.to(turns.sense * _GENTLE)
    speed = turns.first.value
    curvature = turn.unknowns["yaw_rate"] / speed
    ratio = steering_ratio(turns.car, straight)
    angle = (turn.unknowns["steering_wheel"] - straight.unknowns["steering_wheel"]) / curvature
    slow = ratio * turns.car.wheelbase
    by_square = (angle - slow) / speed**2
    return lambda at: slow + by_square * at * at


def _delay(car: DrivingCar, straight: Steady) -> float:
    """Return the delay of the lateral acceleration after the steering wheel [s]."""
    found = steering_response(car, straight, np.array([_SWERVING]))["lateral_acceleration"]
    return float(-np.angle(found[0]) / (2.0 * np.pi * _SWERVING))
