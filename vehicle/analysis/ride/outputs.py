"""Outputs of a ride: accelerations of the body, loads and travels of the wheels."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ....core.named_types import Array
from ...assembly.car import CarAssembly

OUTPUTS_OF_WHEELS = {
    "load": ("force of the tyre in the plane of the wheel", "N"),
    "travel": ("height of the wheel centre on the body above that at design", "m"),
}
"""Outputs of each wheel: words and unit."""


def body_outputs(assembly: CarAssembly) -> dict[str, tuple[str, str]]:
    """Return the accelerations of the centre of mass and of seats: words and unit by name."""
    words = {"body_acceleration": "vertical acceleration of the body's centre of mass"}
    words |= {
        f"{name}_acceleration": f"vertical acceleration at the place of the {name}"
        for name in assembly.car.described.seats
    }
    return {name: (text, "m/s^2") for name, text in words.items()}


def wheel_outputs(
    assembly: CarAssembly,
    signals: Mapping[str, Any],
    coordinates: Mapping[str, Any],
    slopes: Mapping[str, Mapping[str, float]],
) -> dict[str, Sequence[Any]]:
    """Return first-order loads and travels of the wheels, each in the order of the wheels.

    Parameters
    ----------
    assembly : CarAssembly
    signals, coordinates : mapping
        Changes of signals and coordinates, by name.
    slopes : mapping
        Derivatives of the travel of each wheel in the coordinates.
    """
    names = {wheel: assembly.names_of(wheel).signals for wheel in assembly.wheels}
    return {
        "load": [signals[f"{names[wheel]}tyre_force"] for wheel in assembly.wheels],
        "travel": [
            np.sum([slope * coordinates[k] for k, slope in slopes[wheel].items()], axis=0)
            for wheel in assembly.wheels
        ],
    }


def upward(motion: Mapping[str, tuple[Any, Any, Any]], place: Array) -> Any:
    """Return the upward acceleration of a point of a body that heaves, pitches and rolls.

    Parameters
    ----------
    motion : mapping of str to tuple of ndarray or float
        Position, rate and acceleration of ``heave``, and of ``pitch`` and ``roll`` if they exist.
    place : ndarray, shape (3,)
        The point relative to the centre of mass, axes of the body [m].
    """
    none = 0.0 * motion["heave"][0]
    pitch, d_pitch, dd_pitch = motion.get("pitch", (none, none, none))
    roll, d_roll, dd_roll = motion.get("roll", (none, none, none))
    x, y, z = place
    # the height of the point is heave - sin(pitch) x + cos(pitch) h
    h, slope = np.sin(roll) * y + np.cos(roll) * z, np.cos(roll) * y - np.sin(roll) * z
    d_h, dd_h = d_roll * slope, dd_roll * slope - d_roll**2 * h
    sine, cosine = np.sin(pitch), np.cos(pitch)
    return (
        motion["heave"][2]
        - dd_pitch * (cosine * x + sine * h)
        + d_pitch**2 * (sine * x - cosine * h)
        - 2.0 * sine * d_pitch * d_h
        + cosine * dd_h
    )
