"""A simulation as a dataset over time, and its statistics."""

from dataclasses import dataclass

import numpy as np
import xarray as xr
from scipy.integrate import trapezoid

from ..core.named_types import Array
from ..core.quantities import variable
from ..core.validator import Validator
from ..simulation.result import Simulation
from ..systems.system import System

TIME = "time"


def dataset_of(model: System, result: Simulation) -> xr.Dataset:
    """Return signals, states and inputs of a simulation of a model, with their descriptions.

    They are over ``time`` [s], in SI units, with the names of the model's tables.

    Examples
    --------
    >>> from kintrafo import Model, simulate, state_at_height
    >>> model = Model("reference_car")
    >>> result = simulate(model, (0.0, 0.1), state_at_height(model, 0.325))
    >>> dataset_of(model, result)["camber"].attrs["units"]
    'rad'
    """
    with Validator("dataset_of") as given:
        given.instance("model", model, System, System.NEEDED)
        given.instance("result", result, Simulation, "a result of kintrafo.simulate is needed")
        if not given.failed and tuple(result.signals) != model.signal_names:
            given.fail(f"result: it is not a motion of this model, {model!r}.")
    equations = model.equations
    tables = (
        (equations.SIGNALS, [result.signals[name] for name in model.signal_names]),
        (equations.STATE, list(result.y)),
        (equations.INPUTS, list(result.inputs.T)),
    )
    data = {
        name: variable(TIME, values, entry["meaning"], entry["unit"])
        for described, columns in tables
        for (name, entry), values in zip(described.items(), columns, strict=True)
    }
    time = variable(TIME, result.t, "time", "s")
    attrs = {"title": "simulated motion", "solver": result.solver, "message": result.message}
    return xr.Dataset(data, {TIME: time}, attrs)


@dataclass(frozen=True)
class Statistics:
    """Statistics of a signal over a simulation, in its SI unit."""

    smallest: float
    largest: float
    # over time, by the trapezoidal rule; rms is about the mean
    mean: float
    rms: float
    last: float


def statistics(dataset: xr.Dataset) -> dict[str, Statistics]:
    """Return the statistics of every variable of a dataset over ``time`` [s], by name.

    Examples
    --------
    >>> ramp = xr.Dataset({"x": ("time", [0.0, 1.0, 2.0])}, {"time": [0.0, 1.0, 2.0]})
    >>> found = statistics(ramp)["x"]
    >>> found.mean, round(found.rms**2, 12)
    (1.0, 0.5)
    """
    with Validator("statistics") as given:
        given.dataset(dataset, over=TIME)
    times = np.asarray(dataset[TIME].values, dtype=np.float64)
    return {str(name): _of(times, np.asarray(data.values)) for name, data in dataset.items()}


def _of(times: Array, values: Array) -> Statistics:
    span = times[-1] - times[0]

    def average(samples: Array) -> float:
        return float(trapezoid(samples, times) / span) if span else float(samples[-1])

    mean = average(values)
    rms = float(np.sqrt(average((values - mean) ** 2)))
    smallest, largest = float(values.min()), float(values.max())
    return Statistics(smallest, largest, mean, rms, float(values[-1]))
