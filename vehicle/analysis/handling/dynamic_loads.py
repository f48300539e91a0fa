"""The loads on every part of a car in a manoeuvre."""

from functools import partial

import numpy as np
import xarray as xr

from ....core.errors import InputError
from ....core.validator import Validator
from ..loads.along import over_time
from ..loads.on_a_car import of_car
from .car import DrivingCar
from .result import HandlingResult


def dynamic_loads(result: HandlingResult) -> xr.Dataset:
    """Return the loads on every part of a car at each output of a manoeuvre.

    Parameters
    ----------
    result : HandlingResult
        What `drive` returned. Of several simulations the last one is taken.

    Returns
    -------
    xarray.Dataset
        As of `kintrafo.loads.along`.

    Raises
    ------
    InputError
        If nothing was simulated, as in steady turns and parking, or the car has no linkages.
    PositionError
        If the motion comes to a dead point, where what is carried has no bound.
    """
    with Validator("dynamic_loads") as given:
        given.instance("result", result, HandlingResult, "what kintrafo.handling.drive returns")
    if not result.runs:
        problem = "steady turns and parking have no simulation, and so no loads over time."
        raise InputError([problem], "dynamic_loads")
    run = result.runs[-1]
    assembly = run.car.assembly if isinstance(run.car, DrivingCar) else None
    if assembly is None:
        raise InputError(["the car has no linkages: there are no joints."], "dynamic_loads")
    times = np.asarray(run.motion["time"].values)
    return over_time(partial(of_car, assembly), times, run.states, run.inputs)
