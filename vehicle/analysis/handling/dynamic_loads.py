"""The loads on every part of a car in a manoeuvre."""

from functools import partial

import numpy as np
import xarray as xr

from ....core.errors import InputError
from ....core.validator import Validator
from ..loads.along import over_time
from ..loads.on_a_car import of_car
from .result import HandlingResult

_NEEDED = "a result of kintrafo.handling.drive is needed"


def dynamic_loads(result: HandlingResult) -> xr.Dataset:
    """Return the loads on every part of a car at each output of a manoeuvre.

    Parameters
    ----------
    result : HandlingResult
        Result of `drive`; of several simulations the last one is used.

    Returns
    -------
    xarray.Dataset
        As from `kintrafo.loads.along`: over ``time`` [s], forces [N] and moments [N m].

    Raises
    ------
    InputError
        If nothing was simulated, as in steady turns and parking, or the car has no linkages.
    PositionError
        If the motion reaches a dead point, where loads are unbounded.
    """
    with Validator("dynamic_loads") as given:
        given.instance("result", result, HandlingResult, _NEEDED)
    if not result.runs:
        problem = "steady turns and parking have no simulation, and so no loads over time."
        raise InputError([problem], "dynamic_loads")
    run = result.runs[-1]
    if run.car.assembly is None:
        raise InputError(["the car has no linkages: there are no joints."], "dynamic_loads")
    times = np.asarray(run.motion["time"].values)
    return over_time(partial(of_car, run.car.assembly), times, run.states, run.inputs)
