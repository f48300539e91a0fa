"""The loads on every part of an axle that moves."""

from functools import partial

import numpy as np
import xarray as xr

from ...assembly.axle_coupling import (
    SIDES,
    Between,
    pull_of_bar,
    torque_of_bar,
)
from ...assembly.poses import Poses
from ...core.arguments import Arguments
from ...simulation.result import Simulation
from ...suspension.axle.equations import AxleModel
from ...suspension.corner import Array
from ..loads.along import is_motion_of, moving_loads, over_time
from ..recording import TIME
from .loads import with_shared


def loads_along(model: AxleModel, result: Simulation) -> xr.Dataset:
    """Return the loads on every part of an axle at each output of a simulation.

    Parameters
    ----------
    model : AxleModel
        The one that was simulated.
    result : Simulation

    Returns
    -------
    xarray.Dataset
        As of `static_loads`, over ``time`` [s] instead of cases, and with the inertia of the parts
        as of `kintrafo.loads.along`. The bar and its drop links have no mass.

    Raises
    ------
    InputError
        If the result is not a motion of this model.
    """
    with Arguments("loads_along") as given:
        given.kind("model", model, AxleModel, "a kintrafo.AxleModel is needed")
        given.kind("result", result, Simulation, "what kintrafo.simulate returns is needed")
        if not given.refused and not is_motion_of(model, result):
            given.refuse(f"result: it is not a motion of this model, {model!r}.")
    return over_time(partial(_in_motion, model), result)


def _in_motion(model: AxleModel, states: Array, inputs: Array) -> xr.Dataset:
    """Return the loads in some states, of shape (n, states), as over time."""
    axle, by_time = model.axle, model.evaluate("rhs", states, inputs)
    poses, rates = {}, {}
    for side, corner in model.corners.items():
        columns = [model.state_names.index(f"{side}_{name}") for name in corner.state_names]
        own = [f"{side}_{name}" for name in corner.input_names]
        given = [
            model.input_names.index(name if name in model.input_names else shared)
            for name, shared in zip(own, corner.input_names, strict=True)
        ]
        poses[f"_{side}"] = Poses.of(corner, states[:, columns], inputs[:, given])
        rates[f"_{side}"] = by_time[:, columns]
    torques = torque_of_bar(axle, poses) if axle.halves else np.zeros(len(states))
    pulled = {
        f"_{side}": [pull_of_bar(axle, side, poses[f"_{side}"], torques)] if axle.halves else []
        for side in SIDES
    }
    found = moving_loads(poses, rates, pulled, Between(axle))
    return with_shared(axle, found, TIME, torques)
