"""Loads on every part of an assembly along a simulation, by the equations of Newton and Euler."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, cast

import numpy as np
import xarray as xr

from ....core.memory import refuse_beyond
from ....core.named_types import Array
from ....core.quantities import variable
from ....core.threads import shared_out
from ....core.validator import Validator
from ....datasets.recording import TIME
from ....simulation.result import Simulation
from ....systems.system import System
from ...assembly.assembly import HeldAssembly
from ...assembly.load import Load
from ...assembly.of import given_assembly
from ...assembly.part_poses import CENTER, CONTACT, PartPoses, touching, wheel_axes
from ...corner.corner import RoadWheel
from .applied_loads import WHEEL, of_wheel
from .dataset import BalancedLoads
from .inertia import PartTwists
from .on_a_car import of_car

if TYPE_CHECKING:
    from ...assembly.car import CarAssembly


# Signals of the same car in the same states agree to this on every machine.
_SAME = 1e-6
# Outputs that are evaluated together, to limit the memory.
_TOGETHER = 5000
_DOES_NOT_DRIVE = (
    'loads along a motion are those of an axle, or of a car with car = "full". Give the axle, or '
    "the car with that."
)
_NEEDED = (
    "a kintrafo.Model, AxleModel, RigidAxleModel or CarModel is needed: the one that was simulated"
)


def along(model: System, result: Simulation) -> xr.Dataset:
    """Return the forces and moments on every part at each output of a simulation.

    Parameters
    ----------
    model : Model, AxleModel, RigidAxleModel, or CarModel of a car that drives
        The simulated model.
    result : Simulation
        Result of `kintrafo.simulate` with this model.

    Returns
    -------
    xarray.Dataset
        As in `static`, over ``time`` [s] instead of cases. Further loads ``by`` inertia are minus
        mass times acceleration and minus the rate of the angular momentum, so that the sum over
        each part is zero. An anti-roll bar and its drop links have no mass. ``holding_force`` [N]
        is the residual vertical force on each wheel: zero if the equations of motion and the
        balance of the parts agree. The accuracy of the motion depends on the tolerances of the
        simulation. The tyre force acts at the wheel centre, in the plane of the wheel, as in the
        equations. With ``wheel_loads`` the road also acts at the contact; ``by`` input are the
        forces at the centre and the moment on the wheel, ``by`` shaft is its torque. The torque of
        the hub is a part of the load of the bearing. Axes are those of the body. Those of a car
        that drives move with it; names contain ``front`` or ``rear``, and ``by`` road are all
        forces and moments of a tyre, where the plane of the wheel meets the road.

    Raises
    ------
    InputError
        If the result is not a motion of this model.
    PositionError
        If the motion reaches a dead point, where loads are unbounded.

    Examples
    --------
    >>> from kintrafo import Model, loads, simulate, state_at_height
    >>> model = Model("reference_car")
    >>> motion = simulate(model, (0.0, 0.1), state_at_height(model, 0.325))
    >>> found = loads.along(model, motion)
    >>> bool(abs(found["holding_force"]).max() < 1e-5)
    True
    """
    with Validator("along") as given:
        given.instance("model", model, System, _NEEDED)
        if not given.failed:
            assembly = given_assembly(given, model, "model", cars=True)
        if not given.failed and assembly.body_moves and not assembly.drives:
            given.fail(f"model: {_DOES_NOT_DRIVE}")
        given.instance("result", result, Simulation, "a result of kintrafo.simulate is needed")
        if not given.failed and not is_motion_of(model, result):
            given.fail(f"result: it is not a motion of this model, {model!r}.")
    find: Callable[[Array, Array], xr.Dataset]
    if assembly.drives:  # only a car does; the body of other assemblies is held
        find = partial(of_car, cast("CarAssembly", assembly))
    else:
        find = partial(in_motion, cast("HeldAssembly", assembly))
    return over_time(find, result.t, result.y.T, result.inputs)


def over_time(
    find: Callable[[Array, Array], xr.Dataset], times: Array, states: Array, inputs: Array
) -> xr.Dataset:
    """Return the loads along a motion at times, (n,) [s], computed in one thread per core.

    `find` returns the loads in some states with inputs.
    """
    size = times.size
    parts = [slice(begin, begin + _TOGETHER) for begin in range(0, size, _TOGETHER)]
    by_part: dict[int, xr.Dataset] = {}

    def take(some: tuple[int, xr.Dataset]) -> None:
        if not by_part:  # all are of this size, and are joined at the end
            with Validator("along") as given:
                needed, what = 2.0 * len(parts) * some[1].nbytes, f"the loads of {size:,} outputs"
                refuse_beyond(given, needed, what, "Simulate with fewer outputs, by t_eval.")
        by_part.update([some])

    shared_out(lambda rows, _: (rows.start, find(states[rows], inputs[rows])), parts, take)
    found = [by_part[rows.start] for rows in parts]
    data = {
        str(name): _one_after_another([each[name].variable for each in found]) for name in found[0]
    }
    coordinates = {**found[0].coords, TIME: variable(TIME, times, "time", "s")}
    return xr.Dataset(data, coordinates, {**found[0].attrs, "title": "loads along a motion"})


def _one_after_another(parts: Sequence[xr.Variable]) -> xr.Variable:
    """Return a variable joined over time, as `xarray.concat` without its checks of coordinates."""
    first = parts[0]
    if TIME not in first.dims:
        return first
    # the order in memory, with time as the last dimension
    order = [*(name for name in first.dims if name != TIME), TIME]
    values = np.concatenate([part.transpose(*order).values for part in parts], axis=-1)
    return xr.Variable(order, values, first.attrs).transpose(*first.dims)


def is_motion_of(model: System, result: Simulation) -> bool:
    """Return whether the signals of a result are those of the model in the same states."""
    if tuple(result.signals) != model.signal_names:
        return False
    again = model.signals(result.y.T, result.inputs)
    return all(
        np.allclose(values, again[name], rtol=_SAME, atol=_SAME, equal_nan=True)
        for name, values in result.signals.items()
    )


def in_motion(assembly: HeldAssembly, states: Array, inputs: Array) -> xr.Dataset:
    """Return the loads in states of shape (n, states), over time."""
    poses, rates = assembly.in_motion(states, inputs)
    acting = assembly.acting(poses)
    known = {
        suffix: [*acting[suffix], *_on_wheels(group), *_inertia(group, rates[suffix])]
        for suffix, group in poses.items()
    }
    return BalancedLoads.of(assembly, poses, known).dataset()


def _on_wheels(group: PartPoses) -> list[Load]:
    """Return the forces of the tyres, through the wheel centres, and those of inputs."""
    tyres, inputs, still = group.tyre_forces(), group.inputs_of_wheels(), np.zeros(3)
    roads, given = [], []
    for part, wheel in group.wheels.items():
        roads += of_wheel(part, [Load(WHEEL, CENTER, "road", tyres[part], still, wheel.center)])
        if part in inputs:
            given += of_wheel(part, _of_inputs(inputs[part], wheel))
    return [*roads, *given]


def _of_inputs(given: Mapping[str, Array], wheel: RoadWheel) -> list[Load]:
    """Return the loads of inputs on a wheel, each (n,); see `vehicle.corner.wheel_loads`."""
    axes, nothing = wheel_axes(wheel), np.zeros(3)
    contact, center, moment = (
        np.einsum("an,nai->ni", [given[f"{name}_{axis}"] for axis in "xyz"], axes)
        for name in ("contact_force", "center_force", "wheel_moment")
    )
    shaft = given["shaft_torque"][:, None] * (wheel.vehicle.side * wheel.axis)
    return [
        Load(WHEEL, CONTACT, "road", contact, nothing, touching(wheel)),
        Load(WHEEL, CENTER, "input", center, moment, wheel.center),
        Load(WHEEL, CENTER, "shaft", nothing, shaft, wheel.center),
    ]


def _inertia(group: PartPoses, by_time: Array) -> list[Load]:
    """Return the inertia of each part, as loads."""
    rates = group.rates_of_inputs()
    twists = PartTwists.of(group.model, group.states, group.inputs, by_time, rates)
    return [
        twists.load(part, mass, group.turned[part], group.centers[part])
        for part, mass in group.masses().items()
    ]
