"""Metrics of the ride of a car over speed, by the linear equations."""

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ....core.named_types import Array
from ....core.quantities import Display
from ....core.validator import Validator
from ...assembly.by_wheel import WHEEL, wheel_coordinate
from ...assembly.car import CarAssembly
from ...assembly.quantity import SPEED, Quantity
from ...roads.rough import roughness_of
from .linear import (
    FREQUENCIES,
    density,
    linear_at_rest,
    named_modes,
    responses_by_wheel,
    root_mean_square,
    weighted_root_mean_square,
)
from .rest import car_assembly

_PERCENT = Display.of("%")
_ALWAYS = "positive always"
_OF_BODY = (
    Quantity(
        "acceleration_rms", "m/s^2", "vertical acceleration, RMS",
        "root mean square over frequency of the vertical acceleration of a place of the body",
        _ALWAYS,
    ),
    Quantity(
        "weighted_rms", "m/s^2", "weighted vertical acceleration, RMS",
        "the same, weighted by W_k of ISO 2631-1", _ALWAYS,
    ),
)  # fmt: skip
OF_WHEELS = (
    Quantity(
        "load_rms", "N", "variation of the wheel load, RMS",
        "root mean square of the force of the tyre less that at rest", _ALWAYS,
    ),
    Quantity(
        "load_variation", "1", "relative variation of the wheel load",
        "root mean square of the force of the tyre less that at rest, over that at rest", _ALWAYS,
        _PERCENT,
    ),
    Quantity(
        "travel_rms", "m", "wheel travel, RMS",
        "root mean square of the height of the wheel centre on the body less that at rest; three "
        "times of it is the rattle space that is enough for 99.7 % of the time", _ALWAYS,
    ),
)  # fmt: skip
_MODES = ("heave", "pitch", "roll", "hop", "front_hop", "front_tramp", "rear_hop", "rear_tramp")


def _of_mode(name: str) -> tuple[Quantity, Quantity]:
    words = name.replace("_", " ")
    definition = f"of the mode {words} at rest, the same at all speeds"
    return (
        Quantity(
            f"{name}_frequency", "Hz", f"natural frequency of {words}",
            f"undamped natural frequency {definition}", _ALWAYS,
        ),
        Quantity(
            f"{name}_damping_ratio", "1", f"damping ratio of {words}",
            f"damping ratio {definition}", "positive where motions decay",
        ),
    )  # fmt: skip


OF_CAR = {q.name: q for q in (*_OF_BODY, *(q for name in _MODES for q in _of_mode(name)))}
"""Metrics of a car by name; those of each wheel are `OF_WHEELS`."""


def by_speed(
    subject: Any, speeds: ArrayLike, roughness: str | float = "B", *, seat: str | None = None
) -> xr.Dataset:
    """Return accelerations, load variations and modes of a car on a rough road over speed.

    Parameters
    ----------
    subject : Car or CarModel
    speeds : array_like, shape (n,)
        Speeds of the car, above zero [m/s].
    roughness : str or float, optional
        Class of ISO 8608, or G(n0) [m^3].
    seat : str, optional
        Name of the seat at which accelerations are taken, a section ``[seats.NAME]`` of the file;
        by default the body's centre of mass.

    Returns
    -------
    xarray.Dataset
        Over ``speed``: ``acceleration_rms`` and ``weighted_rms`` (W_k of ISO 2631-1) [m/s^2]; of
        each wheel ``load_rms`` [N], ``load_variation``, the same divided by the load at rest, and
        ``travel_rms`` [m]; of each mode ``heave_frequency`` [Hz] and ``heave_damping_ratio``, by
        the names of `modes`, the same at all speeds.

    Notes
    -----
    Spectra are those of `response` over its usual frequencies, 0.2 to 50 Hz.

    Examples
    --------
    >>> import kintrafo
    >>> found = kintrafo.ride.by_speed(kintrafo.load("quarter_car"), [10.0, 20.0])
    >>> found["weighted_rms"].values.round(2).tolist()
    [0.38, 0.54]
    """
    assembly = car_assembly("by_speed", subject)
    with Validator("by_speed") as given:
        chosen = given.array("speeds", speeds, "m/s", dimensions=[1])
        if not given.failed and (chosen <= 0.0).any():
            given.fail("speeds: more than 0 m/s is needed.")
        at_reference = roughness_of(given, roughness)
        seats = list(assembly.car.described.seats)
        if seat is not None and not seats:
            given.fail(f"seat = {seat!r}: the file of the car has no [seats.NAME]. Add one.")
        elif seat is not None:
            given.among("seat", seat, seats)
    linear = linear_at_rest(assembly)
    found = responses_by_wheel(assembly, linear, FREQUENCIES)
    place = "body_acceleration" if seat is None else f"{seat}_acceleration"
    spectra = {
        name: np.stack(
            [density(assembly, found[of], FREQUENCIES, v, at_reference) for v in chosen.tolist()]
        )
        for name, of in {"acceleration": place, "load": "load", "travel": "travel"}.items()
    }
    at_rest = [
        linear.outputs[linear.output_names.index(f"{assembly.names_of(w).signals}tyre_force")]
        for w in assembly.wheels
    ]
    values = _of_spectra(spectra, np.array(at_rest))
    for name, (mode, _) in named_modes(assembly, linear).items():
        values[f"{name}_frequency"] = np.full_like(chosen, mode.natural_frequency)
        values[f"{name}_damping_ratio"] = np.full_like(chosen, mode.damping_ratio)
    return _dataset(assembly, chosen, values)


def _of_spectra(spectra: dict[str, Array], at_rest: Array) -> dict[str, Array]:
    """Return metrics by name, of shape (speeds,), or (wheels, speeds)."""
    loads, travels = (root_mean_square(spectra[n], FREQUENCIES).T for n in ("load", "travel"))
    return {
        "acceleration_rms": root_mean_square(spectra["acceleration"], FREQUENCIES),
        "weighted_rms": weighted_root_mean_square(spectra["acceleration"], FREQUENCIES),
        "load_rms": loads,
        "load_variation": loads / (at_rest[:, None] if loads.ndim > 1 else at_rest[0]),
        "travel_rms": travels,
    }


def _dataset(assembly: CarAssembly, speeds: Array, values: dict[str, Array]) -> xr.Dataset:
    known = OF_CAR | {quantity.name: quantity for quantity in OF_WHEELS}
    along = SPEED.name
    variables: dict[str, Any] = {
        name: ((WHEEL, along) if row.ndim > 1 else (along,), row, known[name].attributes())
        for name, row in values.items()
    }
    coordinates: dict[str, Any] = {along: (along, speeds, SPEED.attributes())}
    if len(assembly.wheels) > 1:
        coordinates[WHEEL] = wheel_coordinate(assembly.wheels)
    return xr.Dataset(variables, coordinates, {"title": "ride over speed, linear"})
