"""The loads on every part of a suspension that moves: Newton and Euler along a simulation."""

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ...core.arguments import Arguments
from ...core.quantities import variable
from ...core.vectors import cross
from ...simulation.result import Simulation
from ...suspension.model import Model
from ...systems.inputs import rates_of
from ...systems.system import System
from ..recording import TIME
from .dataset import Between, alone, dataset_of, joined
from .poses import CENTER, CONTACT, Poses
from .reactions import Equations, Load, known

Array = NDArray[np.float64]

# Accelerations of parts are the derivative of their velocities along the motion, by a difference of
# fourth order over a step in which no state changes by more than this [rad, m, rad/s, m/s]: its
# error is of the fourth power of that, and rounding 1e-16 over it.
_STEP = 1e-3
_WEIGHTS = {-2: 1 / 12, -1: -8 / 12, 1: 8 / 12, 2: -1 / 12}
# Signals of the same car in the same states agree to that, whatever computed them.
_SAME = 1e-6
# So many moments are looked at together, for the memory of it.
_TOGETHER = 2000


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
    return found.assign_attrs(rules="; ".join(model.suspension.structure().rules))


def over_time(find: Callable[[Array, Array], xr.Dataset], result: Simulation) -> xr.Dataset:
    """Return the loads of a motion, from what finds those in some states with their inputs."""
    size = result.t.size
    found = [
        find(result.y.T[rows], result.inputs[rows])
        for begin in range(0, size, _TOGETHER)
        for rows in [slice(begin, min(begin + _TOGETHER, size))]
    ]
    time = variable(TIME, result.t, "time", "s")
    dataset = xr.concat(found, TIME, data_vars="minimal").assign_coords({TIME: time})
    return dataset.assign_attrs(title="loads along a motion")


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
    axes, nothing = poses.wheel_axes(), np.zeros(3)
    contact, center, moment = (
        np.einsum("an,nai->ni", [given[f"{name}_{axis}"] for axis in "xyz"], axes)
        for name in ("contact_force", "center_force", "wheel_moment")
    )
    left = model.suspension.vehicle.sign * poses.axis
    shaft = given["shaft_torque"][:, None] * left
    return [
        Load("wheel", CONTACT, "road", contact, nothing, poses.points[CONTACT]),
        Load("wheel", CENTER, "input", center, moment, poses.points[CENTER]),
        Load("wheel", CENTER, "shaft", nothing, shaft, poses.points[CENTER]),
    ]


def _inertia(poses: Poses, parts: tuple[str, ...], by_time: Array) -> list[Load]:
    """Return what the acceleration of each part takes, as loads."""
    model = poses.model
    twists = model.evaluate("velocities", poses.states, poses.inputs)
    rates = _rates_of_twists(model, poses.states, poses.inputs, by_time)
    loads = []
    for part in parts:
        mass = model.parameters[f"{part}_mass"]
        if mass == 0.0:
            continue
        which = model.equations.BODIES.index(part)
        turning, rate = twists[:, which, :3], rates[:, which]
        inertia = poses.turned[part] @ _inertia_at_design(poses, part) @ poses.turned[part].mT
        momentum = np.einsum("nij,nj->ni", inertia, turning)
        moment = np.einsum("nij,nj->ni", inertia, rate[:, :3]) + cross(turning, momentum)
        loads.append(
            Load(part, "mass", "inertia", -mass * rate[:, 3:], -moment, poses.centers[part])
        )
    return loads


def _inertia_at_design(poses: Poses, part: str) -> Array:
    """Return the inertia tensor of a part about its centre of mass at design, (3, 3) [kg m^2]."""
    values = poses.model.parameters
    if part == "wheel":
        axis = poses.model.suspension.wheel.spin_axis(poses.model.suspension.vehicle.sign)
        spin, across = values["wheel_inertia_spin"], values["wheel_inertia_diametral"]
        symmetric: Array = across * np.eye(3) + (spin - across) * np.outer(axis, axis)
        return symmetric
    xx, yy, zz, xy, xz, yz = (
        values[f"{part}_inertia_{name}"] for name in ("xx", "yy", "zz", "xy", "xz", "yz")
    )
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _rates_of_twists(model: Model, states: Array, inputs: Array, by_time: Array) -> Array:
    """Return the rates of the parts' angular and linear velocities along the motion."""
    inputs_by_time = np.zeros_like(inputs)
    if model.suspension.steered() and not model.free_rack:
        names = ("rack_position", *rates_of("rack_position", model.equations.INPUTS))
        position, velocity, acceleration = (model.input_names.index(name) for name in names)
        inputs_by_time[:, position] = inputs[:, velocity]
        inputs_by_time[:, velocity] = inputs[:, acceleration]
    fastest = np.maximum(
        np.abs(by_time).max(axis=1), np.abs(inputs_by_time).max(axis=1, initial=0.0)
    )
    step = _STEP / np.maximum(fastest, 1.0)[:, None]
    total = np.zeros((*states.shape[:1], len(model.equations.BODIES), 6))
    for by, weight in _WEIGHTS.items():
        moved = (states + by * step * by_time, inputs + by * step * inputs_by_time)
        total += weight * model.evaluate("velocities", *moved)
    rates: Array = total / step[:, :, None]
    return rates
