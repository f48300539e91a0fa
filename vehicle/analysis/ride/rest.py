"""Rest of a car: ride heights, corner weights, alignment."""

from typing import Any

import numpy as np
import xarray as xr

from ....core.quantities import variable
from ...assembly.by_wheel import WHEEL, wheel_coordinate
from ...assembly.car import CarAssembly
from ...assembly.equilibrium import equilibrium
from ...assembly.of import car_assembly_of

_OF_BODY = {
    "heave": ("height of the body's centre of mass above that at design", "m"),
    "pitch": ("pitch of the body, positive nose down", "rad"),
    "roll": ("roll of the body, positive with the left side up", "rad"),
}


def at_rest(subject: Any) -> xr.Dataset:
    """Return the position of rest of a car on a level road.

    Parameters
    ----------
    subject : Car or CarModel

    Returns
    -------
    xarray.Dataset
        Over ``wheel``: ``load``, the vertical force of the road [N]; ``travel``, height of the
        wheel centre above design, in axes of the body [m]; ``camber`` and ``toe`` of the wheel in
        level axes along the heading of the body [rad]. Of the body, if it has these coordinates,
        ``heave``, positive up [m], ``pitch``, positive nose down, and ``roll``, positive with the
        right side down [rad].

    Raises
    ------
    PositionError
        If the car does not rest on its wheels, or rests on a stop.

    Examples
    --------
    >>> import kintrafo
    >>> rest = kintrafo.ride.at_rest(kintrafo.load("quarter_car"))
    >>> round(float(rest["load"]), 1)
    3800.0
    """
    assembly = car_assembly("at_rest", subject, riding=False)
    return of_state(assembly, np.asarray(equilibrium(assembly.model)))


def of_state(assembly: CarAssembly, state: Any) -> xr.Dataset:
    """Return the dataset of `at_rest` for a state of rest."""
    signals = assembly.model.signals(state)
    values: dict[str, list[float]] = {"load": [], "travel": [], "camber": [], "toe": []}
    travels = assembly.travels(state[None])
    for wheel in assembly.wheels:
        names = assembly.names_of(wheel)
        own = {name: float(signals[f"{names.signals}{name}"]) for name in _READ}
        values["load"].append(float(signals[names.load]) * assembly.upright(own["camber"]))
        values["travel"].append(float(travels[wheel][0]))
        values["camber"].append(own["camber"])
        values["toe"].append(own["toe"])
    dims = () if len(assembly.wheels) == 1 else (WHEEL,)
    found = {
        name: variable(dims, np.array(values[name] if dims else values[name][0]), words, unit)
        for name, (words, unit) in _OF_WHEELS.items()
    }
    for name, value in assembly.body_at(state).items():
        found[name] = variable((), np.array(value), *_OF_BODY[name])
    return xr.Dataset(found, {WHEEL: wheel_coordinate(assembly.wheels)}, {"title": "car at rest"})


def wheels_and_body(found: xr.Dataset) -> tuple[list[xr.DataArray], list[xr.DataArray]]:
    """Return the variables of the wheels, and those of the body, of a car at rest or on a road."""
    of_wheels = {*_OF_WHEELS, "road"}
    variables = found.data_vars.items()
    return (
        [data for name, data in variables if name in of_wheels],
        [data for name, data in variables if name not in of_wheels],
    )


_READ = ("camber", "toe")
_OF_WHEELS = {
    "load": ("vertical force of the road on the wheel", "N"),
    "travel": ("height of the wheel centre on the body above that at design", "m"),
    "camber": ("camber to the vertical, positive with the top outboard", "rad"),
    "toe": ("toe angle, positive toe-in", "rad"),
}


def car_assembly(source: str, subject: Any, *, riding: bool = True) -> CarAssembly:
    """Return a car as an assembly, or raise an `InputError`; for `riding` if its body travels."""
    found = car_assembly_of(source, subject, _NEEDED)
    if riding:
        found.require_riding()
    return found


_NEEDED = (
    'a kintrafo.Car, such as kintrafo.load("quarter_car"), is needed; the body of a suspension or '
    "an axle alone is held"
)
