"""The loads on every part of a suspension that moves: Newton and Euler along a simulation."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ...assembly.coupling import Between, alone, rules_of
from ...assembly.load import RACK, Load, known
from ...assembly.poses import (
    CENTER,
    CONTACT,
    Poses,
    touching,
    wheel_axes,
)
from ...core.arguments import Arguments
from ...core.memory import refuse_beyond
from ...core.quantities import variable
from ...core.threads import shared_out
from ...simulation.result import Simulation
from ...suspension.corner import RoadWheel
from ...suspension.model import Model
from ...systems.inputs import rates_of
from ...systems.system import System
from ..recording import TIME
from .dataset import dataset_of, joined
from .inertia import Twists, tensor_of_part, tensor_of_wheel
from .reactions import Equations

Array = NDArray[np.float64]

# Signals of the same car in the same states agree to that, whatever computed them.
_SAME = 1e-6
# So many moments are looked at together, for the memory of it.
_TOGETHER = 5000


def along(model: Model, result: Simulation) -> xr.Dataset:
    """Return the loads on every part at each output of a simulation.

    Parameters
    ----------
    model : Model
        The one that was simulated.
    result : Simulation

    Returns
    -------
    xarray.Dataset
        As of `static`, over ``time`` [s] instead of cases. Besides what acts, ``by`` inertia names
        minus mass times acceleration and minus the rate of the moment of momentum, so that the sum
        over each part is zero. ``holding_force`` [N] is a vertical force on the wheel that the
        motion would need besides: none where the equations of motion and the balance of the parts
        agree. How exact the motion is, the tolerances of the simulation decide. The tyre pushes
        at the wheel centre, in the plane of the wheel, as in the equations. With ``wheel_loads``
        the road does at the contact as well; ``by`` input are the forces at the centre and the
        moment on the wheel, ``by`` shaft is its torque. That of the hub is a part of what the
        bearing carries.

    Raises
    ------
    InputError
        If the result is not a motion of this model.

    Examples
    --------
    >>> from kintrafo import simulate, state_at_height
    >>> model = Model("reference_car")
    >>> motion = simulate(model, (0.0, 0.1), state_at_height(model, 0.325))
    >>> found = along(model, motion)
    >>> bool(abs(found["holding_force"]).max() < 1e-5)
    True
    """
    with Arguments("along") as given:
        given.kind("model", model, Model, Model.NEEDED)
        given.kind("result", result, Simulation, "what kintrafo.simulate returns is needed")
        if not given.refused and not is_motion_of(model, result):
            given.refuse(f"result: it is not a motion of this model, {model!r}.")
    found = over_time(partial(in_motion, model), result)
    return found.assign_attrs(rules=rules_of(model.suspension))


def over_time(find: Callable[[Array, Array], xr.Dataset], result: Simulation) -> xr.Dataset:
    """Return the loads of a motion, from what finds those in some states with their inputs.

    Parts of the motion are looked at in as many threads as there are cores: most of it is
    arithmetic over arrays, which does not keep other threads waiting.
    """
    size = result.t.size
    parts = [slice(begin, begin + _TOGETHER) for begin in range(0, size, _TOGETHER)]
    by_part: dict[int, xr.Dataset] = {}

    def take(some: tuple[int, xr.Dataset]) -> None:
        if not by_part:  # they are as large as each other, and put together at the end
            _refuse_beyond(2.0 * len(parts) * some[1].nbytes, size)
        by_part.update([some])

    shared_out(
        lambda rows, _: (rows.start, find(result.y.T[rows], result.inputs[rows])), parts, take
    )
    found = [by_part[rows.start] for rows in parts]
    data = {
        str(name): _one_after_another([each[name].variable for each in found]) for name in found[0]
    }
    coordinates = {**found[0].coords, TIME: variable(TIME, result.t, "time", "s")}
    return xr.Dataset(data, coordinates, {**found[0].attrs, "title": "loads along a motion"})


def _refuse_beyond(needed: float, outputs: int) -> None:
    with Arguments("along") as given:
        what = f"the loads of {outputs:,} outputs"
        refuse_beyond(given, needed, what, "Simulate with fewer outputs, by t_eval.")


def _one_after_another(parts: Sequence[xr.Variable]) -> xr.Variable:
    """Return what was found in parts of a motion as of all of it.

    The same as `xarray.concat`, which compares all coordinates first.
    """
    first = parts[0]
    if TIME not in first.dims:
        return first
    # as they lie in memory, outputs behind each other
    order = [*(name for name in first.dims if name != TIME), TIME]
    values = np.concatenate([part.transpose(*order).values for part in parts], axis=-1)
    return xr.Variable(order, values, first.attrs).transpose(*first.dims)


def is_motion_of(model: System, result: Simulation) -> bool:
    """Tell whether a result has the signals that the model has in its states."""
    if tuple(result.signals) != model.signal_names:
        return False
    again = model.signals(result.y.T, result.inputs)
    return all(
        np.allclose(values, again[name], rtol=_SAME, atol=_SAME, equal_nan=True)
        for name, values in result.signals.items()
    )


def in_motion(model: Model, states: Array, inputs: Array) -> xr.Dataset:
    """Return the loads in some states, of shape (n, states), as over time."""
    poses = Poses.of(model, states, inputs)
    return moving_loads({"": poses}, {"": model.evaluate("rhs", states, inputs)}, {"": []})


def moving_loads(
    poses: Mapping[str, Poses],
    rates: Mapping[str, Array],
    pulled: Mapping[str, list[Load]],
    between: Between = alone,
) -> xr.Dataset:
    """Return the loads in a motion, of one suspension or of both of an axle.

    Parameters
    ----------
    poses : mapping of str to Poses
        By what goes behind their names: nothing for one suspension.
    rates : mapping of str to ndarray
        Rates of the states.
    pulled : mapping of str to list of Load
        What pulls at its parts besides.
    between : callable, optional
        See `joined`.
    """
    loads, holding = {}, {}
    for suffix, own in poses.items():
        equations = Equations(own)
        acting = [*known(own), *pulled[suffix], _road(own), *_on_the_wheel(own)]
        acting += _inertia(own, equations.parts, rates[suffix])
        unknowns = equations.solve(equations.applied(acting))
        loads[suffix] = [*equations.carried(unknowns), *acting]
        holding[f"holding_force{suffix}"] = unknowns[:, -1]
    meaning = "vertical force at the wheel that the motion would need besides"
    told = {name: variable(TIME, values, meaning, "N") for name, values in holding.items()}
    return dataset_of(TIME, *joined(poses, loads, between)).assign(told)


def _road(poses: Poses) -> Load:
    """Return the force of the tyre, which acts in the plane of the wheel through its centre."""
    return Load("wheel", CENTER, "road", poses.push_of_tyre(), np.zeros(3), poses.points[CENTER])


def _on_the_wheel(poses: Poses) -> list[Load]:
    """Return what the inputs of a model with loads on its wheel say."""
    model = poses.model
    if not model.wheel_loads:
        return []
    given = dict(zip(model.input_names, poses.inputs.T, strict=True))
    return of_inputs(given, poses.wheels["wheel"])


def of_inputs(given: Mapping[str, Array], wheel: RoadWheel) -> list[Load]:
    """Return what inputs exert on a wheel.

    Parameters
    ----------
    given : mapping of str to ndarray
        The inputs of `kintrafo.suspension.wheel_loads` by their names, (n,).
    wheel : RoadWheel
    """
    axes, nothing = wheel_axes(wheel), np.zeros(3)
    contact, center, moment = (
        np.einsum("an,nai->ni", [given[f"{name}_{axis}"] for axis in "xyz"], axes)
        for name in ("contact_force", "center_force", "wheel_moment")
    )
    shaft = given["shaft_torque"][:, None] * (wheel.vehicle.side * wheel.axis)
    return [
        Load("wheel", CONTACT, "road", contact, nothing, touching(wheel)),
        Load("wheel", CENTER, "input", center, moment, wheel.center),
        Load("wheel", CENTER, "shaft", nothing, shaft, wheel.center),
    ]


def _inertia(poses: Poses, parts: tuple[str, ...], by_time: Array) -> list[Load]:
    """Return what the acceleration of each part takes, as loads."""
    model, values = poses.model, poses.model.parameters
    rates_of_inputs = _rates_of_inputs(model, poses.inputs)
    twists = Twists.of(model, poses.states, poses.inputs, by_time, rates_of_inputs)
    axis = model.suspension.wheel.spin_axis(model.suspension.vehicle.sign)
    loads = []
    for part in (part for part in (*parts, RACK) if values.get(f"{part}_mass", 0.0) != 0.0):
        wheel = part == "wheel"
        tensor = tensor_of_wheel(values, part, axis) if wheel else tensor_of_part(values, part)
        mass, turned, center = values[f"{part}_mass"], poses.turned[part], poses.centers[part]
        loads.append(twists.load(part, part, mass, tensor, turned, center))
    return loads


def _rates_of_inputs(model: Model, inputs: Array) -> Array:
    """Return the rates of the inputs that parts move by: those of a rack that is held."""
    by_time = np.zeros_like(inputs)
    if model.suspension.steered() and not model.free_rack:
        names = ("rack_position", *rates_of("rack_position", model.equations.INPUTS))
        position, velocity, acceleration = (model.input_names.index(name) for name in names)
        by_time[:, position] = inputs[:, velocity]
        by_time[:, velocity] = inputs[:, acceleration]
    return by_time
