"""Metrics of a manoeuvre, and curves of the car's motion in it."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import xarray as xr

from ....core.quantities import Display, variable
from ....core.units import KM_PER_H
from ..run import Run


class HandlingResult(NamedTuple):
    """The result of a manoeuvre.

    Attributes
    ----------
    metrics : xarray.Dataset
        Its metrics, each with unit and meaning.
    curves : dict of str to xarray.Dataset
        Curves over time, lateral acceleration or frequency. Their names are the endings of the
        names of data files, such as ``"_response"``; that of the main curves is ``""``.
    runs : sequence of Run
        The simulations, with the states of the equations; empty for steady turns.
    """

    metrics: xr.Dataset
    curves: Mapping[str, xr.Dataset]
    runs: Sequence[Run] = ()

    @property
    def not_valid(self) -> list[str]:
        """The reasons why curves are not valid; empty if all of them are."""
        return [text for one in self.curves.values() for text in one.attrs.get("not_valid", ())]


def quantity(
    dimensions: str | tuple[str, ...], values: Any, meaning: str, units: str
) -> xr.Variable:
    """Return a variable with its description and with display units of vehicle dynamics."""
    found = variable(dimensions, values, meaning, units)
    if units in _READ:
        display, factor = _READ[units]
        found.attrs |= {"display_units": display, "display_factor": factor}
    return found


_DEGREES = 180.0 / math.pi
# Display units by SI unit, with the factor of values.
_READ = {
    "m": ("m", 1.0),
    "m/s": ("km/h", KM_PER_H),
    "rad s^2/m": Display.of("deg/g"),
    "N m s^2/m": Display.of("N m/g"),
    "m/(s^2 rad)": ("m/s^2/deg", 1.0 / _DEGREES),
    "rad s": ("deg s", _DEGREES),
}
