"""A rigid axle over a road, from rest."""

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ...core.arguments import Arguments
from ...simulation.result import Simulation
from ...simulation.signals import time_inputs
from ...simulation.simulate import simulate
from ...suspension.rigid.axle import SIDES
from ...suspension.rigid.model import RigidAxleModel, equilibrium
from ...suspension.wheel_loads import UNITS
from ..axles.ride import WHEELS, of_the_axle, with_sides_told
from ..recording import dataset_of
from ..scenario import Scenario

Array = NDArray[np.float64]


def run(
    model: RigidAxleModel, scenario: Scenario, *, wheels: str = "both", **options: Any
) -> tuple[Simulation, xr.Dataset]:
    """Simulate a rigid axle over a road, from rest.

    Parameters
    ----------
    model : RigidAxleModel
    scenario : Scenario
        Its ``road_height``, and loads on a wheel, are those of the wheels that are named; the
        others have a level road. Inputs of the axle may be given by their own names as well.
    wheels : {'both', 'left', 'right'}, optional
    **options : Any
        Of `kintrafo.simulate`: ``method``, ``rtol``, ``atol``, ...

    Returns
    -------
    Simulation
        With the times at which the left wheel left the ground in ``t_events[0]`` and came back in
        ``t_events[1]``; those of the right one behind them.
    xarray.Dataset
        Signals, states and inputs over time, see `kintrafo.study.recording.dataset_of`.

    Raises
    ------
    InputError, PositionError, SimulationError
        As `kintrafo.simulate` and `kintrafo.rigid_axles.equilibrium`.
    """
    start, inputs = started(model, scenario, wheels=wheels)
    events = [
        f"{side}_axle_wheel_{what}_ground" for side in SIDES for what in ("leaves", "touches")
    ]
    span, times = (0.0, scenario.duration), scenario.times()
    result = simulate(model, span, start, inputs=inputs, t_eval=times, events=events, **options)
    return result, with_sides_told(dataset_of(model, result))


def started(
    model: RigidAxleModel, scenario: Scenario, *, wheels: str = "both"
) -> tuple[Array, dict[str, Any]]:
    """Return the rest that a scenario starts from, and its inputs by the names of the axle's.

    Arguments and errors as of `run`.
    """
    with Arguments("simulation") as given:
        given.kind("model", model, RigidAxleModel, RigidAxleModel.NEEDED)
        given.kind("scenario", scenario, Scenario, "a Scenario is needed")
        given.among("wheels", wheels, WHEELS)
        if not given.refused:
            if scenario.height is not None:
                given.refuse("height: an axle starts from rest. Leave it out.")
            if "rack_position" in scenario.inputs:
                given.refuse("rack_position: a rigid axle has no rack. Leave it out.")
            loads = [name for name in scenario.inputs if name.endswith(tuple(UNITS))]
            if loads and not model.wheel_loads:
                given.refuse(
                    f"{', '.join(loads)}: this model has no loads on the wheels besides those of "
                    "the tyres. Make it with wheel_loads=True."
                )
    inputs = of_the_axle(scenario.inputs, WHEELS[wheels])
    courses = time_inputs(model, inputs, (0.0, scenario.duration))
    first = dict(zip(model.input_names, courses.at(0.0, courses.segments[0]), strict=True))
    start = equilibrium(
        model,
        road_height={side: float(first[f"{side}_road_height"]) for side in SIDES},
        spin_rate=scenario.spin_rate,
        inputs={
            name: float(value)
            for name, value in first.items()
            if name.endswith("_actuator") or (name in inputs and name.endswith(tuple(UNITS)))
        },
    )
    return start, inputs
