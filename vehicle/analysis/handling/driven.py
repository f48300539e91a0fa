"""Simulation of a car with a driver, whose actions are constant between samples."""

import math
from collections.abc import Callable
from typing import Any, Literal, NamedTuple

import numpy as np
import xarray as xr

from ....core.named_types import Array
from ....core.quantities import variable
from ....core.validator import Validator
from ....simulation.result import SimulationError
from ....simulation.stepper import Stepper
from ....simulation.validity import bounds_of, excursions
from ...assembly.by_wheel import WHEEL, wheel_coordinate
from ..run import CAR_ADVICE, Run
from .body_motion import QUANTITIES
from .car import OF_STEERING, DrivingCar
from .drivers import Observation, Pedals, Pushes, Steers
from .result import quantity

_METHOD: Literal["DormandPrince"] = "DormandPrince"
# Greatest lateral displacement of a straight path [m].
_STRAIGHT = 0.5
# Below this cosine of the tilt of the body the car overturns.
_FALLEN = 0.5
MOST_SAMPLES = 2_000_000
"""More samples would fill the memory: the step is probably wrong."""

OF_WHEELS = {
    "fx": ("longitudinal force of the road on the tyre, positive forward", "N"),
    "fy": ("lateral force of the road on the tyre, positive to the left", "N"),
    "fz": ("vertical force of the road on the tyre", "N"),
    "slip": ("longitudinal slip, positive in driving", "1"),
    "slip_angle": ("slip angle, positive moving to the left", "rad"),
}
"""Quantities of each wheel: meaning and unit."""

STEER = ("steer angle of the wheel to the body, positive to the left", "rad")
"""Meaning and unit."""

ROAD = ("height of the road under the wheel", "m")
"""Meaning and unit."""


OF_DRIVER = {
    "steering_wheel_angle": ("steering wheel angle, positive to the left", "rad"),
    "drive_torque": ("torque of all driven wheels together", "N m"),
    "brake_pedal": ("part of the greatest torque of the brakes", "1"),
}
"""Actions of the driver: meaning and unit."""


class Sampling(NamedTuple):
    """Sampling of a simulation."""

    step: float = 1e-3  # time between two samples [s]
    outputs: int = 5  # number of samples from output to output


def driven(
    car: DrivingCar,
    start: Array,
    steers: Steers,
    pushes: Pushes,
    duration: float,
    *,
    samples: Sampling | None = None,
    until: Callable[[Observation], bool] | None = None,
    progress: Callable[[float], None] | None = None,
) -> xr.Dataset:
    """Return the motion of a car with a driver, from a state, for a duration [s].

    Between samples the equations are integrated by the method of Dormand and Prince, with the
    tolerances of `kintrafo.Stepper`. The driver decides at each sample: up to the next one the
    acceleration of the rack and all torques are constant. The simulation ends earlier when `until`
    returns True for an observation of the driver; `progress` is called with the completed fraction.

    The result is over ``time``: the motion of the body, the actions of the driver, and forces and
    slips of each wheel; on a road with heights also these, as ``road``. The attribute ``not_valid``
    describes where the motion leaves the validity of the equations; the simulation of a car that
    overturns ends there. The error of an integration that cannot continue is a `SimulationError`.
    """
    how = samples or Sampling()
    count = max(round(duration / how.step), 1)
    with Validator("drive") as given:
        if count > MOST_SAMPLES:
            given.fail(
                f"step = {how.step:g} s makes {count:,} samples in {duration:g} s: too many."
            )
    stepper = Stepper(car.model, how.step, start, method=_METHOD)
    look, under = _look(car), car.road_under()
    rows: list[tuple[float, Array, Array, float, Pedals]] = []
    for sample in range(count + 1):
        seen = look(stepper.time, stepper.state)
        wheel, pedals = steers.decide(seen, how.step), pushes.decide(seen, how.step)
        angle, rate, acceleration = (float(each) for each in wheel)
        acting = car.inputs(angle, rate, acceleration, pedals.drive, pedals.brake)
        if under is not None:
            under.advance(acting, (seen.speed, seen.lateral_velocity), how.step)
        stepper.inputs = acting
        fallen = seen.upright < _FALLEN
        ended = sample == count or fallen or (until is not None and until(seen))
        if sample % how.outputs == 0 or ended:
            rows.append((seen.time, stepper.state.copy(), stepper.inputs.copy(), angle, pedals))
        if ended:
            break
        try:
            stepper.step()
        except SimulationError as error:
            raise error.advising(CAR_ADVICE) from error
        if progress is not None and sample % 100 == 0:
            progress(sample / count)
    found = _dataset(car, rows)
    if fallen:
        found.attrs["not_valid"].insert(0, f"the car overturns at {seen.time:.2f} s")
    if car.watched is not None:
        states, inputs = (np.array(each) for each in zip(*(row[1:3] for row in rows), strict=True))
        places = np.stack([found["x"].values, found["y"].values], axis=-1)
        road = car.road if runs_straight(found) else None  # which pictures show
        car.watched(Run(car, found, states, inputs, places, road=road))
    return found


def runs_straight(motion: xr.Dataset) -> bool:
    """Return whether a car remains within 0.5 m across a straight line along x."""
    return float(np.ptp(motion["y"].values[np.isfinite(motion["y"].values)])) <= _STRAIGHT


def _look(car: DrivingCar) -> Callable[[float, Array], Observation]:
    """Return a function of time and state that returns the observation of a driver."""
    motion = car.motion
    rows = motion.rows(("x", "y", "e0", "e1", "e2", "e3", "u", "v", "w", "p", "q", "r"))
    ax, ay, az = (motion.reference - motion.center).tolist()
    cx, cy, _ = motion.center.tolist()

    def look(time: float, state: Array) -> Observation:
        x, y, a, b, c, d, u, v, w, p, q, r = state[rows].tolist()
        first = 1 - 2 * (c * c + d * d), 2 * (b * c - a * d), 2 * (b * d + a * c)
        second = 2 * (b * c + a * d), 1 - 2 * (b * b + d * d), 2 * (c * d - a * b)
        third = 2 * (b * d - a * c), 2 * (c * d + a * b), 1 - 2 * (b * b + c * c)
        rolling = first[0] * (first[0] * p + first[1] * q + first[2] * r)
        rolling += second[0] * (second[0] * p + second[1] * q + second[2] * r)
        tilt = third[0] / (first[0] ** 2 + second[0] ** 2)
        turning = third[0] * p + third[1] * q + third[2] * r - tilt * rolling
        u, v, w = u + q * az - r * ay, v + r * ax - p * az, w + p * ay - q * ax
        vx = first[0] * u + first[1] * v + first[2] * w
        vy = second[0] * u + second[1] * v + second[2] * w
        yaw = math.atan2(second[0], first[0])
        cosine, sine = math.cos(yaw), math.sin(yaw)
        return Observation(
            time,
            x + cx + first[0] * ax + first[1] * ay + first[2] * az,
            y + cy + second[0] * ax + second[1] * ay + second[2] * az,
            yaw,
            cosine * vx + sine * vy,
            cosine * vy - sine * vx,
            turning,
            third[2],
        )

    return look


def _dataset(car: DrivingCar, rows: list[tuple[float, Array, Array, float, Pedals]]) -> xr.Dataset:
    times, states, inputs, angles, pedals = zip(*rows, strict=True)
    every, acting = np.array(states), np.array(inputs)
    rates = car.model.evaluate("rhs", every, acting)
    found: dict[str, Any] = {}
    for name, values in car.motion.of(every, rates).items():
        turned = np.unwrap(values) if name == "yaw_angle" else values
        found[name] = quantity("time", turned, *QUANTITIES[name])
    drives, brakes = zip(*pedals, strict=True)
    for name, values in zip(OF_DRIVER, (angles, drives, brakes), strict=True):
        found[name] = quantity("time", np.array(values), *OF_DRIVER[name])
    for name, values in car.of_steering(np.array(angles), every, acting).items():
        found[name] = quantity("time", values, *OF_STEERING[name])
    signals = car.model.evaluate("signals", every, acting)
    for name, described in OF_WHEELS.items():
        found[name] = quantity(
            (WHEEL, "time"), signals[:, car.signal_rows(name, car.wheels)].T, *described
        )
    if car.road is not None:
        heights = [car.model.input_names.index(f"{wheel}_road_height") for wheel in car.wheels]
        found["road"] = variable((WHEEL, "time"), acting[:, heights].T, *ROAD)
    coordinates = {
        "time": ("time", np.array(times), {"units": "s", "long_name": "time"}),
        WHEEL: wheel_coordinate(car.wheels),
    }
    by_name = dict(zip(car.model.signal_names, signals.T, strict=True))
    passed = excursions(car.model, bounds_of(car.model), np.array(times), by_name)
    left = [str(each) for each in passed if not each.bound.possible]
    return xr.Dataset(found, coordinates, {"not_valid": left})
