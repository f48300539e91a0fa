"""Cars with a steering column that twists: against formulas, balances of loads, a rigid column."""

import kintrafo
import numpy as np
import pytest
from cars import rail_car
from cars.driving_cars import COLUMN, FILE, car_on_beams, light_car
from kintrafo import variation
from kintrafo.vehicle.analysis.handling import circle, drive
from kintrafo.vehicle.analysis.handling.circle import Turns
from kintrafo.vehicle.analysis.handling.responses import steering_response
from kintrafo.vehicle.analysis.handling.steady import SteadyCondition
from kintrafo.vehicle.analysis.handling.subject import driving_car
from kintrafo.vehicle.analysis.loads.on_a_car import rack_force
from kintrafo.vehicle.assembly.controls import Controls
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.models.car import Car
from kintrafo.vehicle.models.car.car import masses
from kintrafo.vehicle.models.car.equations import declared, name_of

STIFFNESS = COLUMN["stiffness_Nm_per_deg"]
TRAVEL = 0.05 / (2.0 * np.pi)  # of the rack [m/rad]
INERTIA = COLUMN["pinion_inertia_kg_m2"]


def with_column(**changes):
    return light_car(steering_column=COLUMN | changes)


# -- a car without kinematics ---------------------------------------------------------------------

CORNERING, TRAIL, RATE = {"front": 160e3, "rear": 240e3}, 0.03, 150.0
PINION, PINION_TURN = 0.02, rail_car.Controls.RATIO


@pytest.fixture(scope="module")
def railed():
    values = {"column_rate": RATE, "pinion_turn": PINION_TURN, "pinion_inertia_spin": PINION}
    for end, stiffness in CORNERING.items():
        own = {"camber_stiffness": 0.0, "cornering_stiffness": 0.5 * stiffness, "vxlow": 1e-3}
        values |= {f"{end}_tyre_{name}": value for name, value in own.items()}
    return rail_car.car(column=True, **values)


def in_the_air(car):
    """Return a state in which the tyres do not touch the road."""
    state = car.model.design_state.copy()
    state[car.model.state_names.index("body_z")] = 1.0
    return state


@pytest.mark.parametrize("speed", [10.0, 40.0])
def test_gradients_are_those_of_a_bicycle_with_steering_compliance(railed, speed):
    """The column softens the front tyres: their slip angle is F/C, and F trail/k is added."""
    metrics = circle(railed, speed=speed, lateral_acceleration=[1e-4]).metrics
    base, mass = railed.wheelbase, railed.mass
    by_front = mass * (base - railed.front + TRAIL) / base
    by_rear = mass * (railed.front - TRAIL) / base
    ratio = PINION_TURN / rail_car.TURN
    softened = 1.0 / CORNERING["front"] + TRAIL / (RATE * ratio**2)
    expected = by_front * softened - by_rear / CORNERING["rear"]
    assert float(metrics["understeer_gradient"]) == pytest.approx(expected, rel=1e-6)
    assert float(metrics["steering_ratio"]) == pytest.approx(ratio, rel=1e-9)
    of_wheels = by_front / CORNERING["front"] - by_rear / CORNERING["rear"]
    assert float(metrics["understeer_gradient_of_wheels"]) == pytest.approx(of_wheels, rel=1e-6)


def test_slow_harmonic_steering_is_a_steady_turn(railed):
    straight = Turns(railed, SteadyCondition("speed", 20.0), 1).begin(0.0)
    found = steering_response(railed, straight, np.array([1e-4]))
    slope = straight.slopes["yaw_rate"] / straight.slopes["steering_wheel"]
    # both are of first order in the frequency
    assert found["yaw_rate"][0].real == pytest.approx(slope, rel=1e-4)


def test_the_frequency_of_the_free_rack_is_that_of_one_mass(railed):
    """In the air; the yaw of the body takes a part of the moment of momentum."""
    model, state = railed.model, in_the_air(railed)
    centers = [[x, y] for x in (rail_car.FRONT, rail_car.REAR) for y in (0.75, -0.75)]
    masses = np.array([rail_car.MASS, *4 * [rail_car.CARRIER + rail_car.WHEEL]])
    places = np.array([[0.0, 0.0], *centers])
    apart = places - masses @ places / masses.sum()
    yawing = 1700.0 + 4 * (0.4 + 0.6) + PINION + masses @ (apart**2).sum(axis=1)
    turned = 2 * 0.6 * rail_car.TURN + PINION * PINION_TURN
    mass = 2 * 0.6 * rail_car.TURN**2 + PINION * PINION_TURN**2 - turned**2 / yawing
    found = np.abs(model.eigenvalues(state, np.zeros(len(model.input_names))).imag)
    expected = PINION_TURN * np.sqrt(RATE / mass)
    assert np.abs(found - expected).min() == pytest.approx(0.0, abs=1e-6 * expected)


def test_slow_steering_loses_what_friction_takes(railed):
    """Friction times the travel of the rack, which rests while the twist of the column reverses."""
    friction, amplitude, period = 200.0, 0.02, 4.0
    changes = {"rack_friction": friction, "rack_friction_speed": 1e-4, "gravity": 0.0}
    model = kintrafo.System(railed.model.equations, railed.model.parameters | changes)
    times, omega = np.linspace(0.0, 2.0 * period, 1601), 2.0 * np.pi / period
    positions = amplitude * (1.0 - np.cos(omega * times))
    found = kintrafo.simulate(
        model, (0.0, 2.0 * period), in_the_air(railed), method="BDF", t_eval=times,
        inputs={"rack_position": (times, positions)}, rtol=1e-6, atol=1e-8,
    )  # fmt: skip
    force = model.signal("column_spring_moment", found.y.T, found.inputs) * PINION_TURN
    velocity = found.inputs[:, model.input_names.index("rack_velocity")]
    cycle = times >= period
    work = np.trapezoid((force * velocity)[cycle], times[cycle])
    rests = 2.0 * friction / (RATE * PINION_TURN**2)
    # the rack is braked over some 0.1 mm of 40 mm, and the body turns a little
    assert work == pytest.approx(2.0 * friction * (2.0 * amplitude - rests), rel=3e-3)


# -- a car with linkages --------------------------------------------------------------------------


@pytest.fixture(scope="module")
def column():
    return with_column()


def test_a_steady_turn_twists_the_column_by_its_torque(column):
    """By the balance of all parts; the angle of the steering wheel is that of a rigid column."""
    accelerations = [1.0, 4.0]
    soft, rigid = (
        circle(car, speed=20.0, lateral_acceleration=accelerations) for car in (column, light_car())
    )
    here, there = soft.curves[""], rigid.curves[""]
    rate = STIFFNESS / np.deg2rad(1.0)
    # the torque of the rigid column is that of the loads on the rack
    for name, rel in (("steering_torque", 1e-8), ("steer_angle", 1e-8), ("fy", 1e-8)):
        np.testing.assert_allclose(here[name], there[name], rtol=rel)
    np.testing.assert_allclose(here["column_twist"], there["steering_torque"] / rate, rtol=1e-8)
    added = here["steering_wheel_angle"] - there["steering_wheel_angle"]
    np.testing.assert_allclose(added, here["column_twist"], rtol=1e-6)
    ratio = float(rigid.metrics["steering_ratio"])
    assert float(soft.metrics["steering_ratio"]) == pytest.approx(ratio, rel=1e-9)
    more = float(soft.metrics["understeer_gradient"] - rigid.metrics["understeer_gradient"])
    gradient = float(rigid.metrics["steering_torque_gradient"])
    assert more == pytest.approx(gradient / rate / ratio, rel=1e-5)


def test_studies_vary_the_stiffness(column):
    """The twist is torque by stiffness, at a torque that does not depend on it."""
    key, names = "steering_column.stiffness_Nm_per_deg", ["column_twist", "steering_torque"]
    over = {"over": "lateral_acceleration", "positions": [3.0]}
    slope = variation.sensitivity(column, [key], **over, names=names).squeeze()
    turn = circle(column, speed=100.0 / 3.6, lateral_acceleration=[3.0]).curves[""]
    rate = STIFFNESS / np.deg2rad(1.0)
    # differences of fourth order of turns that are solved to rounding
    assert float(slope["column_twist"]) == pytest.approx(
        -float(turn["steering_torque"][0]) / rate**2, rel=1e-6
    )
    assert float(slope["steering_torque"]) == pytest.approx(0.0, abs=1e-9)


def test_a_stiff_column_is_a_rigid_one():
    """Accelerations in a step steer differ in inverse proportion to the stiffness."""
    changes = {"duration_s": 1.5, "step_ms": 2.0, "output_step_ms": 4.0}
    light = {"friction_Nm": 0.0, "rack_friction_N": 0.0, "pinion_inertia_kg_m2": 0.0}
    rigid = drive(light_car(), "step_steer", changes).metrics
    errors = [
        float(
            drive(with_column(stiffness_Nm_per_deg=k, **light), "step_steer", changes).metrics[
                "yaw_rate_gain"
            ]
            - rigid["yaw_rate_gain"]
        )
        for k in (30.0, 300.0)
    ]
    assert errors[0] == pytest.approx(10.0 * errors[1], rel=0.05)
    assert abs(errors[1]) < 1e-3 * float(rigid["yaw_rate_gain"])


def test_forces_on_the_rack_are_those_of_the_loads(column):
    """In a step steer; the balance of all parts has the rack without its drive."""
    result = drive(column, "step_steer", {"duration_s": 1.5})
    run = result.runs[-1]
    model = run.car.model
    names, signals = model.state_names, model.signals(run.states, run.inputs)
    rates = model.evaluate("rhs", run.states, run.inputs)
    turning = rates[:, names.index("front_beta9_rate")] / TRAVEL + rates[:, names.index("body_r")]
    moment = signals["front_column_spring_moment"] + signals["front_column_damper_moment"]
    expected = (moment - INERTIA * turning) / TRAVEL + signals["front_rack_friction_force"]
    found = rack_force(run.car.assembly, run.states, run.inputs)
    assert np.abs(found).max() > 200.0
    np.testing.assert_allclose(found, expected, atol=1e-6)
    assert np.abs(kintrafo.handling.dynamic_loads(result)["holding_force"]).max() < 1e-6
    # the friction of the column is at the steering wheel, which moves to the left
    velocity = run.inputs[:, model.input_names.index("rack_velocity")]
    smoothed = velocity / np.hypot(velocity, 0.005)
    torque = run.motion["steering_torque"].values
    np.testing.assert_allclose(torque, -(moment + 0.5 * smoothed), atol=1e-12)


def test_a_rack_of_either_sense_is_the_same_steering(column):
    """But for the inertia of the pinion, which turns about one axis in the sense of the rack."""
    rack = column.axles["front"].right.rack.axis
    other = column.with_changes({"front.side.rack.axis": [-each for each in rack]})
    assert (
        Controls(other).rack(1.0)["rack_position"] == -Controls(column).rack(1.0)["rack_position"]
    )
    here, there = (
        circle(car, speed=20.0, lateral_acceleration=[4.0]).curves[""] for car in (column, other)
    )
    for name in ("steering_torque", "column_twist", "steering_wheel_angle", "yaw_rate"):
        np.testing.assert_allclose(there[name], here[name], rtol=1e-8)
    changes = {"duration_s": 1.1, "step_ms": 2.0, "output_step_ms": 4.0}
    here, there = (drive(car, "step_steer", changes).curves[""] for car in (column, other))
    yaw = np.gradient(here["yaw_rate"].values, here["time"].values)
    torque = 2.0 * INERTIA * np.abs(yaw).max()
    assert 1e-3 < torque < 0.02
    assert np.abs(here["steering_torque"]).max() > 1.0
    for name, most in (
        ("steering_torque", torque),
        ("column_twist", torque * np.deg2rad(1.0) / STIFFNESS),
        ("yaw_rate", 1e-4),
    ):
        assert np.abs(there[name] - here[name]).max() < 1.5 * most


def test_a_parked_rack_rests_where_the_steering_turns_back(column):
    changes = {"largest_deg": 180.0, "step_deg": 30.0}
    found = drive(column, "parking", changes).curves[""]
    rigid = drive(light_car(), "parking", changes).curves[""]
    angle, torque = (found[name].values for name in ("steering_wheel_angle", "steering_torque"))
    rack, wheel = 100.0 * TRAVEL, 0.5
    turns = np.flatnonzero(np.diff(found["steer"].values[0]) == 0.0)
    assert turns.tolist() == [6, 19]
    assert torque[turns] - torque[turns + 1] == pytest.approx(
        2.0 * (rack + wheel) * np.array([1.0, -1.0])
    )
    # the rack is where the pinion is, and there torques are those of a rigid column
    towards = np.sign(found["steering_friction_torque"].values)
    pinion = angle - (torque - wheel * towards) * np.deg2rad(1.0) / STIFFNESS
    kept = np.delete(np.arange(angle.size), turns + 1)
    assert np.degrees(pinion[kept]) == pytest.approx(
        np.degrees(rigid["steering_wheel_angle"].values), abs=3.0
    )
    held = np.interp(pinion[:7], rigid["steering_wheel_angle"][:7], rigid["lifting_torque"][:7])
    assert found["lifting_torque"].values[:7] == pytest.approx(held, abs=0.02)


def test_a_car_at_rest_has_its_rack_in_the_middle(column):
    model = kintrafo.CarModel(column)
    rest = kintrafo.equilibrium(model)
    assembly = assembly_of(model)
    row = model.state_names.index("front_beta9")
    assert abs(np.asarray(rest)[row]) < 1e-9
    assert "front_beta9" in assembly.coordinates
    moved = kintrafo.equilibrium(model, rack_position=0.02)
    # springs and weight turn it back by the compliance of the column
    assert 0.0 < 0.02 - np.asarray(moved)[row] < 5e-4
    # a small force of an assistance moves the rack against the column, and a little lifts the car
    helped = kintrafo.equilibrium(model, inputs={"front_rack_force": 10.0})
    alone = 10.0 * TRAVEL**2 / (STIFFNESS / np.deg2rad(1.0))
    assert np.asarray(helped)[row] == pytest.approx(alone, rel=0.05)
    assert assembly.without_friction().car.column.rack_friction_N == 0.0


# -- files ----------------------------------------------------------------------------------------


def test_values_of_a_column_are_checked(refused):
    for changes in (
        {"stiffness_Nm_per_deg": 0.0},
        {"stiffness_Nm_per_deg": 1e6},
        {"stiffness_Nm_per_deg": None},
        {"damping_Nm_s_per_deg": -1.0},
        {"rack_friction_N": -1.0},
        {"friction_Nm": -1.0},
        {"pinion_inertia_kg_m2": -1.0},
        {"friction_velocity_m_per_s": 1e-5},
        {"colour": "black"},
    ):
        own = {name: value for name, value in (COLUMN | changes).items() if value is not None}
        with refused(kintrafo.InputError):
            Car.from_dict(FILE | {"steering_column": own})


def on_arms():
    arm = kintrafo.load("trailing_arm_car").with_changes({"vehicle.end": "front"})
    return {"axle": "front", "side": arm, "drive": {"share": 1.0}}


def without_ratio():
    return kintrafo.load("reference_car").with_changes({"rack.travel_per_turn_mm": None})


def test_a_column_needs_a_rack_and_its_ratio(refused):
    for front in (
        on_arms(),
        FILE["front"] | {"steering": {"angle_deg": [-90, 0, 90], "rack_mm": [12, 0, -12]}},
        FILE["front"] | {"side": without_ratio()},
    ):
        with refused(kintrafo.InputError):
            Car.from_dict(FILE | {"front": front, "steering_column": COLUMN})


def test_other_cars_have_no_column():
    """A car that does not travel holds its rack; without the section equations are as before."""
    assert [name_of(car).count("column") for car in (light_car(), with_column())] == [0, 1]
    assert "[steering_column]" in with_column().with_changes({"car": "roll"}).unused
    assert Car.from_dict(with_column().to_dict()).to_dict() == with_column().to_dict()


def test_a_drag_link_has_a_column():
    car = car_on_beams()
    found, state = declared(car), assembly_of(car).rack_state
    assert "front_rack_guide" in {joint.name for joint in found.independent}
    assert [joint.name for joint in found.prescribed] == ["front_wheel_guide"]
    assert state in {coordinate.name for coordinate in found.mechanism.coordinates}


def test_a_car_on_beams_rests_runs_straight_and_turns_by_its_column():
    """Loads carry the weight; the balance of all parts has the torque of the twisted column."""
    assembly = assembly_of(kintrafo.CarModel(car_on_beams()))
    model, car = assembly.model, assembly.car
    weight = 9.81 * sum(mass for mass, _ in masses(car))
    assert float(kintrafo.ride.at_rest(assembly)["load"].sum()) == pytest.approx(weight, rel=1e-9)
    start = assembly.running(20.0)
    assert np.abs(model.evaluate("rhs", start)[model.layout.positions :]).max() < 1e-8
    turns = Turns(driving_car("test", assembly), SteadyCondition("speed", 20.0), 1)
    turns.begin(0.0)
    turn = turns.to(3.0)
    states, inputs = turn.state[None], turn.inputs[None]
    signals = model.signals(states, inputs)
    moment = float(signals["front_column_spring_moment"][0])
    (force,) = rack_force(assembly, states, inputs)
    travel = car.axles["front"].steering_gear.travel_per_turn() / (2.0 * np.pi)
    assert force * travel == pytest.approx(moment, rel=1e-8)
    assert abs(moment) > 1.0
    twist = float(signals["front_column_angle"][0])
    assert -twist * STIFFNESS / np.deg2rad(1.0) == pytest.approx(moment, rel=1e-12)
    # the centripetal force of 3 m/s^2
    across = sum(
        float(signals[f"{w}_fy"][0] * np.cos(steer) + signals[f"{w}_fx"][0] * np.sin(steer))
        for w in car.wheels
        for steer in [float(signals[f"{w}_steer"][0])]
    )
    assert across == pytest.approx(3.0 * weight / 9.81, rel=5e-3)


def test_a_missing_ratio_is_one_of_the_file_that_lacks_it(refused):
    """An axle without sides has one file, and no curve of its steering."""
    beam = car_on_beams().with_changes(
        {"steering_column": None, "front.pitman_arm.gear_ratio": None}
    )
    sided = light_car(**{"front.side.rack.travel_per_turn_mm": None})
    for car in (beam, sided):
        with refused(kintrafo.InputError):
            Controls(car).rack(0.1)


def test_a_pitman_arm_has_a_column():
    car = kintrafo.load("fed_alpha").with_changes({"car": "full", "steering_column": COLUMN})
    found = declared(car)
    assert "front_rack_guide" in {joint.name for joint in found.independent}
    assert [joint.name for joint in found.prescribed] == ["front_wheel_guide"]
