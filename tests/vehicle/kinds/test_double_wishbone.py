"""Positions, characteristics and equilibrium of the double wishbone, from its input file.

The oracle is a wheel carrier on five rods (`oracle.links`), of which everything is measured anew,
gradients by central differences; besides, arrangements that can be computed by hand.
"""

import kintrafo
import numpy as np
import pytest
from benches import SKEWED, UP, Wishbones
from hypothesis import given, settings
from hypothesis import strategies as st
from kintrafo import Model, PositionError, Suspension, characteristics
from kintrafo.vehicle.models.points import hardpoints

CAR = Suspension.load("double_wishbone_car")
MODEL = Model(CAR)
CARS = {"packaged": CAR, "other": SKEWED, "left": SKEWED.mirrored()}
PLACES = [(-0.07, 0.0), (0.0, 0.0), (0.03, 0.025), (0.08, -0.03)]  # wheel travel, rack [m]

# Poses are rounded to some 1e-15; differences over 2 mm to 1e-12, and ratios of them follow.
POSE, SLOPE = 1e-13, 1e-9


@pytest.fixture(scope="module", params=CARS, ids=str)
def bench(request):
    return Wishbones(CARS[request.param])


# -- positions ------------------------------------------------------------------------------------


@pytest.mark.parametrize("place", PLACES, ids=str)
def test_hardpoints_are_where_the_rods_put_them(bench, place):
    model = Model(bench.suspension)
    travel, rack = place
    height = bench.points["wheel_center"][2] + travel
    state = kintrafo.state_at_height(model, height, rack_position=rack)
    inputs = model.inputs({"rack_position": rack})
    at = hardpoints(model, state, inputs)
    for name in ("lower_ball_joint", "upper_ball_joint", "tie_rod_outer", "wheel_center"):
        assert at[name] == pytest.approx(bench.joint(name, place), rel=0.0, abs=POSE), name
    assert at["spring_seat"] == pytest.approx(bench.seat(place), rel=0.0, abs=POSE)
    moved = bench.points["tie_rod_inner"] + rack * bench.carrier.rack_axis
    assert at["tie_rod_inner"] == pytest.approx(moved, rel=0.0, abs=POSE)
    for name in ("lower_arm_front", "upper_arm_rear", "spring_top"):
        assert np.array_equal(at[name], bench.points[name])


@settings(max_examples=30, deadline=None)
@given(st.floats(-0.19, 0.27))
def test_any_height_within_reach_is_met(travel):
    state = kintrafo.state_at_height(MODEL, 0.3 + travel)
    assert float(MODEL.signal("wheel_center_z", state)) == pytest.approx(0.3 + travel, abs=1e-12)


@pytest.mark.parametrize("height", [0.05, 0.7])
def test_a_height_out_of_reach_is_refused_with_the_range(height):
    with pytest.raises(PositionError, match=r"out of reach: from 107\.68 mm .* to 575\.52 mm"):
        kintrafo.state_at_height(MODEL, height)


# -- characteristics ------------------------------------------------------------------------------


shift = st.floats(-25.0, 25.0).map(lambda x: round(x, 1))


@settings(max_examples=20, deadline=None)
@given(st.lists(shift, min_size=33, max_size=33), st.sampled_from(["right", "left"]))
def test_any_car_stands_as_its_rods_say(shifts, side):
    """Hardpoints in general position: every arm and the rack inclined."""
    points = CAR.hardpoints
    by = dict(zip(points.names(), np.reshape(shifts, (11, 3)), strict=True))
    moved = {f"hardpoints.{name}": (getattr(points, name) + by[name]).tolist() for name in by}
    car = CAR.with_changes(moved)
    car = car if side == "right" else car.mirrored()
    bench, place = Wishbones(car), (0.03, 0.01)
    at = characteristics.over(Model(car), "travel", [place[0]], rack_position=place[1])
    assert float(at["camber"][0]) == pytest.approx(bench.camber(place), abs=1e-12)
    assert float(at["toe"][0]) == pytest.approx(bench.toe(place), abs=1e-12)
    assert float(at["caster"][0]) == pytest.approx(bench.caster(place), abs=1e-12)
    assert float(at["spring_length"][0]) == pytest.approx(bench.spring(place), abs=1e-12)


def test_every_characteristic_of_a_strut_is_there():
    strut = Model("reference_car")
    for motion, places in (("travel", [0.0]), ("rack", [0.01])):
        ours, theirs = (characteristics.over(model, motion, places) for model in (MODEL, strut))
        assert set(ours) == set(theirs)


# -- by hand --------------------------------------------------------------------------------------


def arranged(**points):
    """Return a car with arms in planes across the vehicle, whose lower arm is 400 mm long."""
    standing = {
        "lower_arm_front": [150.0, -350.0, 200.0],
        "lower_arm_rear": [-150.0, -350.0, 200.0],
        "lower_ball_joint": [0.0, -750.0, 200.0],
        "upper_arm_front": [150.0, -350.0, 450.0],
        "upper_arm_rear": [-150.0, -350.0, 450.0],
        "upper_ball_joint": [0.0, -750.0, 450.0],
        "tie_rod_inner": [-120.0, -350.0, 300.0],
        "tie_rod_outer": [-120.0, -750.0, 300.0],
        "spring_top": [0.0, -550.0, 600.0],
        "spring_seat": [0.0, -550.0, 200.0],
        "wheel_center": [0.0, -800.0, 300.0],
    }
    changes = {f"hardpoints.{name}": point for name, point in (standing | points).items()}
    return Model(CAR.with_changes(changes))


def test_parallel_arms_of_equal_length_only_shift_the_wheel():
    travel = np.array([-0.1, -0.03, 0.0, 0.05, 0.1])
    at = characteristics.over(arranged(), "travel", travel)
    for name in ("camber", "toe", "caster", "kingpin_inclination", "wheelbase_change"):
        assert at[name].values == pytest.approx(np.zeros(5), abs=1e-14), name
    for name in ("camber_gradient", "bump_steer", "caster_gradient", "anti_dive"):
        assert at[name].values == pytest.approx(np.zeros(5), abs=1e-13), name
    # the contact moves on a circle of the arms' length, whose centre line is at its height
    drop = 0.4 - np.sqrt(0.4**2 - travel**2)
    assert at["half_track_change"].values == pytest.approx(-drop, abs=1e-14)
    lean = travel / np.sqrt(0.4**2 - travel**2)
    expected = -lean * (0.8 - drop)
    assert at["roll_center_height_kinematic"].values == pytest.approx(expected, abs=1e-13)
    assert at["roll_center_height_geometric"].values == pytest.approx(expected, abs=1e-13)


def test_spring_at_half_the_arm_has_half_the_travel():
    at = characteristics.over(arranged(), "travel", [0.0])
    assert float(at["motion_ratio"][0]) == pytest.approx(0.5, rel=1e-14)
    # k MR^2, and the force by how the ratio changes: length l = sqrt((0.4 - z/2)^2 + d^2) with
    # d = (0.4 - sqrt(0.4^2 - z^2)) / 2, of which the second derivative at zero vanishes
    assert float(at["wheel_rate"][0]) == pytest.approx(60000.0 / 4.0, rel=1e-12)


def test_arms_that_meet_at_a_point_turn_the_wheel_about_it():
    # lines from y = -750 mm through the bearings meet at y = 50 mm, z = 100 mm: the lower ones
    # fall by 100 mm over 800 mm, the upper ones by 350 mm, the tie rod by 200 mm
    model = arranged(
        lower_arm_front=[150.0, -350.0, 150.0],
        lower_arm_rear=[-150.0, -350.0, 150.0],
        upper_arm_front=[150.0, -350.0, 275.0],
        upper_arm_rear=[-150.0, -350.0, 275.0],
        tie_rod_inner=[-120.0, -350.0, 200.0],
    )
    at = characteristics.over(model, "travel", [0.0]).isel(wheel_travel=0)
    # the contact is at y = -800 mm, z = 0
    for way in ("kinematic", "geometric"):
        assert float(at[f"swing_arm_length_{way}"]) == pytest.approx(0.85, rel=1e-13)
        height = 0.8 * 100.0 / 850.0
        assert float(at[f"roll_center_height_{way}"]) == pytest.approx(height, rel=1e-13)
    # the wheel is 850 mm beside the centre: a metre of travel would lean it by 1/0.85 rad
    assert float(at["camber_gradient"]) == pytest.approx(-1.0 / 0.85, rel=1e-13)
    assert float(at["bump_steer"]) == pytest.approx(0.0, abs=1e-13)


def test_steering_axis_goes_through_the_ball_joints():
    at = characteristics.over(MODEL, "travel", [0.0]).isel(wheel_travel=0)
    assert float(at["caster"]) == pytest.approx(np.arctan2(30.0, 320.0))  # top 30 mm rearward
    assert float(at["kingpin_inclination"]) == pytest.approx(np.arctan2(50.0, 320.0))
    # the axis meets the ground 185 mm below the lower ball joint
    assert float(at["trail"]) * 1e3 == pytest.approx(5.0 + 185.0 * 30.0 / 320.0)
    assert float(at["steering_axis_offset"]) * 1e3 == pytest.approx(40.0 - 185.0 * 50.0 / 320.0)


# -- at rest and in motion ------------------------------------------------------------------------


@pytest.mark.parametrize("name", CARS)
def test_at_rest_the_forces_do_no_work(name):
    car = CARS[name]
    bench, model, p = Wishbones(car), Model(car), car.parameters()
    rest = kintrafo.equilibrium(model)
    travel = float(model.signal("wheel_center_z", rest)) - bench.points["wheel_center"][2]
    place = travel, 0.0

    def com(body):
        return np.array([p[f"{body}_com_{axis}"] for axis in "xyz"])

    def potential(place):
        pose = bench.pose(place)
        arm = com("knuckle") - bench.points["wheel_center"]
        heights = {
            "lower_arm": bench.carrier.on_arm(pose, "lower", com("lower_arm"))[2],
            "upper_arm": bench.carrier.on_arm(pose, "upper", com("upper_arm"))[2],
            "knuckle": (pose.center + pose.rotation @ arm)[2],
            "wheel": pose.center[2],
        }
        weight = sum(p["gravity"] * p[f"{body}_mass"] * z for body, z in heights.items())
        pressed = p["spring_free_length"] - bench.spring(place)
        return 0.5 * p["spring_rate"] * pressed**2 + weight

    # the tyre pushes in the plane of the wheel (Eq. 24)
    axis = bench.axis(place)
    load = p["tyre_rate"] * (p["tyre_free_height"] - bench.center(place)[2])
    force = load * (UP - axis * axis[2]) / (1.0 - axis[2] ** 2)
    work = float(force @ bench.by_travel(bench.center, place))
    # 600 J are rounded to 1e-13 J, and divided by 2 mm
    assert bench.by_travel(potential, place) == pytest.approx(work, rel=1e-9)


def test_packaged_car_rests_at_its_design_position():
    rest = kintrafo.equilibrium(MODEL)
    # the force at design is given to a thousandth of a newton
    assert float(MODEL.signal("wheel_center_z", rest)) == pytest.approx(0.3, abs=1e-8)


def test_a_released_wheel_comes_to_rest_again():
    start = kintrafo.state_at_height(MODEL, 0.325, spin_rate=90.0)
    result = kintrafo.simulate(MODEL, (0.0, 2.0), start, rtol=1e-9, atol=1e-12)
    # wheel hop decays by exp(-23 /s t)
    assert result.signals["wheel_center_z"][-1] == pytest.approx(0.3, abs=1e-7)


def test_an_actuator_is_a_spring_that_is_longer_by_force_over_rate():
    stiff = CAR.with_changes({"spring.force_at_design_N": 5360.268 + 500.0})
    lifted = kintrafo.equilibrium(MODEL, strut_force=500.0)
    assert lifted == pytest.approx(kintrafo.equilibrium(Model(stiff)), abs=1e-12)
    assert float(MODEL.signal("wheel_center_z", lifted)) < 0.3
