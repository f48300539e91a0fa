"""The state of rest on the road, from the equations of motion."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.validator import Validator
from ...systems.state import State
from ..corner.wheel_loads import UNITS
from . import rest
from .assembly import Assembly
from .of import given_model
from .rig import RestConditions, RigPosition

if TYPE_CHECKING:
    from .of import AnyModel


def equilibrium(
    model: "AnyModel",
    *,
    rack_position: float = 0.0,
    road_height: float | Mapping[str, float] = 0.0,
    wheel_load: float | Mapping[str, float] | None = None,
    strut_force: float | Mapping[str, float] = 0.0,
    spin_rate: float = 0.0,
    inputs: Mapping[str, float] | None = None,
) -> State:
    """Return the stable state of rest under the forces of springs, stops, tyres and weights.

    The body of a car settles on its springs; that of a suspension or an axle is held.

    Parameters
    ----------
    model : Model, AxleModel, RigidAxleModel or CarModel
    rack_position : float, optional
        Displacement at which the rack is held [m]. With a free rack, the holding force is minus
        the third generalised force (``forces`` of the compiled module).
    road_height : float or mapping of str to float, optional
        Height of the road under all wheels, or by wheel: 'left' and 'right', of a car
        'front_left' and so on; zero by default [m].
    wheel_load : float or mapping of str to float, optional
        Instead of a road: the vertical force of the road on all wheels, or by wheel, positive up
        [N]. `road_under_load` returns the height of the road of one wheel.
    strut_force : float or mapping of str to float, optional
        Force of the actuator in the strut, or beside the spring, of all wheels or by wheel,
        positive when it pushes chassis and wheel apart [N].
    spin_rate : float, optional
        Rate of all wheels relative to their carriers, positive rolling forward [rad/s].
    inputs : mapping of str to float, optional
        Further inputs by name, in SI units: loads on the wheels of a model with ``wheel_loads``.
        The wheels are braked by their carriers: by default ``hub_torque`` is the torque that holds
        the wheel.

    Returns
    -------
    State
        The state, with zero rates except those of the wheels' spin. It contains the inputs that
        keep it at rest (road, rack, actuator force): ``model.signals(rest)`` are those of rest, and
        ``simulate(model, t_span, rest)`` stays there. The state is the one nearest to the design
        position; of an axle with an anti-roll bar, nearest to the rest of each side without it.

    Raises
    ------
    InputError
        If an argument cannot be used.
    PositionError
        If there is no stable equilibrium within the travel; of a car also if it rests on a stop, or
        a wheel does not reach the road.

    Examples
    --------
    >>> from kintrafo import Model, RigidAxleModel, equilibrium
    >>> model = Model("reference_car")
    >>> round(float(model.signal("wheel_center_z", equilibrium(model))), 10)
    0.3
    >>> round(float(model.signal("wheel_center_z", equilibrium(model, wheel_load=3000.0))), 4)
    0.2665
    >>> axle = RigidAxleModel("rigid_axle")
    >>> at_rest = equilibrium(axle, road_height={"left": 0.02})
    >>> round(float(at_rest[axle.state_names.index("roll")]), 4)
    0.0114
    """
    with Validator("equilibrium") as given:
        assembly = given_model(given, model)
        spin = given.number("spin_rate", spin_rate, "rad/s")
        roads = each_wheel(given, assembly, "road_height", road_height, "m")
        loads = {}
        if wheel_load is not None:
            loads = each_wheel(given, assembly, "wheel_load", wheel_load, "N")
            _refuse_both(given, loads, roads)
        held = RestConditions(
            _rack(given, assembly, rack_position),
            roads,
            loads,
            each_wheel(given, assembly, "strut_force", strut_force, "N"),
            _further(given, assembly, inputs),
        )
    state, acting = rest.at(assembly, held, assembly.coordinates_at_rest(held))
    for names in map(assembly.names_of, assembly.wheels):
        if model.wheel_loads and names.hub_torque not in held.inputs:
            brake = -model.evaluate("forces", state, acting)[model.state_names.index(names.spin)]
            acting[model.input_names.index(names.hub_torque)] = brake
        state[model.state_names.index(f"{names.spin}_rate")] = spin
    return State.of(state, acting, model.names_of_states)


def state_at_heights(
    assembly: Assembly, heights: Mapping[str, float], *, rack: float = 0.0, spin_rate: float = 0.0
) -> State:
    """Return the state with wheels at given heights, and zero rates except the wheels' spin.

    `heights` are those of wheel centres by wheel, chassis axes [m], by default those at design;
    `rack` is the displacement of the rack [m], `spin_rate` the rate of all wheels relative to their
    carriers, positive rolling forward [rad/s]. Raises `PositionError` if a wheel cannot be there,
    `InputError` if the assembly moves only on its bushes.
    """
    assembly.require_rigid_motion()
    model, names = assembly.model, {wheel: assembly.names_of(wheel) for wheel in assembly.wheels}
    at_design = model.signals(model.design_state)
    travels = {
        wheel: np.array([heights.get(wheel, design) - design])
        for wheel, own in names.items()
        for design in [float(at_design[f"{own.signals}wheel_center_z"])]
    }
    coordinates = assembly.coordinates_at(RigPosition(travels, np.array([rack])))
    state, inputs = (rows[0] for rows in assembly.at_rest(coordinates, rack))
    for own in names.values():
        state[model.state_names.index(f"{own.spin}_rate")] = spin_rate
    return State.of(state, inputs, model.names_of_states)


def _rack(given: Validator, assembly: Assembly | None, position: Any) -> float:
    rack = given.number("rack_position", position, "m")
    if rack and assembly is not None:
        assembly.refuse_unsteered(given, f"rack_position = {1e3 * rack:g} mm")
    return rack


def each_wheel(
    given: Validator, assembly: Assembly | None, name: str, value: Any, unit: str
) -> dict[str, float]:
    """Return the values by wheel of an argument that is one number or a mapping."""
    limits: dict[str, Any] = {}
    if name == "wheel_load":
        limits = {"least": 0.0, "advice": "A road only pushes."}
    wheels = () if assembly is None else assembly.wheels
    if not isinstance(value, Mapping):
        return dict.fromkeys(wheels, given.number(name, value, unit, **limits))
    return {
        given.among("wheel", wheel, wheels): given.number(
            f"{name} of the {wheel} wheel", one, unit, **limits
        )
        for wheel, one in value.items()
    }


def _refuse_both(given: Validator, loads: Mapping[str, float], roads: Mapping[str, float]) -> None:
    if any(roads.get(wheel, 0.0) != 0.0 for wheel in loads):
        given.fail("road_height and wheel_load are both given. Give the one that is known.")


def _further(
    given: Validator, assembly: Assembly | None, inputs: Mapping[str, float] | None
) -> dict[str, float]:
    """Return the inputs that have no argument of their own."""
    values = given.mapping("inputs", {} if inputs is None else inputs, "input names and values")
    if assembly is None or not values:
        return {}
    refuse_missing_loads(given, assembly, values)
    described = assembly.model.equations.INPUTS
    own = {"rack_position", *(assembly.names_of(wheel).road for wheel in assembly.wheels)}
    for name in [name for name in values if name in own]:
        argument = "rack_position" if name == "rack_position" else "road_height"
        given.fail(f"input '{name}': use the argument {argument} instead.")
    known = [name for name in described if name not in own]
    return {
        given.among("input", name, known): given.number(
            str(name), value, described.get(name, {}).get("unit", "")
        )
        for name, value in values.items()
        if name not in own
    }


def refuse_missing_loads(given: Validator, assembly: Assembly, inputs: Iterable[str]) -> None:
    """Refuse loads on the wheels of a model without them."""
    loads = [str(name) for name in inputs if str(name).endswith(tuple(UNITS))]
    if loads and not assembly.model.wheel_loads:
        given.fail(
            f"{', '.join(loads)}: this model has no loads on the wheels besides those of the "
            "tyres. Make it with wheel_loads=True."
        )
