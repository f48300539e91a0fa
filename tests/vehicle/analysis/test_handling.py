"""Manoeuvres: a car without kinematics against formulas, metrics against closed forms."""

import re

import numpy as np
import pytest
import xarray as xr
from cars import rail_car
from cars.driving_cars import light_car
from kintrafo import CarModel, InputError, load
from kintrafo.vehicle.analysis.handling import circle, drive, load_manoeuvre, responses, steering
from kintrafo.vehicle.analysis.handling.circle import Turns, steering_ratio
from kintrafo.vehicle.analysis.handling.driven import Sampling, driven
from kintrafo.vehicle.analysis.handling.drivers import OpenLoop, SpeedHeld
from kintrafo.vehicle.analysis.handling.manoeuvres import MANOEUVRES
from kintrafo.vehicle.analysis.handling.manoeuvres.sine_with_dwell import amplitudes_of, judge
from kintrafo.vehicle.analysis.handling.paths import Lane, Path, through
from kintrafo.vehicle.analysis.handling.responses import steering_response
from kintrafo.vehicle.analysis.handling.steady import SteadyCondition
from kintrafo.vehicle.analysis.handling.subject import driving_car
from kintrafo.vehicle.data.starter import manoeuvres

CORNERING, TRAIL = {"front": 160e3, "rear": 240e3}, 0.03  # of both wheels together


@pytest.fixture(scope="module")
def car():
    """A car that understeers, with stiff springs; slips are not smoothed at its speeds."""
    values = {}
    for end, stiffness in CORNERING.items():
        own = {"camber_stiffness": 0.0, "cornering_stiffness": 0.5 * stiffness, "vxlow": 1e-3}
        values |= {f"{end}_tyre_{name}": value for name, value in own.items()}
    for wheel in rail_car.WHEELS:
        carried = rail_car.CARRIED[wheel.partition("_")[0]]
        values |= {f"{wheel}_rate": 60e3, f"{wheel}_free": -carried / 60e3}
    return rail_car.car(**values)


def quiet(part):
    del part


def run(car, name, **changes):
    return load_manoeuvre(name, changes).run(car, quiet)


# -- steady turns ---------------------------------------------------------------------------------


def bicycle(car):
    """Lever arms of the lateral forces, which act behind the contacts, and of the wheels."""
    a, b = car.front, car.wheelbase - car.front
    return a, b, a - TRAIL, b + TRAIL


@pytest.mark.parametrize("speed", [10.0, 20.0, 40.0])
def test_gradients_are_those_of_the_bicycle_model(car, speed):
    _, b, front, rear = bicycle(car)
    # of small turns: the next term is of the second order in the acceleration
    found = circle(car, speed=speed, lateral_acceleration=[1e-4]).metrics
    assert "greatest_lateral_acceleration" not in found  # of which nothing is known here
    by_front = car.mass * rear / car.wheelbase / CORNERING["front"]
    by_rear = car.mass * front / car.wheelbase / CORNERING["rear"]
    for name in ("understeer_gradient", "understeer_gradient_of_wheels"):
        assert float(found[name]) == pytest.approx(by_front - by_rear, rel=1e-6)
    assert float(found["sideslip_gradient"]) == pytest.approx(b / speed**2 - by_rear, rel=1e-5)
    ratio = rail_car.Controls.RATIO / rail_car.TURN
    assert float(found["steering_ratio"]) == pytest.approx(ratio, rel=1e-9)
    straight = car.wheelbase / speed**2 + by_front - by_rear
    assert float(found["steering_wheel_gradient"]) == pytest.approx(ratio * straight, rel=1e-6)


def test_a_turn_of_a_car_with_linkages_is_where_its_simulation_ends():
    car = driving_car("test", CarModel(load("driving_car")))
    turns = Turns(car, SteadyCondition("speed", 20.0), -1)
    straight = turns.begin(0.0)
    turn = turns.to(-5.0)
    offset = straight.unknowns["steering_wheel"]
    course = steering.ramp(turn.unknowns["steering_wheel"] - offset, 2.0)
    motion = driven(
        car, straight.state, OpenLoop(course, offset),
        SpeedHeld(float(turn.unknowns["forward"]), turn.unknowns["drive"], 4e3, 0.3), 6.0,
        samples=Sampling(2e-3, 10),
    )  # fmt: skip
    last = motion.isel(time=-1)
    # what the slowest mode has left after 6 s
    assert float(last["yaw_rate"]) == pytest.approx(turn.unknowns["yaw_rate"], rel=1e-4)
    assert float(last["roll_angle"]) == pytest.approx(turn.unknowns["roll"], rel=1e-4)
    assert float(last["lateral_acceleration"]) == pytest.approx(-5.0, rel=1e-4)


def test_a_turn_fulfils_the_balance_of_forces(car):
    found = (
        circle(car, radius=60.0, lateral_acceleration=[6.0]).curves[""].isel(lateral_acceleration=0)
    )
    steer = found["steer"].values
    fx, fy = found["fx"].values, found["fy"].values
    across = np.sum(fy * np.cos(steer) + fx * np.sin(steer))
    along = np.sum(fx * np.cos(steer) - fy * np.sin(steer))
    beta, speed = float(found["sideslip_angle"]), float(found["travel_speed"])
    outward = car.mass * speed**2 / 60.0
    # the wheels do not roll with the body about its centre: their own points are not its
    assert across == pytest.approx(outward * np.cos(beta), rel=2e-3)
    assert along == pytest.approx(-outward * np.sin(beta), abs=2e-3 * outward)
    assert float(found["fz"].sum()) == pytest.approx(9.81 * car.mass, rel=1e-9)
    assert 1.0 / float(found["curvature"]) == pytest.approx(60.0, rel=1e-9)


def test_turns_to_both_sides_are_mirror_images_and_end_at_the_friction(car, refused):
    left, right = (circle(car, speed=25.0, step=2.0, turn=side) for side in ("left", "right"))
    for name in ("steering_wheel_angle", "sideslip_angle", "roll_angle"):
        one, other = (found.curves[""][name].values for found in (left, right))
        assert np.allclose(one, -other, rtol=1e-7, atol=1e-12)
    most = float(left.metrics["greatest_lateral_acceleration"])
    assert 8.0 < most < 9.81  # friction 1, and wheels that are loaded differently
    beyond = most + 0.2
    refused(
        InputError,
        lambda: run(car, "step_steer", lateral_acceleration_m_per_s2=beyond, speed_km_per_h=90.0),
    )


@pytest.mark.parametrize("radius", [300.0, 3000.0, 30000.0])
def test_turns_of_wide_radii_are_those_of_the_bicycle_model(car, radius):
    """Fast cars enter them from straight running in small steps."""
    _, _, front, rear = bicycle(car)
    found = circle(car, radius=radius, lateral_acceleration=[0.5]).curves[""]
    by_front, by_rear = front / CORNERING["rear"], rear / CORNERING["front"]
    gradient = car.mass / car.wheelbase * (by_rear - by_front)
    ratio = rail_car.Controls.RATIO / rail_car.TURN
    angle = ratio * (car.wheelbase / radius + 0.5 * gradient)
    # the next term is of the second order in the acceleration beside that of the friction
    assert float(found["steering_wheel_angle"][0]) == pytest.approx(angle, rel=5e-3)


def test_straight_running_by_speed_is_that_of_the_bicycle_model(car):
    found = run(car, "speed_range", from_km_per_h=40.0, to_km_per_h=300.0, step_km_per_h=20.0)
    _, _, front, rear = bicycle(car)
    by_front, by_rear = (
        car.mass * arm / car.wheelbase / CORNERING[end]
        for end, arm in (("front", rear), ("rear", front))
    )
    gradient, ratio = by_front - by_rear, rail_car.Controls.RATIO / rail_car.TURN
    curves = found.curves[""]
    speed = curves["speed"].values
    gain = speed / (car.wheelbase + gradient * speed**2) / ratio
    np.testing.assert_allclose(curves["yaw_rate_gain"], gain, rtol=1e-6)
    np.testing.assert_allclose(curves["lateral_acceleration_gain"], speed * gain, rtol=1e-6)
    np.testing.assert_allclose(curves["understeer_gradient"], gradient, rtol=1e-5)
    characteristic = float(found.metrics["characteristic_speed"])
    assert characteristic == pytest.approx(np.sqrt(car.wheelbase / gradient), rel=1e-4)


@pytest.fixture(scope="module")
def loose(car):
    """A car that oversteers, and its critical speed by the bicycle model [m/s]."""
    swapped = {"front": CORNERING["rear"], "rear": CORNERING["front"]}
    changed = {f"{end}_tyre_cornering_stiffness": 0.5 * c for end, c in swapped.items()}
    loose = rail_car.car(**(car.model.parameters | changed))
    _, _, front, rear = bicycle(loose)
    gradient = loose.mass / loose.wheelbase * (rear / swapped["front"] - front / swapped["rear"])
    return loose, np.sqrt(-loose.wheelbase / gradient)


def test_the_critical_speed_is_that_of_the_bicycle_model(loose):
    loose, critical = loose
    steps = {"from_km_per_h": 3.0 * critical, "to_km_per_h": 4.5 * critical}
    found = run(loose, "speed_range", **steps, step_km_per_h=0.5 * critical)
    assert float(found.metrics["critical_speed"]) == pytest.approx(critical, rel=1e-4)
    assert "characteristic_speed" not in found.metrics
    growth = found.curves[""]["growth"].values
    assert growth[0] < 1e-3
    assert growth[-1] > 1e-2


def test_slow_harmonic_steering_is_a_steady_turn(car):
    turns = Turns(car, SteadyCondition("speed", 20.0), 1)
    straight = turns.begin(0.0)
    found = steering_response(car, straight, np.array([1e-4]))
    slope = straight.slopes["yaw_rate"] / straight.slopes["steering_wheel"]
    # both are of first order in the frequency
    assert found["yaw_rate"][0].real == pytest.approx(slope, rel=1e-4)
    assert found["lateral_acceleration"][0].real == pytest.approx(20.0 * slope, rel=1e-4)
    assert steering_ratio(car, straight) == pytest.approx(12.5, rel=1e-9)


# -- manoeuvres -----------------------------------------------------------------------------------


def test_a_sweep_measures_what_the_linear_equations_have(car):
    found = run(car, "sine_sweep", lateral_acceleration_m_per_s2=0.1, duration_s=12.0, settle_s=2.0,
                highest_Hz=3.0, step_ms=2.0, output_step_ms=4.0)  # fmt: skip
    curves = found.curves["_response"]
    inside = curves.sel(frequency=slice(0.3, 2.7))  # the swinging has little of the ends
    for name in ("yaw_rate", "lateral_acceleration", "roll_angle"):
        gain = inside[f"{name}_gain"]
        # of the order of the amplitude squared, beside accelerations at the friction
        assert np.allclose(gain[0], gain[1], rtol=3e-3, atol=3e-3 * float(gain[1].max()))
        phase = inside[f"{name}_phase"]
        assert np.allclose(phase[0], phase[1], atol=0.01)
    assert found.curves[""].attrs["not_valid"] == []


def test_a_step_steer_ends_in_its_turn(car):
    found = run(car, "step_steer", holds_speed=True, turn="right").metrics
    # in the last half second a thousandth of the speed is missing still
    assert float(found["lateral_acceleration_steady"]) == pytest.approx(-4.0, rel=2e-3)
    turn = circle(car, speed=80 / 3.6, lateral_acceleration=[4.0], turn="right").curves[""]
    angle = float(turn["steering_wheel_angle"][0])
    assert float(found["steering_wheel_step"]) == pytest.approx(abs(angle), rel=1e-9)
    assert float(found["yaw_rate_gain"]) == pytest.approx(
        float(turn["yaw_rate"][0]) / angle, rel=1e-3
    )
    assert 0.0 < float(found["yaw_rate_response_time"]) < float(found["yaw_rate_peak_time"]) < 1.0


def test_slow_steering_finds_the_angle_of_the_turn(car):
    found = run(car, "slowly_increasing_steer").metrics
    turn = circle(car, speed=80 / 3.6, lateral_acceleration=[0.3 * 9.80665]).curves[""]
    # a line through a curve, and 0.05 s of delay at 13.5 deg/s
    angle = float(turn["steering_wheel_angle"][0])
    assert float(found["reference_angle"]) == pytest.approx(angle, rel=0.06)


@pytest.mark.parametrize(("part", "words"), [
    (0.3, None), (0.7, "lags behind the steering wheel"),
    (0.9, r"a steady turn with 0\.3 g is unstable.*lower speed"),
    (1.1, r"straight running is unstable.*above its critical speed.*lower speed"),
])  # fmt: skip
def test_slow_steering_has_no_angle_where_turns_are_not_stable(loose, part, words):
    loose, critical = loose
    speed = part * critical * 3.6
    found = run(loose, "slowly_increasing_steer", speed_km_per_h=speed, turn="right")
    assert re.search(words or "^$", "; ".join(found.not_valid))
    # it ends at the lateral acceleration, which a car that yaws quickly reaches late
    last = found.curves[""]["lateral_acceleration"].values[-1]
    assert last == pytest.approx(-5.4, rel=0.01)
    if part == 1.1:
        dwell = run(loose, "sine_with_dwell", speed_km_per_h=speed, amplitudes_deg=[1.0])
        assert any(text.startswith("slowly increasing steer: at") for text in dwell.not_valid)


def test_slow_steering_whose_tyres_slide_needs_more_friction(car, refused):
    smooth = rail_car.car(**(car.model.parameters | {"front_tyre_friction": 0.25}))
    refused(
        InputError,
        lambda: run(smooth, "slowly_increasing_steer", largest_deg=60.0, rate_deg_per_s=30.0),
    )


def test_a_driver_passes_between_the_cones(car):
    found = run(car, "double_lane_change").metrics
    assert float(found["cones_hit"]) == 0.0
    assert float(found["clearance"]) > 0.0


def test_a_driver_does_the_same_again_and_on_the_other_side(car):
    points = {"x_m": [0.0, 8.0, 16.0, 24.0, 32.0], "step_ms": 2.0, "output_step_ms": 4.0}
    left, again, right = (
        run(car, "path_following", y_m=[0.0, 0.0, side, side, 0.0], **points).curves[""]
        for side in (1.0, 1.0, -1.0)
    )
    xr.testing.assert_identical(left, again)
    assert np.allclose(right["y"], -left["y"], atol=1e-6)


@pytest.mark.parametrize(("way", "duration", "words"), [
    ([0.0, 0.0, 0.0, 0.0, 0.0], 0.5, r"after 0\.5 s the car is .* m before the end of the path"),
    ([0.0, 0.0, 30.0, 60.0, 90.0], 5.0, r"the car leaves the path: from .* Choose a lower speed"),
])  # fmt: skip
def test_a_path_that_a_car_does_not_follow_is_not_valid(car, way, duration, words):
    points = {"x_m": [0.0, 20.0, 30.0, 31.0, 32.0], "y_m": way, "duration_s": duration}
    found = run(car, "path_following", step_ms=5.0, **points).not_valid
    assert re.match(words, found[-1]), found


def test_braking_and_coasting_follow_newton(car):
    found = run(car, "braking", deceleration_m_per_s2=5.0, rise_s=0.0).metrics
    torque = 5.0 * car.mass * float(np.mean(car.radii))
    height = np.mean([*rail_car.HEIGHTS.values()])
    # the road acts at the height of the wheel centres, and turns wheels of 1 kg m^2
    expected = torque / (height * car.mass + 4.0 / 0.29)
    assert float(found["mean_deceleration"]) == pytest.approx(expected, rel=0.02)
    assert float(found["lateral_deviation"]) < 1e-9
    assert found["locked_wheels"] == 0


def test_locked_wheels_are_counted(car):
    found = run(car, "braking", speed_km_per_h=40.0, deceleration_m_per_s2=14.0).metrics
    assert found["locked_wheels"] >= 2
    assert found["mean_deceleration"] < 12.0


def test_braking_in_a_turn_begins_in_the_turn(car):
    found = run(car, "braking_in_turn", speed_km_per_h=70.0, deceleration_m_per_s2=2.0,
                until_km_per_h=50.0)  # fmt: skip
    motion = found.curves[""].sel(time=slice(0.0, 0.5))
    assert np.ptp(motion["yaw_rate"].values) < 1e-6
    speed = np.hypot(motion["speed"], motion["lateral_velocity"]).values
    assert np.allclose(speed, 70.0 / 3.6, rtol=1e-6)
    assert np.allclose(speed / motion["yaw_rate"].values, 100.0, rtol=1e-6)


def test_sine_with_dwell_judges_every_amplitude(car):
    found = run(car, "sine_with_dwell", reference_deg=20.0, amplitudes_deg=[30.0, 110.0])
    metrics = found.metrics
    assert metrics["yaw_rate_ratio_1_00"].values[0] == pytest.approx(0.0, abs=0.05)
    displaced = metrics["lateral_displacement"].values
    assert 0.0 < displaced[0] < displaced[1]
    assert float(metrics["required_displacement"]) == 1.83
    assert metrics["fulfilled"].values[0] == 1.0
    assert found.curves[""].sizes["amplitude"] == 2


def test_a_car_that_overturns_is_named(car):
    falling = rail_car.car(**(car.model.parameters | {"body_com_z": 1.4}))
    found = run(falling, "step_steer", steering_wheel_deg=300.0,
                lateral_acceleration_m_per_s2=None, duration_s=8.0)  # fmt: skip
    assert any("overturns" in text for text in found.curves[""].attrs["not_valid"])


# -- steering, metrics and paths by themselves ----------------------------------------------------


@pytest.mark.parametrize("course", [
    steering.ramp(-0.7, 3.0, start=0.2),
    steering.sine_with_dwell(0.5, 0.7, 0.5, ease=0.05),
    steering.sine_sweep(0.2, (0.3, 2.0), 5.0, start=0.1, ease=0.1),
])  # fmt: skip
def test_rate_and_acceleration_are_those_of_the_angle(course):
    time = np.linspace(-0.1, course.end + 0.2, 40001)
    found = course.at(time)
    step = time[1] - time[0]
    # differences of the second order; the acceleration jumps at the ends of the easing
    assert np.allclose(np.gradient(found.angle, step)[1:-1], found.rate[1:-1], atol=2e-3)
    assert np.abs(np.diff(found.rate)).max() <= 1.001 * step * np.abs(found.acceleration).max()
    assert np.allclose(np.cumsum(found.acceleration) * step, found.rate, atol=2e-2)
    for at in (0, -1):
        assert found.rate[at] == 0.0
        assert found.acceleration[at] == 0.0


def test_sines_have_their_amplitudes():
    course = steering.sine_with_dwell(0.5, 0.7, 0.5)
    time = np.linspace(0.0, course.end, 200001)
    angle = course.at(time).angle
    assert angle.max() == pytest.approx(0.5, rel=1e-8)
    assert angle.min() == pytest.approx(-0.5, rel=1e-12)
    assert np.sum(angle == angle.min()) * (time[1] - time[0]) == pytest.approx(0.5, abs=1e-4)
    assert course.end == pytest.approx(1.0 / 0.7 + 0.5 + 0.02)
    assert float(steering.sine_sweep(0.2, (0.3, 2.0), 5.0).at(100.0).angle) == pytest.approx(
        0.0, abs=1e-12
    )


def test_a_step_response_of_second_order():
    omega, damping, begun = 6.0, 0.4, 1.0
    time = np.linspace(0.0, 10.0, 10001)
    t = np.maximum(time - begun, 0.0)
    ringing = omega * np.sqrt(1.0 - damping**2)
    values = -3.0 * (1.0 - np.exp(-damping * omega * t) * (
        np.cos(ringing * t) + damping * omega / ringing * np.sin(ringing * t)
    ))  # fmt: skip
    found = responses.step_response(time, values, begun, 8.0)
    assert found.steady == pytest.approx(-3.0, rel=1e-6)
    assert found.peak_time == pytest.approx(np.pi / ringing, rel=1e-5)
    overshoot = np.exp(-np.pi * damping * omega / ringing)
    assert found.overshoot == pytest.approx(overshoot, rel=1e-5)
    assert np.interp(found.response_time, t, -values) == pytest.approx(2.7, rel=1e-5)
    assert np.isnan(responses.first_crossing(time, values, 1.0))


def test_a_step_response_is_that_of_the_change():
    """A car with different sides rolls before the step, to the other side than in the turn."""
    time = np.linspace(0.0, 10.0, 10001)
    values = 2.0 * (1.0 - np.exp(-np.maximum(time - 1.0, 0.0)))
    alone, moved = (responses.step_response(time, values + v, 1.0, 9.0) for v in (0.0, -1.5))
    assert moved.steady == pytest.approx(alone.steady - 1.5)
    assert moved[1:] == pytest.approx(alone[1:], nan_ok=True)
    # the steady value is a mean over the last second
    assert moved.response_time == pytest.approx(-np.log(1.0 - 0.45 * alone.steady), rel=1e-6)
    assert np.isnan(moved.peak_time)  # it rises until the end
    assert moved.drift < 1e-3 < responses.step_response(time, values, 1.0, 1.5).drift


def test_a_response_during_the_step_has_no_response_time():
    """As of the lateral acceleration at walking speed, which follows the steering rate."""
    time = np.linspace(0.0, 5.0, 5001)
    values = np.where(time < 1.0, 0.0, 1.0 + 5.0 * np.exp(-(((time - 1.2) / 0.05) ** 2)))
    found = responses.step_response(time, values, 1.4, 4.5)
    assert np.isnan(found.response_time)
    assert found.overshoot == pytest.approx(5.0, rel=1e-6)


def test_a_step_steer_that_is_not_steady_at_the_end_is_not_valid(car):
    steady, early = (
        run(car, "step_steer", duration_s=end, settled_s=0.4).curves[""].attrs["not_valid"]
        for end in (5.0, 1.0)
    )
    assert not steady
    assert any("is not steady in the last 0.4 s" in text for text in early)


def test_a_car_that_spins_has_no_valid_responses():
    """The steady turn of the step is unstable; after the sweep the car stands the other way round.

    It oversteers far above its critical speed.
    """
    cornering = {"front": 300e3, "rear": 110e3}
    values = {f"{end}_tyre_cornering_stiffness": 0.5 * v for end, v in cornering.items()}
    spun = rail_car.car(**values)
    how = {"lateral_acceleration_m_per_s2": 1.0, "speed_km_per_h": 150.0, "duration_s": 5.0}
    step, sweep = (
        run(spun, name, **how).curves[""].attrs["not_valid"]
        for name in ("step_steer", "sine_sweep")
    )
    for found in (step, sweep):
        assert any(re.match("at 150 km/h straight running is unstable.*lower", t) for t in found)
    assert any("turns to the other side than left" in text for text in step)
    assert not any("duration_s" in text for text in step)
    assert any("the sideslip angle is 100 %" in text for text in sweep)


@pytest.mark.parametrize(("name", "part", "unstable"), [
    ("braking_in_turn", 0.4, False), ("braking_in_turn", 1.2, True), ("braking", 1.2, False),
])  # fmt: skip
def test_an_unstable_car_leaves_its_path_with_a_held_steering_wheel(loose, name, part, unstable):
    """On a straight level road nothing disturbs it."""
    loose, critical = loose
    speed = part * critical * 3.6
    how = {"speed_km_per_h": speed, "deceleration_m_per_s2": 2.0, "until_km_per_h": 0.9 * speed}
    if name == "braking_in_turn":
        how["radius_m"] = (part * critical) ** 2 / 2.0
    found = run(loose, name, **how).not_valid
    assert any("at the beginning is unstable" in text for text in found) == unstable


def test_a_sweep_that_ends_early_is_not_valid(car):
    found = run(car, "sine_sweep", duration_s=3.0, settle_s=0.01).curves[""].attrs["not_valid"]
    assert any("Raise settle_s" in text for text in found)


def test_a_frequency_response_of_first_order():
    time = np.linspace(0.0, 30.0, 30001)
    cause = np.exp(-((time - 5.0) ** 2))
    effect = np.zeros_like(cause)
    for i in range(time.size - 1):  # the trapezoidal rule, whose error is of the second order
        h = time[i + 1] - time[i]
        drive = 0.5 * h * (cause[i] + cause[i + 1])
        effect[i + 1] = ((1.0 - 0.5 * h) * effect[i] + drive) / (1.0 + 0.5 * h)
    frequency = np.array([0.05, 0.2, 0.4])
    found = responses.frequency_response(time, cause, effect, frequency)
    assert np.allclose(found, 1.0 / (1.0 + 2j * np.pi * frequency), rtol=1e-6)


def test_offsets_from_a_circle_are_radii():
    angle = np.linspace(0.0, 1.5, 40)
    path = Path(50.0 * np.array([np.sin(angle), 1.0 - np.cos(angle)]).T)
    at = np.linspace(0.2, 1.3, 7)
    for radius in (48.0, 50.0, 53.0):
        x, y = radius * np.sin(at), 50.0 - radius * np.cos(at)
        # positive to the left, where the centre is; a spline through points 2 m apart
        assert np.allclose(path.offsets(x, y), 50.0 - radius, atol=1e-5)


def test_a_path_keeps_to_the_middle_of_its_lanes():
    lanes = [Lane(0.0, 15.0, -1.0, 1.0), Lane(45.0, 70.0, 2.5, 4.9)]
    path = through(lanes, before=10.0, after=5.0)
    for lane in lanes:
        x = np.linspace(lane.start + 1.0, lane.end - 1.0, 9)
        # a spline through points 0.5 m apart
        assert np.abs(path.offsets(x, np.full(x.size, lane.center))).max() < 1e-3


@pytest.mark.parametrize(("reference", "last", "count"), [
    (30.0, 270.0, 16), (45.0, 292.5, 11), (50.0, 300.0, 10),
])  # fmt: skip
def test_amplitudes_end_by_the_standard(reference, last, count):
    found = amplitudes_of(reference)
    assert found[0] == 1.5 * reference
    assert found[-1] == last
    assert len(found) == count
    assert np.allclose(np.diff(found[:-1]), 0.5 * reference)


def test_a_run_is_judged_at_the_times_of_the_standard():
    course = steering.sine_with_dwell(1.0, 0.7, 0.5, ease=0.02)
    time = np.linspace(0.0, course.end + 2.0, 20001)
    late = np.maximum(time - 1.2, 0.0)
    yaw = np.where(time < 0.7, 0.3, -late * np.exp(-2.0 * late))
    angle = course.at(time).angle
    motion = xr.Dataset({
        "steering_wheel_angle": ("time", angle), "yaw_rate": ("time", yaw), "y": ("time", 2 * time),
        "sideslip_angle": ("time", 0 * time), "fz": ("time", 1 + 0 * time),
    }, {"time": time})  # fmt: skip
    found = judge(motion, course, 1)
    peak = 0.5 * np.exp(-1.0)
    assert found["yaw_rate_peak"] == pytest.approx(peak, rel=1e-6)
    for after, key in ((1.0, "1_00"), (1.75, "1_75")):
        t = course.end + after - 1.2
        expected = t * np.exp(-2.0 * t) / peak
        assert found[f"yaw_rate_ratio_{key}"] == pytest.approx(expected, rel=1e-5)
    beginning = np.interp(np.deg2rad(5.0), angle[:2000], time[:2000])
    assert found["lateral_displacement"] == pytest.approx(2.0 * (beginning + 1.07), rel=1e-6)


@pytest.mark.parametrize(("rate", "ratio"), [
    (-1.0, np.nan),  # turns on to the left: there is no peak to the right, and no limit is kept
    (0.3, -0.3 / 0.5),  # swings back beyond zero: the ratio has the sign of the yaw rates
])  # fmt: skip
def test_the_peak_of_the_yaw_rate_is_one_of_the_way_back(rate, ratio):
    course = steering.sine_with_dwell(1.0, 0.7, 0.5)
    time = np.linspace(0.0, course.end + 2.0, 4001)
    back = np.interp(time, [0.0, 0.8, 1.0, course.end, course.end + 0.5], [0, 0, 0.5, 0, -0.3])
    yaw = -back if rate > 0.0 else 0.0 * time - rate
    motion = xr.Dataset({
        "steering_wheel_angle": ("time", course.at(time).angle), "yaw_rate": ("time", yaw),
        "y": ("time", time), "sideslip_angle": ("time", 0 * time), "fz": ("time", 1 + 0 * time),
    }, {"time": time})  # fmt: skip
    found = judge(motion, course, 1)
    assert found["yaw_rate_ratio_1_00"] == pytest.approx(ratio, rel=1e-3, nan_ok=True)
    judged = load_manoeuvre("sine_with_dwell")._judged([found], np.array([30.0]), 20.0, 1500.0)
    assert float(judged["fulfilled"][0]) == (0.0 if np.isnan(ratio) else 1.0)


# -- files ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", manoeuvres())
def test_a_packaged_manoeuvre_has_all_keys_with_a_comment(name):
    text = manoeuvres()[name].read_text(encoding="utf-8")
    model = load_manoeuvre(name)
    for key, field in type(model).model_fields.items():
        assert field.description
        assert re.search(rf"^#? ?\[?{key}\b|\[{key}\.|# .*\b{key}\b|or {key}\b", text, re.MULTILINE)
    assert {*MANOEUVRES} >= {model.manoeuvre}


def test_a_mistake_in_a_manoeuvre_is_named(refused):
    for name, changes in (
        ("step_steer", {"speed_km_per_h": 0.0}),
        ("braking", {"turn": "left"}),
        ("step_steer", {"sped": 1.0}),
        ("step_steer", {"steering_wheel_deg": 10.0}),
        ("step_steer", {"duration_s": 0.6}),
        ("step_steer", {"output_step_ms": 1.5}),
        ("step_steer", {"manoeuvre": "step_ster"}),
        ("step_steer", {"manoeuvre": None}),
        ("constant_speed_circle", {"speed_km_per_h": 0.0}),
        ("circle", {"radius_m": None}),
        ("circle", {"step_m_per_s2": 100.0}),
        ("circle", {"step_m_per_s2": 1e-9}),
        ("double_lane_change", {"lanes": {}}),
        ("double_lane_change", {"lanes.second.start_m": 2.0}),
        ("double_lane_change", {"lanes.second.width_of_car": 0.5}),
        ("path_following", {"x_m": [], "y_m": []}),
        ("path_following", {"x_m": [0.0]}),
        ("braking", {"pedal": 0.3}),
        ("braking", {"deceleration_m_per_s2": None, "pedal": 1.5}),
        ("braking", {"until_km_per_h": 120.0}),
        ("braking_in_turn", {"until_km_per_h": 80.0}),
        ("acceleration", {"until_km_per_h": 5.0}),
        ("sine_with_dwell", {"amplitudes_deg": [30.0, -1.0]}),
        ("braking", {"pedal": -1.0}),
        ("sine_sweep", {"highest_Hz": 0.1}),
        ("sine_sweep", {"output_step_ms": 50.0}),
    ):
        with refused(InputError):
            load_manoeuvre(name, changes)


def test_what_a_car_cannot_do_is_named(car, refused):
    for name, changes in (
        ("braking", {"deceleration_m_per_s2": 50.0}),
        ("braking", {"duration_s": 1.0}),
        ("braking_in_turn", {"radius_m": 20.0}),
        ("coast_down", {"duration_s": 0.5}),
        ("acceleration", {"duration_s": 0.5}),
        ("slowly_increasing_steer", {"largest_deg": 10.0}),
        ("slowly_increasing_steer", {"rate_deg_per_s": 400.0, "output_step_ms": 200.0}),
    ):
        with refused(InputError):
            run(car, name, **changes)


def test_a_car_is_checked_before_its_equations_are_derived(refused):
    for name, changes, of_car in (
        ("double_lane_change", {"car_width_mm": 1500.0}, {}),
        ("obstacle_avoidance", {"car_length_mm": 3000.0}, {}),
        ("braking", {}, {"brakes": None}),
        ("coast_down", {}, {"front.drive": None}),
        ("circle", {}, {"front.side.rack.travel_per_turn_mm": None}),
    ):
        model = load_manoeuvre(name, changes)
        with refused(InputError):
            drive(light_car(**of_car), model)  # whose equations take half a minute
