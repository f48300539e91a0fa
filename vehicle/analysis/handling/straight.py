"""Straight running by speed, and its small turns, from the exact linearisation.

Gains are slopes of steady turns at no lateral acceleration. Nothing is simulated.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr

from ....core.named_types import Array
from ....core.units import KM_PER_H
from ....equations.errors import ModelError
from ...models.reach import PositionError
from .car import DrivingCar
from .circle import Turns, described
from .result import HandlingResult, quantity
from .steady import NoSteadyMotionError, SteadyCondition

SPEED = "speed"
# Speeds are found to this [m/s].
_RESOLVED = 1e-4

_GAINS = {
    "yaw_rate_gain": ("yaw velocity by steering wheel angle", "1/s"),
    "lateral_acceleration_gain": ("lateral acceleration by steering wheel angle", "m/(s^2 rad)"),
    "sideslip_gain": ("sideslip angle by steering wheel angle", "1"),
    "roll_gain": ("roll angle by steering wheel angle", "1"),
}
_ZERO_OR_KNOWN = ("curvature", "travel_speed", "yaw_rate", "sideslip_angle", "roll_angle")


def straight_running(
    car: DrivingCar, speeds: Array, *, progress: Callable[[float], None] | None = None
) -> HandlingResult:
    """Return straight running of a car at rising speeds [m/s], and its response to small angles.

    Curves over ``speed`` are gradients as of `steady_turns`, gains by the angle of the steering
    wheel, and ``growth``; metrics are the speed of the greatest gain of the yaw velocity, which is
    the characteristic speed of a car that understeers there (ISO 8855), or the critical speed,
    where the gain has no bound. A speed at which the car does not run straight ahead is a
    `PositionError`.
    """
    rows = []
    for i, speed in enumerate(speeds.tolist()):
        rows.append(at_speed(car, speed))
        if progress is not None:
            progress((i + 1) / speeds.size)
    curves = xr.concat(rows, SPEED, combine_attrs="override", coords="minimal", compat="override")
    axis = quantity(SPEED, speeds, "speed", "m/s")
    first, last = (f"{KM_PER_H * speed:g}" for speed in (speeds[0], speeds[-1]))
    title = {"title": f"straight running, {first} to {last} km/h"}
    curves = curves.assign_coords({SPEED: axis}).assign_attrs(title)
    return HandlingResult(xr.Dataset(_metrics(car, curves), attrs=title), {"": curves})


def at_speed(car: DrivingCar, speed: float) -> xr.Dataset:
    """Return gradients and gains of straight running at a speed [m/s]."""
    turns = Turns(car, SteadyCondition("speed", speed), 1)
    try:
        straight = turns.begin(0.0)
    except (NoSteadyMotionError, ModelError):
        problem = f"the car does not run straight ahead at {KM_PER_H * speed:g} km/h. Choose less."
        raise PositionError(problem) from None
    _, turn = described(turns, straight, {0.0: straight}, np.nan)
    found = turn[""].isel(lateral_acceleration=0)
    found = found.drop_vars(["lateral_acceleration", *_ZERO_OR_KNOWN])
    wheel = float(found["steering_wheel_gradient"])
    gains = (
        1.0 / speed,  # the lateral acceleration is speed times yaw velocity
        1.0,
        float(found["sideslip_gradient"]),
        float(found["roll_gradient"]),
    )
    more: dict[str, Any] = {
        name: quantity((), gain / wheel, *words)
        for (name, words), gain in zip(_GAINS.items(), gains, strict=True)
    }
    return found.assign(more)


def _metrics(car: DrivingCar, curves: xr.Dataset) -> dict[str, Any]:
    """Return the speed of the greatest gain or the critical speed, if it is within the range."""
    from scipy.optimize import brentq, minimize_scalar  # noqa: PLC0415 (slow to import)

    speeds, gains = curves[SPEED].values, curves["yaw_rate_gain"].values
    changes = np.flatnonzero(np.diff(np.sign(gains)))
    if changes.size:
        low, high = speeds[changes[0]], speeds[changes[0] + 1]

        def angle_by_yaw_rate(speed: float) -> float:
            return float(1.0 / at_speed(car, speed)["yaw_rate_gain"])

        found = float(brentq(angle_by_yaw_rate, low, high, xtol=_RESOLVED))
        words = "critical speed, where the gain of the yaw velocity has no bound"
        return {"critical_speed": quantity((), found, words, "m/s")}
    top = int(np.argmax(gains))
    if not 0 < top < gains.size - 1:
        return {}

    def negative_gain(speed: float) -> float:
        return -float(at_speed(car, speed)["yaw_rate_gain"])

    between = (speeds[top - 1], speeds[top + 1])
    best = minimize_scalar(
        negative_gain, bounds=between, method="bounded", options={"xatol": _RESOLVED}
    )
    name, words = "speed_of_greatest_gain", "speed of the greatest gain of the yaw velocity"
    if float(at_speed(car, float(best.x))["understeer_gradient"]) > 0.0:
        name, words = "characteristic_speed", f"characteristic speed, {words}"
    meaning, unit = _GAINS["yaw_rate_gain"]
    return {
        name: quantity((), float(best.x), words, "m/s"),
        "greatest_yaw_rate_gain": quantity((), -float(best.fun), f"greatest {meaning}", unit),
    }
