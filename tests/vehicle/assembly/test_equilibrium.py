"""The state of rest of a corner, an axle and a rigid axle: the same arguments do the same."""

from functools import cache

import kintrafo
import numpy as np
import pytest
from kintrafo import Axle, AxleModel, InputError, Model, RigidAxleModel, equilibrium
from kintrafo.vehicle.analysis.scenario import Scenario, run, started
from kintrafo.vehicle.assembly.measures.measure import values
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.assembly.rig import RigPosition
from kintrafo.vehicle.models.positions import PositionError

MODELS = {
    "corner": lambda: Model("reference_car"),
    "axle": lambda: AxleModel(Axle.load("reference_axle")),
    "rigid axle": lambda: RigidAxleModel("rigid_axle"),
}
CENTERS = {
    "corner": {"right": ("", "")},
    "axle": {side: (f"{side}_", f"{side}_front_") for side in ("left", "right")},
    "rigid axle": {side: (f"{side}_", f"{side}_axle_") for side in ("left", "right")},
}
# A rounding of an angle of 1 rad moves a wheel by 1e-16 m.
EXACT = 1e-10

each = pytest.mark.parametrize("name", MODELS)


@cache
def model_of(name):
    return MODELS[name]()


def of_wheels(name, rest):
    """Return heights of wheel centres and of the roads below them."""
    model, names = model_of(name), CENTERS[name].values()
    heights = [float(model.signal(f"{signals}wheel_center_z", rest)) for _, signals in names]
    places = [model.input_names.index(f"{prefix}road_height") for prefix, _ in names]
    return np.array(heights), rest.inputs[places]


@each
def test_a_wheel_load_is_the_deflection_of_the_tyre_times_its_rate(name):
    rest = equilibrium(model_of(name), wheel_load=3000.0)
    heights, roads = of_wheels(name, rest)
    tyre = model_of(name).parameters
    left = tyre.get("tyre_free_height") - (heights - roads)
    np.testing.assert_allclose(tyre["tyre_rate"] * left, 3000.0, rtol=1e-9)


@each
def test_the_road_of_a_loaded_wheel_makes_the_same_rest(name):
    loaded = equilibrium(model_of(name), wheel_load=3000.0)
    _, roads = of_wheels(name, loaded)
    road = dict(zip(CENTERS[name], map(float, roads), strict=True))
    np.testing.assert_allclose(equilibrium(model_of(name), road_height=road), loaded, atol=EXACT)


@each
def test_a_road_that_is_the_same_under_all_wheels_is_a_number(name):
    by_wheel = dict.fromkeys(CENTERS[name], 0.01)
    found = [equilibrium(model_of(name), road_height=road) for road in (0.01, by_wheel)]
    np.testing.assert_array_equal(*found)


@each
def test_a_run_with_actuators_begins_at_rest(name):
    model = model_of(name)
    pushing = [name for name in model.input_names if name.endswith(("actuator", "strut_force"))]
    _, motion = run(model, Scenario(duration=0.05, inputs=dict.fromkeys(pushing, 300.0)))
    for _, signals in CENTERS[name].values():
        height = motion[f"{signals}wheel_center_z"]
        # tolerances of the simulation
        assert float(height.max() - height.min()) < 1e-7
    assert pushing


@each
def test_what_cannot_be_is_refused(name, refused):
    model = model_of(name)
    own = [name for name in model.input_names if name.endswith(("road_height", "rack_position"))]
    refused(
        InputError,
        lambda: equilibrium(model, wheel_load=3000.0, road_height=0.01),
        lambda: equilibrium(model, road_height={"front": 0.01}),
        lambda: equilibrium(model, wheel_load={"right": -1.0}),
        lambda: equilibrium(
            model, inputs={f"{next(iter(CENTERS[name].values()))[0]}shaft_torque": 1.0}
        ),
        lambda: equilibrium(model, inputs={"road": 1.0}),
        lambda: equilibrium(model, inputs=dict.fromkeys(own, 0.01)),
        lambda: run(model, Scenario(), wheels="front"),
    )


def test_a_rack_that_is_not_there_is_refused(refused):
    model = model_of("rigid axle")
    refused(
        InputError,
        lambda: equilibrium(model, rack_position=0.01),
        lambda: run(model, Scenario(inputs={"rack_position": 0.01})),
    )


@each
def test_a_motion_names_the_wheel_of_each_signal_in_words(name):
    _, motion = run(model_of(name), Scenario(duration=0.01))
    for wheel, (prefix, signals) in CENTERS[name].items():
        words = motion[f"{signals}wheel_center_z"].attrs["long_name"]
        assert words == f"wheel centre, z, {wheel}" if prefix else "wheel centre, z"
    if "bar_spring_moment" in motion:
        assert motion["bar_spring_moment"].attrs["long_name"] == "moment of the anti-roll bar"


@each
def test_motions_start_with_the_wheels_at_given_heights(name, refused):
    model = model_of(name)
    at_rest, _ = of_wheels(name, equilibrium(model))
    both = {wheel: at_rest[i] + (0.01, -0.005)[i] for i, wheel in enumerate(CENTERS[name])}
    for height in (both, float(at_rest[0]) + 0.01):
        start, _ = started(model, Scenario(height=height, spin_rate=30.0))
        wanted = [*height.values()] if isinstance(height, dict) else [height] * len(both)
        np.testing.assert_allclose(of_wheels(name, start)[0], wanted, atol=EXACT)
        rates = np.asarray(start)[len(start) // 2 :]
        assert sorted(rates)[-len(both) :] == [30.0] * len(both)
        assert np.count_nonzero(rates) == len(both)
    refused(PositionError, lambda: started(model, Scenario(height=9.0)))
    refused(InputError, lambda: started(model, Scenario(height={"middle": 0.3})))


@pytest.mark.parametrize("name", ["rigid_axle", "steered_rigid_axle", "twist_beam", "lopsided"])
def test_the_ride_rate_is_the_slope_of_the_tyre_force_over_a_road_that_rises(name):
    """At rest on a road under both wheels, of an axle without weight."""
    changes = {"gravity": {"acceleration_m_per_s2": 0.0}}
    if name == "lopsided":
        changes["left_hardpoints"] = {"spring_seat": [40.0, 250.0, 430.0]}
    axle = kintrafo.load("rigid_axle" if name == "lopsided" else name).with_changes(changes)
    assembly, step = assembly_of(kintrafo.model_of(axle)), 1e-5
    model, names = assembly.model, [assembly.names_of(side).signals for side in assembly.wheels]
    below, at, above = (
        model.signals(equilibrium(model, road_height=road)) for road in (-step, 0.0, step)
    )
    forces = [f"{signals}tyre_force" for signals in names]
    slopes = [float(above[force] - below[force]) / (2.0 * step) for force in forces]
    travels = {
        side: np.array([float(at[f"{signals}wheel_center_z"]) - axle.center[2]])
        for side, signals in zip(assembly.wheels, names, strict=True)
    }
    of = assembly.kinematics(RigPosition(travels, np.zeros(1)))
    rates = [f"ride_rate_{side}" for side in assembly.wheels]
    found = values(assembly.measures("bump"), of, assembly.wheels, rates)
    # The tyre acts at the lowest point of a wheel, which rises less in camber.
    np.testing.assert_allclose([found[rate][0] for rate in rates], slopes, rtol=1e-3)
    if name == "lopsided":  # where the wheels do not rise together, rates in series differ
        wheel_rates = values(
            assembly.measures("bump"), of, assembly.wheels, [f"wheel_{rate[5:]}" for rate in rates]
        )
        tyre = axle.tyre.rate_N_per_m
        series = [rate[0] * tyre / (rate[0] + tyre) for rate in wheel_rates.values()]
        assert np.all(np.abs(np.array(series) / slopes - 1.0) > 5e-3)
