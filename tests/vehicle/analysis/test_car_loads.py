"""Loads on the parts of a car in a manoeuvre, against balances that no joint is a part of."""

import kintrafo
import numpy as np
import pytest
from cars.driving_cars import FILE, LINES, car_on_beams
from kintrafo.vehicle.analysis.handling import circle, drive, dynamic_loads
from kintrafo.vehicle.analysis.handling.subject import driving_car
from kintrafo.vehicle.analysis.loads import along, peaks, static
from kintrafo.vehicle.analysis.loads.on_a_car import CarInMotion, of_car, rack_force
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.models.car import Car
from kintrafo.vehicle.models.car.equations import declared

G, UP = 9.81, np.array([0.0, 0.0, 1.0])
OF_TYRE = ("fx", "fy", "fz", "mx", "my", "mz", "deflection", "wheel_center_z")


@pytest.fixture(scope="module")
def car():
    return kintrafo.load("driving_car")


@pytest.fixture(scope="module")
def result(car):
    """A car that turns into a bend: the body rolls and yaws, wheels spin, the rack moves."""
    changes = {"lateral_acceleration_m_per_s2": 4.0, "duration_s": 1.3, "start_s": 0.2}
    return drive(car, "step_steer", changes)


@pytest.fixture(scope="module")
def loads(result):
    return dynamic_loads(result)


@pytest.fixture(scope="module")
def motion(result):
    run = result.runs[-1]
    return CarInMotion(run.car.assembly, run.states, run.inputs)


def of_state(motion, letters):
    names = motion.model.state_names
    return motion.states[:, [names.index(f"body_{letter}") for letter in letters]]


def air(motion):
    """Return force and moment of the air about the body's centre of mass, N, N m, its axes."""
    parameters, com = motion.model.parameters, motion.assembly.car.com
    arm = np.array([parameters[f"air_center_{axis}"] for axis in "xyz"]) - com
    velocity = of_state(motion, "uvw") + np.cross(of_state(motion, "pqr"), arm)
    drag, lift = (motion.signals[f"air_{what}"][:, None] for what in ("drag", "lift"))
    force = -drag * velocity / np.linalg.norm(velocity, axis=1)[:, None] + lift * UP
    pitching = 0.5 * parameters["air_density"] * parameters["air_pitching"]
    moment = np.cross(arm, force)
    moment[:, 1] += pitching * velocity[:, 0] ** 2
    return force, moment


def test_loads_of_the_joints_agree_with_the_equations_of_motion(loads):
    """Equations in minimal coordinates and the balance of all parts agree."""
    # rounding of differences of velocities, times masses
    assert np.abs(loads["holding_force"]).max() < 1e-5
    assert loads["residual"].max() < 1e-5
    assert loads["residual_moment"].max() < 1e-5
    assert {"wheel_front_left", "knuckle_rear_right", "rack"} < {*loads["moving_part"].values}


def test_forces_on_the_body_move_it(motion, loads):
    the_body_is_balanced(motion, loads)


def the_body_is_balanced(motion, loads, vertical=UP):
    """Newton and Euler for the body, which is not among the parts that the analysis balances."""
    parameters, com = motion.model.parameters, motion.assembly.car.com
    own = loads.sel(load=loads["part"] == "chassis")
    forces, moments, at = (own[name].values for name in ("force", "moment", "at"))
    of_air, about = air(motion)
    weight = parameters["body_mass"] * G * np.einsum("nji,j->ni", motion.body, vertical)
    force = forces.sum(axis=1) + of_air - weight
    about = about + (moments + np.cross(at - com, forces)).sum(axis=1)
    # the reaction of the drive torque is on the body
    for end in motion.assembly.car.drive_shares:
        for suffix, group in motion.axle(end).poses.items():
            for name, wheel in group.wheels.items():
                side = name.removeprefix("wheel")
                torque = motion.signals[f"{end}{suffix}{side}_drive_moment"]
                about -= torque[:, None] * wheel.vehicle.side * wheel.axis
    rates = motion.model.evaluate("rhs", motion.states, motion.inputs)
    changed = CarInMotion(motion.assembly, rates, motion.inputs)
    u, p = of_state(motion, "uvw"), of_state(motion, "pqr")
    du, dp = of_state(changed, "uvw"), of_state(changed, "pqr")
    np.testing.assert_allclose(force, parameters["body_mass"] * (du + np.cross(p, u)), atol=1e-4)
    tensor = tensor_of(motion, "body")
    np.testing.assert_allclose(about, dp @ tensor + np.cross(p, p @ tensor), atol=1e-4)


def test_at_rest_they_are_those_of_the_axle_under_its_load(car):
    model = kintrafo.CarModel(car)
    rest = kintrafo.equilibrium(model)
    found = of_car(driving_car("test", car).assembly, np.array([rest]), np.array([rest.inputs]))
    load = float(model.signal("front_left_fz", rest))
    alone = static(car.axles["front"], {"rest": {"contact_N": [0.0, 0.0, load]}})
    for point in ("strut_top", "ball_joint", "tie_rod_outer", "arm_front"):
        here, there = (
            np.linalg.norm(each.sel(load=each["point"] == name)["force"].values, axis=-1).max()
            for each, name in ((found, f"{point}_front_left"), (alone, f"{point}_left"))
        )
        # the body has a pitch angle of some 1e-3 rad at rest, and that of an axle is level
        assert here == pytest.approx(there, abs=3e-3 * load)


def test_forces_over_a_bump_on_a_slope_move_the_body(car):
    bump = kintrafo.road_profiles.bump(0.03, 0.8, at=1.0, sides="left")
    run = drive(car, "straight", {"duration_s": 0.4}, road=bump, grade=0.05, crossfall=0.1).runs[-1]
    motion = CarInMotion(run.car.assembly, run.states, run.inputs)
    found = of_car(run.car.assembly, run.states, run.inputs)
    assert np.abs(found["holding_force"]).max() < 1e-5
    # the vertical along the road, to the left of it, and along its normal, (-0.05, -0.1, 1)
    along, normal = 0.05 / np.hypot(1.0, 0.05), (1.0 + 0.05**2 + 0.1**2) ** -0.5
    vertical = np.array([along, np.sqrt(1.0 - along**2 - normal**2), normal])
    the_body_is_balanced(motion, found, vertical)
    assert np.ptp(motion.inputs[:, motion.model.input_names.index("rear_left_road_height")]) > 0.02


def power_of_wheels(motion):
    """Return the power of the road on the wheels and of the drive torques, (n,), W."""
    bodies, total = motion.model.equations.BODIES, 0.0
    twists = motion.twists.twists
    turning = twists[:, bodies.index("body"), :3]
    for end in ("front", "rear"):
        for suffix, group in motion.axle(end).poses.items():
            name, wheel = f"{end}{suffix}", group.wheels["wheel"]
            left, up = wheel.vehicle.side * wheel.axis, motion.up
            leaning = np.cross(left, up)
            cosine = np.linalg.norm(leaning, axis=1)[:, None]
            axes = leaning / cosine, np.cross(up, leaning / cosine), up
            down = np.cross(left, axes[0])
            signals = {k: motion.signals[f"{name}_{k}"][:, None] for k in OF_TYRE}
            along = signals["fx"] * axes[0] + signals["fy"] * axes[1]
            high = signals["wheel_center_z"]
            moment = sum(signals[f"m{k}"] * axis for k, axis in zip("xyz", axes, strict=True))
            moment = moment + np.cross(high / cosine * down, along)
            lowest = (high + signals["deflection"]) / cosine * down
            moment += np.cross(lowest, signals["fz"] * up)
            own = twists[:, bodies.index(f"{name}_wheel")]
            total += ((along + signals["fz"] * up) * own[:, 3:]).sum(1) + (moment * own[:, :3]).sum(
                1
            )
            if end == "front":  # the reaction is on the body
                torque = motion.signals[f"{name}_drive_moment"]
                total += torque * ((own[:, :3] - turning) * left).sum(1)
    return total


def test_the_steering_does_the_work_that_is_missing(motion):
    """The rack adds the difference between the rate of the kinetic energy and all other power."""
    model, signals = motion.model, motion.signals
    twists, rates = motion.twists.twists, motion.twists.rates
    needed = 0.0
    spinning = model.evaluate("orientations", motion.states, motion.inputs)
    for i, name in enumerate(model.equations.BODIES):
        mass = model.parameters.get(f"{name}_mass", 0.0)
        if not mass:
            continue
        turned = motion.body.mT @ spinning[:, i]
        # a wheel has its tensor about the axis at design, another part that of the file
        tensor = turned @ tensor_of(motion, name) @ turned.mT
        w, v, dw, dv = (each[:, i, part] for each in (twists, rates) for part in
                        (slice(0, 3), slice(3, 6)))  # fmt: skip
        needed += mass * (v * (dv + G * motion.up)).sum(1) + np.einsum(
            "ni,nij,nj->n", w, tensor, dw
        )
    given = power_of_wheels(motion) + sum(
        (signals[f"{line}_spring_force"] + signals[f"{line}_damper_force"])
        * signals[f"{line}_velocity"]
        for line in LINES
    )
    given += signals["front_bar_spring_moment"] * signals["front_bar_angular_velocity"]
    force, about = air(motion)
    given += (force * of_state(motion, "uvw")).sum(1) + (about * of_state(motion, "pqr")).sum(1)
    velocity = motion.inputs[:, model.input_names.index("rack_velocity")]
    steering = rack_force(motion.assembly, motion.states, motion.inputs) * velocity
    assert np.abs(steering).max() > 10.0
    # rounding of a sum of powers of up to 1e5 W
    np.testing.assert_allclose(steering, needed - given, atol=1e-4)


def tensor_of(motion, name):
    """Return the tensor of inertia of a body about its centre of mass, kg m^2."""
    end, _, part = name.partition("_")
    if name == "body":
        return np.diag([motion.model.parameters[f"body_inertia_{axis}{axis}"] for axis in "xyz"])
    side, _, part = part.partition("_")
    group = motion.axle(end).poses[f"_{side}"]
    return group.masses()[part].tensor


def test_the_torque_turns_to_the_side_to_which_the_driver_pushes(result):
    run = result.runs[-1]
    # a car whose tyres have trail is held in a turn to the left by a torque to the left
    assert float(run.motion["steering_torque"][-1]) > 1.0
    assert abs(float(run.motion["steering_torque"][0])) < 1e-6


@pytest.mark.parametrize("name", ["twist_beam", "rigid_axle"])
def test_an_axle_without_sides_has_its_parts_in_a_car(name):
    """Positions of its parts from states by name, and names of its bodies in the car."""
    held = assembly_of(kintrafo.load(name))
    states = held.model.design_state[None] + 0.01
    inputs = np.zeros((1, len(held.model.input_names)))
    found = held.parts_with(dict(zip(held.model.state_names, states.T, strict=True)), 1)[""]
    expected = held.in_motion(states, inputs)[0][""]
    for part, center in expected.centers.items():
        np.testing.assert_array_equal(found.centers[part], center)
    rear = {k: v for k, v in kintrafo.load(name).to_dict().items() if k not in ("drive", "vehicle")}
    com = [-1300.0, 0.0, 585.8 if name == "rigid_axle" else 582.4]
    car = Car.from_dict(FILE | {"rear": rear, "body": FILE["body"] | {"com_mm": com}})
    bodies = {body.name for body in declared(car).mechanism.bodies}
    assert {f"rear_{mass.body}" for mass in found.masses().values()} <= bodies


def test_loads_of_a_car_on_beams():
    """It is steered, rolls and leaps; its pinion has no inertia, whose reaction is on the body."""
    column = {"steering_column.pinion_inertia_kg_m2": 0.0}
    assembly = assembly_of(car_on_beams().with_changes(column))
    start = assembly.running(15.0)
    # angles of some degrees, speeds of some decimetres and tenths of a radian per second
    off = np.random.default_rng(1).normal(scale=0.05, size=(3, len(start)))
    states = np.asarray(start) + off
    norm = [assembly.model.state_names.index(f"body_e{i}") for i in range(4)]
    states[:, norm] /= np.linalg.norm(states[:, norm], axis=1)[:, None]
    inputs = np.tile(start.inputs, (3, 1))
    found, motion = of_car(assembly, states, inputs), CarInMotion(assembly, states, inputs)
    assert np.abs(found["holding_force"]).max() < 1e-5
    assert found["residual_moment"].max() < 1e-5
    beam = found.sel(load=found["point"] == "shear_center_rear")
    assert np.abs(beam["force"]).max() > 1.0
    the_body_is_balanced(motion, found)


def test_peaks_are_the_greatest_of_all_outputs(loads):
    found = peaks(loads)
    sizes = np.linalg.norm(loads["force"].transpose("time", "load", "axis").values, axis=-1)
    np.testing.assert_array_equal(found["force_peak"], sizes.max(axis=0))
    first = sizes[:, 0].argmax()
    assert float(found["force_peak_time"][0]) == float(loads["time"][first])
    np.testing.assert_array_equal(found["force"][0], loads["force"].isel(load=0, time=first))


def test_a_gradient_of_the_torque_is_its_slope(car):
    near = [3.9, 4.0, 4.1]
    turns = circle(car, speed=20.0, lateral_acceleration=near).curves[""]
    torque = turns["steering_torque"].values
    slope = (torque[2] - torque[0]) / 0.2
    assert float(turns["steering_torque_gradient"][1]) == pytest.approx(slope, rel=1e-3)
    right = circle(car, speed=20.0, lateral_acceleration=near, turn="right").curves[""]
    np.testing.assert_allclose(right["steering_torque"], -torque, rtol=1e-6)


def test_a_simulation_of_the_equations_has_them_too(car, refused):
    assembly = driving_car("test", car).assembly
    start = assembly.running(15.0)
    found = kintrafo.simulate(assembly.model, (0.0, 0.1), start)
    assert np.abs(along(assembly.model, found)["holding_force"]).max() < 1e-5
    model = kintrafo.CarModel(kintrafo.load("quarter_car"))
    found = kintrafo.simulate(model, (0.0, 0.01), kintrafo.equilibrium(model))
    refused(kintrafo.InputError, lambda: along(model, found))


def test_the_command_writes_them_and_prints_the_greatest(kintrafo, tmp_path, ends):
    file = tmp_path / "short.toml"
    file.write_text(
        'manoeuvre = "braking"\nspeed_km_per_h = 20.0\nuntil_km_per_h = 18.0\n'
        "deceleration_m_per_s2 = 5.0\nstart_s = 0.05\n",
        encoding="utf-8",
    )
    code, out, _ = kintrafo("drive", "driving_car", "--manoeuvre", file, "--loads", "loads.csv")
    assert code == 0
    assert "greatest force" in out
    assert "ball_joint_front_left" in (tmp_path / "loads.csv").read_text(encoding="utf-8")
    words = ("--manoeuvre", "circle", "--loads", "loads.csv")
    ends(2, "drive", "driving_car", *words)
