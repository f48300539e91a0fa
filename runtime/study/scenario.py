"""One run of a suspension over a road: where it starts, what road and rack do, for how long."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ..core.arguments import Arguments
from ..simulation.courses import Signal
from ..simulation.result import Simulation
from ..simulation.signals import time_inputs
from ..simulation.simulate import simulate
from ..suspension.model import Model
from ..suspension.positions import equilibrium, state_at_height
from ..suspension.wheel_loads import UNITS
from .recording import dataset_of

Array = NDArray[np.float64]

# More output than this is a mistake in the step, and would fill the memory.
_MOST_OUTPUTS = 5_000_000


@dataclass(frozen=True)
class Scenario:
    """What happens to a suspension in a simulation.

    Attributes
    ----------
    duration : float
        [s]
    output_step : float
        Time between outputs [s].
    height : float, optional
        Height of the wheel centre at the start, chassis axes [m]; by default that of the
        equilibrium on the road as it is at the start.
    spin_rate : float
        Rate of the wheel relative to the knuckle, positive rolling forward [rad/s].
    inputs : dict
        Inputs by name, as `kintrafo.simulate` takes them; see `kintrafo.roads`.
    """

    duration: float = 1.0
    output_step: float = 0.001
    height: float | None = None
    spin_rate: float = 0.0
    inputs: dict[str, Signal] = field(default_factory=dict)

    def times(self) -> Array:
        """Return the times of the output, the first and the last included [s]."""
        with Arguments("simulation") as given:
            duration = given.number("duration", self.duration, "s", above=0.0)
            step = given.number("output step", self.output_step, "s", above=0.0)
            if not given.refused and duration / step > _MOST_OUTPUTS:
                given.refuse(
                    f"an output every {step:g} s for {duration:g} s makes more than "
                    f"{_MOST_OUTPUTS} rows. Choose a larger output step."
                )
        count = int(np.floor(duration / step + 1e-9))
        times = np.linspace(0.0, count * step, count + 1)
        if duration - times[-1] > 1e-9 * step:
            return np.array([*times, duration])
        times[-1] = duration
        return times

    def start(self, model: Model) -> Array:
        """Return the state at the start, with road and rack as they are then."""
        with Arguments("simulation") as checked:
            checked.mapping("inputs", self.inputs, "input names, what they do")
        given = time_inputs(model, self.inputs, (0.0, self.duration))
        at_start = given.at(0.0, given.segments[0])
        known = dict(zip(model.input_names, map(float, at_start), strict=True))
        rack = known.get("rack_position", 0.0)
        if self.height is not None:
            return state_at_height(model, self.height, rack_position=rack, spin_rate=self.spin_rate)
        return equilibrium(
            model,
            rack_position=rack,
            road_height=known["road_height"],
            strut_force=known[model.names.actuator],
            spin_rate=self.spin_rate,
            inputs={name: known[name] for name in UNITS if name in self.inputs},
        )


def run(model: Model, scenario: Scenario, **options: Any) -> tuple[Simulation, xr.Dataset]:
    """Simulate a scenario.

    Parameters
    ----------
    model : Model
    scenario : Scenario
    **options : Any
        Of `kintrafo.simulate`: ``method``, ``rtol``, ``atol``, ...

    Returns
    -------
    Simulation
        With the times at which the wheel left the ground in ``t_events[0]``, and at which it came
        back in ``t_events[1]``.
    xarray.Dataset
        Signals, states and inputs over time, see `kintrafo.study.recording.dataset_of`.

    Raises
    ------
    InputError, PositionError, SimulationError
        As `kintrafo.simulate`, `kintrafo.equilibrium` and `kintrafo.state_at_height`.

    Examples
    --------
    >>> from kintrafo import roads
    >>> bump = roads.step(0.02, at=0.1, end=1.0)
    >>> result, motion = run(Model("reference_car"), Scenario(inputs={"road_height": bump}))
    >>> round(float(motion["wheel_center_z"][-1] - motion["wheel_center_z"][0]), 4)
    0.0178
    """
    with Arguments("simulation") as given:
        given.kind("model", model, Model, Model.NEEDED)
        given.kind("scenario", scenario, Scenario, "a Scenario is needed")
    times = scenario.times()
    result = simulate(
        model,
        (0.0, scenario.duration),
        scenario.start(model),
        inputs=scenario.inputs,
        t_eval=times,
        events=("wheel_leaves_ground", "wheel_touches_ground"),
        **options,
    )
    return result, dataset_of(model, result)
