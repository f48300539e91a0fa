"""An axle at rest and over a road: its own equations, in which the bar couples the wheels."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.optimize import root

from ...core.arguments import Arguments
from ...core.errors import InputError
from ...core.named_types import ArrayLike
from ...simulation.courses import Signal
from ...simulation.result import Simulation
from ...simulation.signals import time_inputs
from ...simulation.simulate import simulate
from ...suspension.axle.axle import LEFT, RIGHT
from ...suspension.axle.equations import AxleModel
from ...suspension.positions import PositionError
from ...suspension.positions import equilibrium as of_one_side
from ...suspension.reach import refuse_beyond
from ...suspension.wheel_loads import UNITS
from ...systems.state import State
from ..recording import dataset_of
from ..scenario import Scenario
from .datasets import by_ends

Array = NDArray[np.float64]

WHEELS = {"both": (LEFT, RIGHT), LEFT: (LEFT,), RIGHT: (RIGHT,)}
"""Under which wheels a road is, by name."""

_NEEDED = "a kintrafo.AxleModel is needed"
# What is left of the forces at rest, over those of the bar that is bent by a degree or of gravity.
_AT_REST = 1e-9


def equilibrium(
    model: AxleModel,
    *,
    rack_position: float = 0.0,
    road_height: Mapping[str, float] | None = None,
    spin_rate: float = 0.0,
    inputs: Mapping[str, float] | None = None,
) -> State:
    """Return the state of an axle at rest, the body held.

    Parameters
    ----------
    model : AxleModel
    rack_position : float, optional
        Displacement of the rack [m].
    road_height : mapping of str to float, optional
        Height of the road under the wheels 'left' and 'right' [m], zero where it is not given.
    spin_rate : float, optional
        Rate of both wheels relative to their carriers, positive rolling forward [rad/s].
    inputs : mapping of str to float, optional
        Further inputs of the model by name, in SI units, such as ``left_contact_force_x``. Of a
        wheel without ``hub_torque``, the state carries that which holds it.

    Returns
    -------
    State
        Nearest to where each side would rest without the bar.

    Raises
    ------
    PositionError
        If there is no stable one.

    Examples
    --------
    >>> from kintrafo import Axle, AxleModel
    >>> model = AxleModel(Axle.load("reference_axle"))
    >>> rest = equilibrium(model)
    >>> round(float(model.signal("left_front_wheel_center_z", rest)), 6)
    0.3
    """
    with Arguments("equilibrium") as given:
        given.kind("model", model, AxleModel, _NEEDED)
        rack = given.number("rack_position", rack_position, "m")
        spin = given.number("spin_rate", spin_rate, "rad/s")
        roads = dict(given.mapping("road_height", road_height or {}, "sides and heights"))
        for side, height in roads.items():
            given.among("side", side, (LEFT, RIGHT))
            roads[side] = given.number(f"road_height of the {side} wheel", height, "m")
        further = given.mapping("inputs", inputs or {}, "input names and values")
    corners = model.axle.models
    rest = {
        side: of_one_side(corner, rack_position=rack, road_height=roads.get(side, 0.0))
        for side, corner in corners.items()
    }
    road_heights = {f"{side}_road_height": height for side, height in roads.items()}
    of_rack = {"rack_position": rack} if model.axle.steered() else {}
    held = model.inputs({**further, **of_rack, **road_heights})
    arm = corners[RIGHT].names.arm
    arms = [model.state_names.index(f"{side}_{arm}") for side in corners]

    def at(angles: ArrayLike) -> Array:
        state = model.design_state.copy()
        state[arms] = angles
        return state

    def moments(angles: ArrayLike) -> Array:
        return np.asarray(model.evaluate("forces", at(angles), held)[arms])

    start = np.array([float(rest[s][corners[s].state_names.index(arm)]) for s in corners])
    found = root(moments, start, options={"xtol": 1e-14})
    stiffness = _slopes(moments, found.x)
    # nothing is nearer to zero than the stiffness times the rounding of an angle
    small = _AT_REST * max(float(np.abs(stiffness).max()), 1.0)
    stable = bool(np.all(np.linalg.eigvals(stiffness).real < 0.0))
    if not np.abs(moments(found.x)).max() <= small or not stable:
        message = (
            "the axle has no stable equilibrium near that of its sides. Check the anti-roll bar's "
            "free_twist_deg and rate, or the heights of the road."
        )
        raise PositionError(message)
    state = at(found.x)
    refuse_beyond(model, state, held)
    for side, corner in corners.items():
        if model.wheel_loads and f"{side}_hub_torque" not in further:
            place = model.state_names.index(f"{side}_{corner.names.spin}")
            brake = -model.evaluate("forces", state, held)[place]
            held[model.input_names.index(f"{side}_hub_torque")] = brake
        state[model.state_names.index(f"{side}_{corner.names.spin}_rate")] = spin
    return State.of(state, held, model.names_of_states)


def _slopes(moments: Any, at: Array, step: float = 1e-6) -> Array:
    """Return the derivatives of the moments by the arms' angles."""
    columns = [moments(at + d) - moments(at - d) for d in step * np.eye(at.size)]
    return np.stack(columns, -1) / (2.0 * step)


def run(
    model: AxleModel, scenario: Scenario, *, wheels: str = "both", **options: Any
) -> tuple[Simulation, xr.Dataset]:
    """Simulate an axle over a road, from rest.

    Parameters
    ----------
    model : AxleModel
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
        As `kintrafo.simulate` and `equilibrium`.
    """
    with Arguments("simulation") as given:
        given.kind("model", model, AxleModel, _NEEDED)
        given.kind("scenario", scenario, Scenario, "a Scenario is needed")
        given.among("wheels", wheels, WHEELS)
        if not given.refused and scenario.height is not None:
            given.refuse("height: an axle starts from rest. Leave it out.")
    inputs = of_the_axle(scenario.inputs, WHEELS[wheels])
    times = scenario.times()
    span = (0.0, scenario.duration)
    courses = time_inputs(model, inputs, span)
    first = dict(zip(model.input_names, courses.at(0.0, courses.segments[0]), strict=True))
    start = equilibrium(
        model,
        rack_position=float(first.get("rack_position", 0.0)),
        road_height={side: float(first[f"{side}_road_height"]) for side in (LEFT, RIGHT)},
        spin_rate=scenario.spin_rate,
        inputs={name: float(first[name]) for name in inputs if name.endswith(tuple(UNITS))},
    )
    events = [
        f"{side}_{model.axle.end}_wheel_{what}_ground"
        for side in (LEFT, RIGHT)
        for what in ("leaves", "touches")
    ]
    result = simulate(model, span, start, inputs=inputs, t_eval=times, events=events, **options)
    return result, with_sides_told(dataset_of(model, result))


def of_the_axle(given: Mapping[str, Signal], sides: tuple[str, ...]) -> dict[str, Signal]:
    """Return inputs by the names of the axle: what is given for one wheel, for each of these."""
    inputs = dict(given)
    for name in ("road_height", *UNITS):
        if name not in inputs:
            continue
        named = [f"{side}_{name}" for side in sides]
        twice = [other for other in named if other in inputs]
        if twice:
            problem = f"{name} and {', '.join(twice)} are given. Give one of them for a wheel."
            raise InputError([problem], "simulation")
        inputs |= dict.fromkeys(named, inputs.pop(name))
    return inputs


def by_side(motion: xr.Dataset) -> xr.Dataset:
    """Return a motion in which the two sides are a dimension, as it is drawn."""
    return by_ends(motion, "{side}_{stem}")


def with_sides_told(motion: xr.Dataset) -> xr.Dataset:
    """Say in words, too, which side a signal is of."""
    if "bar_spring_moment" in motion:
        motion["bar_spring_moment"].attrs["long_name"] = "moment of the anti-roll bar"
    for name, data in motion.items():
        side = str(name).partition("_")[0]
        if side in (LEFT, RIGHT):
            data.attrs["long_name"] = f"{data.attrs['long_name']}, {side}"
    return motion
