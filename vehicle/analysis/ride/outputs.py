"""What a ride is judged by: accelerations of the body, loads and travels of the wheels."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ...assembly.car import CarAssembly

OUTPUTS_OF_WHEELS = {
    "load": ("force of the tyre in the plane of the wheel", "N"),
    "travel": ("height of the wheel centre on the body above that at design", "m"),
}
"""Of each wheel: words and unit."""


def body_outputs(assembly: CarAssembly) -> dict[str, tuple[str, str]]:
    """Return the accelerations of the body that are felt: words and unit by name."""
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
    """Return loads and travels of the wheels to first order, each by wheel.

    Parameters
    ----------
    assembly : CarAssembly
    signals, coordinates : mapping
        Changes of signals and coordinates, by name.
    slopes : mapping
        Of the travel of each wheel by coordinates.
    """
    names = {wheel: assembly.names_of(wheel).signals for wheel in assembly.wheels}
    return {
        "load": [signals[f"{names[wheel]}tyre_force"] for wheel in assembly.wheels],
        "travel": [
            np.sum([slope * coordinates[k] for k, slope in slopes[wheel].items()], axis=0)
            for wheel in assembly.wheels
        ],
    }
