"""Simulation of a car over a road, with metrics of the ride."""

from typing import Any

import numpy as np
import xarray as xr

from ....core.quantities import variable
from ....core.validator import Validator
from ....simulation.result import Simulation, SimulationError
from ....simulation.simulate import simulate
from ...assembly.by_wheel import WHEEL, wheel_coordinate
from ...assembly.car import CarAssembly
from ...assembly.equilibrium import equilibrium
from ...roads import Road
from ..run import CAR_ADVICE, MovingCar, Run
from .outputs import OUTPUTS_OF_WHEELS, body_outputs, upward
from .rest import car_assembly
from .weighting import weighted

# More outputs would fill the memory: the step is probably wrong.
_MOST_OUTPUTS = 2_000_000
# Fewer outputs than this are no motion.
_FEWEST_OUTPUTS = 10
# With linear interpolation between outputs at this step, the weighted acceleration of a wheel hop
# at 12 Hz is some 3 % too small [s].
_LONGEST_STEP = 0.01
# The start from rest on a rough road has decayed after this time [s].
_SETTLED = 2.0
# A tyre with less load is off the road [N].
_OFF = 1e-6


def over(
    subject: Any,
    road: Road,
    speed: float,
    *,
    duration: float | None = None,
    settle: float | None = None,
    output_step: float = 0.005,
    **options: Any,
) -> xr.Dataset:
    """Return the simulated motion of a car over a road, from rest at its beginning.

    Parameters
    ----------
    subject : Car or CarModel
    road : Road
        The road under the left and right wheels; rear wheels reach it later by the wheelbase.
    speed : float
        Speed of the car, above zero [m/s].
    duration : float, optional
        Duration of the simulation [s]; by default until the rear wheels reach the end of the road.
    settle : float, optional
        Time after which RMS and extremes are taken [s]; by default 2 s on a stationary rough
        road, and 0 on other roads, which may begin with a bump.
    output_step : float, optional
        Time between two outputs [s]; 0.01 s at most, so that accelerations can be weighted.
    **options
        Of `kintrafo.simulate`: ``method``, by default 'DormandPrince', and tolerances.

    Returns
    -------
    xarray.Dataset
        Over ``time``: ``body_acceleration`` of the centre of mass, upward, and that of each seat
        [m/s^2]; the coordinates of the body; also over ``wheel`` the ``load``, the force of the
        tyre [N], ``travel`` of the wheel centre on the body from design, and ``road`` [m]. Each
        variable has ``rms`` about its mean, ``smallest`` and ``largest`` after `settle` as
        attributes; accelerations also ``weighted_rms`` by W_k of ISO 2631-1, loads
        ``off_the_road``, the part of that time without load. The attribute ``not_valid`` describes
        where the motion leaves the validity of the equations, such as tension in a tyre without
        lift-off in its file.

    Raises
    ------
    PositionError
        If the car does not rest at the beginning of the road.
    SimulationError
        If the integration cannot continue.
    """
    how = {"duration": duration, "settle": settle, "output_step": output_step, **options}
    return run(subject, road, speed, **how).motion


def run(
    subject: Any,
    road: Road,
    speed: float,
    *,
    duration: float | None = None,
    settle: float | None = None,
    output_step: float = 0.005,
    **options: Any,
) -> Run:
    """Return the simulation of a car over a road, with the states of its equations.

    Errors are those of `over`.

    Parameters
    ----------
    subject, road, speed, duration, settle, output_step, **options
        Car, road, speed [m/s], times [s] and options of the integration; see `over`.

    Returns
    -------
    Run
    """
    assembly = car_assembly("ride", subject)
    with Validator("ride") as given:
        given.instance("road", road, Road, "a kintrafo.road_profiles.Road is needed")
        speed = given.number("speed", speed, "m/s", above=0.0)
        step = given.number("output_step", output_step, "s", above=0.0)
        for name in options.keys() & {"inputs", "t_eval"}:
            given.fail(f"{name} follows from the road. Leave it out; see output_step and duration.")
        if not given.failed:
            longest = (road.length + max(assembly.behind().values())) / speed
            end = (
                longest if duration is None else given.number("duration", duration, "s", above=0.0)
            )
            usual = _SETTLED if road.stationary else 0.0
            begin = usual if settle is None else given.number("settle", settle, "s", least=0.0)
            if not given.failed:
                check_times(end, begin, step)
    try:
        result = _simulated(assembly, road, speed, end, step, options)
    except SimulationError as error:
        if options:
            raise
        raise error.advising(CAR_ADVICE) from error
    motion = _judged(_dataset(assembly, result), begin)
    states, inputs = result.y.T, result.inputs
    car = MovingCar.at_rest(assembly, states[0], inputs[0])
    way = speed * result.t
    return Run(car, motion, states, inputs, np.stack([way, 0.0 * way], axis=-1), way, road)


def check_times(duration: float, settle: float, output_step: float) -> None:
    """Refuse durations and intervals [s] of a simulation that do not go together."""
    least, finest = _FEWEST_OUTPUTS * output_step, duration / _MOST_OUTPUTS
    step = f"output_step = {output_step:g} s"
    with Validator("ride") as given:
        if settle >= duration:
            given.fail(f"settle = {settle:g} s: less than the duration, {duration:g} s, is needed.")
        if output_step > _LONGEST_STEP:
            given.fail(f"{step}: at most {_LONGEST_STEP:g} s is allowed.")
        elif duration < least:
            given.fail(
                f"duration = {duration:g} s: {_FEWEST_OUTPUTS} times output_step, {least:g} s, or "
                "more is needed."
            )
        if output_step < finest:
            given.fail(f"{step}: {finest:.3g} s or more is needed.")


def _simulated(
    assembly: CarAssembly,
    road: Road,
    speed: float,
    end: float,
    step: float,
    options: dict[str, Any],
) -> Simulation:
    model, behind = assembly.model, assembly.behind()
    heights = {
        wheel: road.over_time(wheel.rpartition("_")[2], speed, behind[wheel], end)
        for wheel in assembly.wheels
    }
    return simulate(
        model,
        (0.0, end),
        equilibrium(model, road_height={w: float(h(0.0)) for w, h in heights.items()}),
        inputs={assembly.names_of(wheel).road: heights[wheel] for wheel in assembly.wheels},
        t_eval=np.linspace(0.0, end, max(round(end / step), 1) + 1),
        **({"method": "DormandPrince"} | options),
    )


def _dataset(assembly: CarAssembly, result: Simulation) -> xr.Dataset:
    model, states = assembly.model, result.y.T
    rates = model.evaluate("rhs", states, result.inputs)
    motion = {
        name: (states[:, i], states[:, i + half], rates[:, i + half])
        for half in [len(model.state_names) // 2]
        for name in assembly.car.coordinates
        for i in [model.state_names.index(name)]
    }
    found = {
        name: variable("time", upward(motion, assembly.felt_at()[name]), words, unit)
        for name, (words, unit) in body_outputs(assembly).items()
    }
    for name, (position, *_) in motion.items():
        unit = "m" if name == "heave" else "rad"
        found[name] = variable("time", position, f"{name} of the body", unit)
    single = len(assembly.wheels) == 1
    travels = assembly.travels(states)
    names = {wheel: assembly.names_of(wheel) for wheel in assembly.wheels}
    roads = {w: result.inputs[:, model.input_names.index(own.road)] for w, own in names.items()}
    rows = {
        "load": [result.signals[f"{own.signals}tyre_force"] for own in names.values()],
        "travel": list(travels.values()),
        "road": list(roads.values()),
    }
    described = OUTPUTS_OF_WHEELS | {"road": ("height of the road under the wheel", "m")}
    for name, (words, unit) in described.items():
        values = rows[name][0] if single else np.stack(rows[name])
        found[name] = variable(("time",) if single else (WHEEL, "time"), values, words, unit)
    coordinates = {
        "time": ("time", result.t, {"units": "s", "long_name": "time"}),
        WHEEL: wheel_coordinate(assembly.wheels),
    }
    left = [str(found) for found in result.validity if not found.bound.possible]
    attributes = {"title": "ride over a road", "solver": result.solver, "not_valid": left}
    return xr.Dataset(found, coordinates, attributes)


def _judged(found: xr.Dataset, begin: float) -> xr.Dataset:
    """Return the motion with the metrics of each variable as attributes."""
    times = found["time"].values
    after, step = times >= begin, float(times[1] - times[0])
    for name, data in found.data_vars.items():
        values = data.values[..., after]
        data.attrs |= {
            "rms": values.std(axis=-1).tolist(),
            "smallest": values.min(axis=-1).tolist(),
            "largest": values.max(axis=-1).tolist(),
        }
        if str(name).endswith("acceleration"):
            felt = weighted(data.values, step)[after]
            data.attrs["weighted_rms"] = float(np.sqrt(np.mean(felt**2)))
        if name == "load":
            data.attrs["off_the_road"] = (values <= _OFF).mean(axis=-1).tolist()
    return found
