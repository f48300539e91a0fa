"""Studies of whole cars: motions of the body, and steady turns of cars that drive."""

import kintrafo
import numpy as np
import pytest
from cars.driving_cars import light_car
from kintrafo import InputError, characteristics, variation
from kintrafo.vehicle.analysis.compare import compare
from kintrafo.vehicle.analysis.handling import circle
from kintrafo.vehicle.assembly.by_wheel import flat
from kintrafo.vehicle.models.car import equations
from kintrafo.vehicle.models.car.equations import CarModel
from kintrafo.vehicle.studies.design_variables import places_of
from kintrafo.vehicle.studies.sweep_axes import TURNS

TURNING_SPEED = 100.0 / 3.6
RIDES = kintrafo.load("reference_vehicle")
DRIVES = light_car()
ROD, MASS = "front.side.hardpoints.tie_rod_inner.z", "body.mass_kg"
RATE = "rear.side.spring.rate_N_per_m"
# Central differences of second order over 0.5 mm of lengths of 300 mm, (0.5 / 300)^2 = 3e-6, where
# curves change as quickly as the geometry; steer angles are small differences of larger ones.
SECOND_ORDER = 1e-4


def turn(car, acceleration, speed=TURNING_SPEED):
    found = circle(car, speed=speed, lateral_acceleration=[acceleration])
    return flat(found.curves[""].isel(lateral_acceleration=0))


def understeer(car, acceleration):
    """Return the understeer gradient by its definition, from angles of two turns beside it."""
    near = 1e-3
    more, less = turn(car, acceleration + near), turn(car, acceleration - near)
    gentle = circle(car, speed=TURNING_SPEED, lateral_acceleration=[1e-6])
    angle = (more - less) / (2.0 * near)
    wheelbase = 2.6
    ratio = float(gentle.metrics["steering_ratio"])
    return float(angle["steering_wheel_angle"] / ratio - wheelbase * angle["curvature"])


def test_values_are_those_of_its_own_file_and_of_its_axles():
    known = places_of(DRIVES)
    assert {ROD, RATE, MASS, "body.com_mm.z", "tyres.front.friction"} <= {*known}
    assert known[ROD].words == "front tie rod inner z"
    assert known[MASS].value == 1300.0
    both = variation.sensitivity(
        RIDES, ["wheel_center.z"], names=["camber_front_left"], positions=[0.0]
    )
    assert both["place"].values.tolist() == [
        f"{end}.side.hardpoints.wheel_center.z" for end in ("front", "rear")
    ]
    assert both["camber_front_left"].values[1] == 0.0


@pytest.mark.parametrize("motion", ["heave", "pitch", "roll"])
def test_derivatives_over_motions_of_the_body(motion):
    at, step = np.array([0.01]), 0.5
    found = variation.sensitivity(
        RIDES, [ROD], over=motion, names=["toe_front_left", "camber_rear_left"], positions=at
    )
    height = places_of(RIDES)[ROD].value

    def toe(by):
        moved = RIDES.with_changes({ROD: height + by})
        return float(characteristics.over(moved, motion, at)["toe"].sel(wheel="front_left")[0])

    wanted = (toe(step) - toe(-step)) / (2e-3 * step)
    assert found["toe_front_left"].item() == pytest.approx(wanted, rel=SECOND_ORDER)
    assert found["camber_rear_left"].item() == 0.0


def test_derivatives_of_steady_turns():
    at = np.array([-3.0, 0.0, 3.0])
    found = variation.sensitivity(
        DRIVES, [ROD, MASS], over=TURNS, positions=at,
        names=["understeer_gradient", "roll_angle", "fz_front_left", "fz_front_right"],
    )  # fmt: skip
    for row, (place, step, si) in enumerate([(ROD, 0.5, 1e-3), (MASS, 1.0, 1.0)]):
        value = places_of(DRIVES)[place].value
        more, less = (turn(DRIVES.with_changes({place: value + d}), 3.0) for d in (step, -step))
        wanted = (more - less) / (2.0 * step * si)
        for name in ("roll_angle", "fz_front_left"):
            here = float(found[name].sel(lateral_acceleration=3.0)[row])
            assert here == pytest.approx(float(wanted[name]), rel=SECOND_ORDER)
    # the car is symmetric
    np.testing.assert_allclose(
        found["understeer_gradient"][:, 0], found["understeer_gradient"][:, 2], rtol=1e-6
    )
    np.testing.assert_allclose(found["fz_front_left"], found["fz_front_right"][:, ::-1], rtol=1e-5)


@pytest.mark.parametrize(
    ("option", "constant", "value"),
    [
        ("speed_km_per_h=72", "travel_speed", 20.0),
        ("radius_m=60", "curvature", 1.0 / 60.0),
        ("steering_wheel_deg=30", "steering_wheel_angle", np.deg2rad(30.0)),
    ],
)
def test_the_chosen_quantity_is_constant_in_steady_turns(option, constant, value):
    over, at = f"{TURNS}:{option}", [1.0, 3.0]
    names = ["travel_speed", "curvature", "steering_wheel_angle", "roll_angle"]
    own = variation.cars(DRIVES, {MASS: [1300.0]}, over=over, positions=[-3.0, *at], names=names)
    np.testing.assert_allclose(own[constant][0, 1:], value, rtol=1e-9)
    # v r = a in a steady turn, but for the cosine of the sideslip angle
    product = own["curvature"] * own["travel_speed"] ** 2
    np.testing.assert_allclose(product[0], [-3.0, *at], rtol=2e-2)
    # the turn at a constant speed is the same one, if the speeds are equal
    speed = float(own["travel_speed"][0, 2])
    same = turn(DRIVES, 3.0, speed)
    for name in names:
        assert float(own[name][0, 2]) == pytest.approx(float(same[name]), rel=1e-9)
    slope = variation.sensitivity(DRIVES, [MASS], over=over, positions=[3.0], names=["roll_angle"])
    more, less = (
        variation.cars(DRIVES, {MASS: [1300.0 + by]}, over=over, positions=[3.0])["roll_angle"]
        for by in (1.0, -1.0)
    )
    wanted = float((more - less).item()) / 2.0
    assert slope["roll_angle"].item() == pytest.approx(wanted, rel=SECOND_ORDER)


def test_an_error_is_found_by_measured_turns(tmp_path):
    """The car has another tie rod and a softer rear spring: steering and roll on a radius."""
    height, rate = (places_of(DRIVES)[place].value for place in (ROD, RATE))
    built = DRIVES.with_changes({ROD: height + 2.0, RATE: 0.95 * rate})
    at = np.array([1.0, 3.0, 5.0])
    turns = circle(built, radius=60.0, lateral_acceleration=at).curves[""]
    columns = {n: np.rad2deg(turns[n].values) for n in ("steering_wheel_angle", "roll_angle")}
    head = "lateral_acceleration [m/s^2],steering_wheel_angle [deg],roll_angle [deg]"
    table = np.column_stack([at, *columns.values()])
    np.savetxt(tmp_path / "turns.csv", table, delimiter=",", header=head, comments="")
    measured = kintrafo.rig.measured_curves(tmp_path / "turns.csv")
    found = variation.fit(
        DRIVES, measured, {ROD: 10.0, RATE: "30 %"}, over=f"{TURNS}:radius_m=60",
        accuracy={"steering_wheel_angle": 0.01, "roll_angle": 0.001},
    )  # fmt: skip
    assert found.success, found.message
    # accurate measurements outweigh the assumption that values are near those of the file
    assert found.moved[ROD] == pytest.approx(2.0, abs=0.05)
    assert found.moved[RATE] == pytest.approx(-0.05 * rate, rel=0.02)
    with pytest.raises(InputError, match="lateral_acceleration"):
        variation.fit(DRIVES, measured, {ROD: 10.0}, over="heave")


QUARTER = kintrafo.load("quarter_car")
SPRING, DAMPER = "corner.strut.spring_rate_N_per_m", "corner.strut.damper_rate_N_s_per_m"


def test_derivatives_of_a_ride():
    over, names = "speed:road=C", ["weighted_rms", "load_variation", "travel_rms", "hop_frequency"]
    found = variation.sensitivity(
        QUARTER, [SPRING, DAMPER], over=over, positions=[20.0], names=names
    )
    for row, place in enumerate((SPRING, DAMPER)):
        value = places_of(QUARTER)[place].value
        more, less = (
            kintrafo.ride.by_speed(QUARTER.with_changes({place: value + by}), [20.0], "C")
            for by in (1e-3 * value, -1e-3 * value)
        )
        for name in names:
            wanted = float((more[name] - less[name]).item()) / (2e-3 * value)
            assert found[name][row, 0].item() == pytest.approx(wanted, rel=SECOND_ORDER)


def test_a_ride_comes_to_its_targets():
    """Two rates, for a frequency and a damping ratio; comfort is a limit."""
    targets = {
        "heave_frequency": {"over": "speed", "value": 1.1, "within": 1e-3},
        "heave_damping_ratio": {"over": "speed", "value": 0.3, "within": 1e-3},
    }
    limits = {"weighted_rms": {"over": "speed", "road": "C", "at_km_per_h": [80.0], "most": 2.0}}
    found = variation.optimise(QUARTER, {SPRING: 12e3, DAMPER: 1500.0}, targets, limits)
    assert found.success, found.message
    modes = kintrafo.ride.modes(found.suspension).sel(mode="heave")
    assert float(modes["frequency"]) == pytest.approx(1.1, abs=1e-3)
    assert float(modes["damping_ratio"]) == pytest.approx(0.3, abs=1e-3)
    (verdict,) = variation.judge(
        found.suspension, variation.goals({"limits": limits}, ["heave", "speed"])
    )
    comfort = kintrafo.ride.by_speed(found.suspension, [80.0 / 3.6], "C")["weighted_rms"].item()
    assert verdict.beyond == pytest.approx(comfort - 2.0, abs=1e-12)
    assert verdict.over == "speed:road=C"


def test_options_of_axes_that_cannot_be_are_refused(refused):
    for car, over in (
        (DRIVES, f"{TURNS}:radius_m=60,speed_km_per_h=80"),
        (DRIVES, f"{TURNS}:radius=60"),
        (DRIVES, f"{TURNS}:radius_m=sixty"),
        (DRIVES, f"{TURNS}:radius_m"),
        (DRIVES, "heave:radius_m=60"),
        (QUARTER, "speed:road=Z"),
        (QUARTER, "speed:seat=driver"),
        (QUARTER, TURNS),
    ):
        with refused(InputError):
            variation.sensitivity(car, ["body.mass_kg"], over=over)


def test_a_car_that_does_not_move_is_on_no_radius():
    found = variation.cars(DRIVES, {MASS: [1300.0]}, over=f"{TURNS}:radius_m=60", positions=[0.0])
    assert "does not move" in str(found["reason"].item())


def test_an_understeer_gradient_comes_to_its_target():
    wanted = 0.3  # deg/g
    found = variation.optimise(
        DRIVES,
        {ROD: 10.0, RATE: 5000.0},
        {"understeer_gradient": {
            "over": TURNS, "at_m_per_s2": [3.0], "value": wanted, "within": 0.01
        }},
    )  # fmt: skip
    assert found.success, found.message
    per_g = np.deg2rad(1.0) / 9.80665
    assert abs(understeer(DRIVES, 3.0) / per_g - wanted) > 0.3
    # a hundredth of what matters is what moving values is worth; the rest is `near`
    assert understeer(found.suspension, 3.0) / per_g == pytest.approx(wanted, abs=0.01)
    # five cars a step: itself, and two beside it for each value; three steps, and one at the end
    assert found.evaluations <= 22
    assert "all deviations are at most 1 %" in found.message


def test_targets_that_are_met_need_no_search():
    """The car is evaluated, and two beside it, to see whether the value moves the target."""
    frequency = float(kintrafo.ride.modes(QUARTER).sel(mode="heave")["frequency"])
    target = {"over": "speed", "value": frequency, "within": 1e-3}
    found = variation.optimise(QUARTER, {SPRING: 12e3}, {"heave_frequency": target})
    assert (found.evaluations, found.moved[SPRING]) == (3, 0.0)


def test_a_car_that_varies_is_derived_and_compiled_once(monkeypatch):
    CarModel(DRIVES)

    def compiled(*_, **__):
        raise AssertionError("other values need no other equations")

    monkeypatch.setattr(equations, "compile_mechanism", compiled)
    found = variation.tolerance(
        DRIVES, {ROD: 1.0, MASS: 5.0}, count=8, over=TURNS, positions=[2.0],
        names=["understeer_gradient", "roll_gradient"],
        limits={"understeer_gradient": {"over": TURNS, "at_m_per_s2": 2.0, "least": -90.0}},
    )  # fmt: skip
    assert found.attrs["yield"] == 1.0
    assert found["understeer_gradient_share"].sum().item() == pytest.approx(1.0)
    low, high = (float(found["understeer_gradient"].sel(quantile=q)[0]) for q in (0.0, 1.0))
    assert low < float(found["understeer_gradient_nominal"][0]) < high


def test_the_steering_ratio_is_that_straight_ahead():
    ratios = [
        float(circle(DRIVES, speed=TURNING_SPEED, lateral_acceleration=at).metrics[
            "steering_ratio"
        ])
        for at in ([3.0], [1.0, 3.0])
    ]  # fmt: skip
    assert ratios[0] == ratios[1]


def test_cars_are_compared():
    other = RIDES.with_changes({ROD: places_of(RIDES)[ROD].value + 2.0})
    found = compare({"one": RIDES, "other": other}, [0.0])
    assert found["toe"].dims == ("data_set", "wheel", "body_heave")


def test_what_a_car_has_not_is_refused(refused):
    for study, error in (
        (lambda: variation.sensitivity(RIDES, [ROD], over=TURNS), InputError),
        (lambda: variation.sensitivity(DRIVES, [MASS], over=TURNS, positions=[30.0]), InputError),
        (lambda: variation.sensitivity(RIDES, [ROD], held="height"), InputError),
        (lambda: variation.sweep(RIDES, {MASS: [1.0]}), InputError),
        (
            lambda: variation.judge(
                RIDES,
                variation.goals(
                    {"limits": {"toe_front_left": {"over": TURNS, "most": 1.0}}}, ["heave", TURNS]
                ),
            ),
            InputError,
        ),
    ):
        with refused(error):
            study()
