"""Loads on a wheel as inputs in time: against load cases, and Newton and Euler part by part."""

import pickle
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import xarray as xr
from cars.rigid_axles import AXLE, LOPSIDED, Found
from kintrafo import (
    Axle,
    AxleModel,
    InputError,
    Model,
    RigidAxleModel,
    Suspension,
    equilibrium,
    loads,
    simulate,
)
from kintrafo.generator import DeclarationError, Direction, Input
from kintrafo.generator.mechanisms import MODELS
from kintrafo.generator.mechanisms.suspension import with_wheel_loads
from kintrafo.vehicle.analysis.checkup import checkup
from kintrafo.vehicle.analysis.loads.along import in_motion
from kintrafo.vehicle.analysis.measurement import measured
from kintrafo.vehicle.analysis.scenario import Scenario, run
from kintrafo.vehicle.assembly.corner import CornerAssembly
from kintrafo.vehicle.corner.wheel_loads import UNITS
from kintrafo.vehicle.models.positions import design_height

CARS = [Suspension.load("reference_car"), Suspension.load("double_wishbone_car").mirrored()]
LIMITS = {"N": 4000.0, "N m": 400.0}
BRAKED = "time_s,contact_force_x_N,hub_torque_Nm\n0,0,0\n0.1,0,0\n0.2,-2000,-600\n0.4,-2000,-600\n"


@pytest.mark.parametrize("car", CARS, ids=lambda car: car.TITLE)
def test_rest_is_that_of_a_load_case(car):
    """A wheel without a tyre, braked and in a corner: equations of motion against statics."""
    contact = np.array([-1900.0, 1100.0, 3900.0])
    case = {"contact_N": contact.tolist(), "contact_Nm": [0.0, 0.0, 60.0]}
    wanted = float(loads.static(Model(car), {"case": case})["travel"][0])
    model = Model(car.with_changes({"tyre.rate_N_per_m": 0.0}), wheel_loads=True)
    given = dict(zip((f"contact_force_{axis}" for axis in "xyz"), contact, strict=True))
    rest = equilibrium(model, inputs={**given, "wheel_moment_z": 60.0})
    travel = float(model.signal("wheel_center_z", rest)) - design_height(model)
    # roundings of moments of 1e3 N m over a stiffness of some 1e4 N m
    assert travel == pytest.approx(wanted, abs=1e-12)
    held = {"hub_torque": -1900.0 * model.parameters["tyre_radius"]}
    still = simulate(model, (0.0, 0.2), rest, inputs={**given, **held, "wheel_moment_z": 60.0})
    assert abs(still.y[:2] - rest[:2, None]).max() < 1e-2  # it turns by its camber, and stays


@pytest.mark.parametrize("car", CARS, ids=lambda car: car.TITLE)
def test_every_part_is_in_balance(car):
    """Residual of the Newton-Euler equations in any motion, and the loads of the bearing."""
    model = Model(car, wheel_loads=True)
    random = np.random.default_rng(1)
    size = len(model.state_names) // 2
    away = np.repeat([0.1, 10.0], size) * random.uniform(-1.0, 1.0, (8, 2 * size))
    inputs = np.zeros((8, len(model.input_names)))
    for name, unit in UNITS.items():
        column = model.input_names.index(name)
        inputs[:, column] = LIMITS[unit] * random.uniform(-1.0, 1.0, 8)
    found = in_motion(CornerAssembly(model), model.design_state + away, inputs)
    assert abs(found["holding_force"]).max() < 1e-9 * abs(found["force"]).max()
    bearing = found.isel(load=((found["part"] == "wheel") & (found["by"] == "knuckle")).values)
    shaft = found.isel(load=((found["part"] == "wheel") & (found["by"] == "shaft")).values)
    torque, hub = (inputs[:, model.input_names.index(f"{n}_torque")] for n in ("shaft", "hub"))
    axis = shaft["moment"].values[:, 0] / torque[:, None]  # points to the left
    np.testing.assert_allclose(np.linalg.norm(axis, axis=1), 1.0, rtol=1e-12)
    assert (axis[:, 1] > 0.9).all()
    carried = (bearing["moment"].values.sum(1) * axis).sum(1)
    np.testing.assert_allclose(carried, hub, rtol=0.0, atol=1e-9 * abs(found["moment"]).max())


@pytest.mark.parametrize("name", [name for name in UNITS if name != "hub_torque"])
def test_what_is_at_rest_stays_there(name):
    """The state carries the brake that holds the wheel, against whatever turns it."""
    model = Model(CARS[0], wheel_loads=True)
    rest = equilibrium(model, inputs={name: 0.25 * LIMITS[UNITS[name]]}, spin_rate=20.0)
    rates = model.evaluate("rhs", rest, rest.inputs)
    # roundings of moments of 1e3 N m over inertias of some kg m^2, with a spin that does not end
    np.testing.assert_allclose(rates, [0.0, 20.0, 0.0, 0.0], atol=1e-9)


def test_both_sides_of_an_axle_do_what_one_does(refused):
    """Loads alike on both sides, as if one stood alone; on one side, the bar takes a part of it."""
    axle = Axle.load("reference_axle")
    model = AxleModel(axle, wheel_loads=True)
    corner = Model(axle.right, wheel_loads=True)
    braked = {"contact_force_x": -2000.0, "hub_torque": -600.0}
    alone = equilibrium(corner, inputs=braked)
    both = {f"{side}_{name}": value for side in ("left", "right") for name, value in braked.items()}
    rest = equilibrium(model, inputs=both)
    height = float(corner.signal("wheel_center_z", alone))
    for side in ("left", "right"):
        found = float(model.signal(f"{side}_front_wheel_center_z", rest))
        assert found == pytest.approx(height, abs=1e-9)
    scenario = Scenario(duration=0.1, inputs=braked)
    result, motion = run(model, scenario, wheels="left")
    twist = motion["bar_spring_moment"].values
    # at rest from the beginning; the brake holds the wheel, but for its camber
    assert np.ptp(twist) < 0.01 * abs(twist[0]) > 0.0
    of_parts = loads.along(model, result)
    for side in ("left", "right"):
        assert (
            abs(of_parts["holding_force"].sel(wheel=side)).max()
            < 1e-9 * abs(of_parts["force"]).max()
        )
    refused(
        InputError,
        lambda: run(model, replace(scenario, inputs={**braked, "left_contact_force_x": 0.0})),
    )


@pytest.mark.parametrize("of", ["reference_car", "rigid_axle --wheels left"])
def test_measured_loads_are_driven(kintrafo, tmp_path, of):
    file = tmp_path / "braked.csv"
    file.write_text(BRAKED)
    assert set(measured(file).values) == {"contact_force_x", "hub_torque"}
    out = tmp_path / "loads.nc"
    command = f"simulate {of} --measured {file} --loads {out} --json"
    code, told, _ = kintrafo(*command.split())
    assert code == 0, told
    found = xr.load_dataset(out)
    point, part = ("contact", "wheel") if of == "reference_car" else ("contact_left", "wheel_left")
    by_road = found.isel(load=((found["point"] == point) & (found["part"] == part)).values)
    np.testing.assert_allclose(by_road["force"].values[-1, 0, 0], -2000.0, rtol=1e-3)


CORNERS = [m for m in MODELS if any(body.name == "wheel" for body in m.mechanism.bodies)]


@pytest.mark.parametrize("formulation", CORNERS, ids=lambda model: model.name)
def test_every_kind_can_have_them(formulation):
    loaded = with_wheel_loads(formulation)
    assert set(loaded.inputs) - set(formulation.inputs) == set(UNITS)
    assert {name: loaded.inputs[name].unit for name in UNITS} == UNITS
    assert all(f"`{name}`" in loaded.mechanism.forces[-1].describe().acts for name in UNITS)


def test_what_cannot_be_is_refused(refused):
    car = CARS[0]
    points = car.hardpoints.given()
    lower = {f"hardpoints.{name}.z": getattr(car.hardpoints, name)[2] - 300.0 for name in points}
    refused(
        InputError,
        lambda: Model(car.with_changes({**lower, "tyre.radius_mm": None}), wheel_loads=True),
    )
    with pytest.raises(InputError, match="wheel_loads=True"):
        equilibrium(Model(car), inputs={"contact_force_x": 1.0})
    with pytest.raises(InputError, match=r"contact_force_w.*contact_force_"):
        equilibrium(Model(car, wheel_loads=True), inputs={"contact_force_w": 1.0})


def test_a_bearing_that_is_not_the_wheels_is_refused(refused):
    loaded = with_wheel_loads(MODELS[0])
    force = loaded.mechanism.forces[-1]
    refused(DeclarationError, lambda: replace(force, hub=Input("hub", "N", "torque")))
    other = Direction("other", (0.0, 1.0, 0.0), "another direction")
    refused(DeclarationError, lambda: replace(force, wheel=replace(force.wheel, spin=other)))
    arm = loaded.mechanism.body("control_arm")
    refused(DeclarationError, lambda: replace(force, wheel=replace(force.wheel, carrier=arm)))


def test_a_car_with_friction_and_a_free_rack_is_looked_at():
    """Its equations without friction are those with a free rack, too."""
    car = Suspension.load("offset_strut_car").with_changes(
        {"bodies.tie_rod.mass_kg": 1.0, "strut.friction_N": 50.0}
    )
    assert checkup(Model(car, free_rack=True)).wheels[0].equilibrium is not None


# -- rigid axles ----------------------------------------------------------------------------------

SIDES = {"left": 1.0, "right": -1.0}
CASE = {
    "left": {"contact_N": [-900.0, 700.0, 4900.0], "contact_Nm": [0.0, 0.0, 60.0]},
    "right": {"contact_N": [-1900.0, 1100.0, 7900.0], "center_N": [300.0, 0.0, -200.0]},
}


@cache
def lopsided():
    """Return an axle whose sides differ; its equations are compiled when first needed."""
    return RigidAxleModel(LOPSIDED, wheel_loads=True)


def inputs_of(case):
    """Return a load case as inputs."""
    names = {"contact_N": "contact_force", "contact_Nm": "wheel_moment", "center_N": "center_force"}
    return {
        f"{side}_{names[key]}_{axis}": value
        for side, own in case.items()
        for key, vector in own.items()
        for axis, value in zip("xyz", vector, strict=True)
    }


def test_an_axle_rests_as_in_a_load_case():
    """Wheels without tyres, braked and in a corner: equations of motion against statics."""
    wanted = loads.static(LOPSIDED, {"case": CASE})
    free = LOPSIDED.with_changes({"tyre.rate_N_per_m": 0.0})
    model, given = RigidAxleModel(free, wheel_loads=True), inputs_of(CASE)
    rest = equilibrium(model, inputs=given)
    for side in SIDES:
        height = float(model.signal(f"{side}_axle_wheel_center_z", rest))
        travel = height - LOPSIDED.center[2]
        # roundings of 1e4 N over a stiffness of some 4e4 N/m
        assert travel == pytest.approx(float(wanted["travel"].sel(wheel=side)[0]), abs=1e-11)
    # the state carries the brakes that hold the wheels, against whatever turns them
    rates = model.evaluate("rhs", rest, rest.inputs)
    np.testing.assert_allclose(rates, 0.0, atol=1e-8)
    brake = float(rest.inputs[model.input_names.index("right_hub_torque")])
    assert brake == pytest.approx(-1900.0 * model.parameters["tyre_radius"], rel=1e-3)


def test_power_on_an_axle_is_that_at_the_places_of_the_root_finder():
    """Generalised forces in heave, roll and spin by differences of where the wheels' points go."""
    model = lopsided()
    random, at, step = np.random.default_rng(2), (0.02, -0.03), 1e-6
    state = model.state(heave=at[0], roll=at[1])
    given = {
        f"{side}_{name}": LIMITS[unit] * random.uniform(-1.0, 1.0)
        for side in SIDES
        for name, unit in UNITS.items()
    }
    ours = model.evaluate("forces", state, model.inputs(given)) - model.evaluate(
        "forces", state, model.inputs({})
    )
    finder, radius = Found(LOPSIDED), LOPSIDED.tyre_radius()
    _, turn = finder.pose(*at)
    wanted = np.zeros(len(ours))
    spins = {side: model.state_names.index(f"{side}_spin_angle") for side in SIDES}
    for side, sign in SIDES.items():
        local = LOPSIDED.wheel.spin_axis(sign)
        axis = turn.apply(local)
        forward = np.cross(axis, [0.0, 0.0, 1.0])
        forward /= np.linalg.norm(forward)
        axes = np.stack([forward, np.cross([0.0, 0.0, 1.0], forward), [0.0, 0.0, 1.0]])
        contact, center, moment = (
            axes.T @ [given[f"{side}_{name}_{x}"] for x in "xyz"]
            for name in ("contact_force", "center_force", "wheel_moment")
        )
        place = LOPSIDED.center + sign * LOPSIDED.half_track * np.eye(3)[1]
        upright = np.array([0.0, 0.0, 1.0]) - axis[2] * axis
        lowest = turn.inv().apply(-radius * upright / np.linalg.norm(upright))
        moment = moment + given[f"{side}_shaft_torque"] * axis
        for which, way in enumerate(np.eye(2)):
            poses = [finder.pose(*(np.array(at) + s * step * way)) for s in (-1.0, 1.0)]
            low, high = (
                np.array([m + t.apply(place + p - LOPSIDED.center) for p in (lowest, 0.0 * lowest)])
                for m, t in poses
            )
            by_contact, by_center = (high - low) / (2.0 * step)
            turning = (poses[1][1] * poses[0][1].inv()).as_rotvec() / (2.0 * step)
            wanted[which] += contact @ by_contact + center @ by_center + moment @ turning
        # spinning by itself, the wheel takes its lowest point with it
        arm = turn.apply(lowest)
        about = moment @ axis + np.cross(axis, arm) @ contact + given[f"{side}_hub_torque"]
        wanted[spins[side]] = about
    # 1e-12 m of the root finder over the step, times forces of 1e4 N
    np.testing.assert_allclose(ours, wanted, rtol=0.0, atol=3e-2)
    assert np.abs(wanted).max() > 1e3


def test_every_part_of_an_axle_is_in_balance_along_a_motion():
    """Residual of the Newton-Euler equations, and moments of bearings about their axes."""
    time = [0.0, 0.02, 0.05]
    inputs = {
        "left_contact_force_x": (time, [0.0, 0.0, -3000.0]),
        "right_contact_force_y": (time, [0.0, 500.0, 2500.0]),
        "left_hub_torque": (time, [0.0, 0.0, -900.0]),
        "right_shaft_torque": (time, [0.0, 100.0, 300.0]),
        "right_wheel_moment_z": (time, [0.0, 0.0, 80.0]),
        "left_center_force_z": (time, [0.0, 900.0, 0.0]),
    }
    model = lopsided()
    start = equilibrium(model, spin_rate=30.0)
    motion = simulate(model, (0.0, 0.05), start, inputs=inputs, t_eval=np.linspace(0.0, 0.05, 6))
    found = loads.along(model, motion)
    most = abs(found["force"]).max()
    for side, sign in SIDES.items():
        assert abs(found["holding_force"].sel(wheel=side)).max() < 1e-9 * most
        rows = ((found["part"] == f"wheel_{side}") & (found["by"] == "beam")).values
        (carried,) = found.isel(load=rows)["moment_in_part"].values[-1]
        # the brake is on the axle; in the axes of design, which the wheel does not spin out of
        hub = -900.0 if side == "left" else 0.0
        assert carried @ LOPSIDED.wheel.spin_axis(sign) == pytest.approx(hub, abs=1e-6)


def test_a_ride_of_an_axle_under_loads_and_what_is_refused(refused):
    braked = {"contact_force_x": -1500.0, "hub_torque": -540.0}
    model = RigidAxleModel(AXLE, wheel_loads=True)
    again = pickle.loads(pickle.dumps(model))
    assert again.wheel_loads
    result, _ = run(model, Scenario(duration=0.05, inputs=braked), wheels="left")
    # at rest from the beginning: one brake alone steers and rolls the axle, and it stays
    assert np.ptp(result.y[:2], axis=1).max() < 1e-6
    assert abs(result.y[1, 0]) > 1e-5
    plain = Scenario(duration=0.01)
    ways = [run(m, plain)[0].y[:, -1] for m in (model, RigidAxleModel(AXLE))]
    np.testing.assert_allclose(ways[0], ways[1], atol=1e-12)
    with pytest.raises(InputError, match="wheel_loads=True"):
        run(RigidAxleModel(AXLE), replace(plain, inputs=braked))
    low = {f"hardpoints.{name}": [p[0], p[1], p[2] - 330.0] for name, p in
           AXLE.to_dict()["hardpoints"].items() if name != "unit"}  # fmt: skip
    low |= {f"rods.{name}.{end}": [p[0], p[1], p[2] - 330.0]
            for name, rod in AXLE.to_dict()["rods"].items() for end, p in rod.items()}  # fmt: skip
    refused(InputError, lambda: RigidAxleModel(AXLE.with_changes(low), wheel_loads=True))
