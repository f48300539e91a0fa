"""Where a rig puts the wheels of an axle: the usual positions of each motion."""

from dataclasses import dataclass

import numpy as np

from ...core.arguments import Arguments
from ...core.errors import InputError
from ...suspension.axle import Axle
from ...suspension.axle.axle import LEFT, RIGHT
from ...suspension.corner import Array
from ...suspension.positions import PositionError, design_height, travel_range
from ..sweep import grid, usual_rack, usual_travel

MOTIONS = {
    "bump": "both wheels rise and fall together",
    "roll": "the wheels move oppositely, as when the body rolls",
    "left": "the left wheel moves, the right one stays at design",
    "right": "the right wheel moves, the left one stays at design",
    "steer": "the steering wheel turns, both wheels at one height",
}
"""The motions of a rig, by name."""

USUAL_ROLL = np.deg2rad(4.0)
USUAL_ROLL_STEP = np.deg2rad(0.25)
USUAL_ANGLE_STEP = np.deg2rad(10.0)  # of the steering wheel
_MOST_TURNS = 40.0 * np.pi  # twenty turns of it
_MOST_ROLL = np.pi / 4.0
# A sweep that is not told otherwise keeps clear of the ends of the motion by this part of them.
_CLEARANCE = 0.02


@dataclass(frozen=True)
class Extent:
    """How far a motion goes, where it is not the usual; all positive.

    Attributes
    ----------
    rebound, bump : float or None
        Wheel travel [m].
    roll : float or None
        To either side [rad].
    rack : float or None
        To either side [m].
    step : float
        Distance of the positions, of wheel travel and rack [m].
    """

    rebound: float | None = None
    bump: float | None = None
    roll: float | None = None
    rack: float | None = None
    step: float = 0.002


def track(axle: Axle) -> float:
    """Return the distance of the wheel centres at design [m]."""
    left, right = (side.hardpoints.metres("wheel_center") for side in axle.sides.values())
    return float(left[1] - right[1])


def travels(axle: Axle, extent: Extent, sides: tuple[str, ...] = (LEFT, RIGHT)) -> Array:
    """Return usual wheel travels that some wheels reach [m], zero included."""
    found = [
        usual_travel(axle.models[side], rebound=extent.rebound, bump=extent.bump, step=extent.step)
        for side in sides
    ]
    low, high = max(f[0] for f in found), min(f[-1] for f in found)
    return grid(low, high, extent.step)


def rolls(axle: Axle, extent: Extent) -> Array:
    """Return usual roll angles that both wheels reach [rad], zero included."""
    most = extent.roll
    if most is None:
        reach = min(
            (1.0 - _CLEARANCE) * abs(end - design_height(model))
            for model in axle.models.values()
            for end in travel_range(model).height
        )
        most = min(USUAL_ROLL, float(np.arctan2(2.0 * reach, track(axle))))
    with Arguments("roll") as given:
        most = given.number("roll", most, "rad", least=0.0, below=_MOST_ROLL)
    return grid(-most, most, USUAL_ROLL_STEP)


def racks(axle: Axle, extent: Extent) -> Array:
    """Return usual displacements of the rack that both wheels reach [m], zero included."""
    found = [
        usual_rack(model, extent=extent.rack, step=extent.step) for model in axle.models.values()
    ]
    most = min(f[-1] for f in found)
    return grid(-most, most, extent.step)


def steering_angles(axle: Axle, extent: Extent) -> Array | None:
    """Return angles of the steering wheel for the usual displacements of the rack [rad].

    Returns
    -------
    ndarray or None
        None where nothing says how the steering wheel moves the rack.
    """
    most = float(racks(axle, extent)[-1])
    if axle.steering is not None:
        low, high = axle.steering.limits()
        dense = np.linspace(low, high, 2001)
        inside = dense[np.abs(axle.steering.rack(dense)) <= most * (1.0 + 1e-9)]
        ends = (float(inside[0]), float(inside[-1])) if inside.size else (1.0, 1.0)
    else:
        per_turn = travel_per_turn(axle)
        if per_turn is None:
            return None
        ends = -2.0 * np.pi * most / per_turn, 2.0 * np.pi * most / per_turn
    if not -_MOST_TURNS < ends[0] <= 0.0 <= ends[1] < _MOST_TURNS:
        problem = (
            f"the steering wheel turns from {np.degrees(ends[0]):.4g} deg to "
            f"{np.degrees(ends[1]):.4g} deg for the {1e3 * most:.4g} mm to either side that the "
            "rack goes; that must have 0 deg within, and 20 turns at most. Correct [steering] "
            "angle_deg and rack_mm (0 mm in the middle), or [rack] travel_per_turn_mm."
            if axle.steering is None or inside.size
            else f"[steering] rack_mm has nothing within the {1e3 * most:.4g} mm to either side "
            "that the rack goes. Count it from the middle position."
        )
        raise InputError([problem], "axle")
    return grid(*ends, USUAL_ANGLE_STEP)


def travel_per_turn(axle: Axle) -> float | None:
    """Return the rack travel for one turn of the steering wheel that the files give [m]."""
    given = axle.right.rack.travel_per_turn_mm
    return None if given is None else given / 1e3


def opposite(axle: Axle, angles: Array) -> tuple[Array, Array]:
    """Return the travels of the left and the right wheel for roll angles of the body [m].

    The wheel centres move oppositely, so that the line between them has the angle to the body.

    Raises
    ------
    PositionError
        If a wheel does not get there.
    """
    if np.abs(angles).max(initial=0.0) >= _MOST_ROLL:
        worst = np.degrees(np.abs(angles).max())
        problem = f"roll of {worst:.4g} deg: less than 45 deg is needed; Python's unit is rad."
        raise InputError([problem], "axle")
    half = 0.5 * track(axle) * np.tan(angles)
    for side, model in axle.models.items():
        low, high = (end - design_height(model) for end in travel_range(model).height)
        if np.abs(half).max(initial=0.0) > min(-low, high):
            most = np.degrees(np.arctan2(2.0 * min(-low, high), track(axle)))
            worst = np.degrees(np.abs(angles).max())
            message = (
                f"roll of {worst:.6g} deg is out of reach: the {side} wheel travels from "
                f"{1e3 * low:+.2f} mm to {1e3 * high:+.2f} mm from design, which is "
                f"{np.floor(1e3 * most) / 1e3:g} deg to either side. Choose less roll."
            )
            raise PositionError(message)
    return -half, half
