"""Outputs of a ride: accelerations of the body, loads and travels of the wheels."""

from collections.abc import Mapping
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


def upward(motion: Mapping[str, tuple[Any, Any, Any]], place: Array) -> Any:
    """Return the upward acceleration of a point of a body that heaves, pitches and rolls.

    The motion is position, rate and acceleration of ``heave``, and of ``pitch`` and ``roll`` if
    they exist; the point is relative to the centre of mass, in the axes of the body, (3,) [m].
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
