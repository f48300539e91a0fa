"""A simulation over a road: its start, its inputs and its duration."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.errors import InputError
from ...core.named_types import Array
from ...core.validator import Validator
from ...datasets.recording import dataset_of
from ...simulation.input_profiles import Signal
from ...simulation.result import Simulation
from ...simulation.signals import time_inputs
from ...simulation.simulate import simulate
from ...systems.state import State
from ..assembly.assembly import Assembly
from ..assembly.by_wheel import together, wheel_that_begins
from ..assembly.equilibrium import each_wheel, equilibrium, refuse_missing_loads, state_at_heights
from ..assembly.of import AnyModel, assembly_of, given_model
from ..corner.wheel_loads import UNITS

if TYPE_CHECKING:
    import xarray as xr


BOTH = "both"
"""The inputs are those of all wheels."""

_RACK = "rack_position"

# More rows of output would fill the memory: the output step is probably wrong.
_MOST_OUTPUTS = 5_000_000


@dataclass(frozen=True)
class Scenario:
    """The inputs, start and duration of a simulation of a suspension or an axle.

    Attributes
    ----------
    duration : float
        Duration of the simulation [s].
    output_step : float
        Time between two outputs [s].
    height : float or mapping of str to float, optional
        Height of all wheel centres at the start, z in chassis axes [m], or by wheel, 'left' and
        'right', where a wheel that is left out has that of design. By default the motion starts in
        the equilibrium on the road at time 0.
    spin_rate : float
        Rate of the wheels relative to their carriers, positive rolling forward [rad/s].
    inputs : dict
        Inputs by name, as `kintrafo.simulate` takes them; see `kintrafo.roads`.
    """

    duration: float = 1.0
    output_step: float = 0.001
    height: float | Mapping[str, float] | None = None
    spin_rate: float = 0.0
    inputs: dict[str, Signal] = field(default_factory=dict)

    def checked(self, given: Validator) -> tuple[float, float]:
        """Return duration and output step [s], or add an error to the validator."""
        duration = given.number("duration", self.duration, "s", above=0.0)
        step = given.number("output step", self.output_step, "s", above=0.0)
        if not given.failed and duration / step > _MOST_OUTPUTS:
            given.fail(
                f"an output every {step:g} s for {duration:g} s makes more than "
                f"{_MOST_OUTPUTS} rows. Choose a larger output step."
            )
        return duration, step

    def times(self) -> Array:
        """Return the times of the output, with the first and the last one [s]."""
        with Validator("simulation") as given:
            duration, step = self.checked(given)
        count = int(np.floor(duration / step + 1e-9))
        times = np.linspace(0.0, count * step, count + 1)
        if duration - times[-1] > 1e-9 * step:
            return np.array([*times, duration])
        times[-1] = duration
        return times


def run(
    model: AnyModel, scenario: Scenario, *, wheels: str = BOTH, **options: Any
) -> "tuple[Simulation, xr.Dataset]":
    """Return the simulation of a scenario, and its signals over time.

    Parameters
    ----------
    model : Model, AxleModel or RigidAxleModel
    scenario : Scenario
    wheels : {'both', 'left', 'right'}, optional
        The wheels that ``road_height`` and loads on a wheel are for; the others have a level road.
        Inputs of an axle may also have the names of the model, such as ``left_road_height``.
    **options : Any
        Of `kintrafo.simulate`: ``method``, ``rtol``, ``atol``, ...

    Returns
    -------
    result : Simulation
        ``t_events[0]`` has the times at which the first wheel left the ground, ``t_events[1]``
        those at which it came back; then come those of the second wheel. The left one is the first.
    motion : xarray.Dataset
        Signals, states and inputs over ``time`` [s], SI units, with units and meanings.

    Raises
    ------
    InputError, PositionError, SimulationError
        As `kintrafo.simulate` and `kintrafo.equilibrium`; or if a wheel does not reach its height.

    Examples
    --------
    >>> from kintrafo import Model, RigidAxleModel, roads, scenario
    >>> bump = roads.step(0.02, at=0.1, end=1.0)
    >>> over = scenario.Scenario(inputs={"road_height": bump})
    >>> result, motion = scenario.run(Model("reference_car"), over)
    >>> round(float(motion["wheel_center_z"][-1] - motion["wheel_center_z"][0]), 4)
    0.0178
    >>> _, motion = scenario.run(RigidAxleModel("rigid_axle"), over, wheels="left")
    >>> float(motion["right_road_height"].max())
    0.0
    """
    start, inputs = started(model, scenario, wheels=wheels)
    assembly = assembly_of(model)
    events = [name for wheel in assembly.wheels for name in assembly.names_of(wheel).events]
    span, times = (0.0, scenario.duration), scenario.times()
    result = simulate(model, span, start, inputs=inputs, t_eval=times, events=events, **options)
    return result, motion_of(model, result)


def motion_of(model: AnyModel, result: Simulation) -> "xr.Dataset":
    """Return signals, states and inputs of a simulation, with the wheel in their long names.

    Parameters
    ----------
    model : Model, AxleModel or RigidAxleModel
        The simulated model.
    result : Simulation

    Returns
    -------
    xarray.Dataset
        As the second result of `run`.
    """
    with Validator("motion_of") as given:
        assembly = given_model(given, model)
    motion = dataset_of(model, result)
    if "bar_spring_moment" in motion:
        motion["bar_spring_moment"].attrs["long_name"] = "moment of the anti-roll bar"
    for name, data in motion.items():
        wheel = wheel_that_begins(str(name), assembly.wheels)
        if wheel and assembly.names_of(wheel).prefix:
            words = data.attrs["long_name"].replace(f"{wheel}_", "")
            data.attrs["long_name"] = f"{words}, {wheel}"
    return motion


def by_wheel(model: AnyModel, motion: "xr.Dataset") -> "xr.Dataset":
    """Return a motion in which variables of wheels have the dimension ``wheel``.

    Parameters
    ----------
    model : Model, AxleModel or RigidAxleModel
    motion : xarray.Dataset
        Result of `run`.

    Returns
    -------
    xarray.Dataset
        ``left_road_height`` and ``right_road_height`` become ``road_height``. The motion of a
        corner is unchanged.
    """
    with Validator("by_wheel") as given:
        assembly = given_model(given, model)
        given.dataset(motion)
    return motion if len(assembly.wheels) == 1 else together(motion, assembly.wheels)


def started(
    model: AnyModel, scenario: Scenario, *, wheels: str = BOTH
) -> tuple[State, dict[str, Signal]]:
    """Return the first state of a scenario, and its inputs by the names of the model; see `run`."""
    with Validator("simulation") as given:
        assembly = given_model(given, model)
        given.instance("scenario", scenario, Scenario, "a Scenario is needed")
        if not given.failed:
            given.among("wheels", wheels, dict.fromkeys((BOTH, *assembly.wheels)))
            _refuse_unusable(given, assembly, scenario)
        heights = None
        if scenario.height is not None and not given.failed:
            heights = each_wheel(given, assembly, "height", scenario.height, "m")
    chosen = assembly.wheels if wheels == BOTH else (wheels,)
    inputs = _by_wheel(assembly, scenario.inputs, chosen)
    profiles = time_inputs(model, inputs, (0.0, scenario.duration))
    at_start = map(float, profiles.at(0.0, profiles.segments[0]))
    first = dict(zip(model.input_names, at_start, strict=True))
    rack, spin = first.get(_RACK, 0.0), scenario.spin_rate
    if heights is not None:
        return state_at_heights(assembly, heights, rack=rack, spin_rate=spin), inputs
    roads = {wheel: assembly.names_of(wheel).road for wheel in assembly.wheels}
    further = inputs.keys() - {_RACK, *roads.values()}
    start = equilibrium(
        model,
        rack_position=rack,
        road_height={wheel: first[road] for wheel, road in roads.items()},
        spin_rate=spin,
        inputs={name: first[name] for name in model.input_names if name in further},
    )
    return start, inputs


def _refuse_unusable(given: Validator, assembly: Assembly, scenario: Scenario) -> None:
    """Add errors for wrong times, and for inputs that the assembly does not have."""
    scenario.checked(given)
    inputs = given.mapping("inputs", scenario.inputs, "input names and their values")
    if _RACK in inputs:
        assembly.refuse_unsteered(given, _RACK)
    refuse_missing_loads(given, assembly, inputs)


def _by_wheel(
    assembly: Assembly, given: Mapping[str, Signal], wheels: Sequence[str]
) -> dict[str, Signal]:
    """Return inputs by the names of the model; an input of one wheel is that of each of these."""
    inputs, prefixes = dict(given), [assembly.names_of(wheel).prefix for wheel in wheels]
    for name in ("road_height", *UNITS):
        named = [f"{prefix}{name}" for prefix in prefixes]
        if name not in inputs or named == [name]:
            continue
        twice = [other for other in named if other in inputs]
        if twice:
            problem = f"{name} and {', '.join(twice)} are given. Give one of them for a wheel."
            raise InputError([problem], "simulation")
        inputs |= dict.fromkeys(named, inputs.pop(name))
    return inputs
