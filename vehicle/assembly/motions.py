"""Motions of an axle of two corners on a rig: the default positions, and opposite travel."""

import numpy as np

from ...core.errors import InputError
from ...core.named_types import Array
from ...core.validator import Validator
from ..models.axle import Axle
from ..models.positions import PositionError, design_height, travel_range
from ..models.sides import LEFT, RIGHT
from .rig import SweepRange
from .usual import CLEARANCE, grid, usual_rack, usual_travel
from .wheel_centre_line import WheelCentreLine

MOTIONS = {
    "bump": "both wheels rise and fall together",
    "roll": "the wheels move in opposite directions, as the body rolls",
    "left": "the left wheel moves, the right one stays at design",
    "right": "the right wheel moves, the left one stays at design",
    "steer": "the steering wheel turns, both wheels at one height",
}
"""The motions of a rig, by name."""

USUAL_ROLL = np.deg2rad(4.0)
USUAL_ROLL_STEP = np.deg2rad(0.25)
MOST_ROLL = np.pi / 4.0
# Rounding of heights of the order of 1 m is 1e-16 m: Newton's steps of this size change nothing.
_CLOSE = 1e-15
_MOST_STEPS = 100


def track(axle: Axle) -> float:
    """Return the distance of the wheel centres at design [m]."""
    left, right = (side.hardpoints.metres("wheel_center") for side in axle.sides.values())
    return float(left[1] - right[1])


def travels(axle: Axle, extent: SweepRange, sides: tuple[str, ...] = (LEFT, RIGHT)) -> Array:
    """Return default wheel travels within the range of some wheels [m], zero included."""
    found = [
        usual_travel(axle.models[side], rebound=extent.rebound, bump=extent.bump, step=extent.step)
        for side in sides
    ]
    low, high = max(f[0] for f in found), min(f[-1] for f in found)
    return grid(low, high, extent.step)


def rolls(axle: Axle, extent: SweepRange) -> Array:
    """Return default roll angles within the range of both wheels [rad], zero included."""
    most = extent.roll
    if most is None:
        ends = (1.0 - CLEARANCE) * _most_opposite(axle) * np.array([-1.0, 1.0])
        most = min(USUAL_ROLL, *np.abs(WheelCentreLine.at(axle, -ends, ends).roll))
    with Validator("roll") as given:
        most = given.number("roll", most, "rad", least=0.0, below=MOST_ROLL)
    return grid(-most, most, USUAL_ROLL_STEP)


def racks(axle: Axle, extent: SweepRange) -> Array:
    """Return default rack displacements within the range of both wheels [m], zero included."""
    found = [
        usual_rack(model, extent=extent.rack, step=extent.step) for model in axle.models.values()
    ]
    most = min(f[-1] for f in found)
    return grid(-most, most, extent.step)


def opposite(axle: Axle, angles: Array, rack: float = 0.0) -> tuple[Array, Array]:
    """Return the travels of the left and the right wheel for roll angles [rad] of the body [m].

    The wheel centres move oppositely, so that the line through them turns by the angle. Raises
    `PositionError` if this is out of reach.
    """
    if np.abs(angles).max(initial=0.0) >= MOST_ROLL:
        worst = np.degrees(np.abs(angles).max())
        problem = f"roll of {worst:.4g} deg: less than 45 deg is needed; Python's unit is rad."
        raise InputError([problem], "axle")
    most = _most_opposite(axle, rack)
    ends = most * np.array([-1.0, 1.0])
    low, high = WheelCentreLine.at(axle, -ends, ends, rack).roll
    beyond = (angles < low) | (angles > high)
    if beyond.any():
        worst = float(angles[beyond][np.abs(angles[beyond]).argmax()])
        inside = np.ceil(1e3 * np.degrees(low)) / 1e3, np.floor(1e3 * np.degrees(high)) / 1e3
        side, travels = _nearest_end(axle, rack)
        message = (
            f"roll of {np.degrees(worst):.6g} deg is out of reach: the {side} wheel travels from "
            f"{1e3 * travels[0]:+.2f} mm to {1e3 * travels[1]:+.2f} mm from design, which is "
            f"{inside[0]:g} deg to {inside[1]:g} deg. Choose less roll."
        )
        raise PositionError(message)
    half = _half_travels(axle, angles, rack, most)
    return -half, half


def _reaches(axle: Axle, rack: float) -> dict[str, tuple[float, float]]:
    """Return the lowest and the highest travel of each wheel [m]."""
    return {
        side: (low - design_height(model), high - design_height(model))
        for side, model in axle.models.items()
        for low, high in [travel_range(model, rack).height]
    }


def _nearest_end(axle: Axle, rack: float) -> tuple[str, tuple[float, float]]:
    """Return the side with the smallest range for opposite travel, and its range [m]."""
    reaches = _reaches(axle, rack)
    side = min(reaches, key=lambda side: min(-reaches[side][0], reaches[side][1]))
    return side, reaches[side]


def _most_opposite(axle: Axle, rack: float = 0.0) -> float:
    """Return the greatest opposite travel of both wheels [m]."""
    low, high = _nearest_end(axle, rack)[1]
    return min(-low, high)


def _half_travels(axle: Axle, angles: Array, rack: float, most: float) -> Array:
    """Return the travels of the right wheel at which the line has the roll angles [m].

    By Newton's method with the exact slope; a step that leads out of the bracket, beside a dead
    point, is replaced by half of the bracket.
    """
    half = np.clip(0.5 * track(axle) * np.sin(angles), -most, most)
    low, high = np.full_like(half, -most), np.full_like(half, most)
    for _ in range(_MOST_STEPS):
        line = WheelCentreLine.at(axle, -half, half, rack)
        excess = line.roll - angles
        low, high = np.where(excess <= 0.0, half, low), np.where(excess >= 0.0, half, high)
        before, newton = half, half - excess / line.roll_rate
        inside = (newton >= low) & (newton <= high)
        half = np.where(inside, newton, 0.5 * (low + high))
        if (np.abs(half - before) <= _CLOSE).all():
            break
    return half
