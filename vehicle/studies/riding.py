"""The axis of speeds of a car on a rough road, with metrics of its ride as curves."""

from collections.abc import Mapping
from typing import Any

import xarray as xr

from ...core.named_types import Array
from ...core.units import KM_PER_H
from ...core.validator import Validator
from ..analysis.ride.by_speed import OF_CAR, OF_WHEELS, by_speed
from ..assembly.assembly import Assembly
from ..assembly.quantity import SPEED
from ..models.car.car import WHEELS
from ..roads.rough import roughness_of
from .axis import SweepAxis, number_of

RIDE = "speed"
"""Speed of cars that do not drive, on a rough road."""
OPTIONS = ("road", "seat")
"""The class of the road, or G(n0) [m^3], and the seat of accelerations."""

_USUAL_KM_PER_H, _AT_KM_PER_H = (40.0, 60.0, 80.0, 100.0, 120.0), 80.0
_KNOWN = OF_CAR | {
    each.name: each
    for quantity in OF_WHEELS
    for each in (quantity, *(quantity.of_wheel(wheel) for wheel in WHEELS))
}


def axis(given: Validator, options: Mapping[str, Any]) -> SweepAxis:
    """Return the axis of speeds on a road."""
    road, seat = number_of(options.get("road", "B")), options.get("seat")
    roughness_of(given, road)
    if seat is not None:
        given.text("seat", seat)
    place = "" if seat is None else f", at the place of the {seat}"
    known = f"class {road}" if isinstance(road, str) else f"G(n0) = {road} m^3"

    def curves(assembly: Assembly, speeds: Array) -> xr.Dataset:
        return by_speed(assembly, speeds, road, seat=seat)

    usual = tuple(v / KM_PER_H for v in _USUAL_KM_PER_H)
    words = f"speed on a road of {known}{place}"
    return SweepAxis(SPEED, _KNOWN, words, curves, usual, _AT_KM_PER_H / KM_PER_H)
