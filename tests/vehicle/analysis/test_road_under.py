"""A car on a road with heights or a slope, against heights over time and balances of forces."""

import re
from dataclasses import replace

import numpy as np
import pytest
from cars.driving_cars import light_car
from kintrafo import CarModel, InputError, SimulationError, road_profiles, simulate
from kintrafo.simulation import stepper
from kintrafo.vehicle.analysis.handling import drive
from kintrafo.vehicle.analysis.handling.circle import Turns
from kintrafo.vehicle.analysis.handling.driven import driven
from kintrafo.vehicle.analysis.handling.drivers import Fixed, HeldTorque
from kintrafo.vehicle.analysis.handling.road_under import RoadUnder
from kintrafo.vehicle.analysis.handling.steady import NoSteadyMotionError
from kintrafo.vehicle.analysis.handling.subject import driving_car
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.models.car.car import center_of_gravity
from kintrafo.vehicle.models.car.slope import Slope
from kintrafo.vehicle.models.sides import SIDES

SPEED, WHEELBASE = 20.0, 2.6


@pytest.fixture(scope="module")
def model():
    return CarModel(light_car())


def test_heights_by_distance_are_those_over_time_at_constant_speed(model):
    """`kintrafo.simulate` has the heights as splines of time, and its own steps."""
    road = road_profiles.bump(0.03, 1.0, at=2.0, end=40.0, sides="left")
    car = driving_car("test", model)
    start = car.assembly.running(SPEED)
    inputs = dict(zip(model.input_names, start.inputs.tolist(), strict=True))
    torque = inputs["front_left_drive_torque"] + inputs["front_right_drive_torque"]
    angle = inputs["rack_position"] / float(car.controls.rack(1.0, 0.0)["rack_position"])
    found = driven(
        replace(car, road=road), np.asarray(start), Fixed(angle), HeldTorque(torque, torque), 0.6
    )
    behind = {"front": 0.0, "rear": WHEELBASE}
    heights = {
        f"{wheel}_road_height": road.over_time(side, SPEED, behind[end], 0.6)
        for wheel in car.wheels
        for end, side in [wheel.split("_")]
    }
    other = simulate(
        model, (0.0, 0.6), start, inputs=heights, t_eval=found["time"].values,
        method="DormandPrince", rtol=1e-8, atol=1e-10,
    )  # fmt: skip
    for wheel in car.wheels:
        load = other.signals[f"{wheel}_fz"]
        # chords of 20 mm on a bump of 1 m, and 1 mm of distance as the bump slows the car
        assert np.abs(found["fz"].sel(wheel=wheel) - load).max() < 5e-3 * np.ptp(load)
    assert np.ptp(other.signals["rear_left_fz"]) > 2000.0


def test_the_wheels_of_a_car_that_drives_have_the_radius_of_its_tyres():
    """For the cams of a tyre on a kerb; the files of the axles have another radius."""
    car = light_car()
    assert list(assembly_of(car).tyre_radii) == [car.tyre(one).radius for one in car.wheels]
    riding = assembly_of(car.with_changes({"car": "roll"}))
    assert riding.tyre_radii != assembly_of(car).tyre_radii


def test_a_wheel_is_on_the_road_at_its_own_distance(model):
    """In braking: the distance is the integral of the speed, and rear wheels are behind."""
    road = road_profiles.Road(0.5, 0.02 * np.sin(np.arange(80.0)), 0.01 * np.cos(np.arange(80.0)))
    changes = {
        "speed_km_per_h": 50.0,
        "deceleration_m_per_s2": 6.0,
        "step_ms": 2.0,
        "output_step_ms": 2.0,
    }
    found = drive(model, "braking", changes, road=road).curves[""]
    way = found["x"].values - found["x"].values[0]
    for wheel, back in {"front_left": 0.0, "front_right": 0.0, "rear_left": WHEELBASE}.items():
        track = road.over_distance(wheel.rpartition("_")[2])
        # the right track begins 10 mm above level: the car begins before the road
        wanted = track(np.clip(way - road.lead - back, track.x[0], track.x[-1]))
        assert np.abs(found["road"].sel(wheel=wheel) - wanted).max() < 1e-4
    assert way[-1] > 15.0
    assert found.attrs["title"].endswith("a road of given heights")


@pytest.mark.parametrize("spacing", [0.3, 8.0])
def test_a_car_begins_on_the_level_at_any_altitude(spacing):
    left, right = 0.01 * np.cos(np.arange(6.0)), np.full(6, -0.01)
    tracks = [road_profiles.Road(spacing, left + height, right + height) for height in (0.0, 812.5)]
    for side, first in (("left", 0.01), ("right", -0.01)):
        low, high = (road.over_distance(side) for road in tracks)
        assert low(-tracks[0].lead) == pytest.approx(0.0, abs=1e-15)
        assert low(0.0) == pytest.approx(first, abs=1e-15)
        every = np.linspace(low.x[0], low.x[-1], 50)
        assert high(every) == pytest.approx(low(every), abs=1e-11)  # rounding of 812.5 m
    level = road_profiles.Road(spacing, left + 812.5, left + 812.5)
    assert level.lead == 0.0


def test_a_car_that_rolls_back_returns_over_its_road():
    """Uphill without a drive, and a spin, in which the car goes on backward."""
    names = [f"front_{side}_road_{kind}" for side in SIDES for kind in ("height", "velocity")]
    road = road_profiles.sine(0.02, 8.0, end=60.0)
    wheels = [f"front_{side}" for side in SIDES]
    track, step = road.over_distance("left"), 0.01
    times = step * np.arange(400)
    angle = 2.0 * times  # of the velocity to the heading
    for velocities, places in (
        ([(4.0 - 2.0 * t, 0.0) for t in times], 4.0 * times - times**2),
        ([(4.0 * np.cos(a), 4.0 * np.sin(a)) for a in angle], 4.0 * times),
    ):
        under, inputs = RoadUnder(road, wheels, [0.0, 0.0], names), np.zeros(4)
        heights = []
        for velocity in velocities:
            under.advance(inputs, velocity, step)
            heights.append(inputs[0])
        # the height of a sample is that expected at the sample before: 0.1 mm at 4 m/s
        assert np.abs(heights - track(places)).max() < 1e-4


def test_a_road_is_refused_where_nothing_is_simulated(model, refused):
    road = road_profiles.bump(0.03, 1.0)
    refused(
        InputError,
        lambda: drive(model, "circle", road=road),
        lambda: drive(model, "straight", road="C"),
    )


@pytest.mark.parametrize(("grade", "crossfall"), [(0.08, 0.0), (-0.03, 0.05)])
def test_tyres_carry_the_weight_on_a_slope(model, grade, crossfall):
    changes = {"speed_km_per_h": 60.0, "duration_s": 0.5}
    found = drive(model, "straight", changes, grade=grade, crossfall=crossfall)
    ((run,), motion) = found.runs, found.curves[""]
    weight = driving_car("test", model).mass * 9.81
    # the world's vertical in axes along the slope: its normal is along (-grade, -crossfall, 1)
    sine, normal = grade / np.hypot(1.0, grade), (1.0 + grade**2 + crossfall**2) ** -0.5
    left = np.sign(crossfall) * np.sqrt(max(1.0 - sine**2 - normal**2, 0.0))
    signals = run.car.model.signals(run.states[0], run.inputs[0])
    forces = motion.isel(time=0)
    total = {axis: float(forces[f"f{axis}"].sum()) for axis in "xyz"}
    # wheels are steered by a degree at most: their own axes differ by 2e-2
    assert total["x"] - float(signals["air_drag"]) == pytest.approx(
        weight * sine, abs=3e-3 * weight
    )
    assert total["y"] == pytest.approx(weight * left, abs=3e-3 * weight)
    lift = float(signals["air_lift"])
    assert total["z"] + lift == pytest.approx(weight * normal, abs=1e-5 * weight)
    assert np.ptp(motion["speed"].values) < 1e-3
    # on a crossfall the car has a sideslip angle, and moves along the road
    assert np.ptp(motion["y"].values) < 1e-5
    assert np.ptp(motion["yaw_angle"].values) < 1e-6


def test_a_car_climbs_until_its_driven_wheels_slide(model):
    """The steepest grade has the friction of the front wheels, by their load as a rigid car.

    Their load is (cos b - sin h) / L of the weight W, and they carry W sin; the drag is 0.2 % of W.
    """
    car, changes = driving_car("test", model), {"speed_km_per_h": 30.0, "duration_s": 0.1}
    behind, _, height = center_of_gravity(model.car) - [model.car.axle_positions["rear"], 0.0, 0.0]
    friction = model.car.tyre("front_left").friction
    steepest = friction * behind / (WHEELBASE + friction * height)
    near = 0.95 * steepest
    found = drive(model, "straight", changes, grade=near)
    weight = car.mass * 9.81 / np.hypot(1.0, near)
    load = 0.5 * weight * (behind - near * height) / WHEELBASE
    radius = model.car.tyre("front_left").evaluate(load).loaded_radius
    assert float(found.metrics["drive_torque"]) == pytest.approx(weight * near * radius, rel=0.01)
    assert np.ptp(found.curves[""]["speed"].values) < 1e-3
    with pytest.raises(InputError) as refused:
        drive(model, "straight", changes, grade=1.05 * steepest)
    (named,) = re.findall(r"about ([\d.]+) %", str(refused.value))
    # found to 1 % of the slope; the slipping tyres approach their friction
    assert float(named) == pytest.approx(100.0 * steepest, rel=0.03)


def test_a_slope_that_is_level_in_words_is_not_named(model, monkeypatch, refused):
    def begin(turns, _acceleration):
        turns.slope = Slope(0.0004)
        raise NoSteadyMotionError("")

    monkeypatch.setattr(Turns, "begin", begin)
    refused(InputError, lambda: drive(model, "straight", grade=0.03))


def test_a_deceleration_is_that_of_brakes_and_grade(model, refused):
    """The weight along the grade has 1 m/s^2 of 6: without it the difference would be 2 m/s^2."""
    changes = {"speed_km_per_h": 40.0, "deceleration_m_per_s2": 6.0}
    up, down = (
        float(drive(model, "braking", changes, grade=one).metrics["mean_deceleration"])
        for one in (0.1, -0.1)
    )
    assert up == pytest.approx(down, abs=0.05)
    refused(
        InputError,
        lambda: drive(model, "braking", changes | {"deceleration_m_per_s2": 0.9}, grade=0.1),
    )


def test_a_coast_down_without_a_result_is_refused(model, refused):
    for grade, changes in ((0.2, {"until_km_per_h": 95.0}), (-0.1, {"duration_s": 0.5})):
        with refused(InputError):
            drive(model, "coast_down", changes, grade=grade)


def test_advice_about_a_simulation_names_no_argument_that_a_manoeuvre_lacks(
    model, monkeypatch, refused
):
    """A stepper with fewer steps than it needs has the error of a motion that is too fast."""
    monkeypatch.setattr(stepper, "_MOST_STEPS", 1)
    with pytest.raises(SimulationError, match="more than 1 steps") as caught:
        drive(model, "straight", {"duration_s": 0.1}, road=road_profiles.bump(0.03, 0.01, at=0.0))
    assert "Choose a lower speed" in str(caught.value)
    assert "max_steps" not in str(caught.value)
    refused(
        SimulationError, lambda: stepper.Stepper(model, 0.1, method="DormandPrince").step()
    )  # falls from design


def test_a_model_on_a_slope_is_refused_where_a_car_rests(refused):
    refused(
        InputError,
        lambda: drive(CarModel(light_car(), slope=Slope(0.05)), "straight"),
        lambda: CarModel(light_car(), slope=Slope(np.nan)),
    )


def test_a_slope_is_refused_where_turns_are_steady(model, refused):
    refused(
        InputError,
        lambda: drive(model, "step_steer", grade=0.05),
        lambda: drive(model, "straight", grade=8.0),
    )
