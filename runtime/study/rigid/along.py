"""The loads on every part of a rigid axle that moves: Newton and Euler along a simulation."""

from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ...assembly.beam import SENSE, SIDES
from ...assembly.load import Load
from ...assembly.parts import MASSIVE, PARAMETERS, Parts
from ...assembly.poses import CENTER
from ...core.arguments import Arguments
from ...simulation.result import Simulation
from ...suspension.rigid.model import RigidAxleModel
from ...suspension.rigid.structure import BEAM
from ...suspension.wheel_loads import UNITS
from ..loads.along import is_motion_of, of_inputs, over_time
from ..loads.dataset import of_side
from ..loads.inertia import Twists, tensor_of_part, tensor_of_wheel
from ..recording import TIME
from .balance import Balance
from .loads import dataset_of_parts

Array = NDArray[np.float64]


def loads_along(model: RigidAxleModel, result: Simulation) -> xr.Dataset:
    """Return the loads on every part of a rigid axle at each output of a simulation.

    Parameters
    ----------
    model : RigidAxleModel
        The one that was simulated.
    result : Simulation

    Returns
    -------
    xarray.Dataset
        As of `static_loads`, over ``time`` [s] instead of cases, and with the inertia of axle and
        wheels as of `kintrafo.loads.along`. The tyres push at the wheel centres, in the planes of
        the wheels, as in the equations. ``holding_force_left`` and ``_right`` [N] are vertical
        forces on the wheels that the motion would need besides: none where the equations of motion
        and the balance of the parts agree.

    Raises
    ------
    InputError
        If the result is not a motion of this model.

    Examples
    --------
    >>> from kintrafo.study.scenario import Scenario, run
    >>> model = RigidAxleModel("rigid_axle")
    >>> motion, _ = run(model, Scenario(duration=0.05))
    >>> found = loads_along(model, motion)
    >>> bool(abs(found["holding_force_left"]).max() < 1e-5)
    True
    """
    with Arguments("loads_along") as given:
        given.kind("model", model, RigidAxleModel, RigidAxleModel.NEEDED)
        given.kind("result", result, Simulation, "what kintrafo.simulate returns is needed")
        if not given.refused and not is_motion_of(model, result):
            given.refuse(f"result: it is not a motion of this model, {model!r}.")
    return over_time(partial(_in_motion, model), result)


def _in_motion(model: RigidAxleModel, states: Array, inputs: Array) -> xr.Dataset:
    """Return the loads in some states, of shape (n, states), as over time."""
    parts = Parts.of(model, states, inputs)
    acting = [*parts.acting(), *_road(parts), *_on_the_wheels(parts), *_inertia(parts)]
    balance = Balance(parts, acting)
    balance.refuse_dead_points()
    return dataset_of_parts(TIME, balance, [*balance.carried(), *acting], balance.missing)


def _road(parts: Parts) -> list[Load]:
    """Return the forces of the tyres, in the planes of the wheels through their centres."""
    return [
        Load(
            f"wheel_{side}",
            f"{CENTER}_{side}",
            f"road_{side}",
            parts.push_of_tyre(side),
            np.zeros(3),
            parts.points[f"{CENTER}_{side}"],
        )
        for side in SIDES
    ]


def _on_the_wheels(parts: Parts) -> list[Load]:
    """Return what the inputs of a model with loads on its wheels say."""
    model, found = parts.model, []
    if not model.wheel_loads:
        return []
    given = dict(zip(model.input_names, parts.inputs.T, strict=True))
    for side in SIDES:
        own = {name: given[f"{side}_{name}"] for name in UNITS}
        found += [
            of_side(load, f"_{side}") for load in of_inputs(own, parts.wheels[f"wheel_{side}"])
        ]
    return found


def _inertia(parts: Parts) -> list[Load]:
    """Return what the acceleration of each part takes, as loads."""
    model, states, inputs = parts.model, parts.states, parts.inputs
    # nothing but the states moves the parts
    by_time = model.evaluate("rhs", states, inputs)
    twists = Twists.of(model, states, inputs, by_time, np.zeros_like(inputs))
    tensors = {BEAM: tensor_of_part(model.parameters, PARAMETERS[BEAM])}
    for side in SIDES:
        wheel, axis = f"wheel_{side}", parts.axle.wheel.spin_axis(SENSE[side])
        tensors[wheel] = tensor_of_wheel(model.parameters, PARAMETERS[wheel], axis)
    return [
        twists.load(
            MASSIVE[part], part, parts.mass(part), tensor, parts.turned[part], parts.centers[part]
        )
        for part, tensor in tensors.items()
    ]
