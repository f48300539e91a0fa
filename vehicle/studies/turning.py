"""The axis of lateral accelerations of steady turns with a constant quantity."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from ...core.named_types import Array
from ...core.units import KM_PER_H
from ...core.validator import Validator
from ..analysis.handling.circle import columns_of_turns, turns_at
from ..analysis.handling.steady import SteadyCondition
from ..analysis.handling.subject import driving_car
from ..assembly.assembly import Assembly
from ..assembly.quantity import GREATEST_SPEED, LATERAL_ACCELERATION
from ..models.car.car import WHEELS
from .axis import SweepAxis, number_of

TURNS = "lateral_acceleration"
"""Steady turns of cars that drive (ISO 4138)."""
TURNING_SPEED_KM_PER_H = 100.0
"""Default of the constant speed of steady turns [km/h]."""

# Constant quantities: kind, factor from the unit of the key to SI units, greatest value in the unit
# of the key, and words.
_CONSTANT = {
    "speed_km_per_h": ("speed", 1.0 / KM_PER_H, GREATEST_SPEED, "speed of {:g} km/h"),
    "radius_m": ("curvature", 1.0, 1e5, "radius of {:g} m"),
    "steering_wheel_deg": ("steering_wheel", np.pi / 180.0, 2000.0, "steering wheel of {:g} deg"),
}
OPTIONS = tuple(_CONSTANT)
"""Quantities of which one is constant in all turns."""


def axis(given: Validator, options: Mapping[str, object]) -> SweepAxis:
    """Return the axis of steady turns in which one of the `OPTIONS` is constant."""
    if len(options) > 1:
        given.fail(f"{', '.join(options)}: one of them is constant in steady turns. Leave out one.")
    chosen = dict(options) or {OPTIONS[0]: TURNING_SPEED_KM_PER_H}
    key, value = next(iter(chosen.items()))
    kind, to_si, most, words = _CONSTANT[key]
    number = given.number(key, number_of(value), above=0.0, below=most)
    size = 1.0 / number if kind == "curvature" else number * to_si
    moving = kind == "speed"  # others have no turn without lateral acceleration

    def curves(assembly: Assembly, accelerations: Array) -> xr.Dataset:
        first = SteadyCondition(kind, size)
        return turns_at(driving_car("steady turns", assembly), first, accelerations)

    return SweepAxis(
        LATERAL_ACCELERATION,
        columns_of_turns(WHEELS),
        f"lateral acceleration at a {words.format(number)}",
        curves,
        (0.0, 1.0, 2.0, 3.0, 4.0) if moving else (1.0, 2.0, 3.0, 4.0),
        0.0 if moving else 1.0,
    )
