"""Characteristics against published and independent numbers.

Two oracles: curves of Project Chrono's generic strut by an independent program, in tests/data/, to
their last digit; and the maximal-coordinate model of tests/oracle, of which everything is measured
anew here, gradients by central differences.
"""

import csv
import dataclasses
import re

import kintrafo
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from kintrafo import Axle, InputError, Model, Suspension, characteristics, variation
from kintrafo.vehicle.assembly import wheel
from kintrafo.vehicle.assembly.by_wheel import flat
from kintrafo.vehicle.assembly.corner_kinematics import corner
from kintrafo.vehicle.assembly.measures import ackermann as axle
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.models.points import hardpoints
from oracle.corners import SKEWED, UP, Strut, Wishbones, difference, second_difference
from support.folders import DATA, ROOT

CAR = Suspension.load("reference_car")
MODEL = Model(CAR)
CHRONO = Suspension.load("chrono_generic")

# Of the published curves: what a column is called here.
TRAVEL_COLUMNS = {
    "theta": "arm_rotation",
    "camber": "camber",
    "toe_in": "toe",
    "caster": "caster",
    "kpi": "kingpin_inclination",
    "trail": "trail",
    "offset_ground": "steering_axis_offset",
    "hub_trail": "hub_trail",
    "spindle_off": "spindle_offset",
    "dy_cp": "half_track_change",
    "dx_wc": "wheelbase_change",
    "spring": "spring_length",
    "MR": "motion_ratio",
    "rc_h": "roll_center_height_kinematic",
    "camber_grad": "camber_gradient",
    "bump_steer": "bump_steer",
    "caster_grad": "caster_gradient",
    "dxdz_cp": "side_view_swing_arm_angle",
    "dxdz_wc": "side_view_hub_angle",
    "fvsa": "swing_arm_length_kinematic",
}


def table(name):
    with (DATA / name).open(newline="") as file:
        rows = list(csv.DictReader(file))
    return {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}


def shown(variable):
    return variable.values * variable.attrs["display_factor"]


def last_digit(values):
    """Return half a unit of the ninth significant digit, which is the last in the files.

    Where a value is zero but for rounding, 1e-9 deg or mm.
    """
    size = np.maximum(np.abs(values), 1e-1)
    return 0.501 * 10.0 ** (np.floor(np.log10(size)) - 8.0)


TRAVEL_TABLE, RACK_TABLE = table("chrono_generic_travel.csv"), table("chrono_generic_rack.csv")


@pytest.fixture(scope="module")
def chrono_travel():
    return characteristics.over(Model(CHRONO), "travel", TRAVEL_TABLE["z"] * 1e-3)


def test_every_published_column_is_compared():
    assert set(TRAVEL_TABLE) == {"z", *TRAVEL_COLUMNS}


@pytest.mark.parametrize("column", TRAVEL_COLUMNS)
def test_published_curves_over_travel(chrono_travel, column):
    variable = chrono_travel[TRAVEL_COLUMNS[column]]
    # two columns are tangents
    found = np.tan(variable.values) if column.startswith("dxdz") else shown(variable)
    expected = TRAVEL_TABLE[column]
    assert (np.abs(found - expected) <= last_digit(expected)).all()


@pytest.mark.parametrize("side", ["left", "right"])
def test_published_curves_over_the_rack(side):
    suspension = CHRONO if side == "left" else CHRONO.mirrored()
    found = characteristics.over(Model(suspension), "rack", RACK_TABLE["rack_mm"] * 1e-3)
    columns = {"steer_left": "steer_L_deg", "steer_right": "steer_R_deg"}
    columns["camber"] = f"camber_{side[0].upper()}_deg"
    if side == "left":
        columns["caster"] = "caster_L_deg"
    for name, column in columns.items():
        expected = RACK_TABLE[column]
        assert (np.abs(shown(found[name]) - expected) <= last_digit(expected)).all(), name
    assert np.array_equal(found["steer"], found[f"steer_{side}"])


# -- the oracle measured anew ---------------------------------------------------------------------

OTHER = CAR.with_changes(
    {
        "hardpoints.arm_front.z": 195.0,
        "hardpoints.arm_rear.y": -340.0,
        "hardpoints.strut_top.x": -45.0,
        "hardpoints.tie_rod_inner.z": 270.0,
        "wheel.camber_deg": -1.5,
        "wheel.toe_deg": 0.3,
        "rack.axis": [0.05, 1.0, 0.02],
        "tyre.radius_mm": 310.0,
    }
)
RODS = Suspension.load("double_wishbone_car")
BENCHES = {
    "reference": (Strut, CAR),
    "other": (Strut, OTHER),
    "left": (Strut, OTHER.mirrored()),
    "wishbones": (Wishbones, RODS),
    "other wishbones": (Wishbones, SKEWED),
    "left wishbones": (Wishbones, SKEWED.mirrored()),
}
PLACES = [(-0.06, 0.0), (0.0, 0.0), (0.03, 0.025), (0.07, -0.03)]  # wheel travel, rack [m]


# Poses are rounded to some 1e-15; differences over 2 mm to 1e-12, and ratios of them follow.
POSE, SLOPE = 1e-13, 1e-9


@pytest.fixture(scope="module", params=BENCHES, ids=str)
def bench(request):
    make, car = BENCHES[request.param]
    return make(car)


@pytest.fixture(scope="module")
def found(bench):
    """All characteristics at the places, by place."""
    model = Model(bench.suspension)
    return {
        (travel, rack): characteristics.over(model, "travel", [travel], rack_position=rack).isel(
            wheel_travel=0
        )
        for travel, rack in PLACES
    }


@pytest.mark.parametrize("place", PLACES, ids=str)
def test_angles_and_places(bench, found, place):
    values, side = found[place], bench.side
    low, high = bench.steering_axis(place)
    center, contact = bench.center(place), bench.contact(place)
    expected = {
        "camber": bench.camber(place),
        "toe": bench.toe(place),
        "steer": -side * bench.toe(place),
        "caster": bench.caster(place),
        "kingpin_inclination": np.arctan2(-side * (high - low)[1], (high - low)[2]),
        "half_track_change": side * (contact - bench.contact((0.0, 0.0)))[1],
        "wheelbase_change": (center - bench.center((0.0, 0.0)))[0],
        "spring_length": bench.spring(place),
        "damper_length": bench.spring(place),
    }
    forward = np.cross(side * bench.axis(place), UP)
    forward /= np.linalg.norm(forward)
    inboard = -side * np.cross(UP, forward)

    def pierced(level):
        return low + (level - low[2]) / (high - low)[2] * (high - low)

    ground, hub = pierced(contact[2]) - contact, pierced(center[2]) - center
    expected |= {"trail": ground @ forward, "steering_axis_offset": ground @ inboard}
    expected |= {"hub_trail": hub @ forward, "spindle_offset": hub @ inboard}
    expected["scrub_radius"] = np.linalg.norm(ground)
    for name, value in expected.items():
        assert float(values[name]) == pytest.approx(value, rel=0.0, abs=POSE), name


@pytest.mark.parametrize("place", PLACES, ids=str)
def test_hardpoints_are_where_the_oracle_puts_them(bench, place):
    model, (travel, rack) = Model(bench.suspension), place
    height = bench.points["wheel_center"][2] + travel
    state = kintrafo.state_at_height(model, height, rack_position=rack)
    at = hardpoints(model, state, model.inputs({"rack_position": rack}))
    expected = {
        name: bench.joint(name, place)
        for name in at
        if name.endswith("ball_joint") or name in ("tie_rod_outer", "wheel_center")
    }
    if isinstance(bench, Wishbones):
        expected["spring_seat"] = bench.seat(place)
    axis = np.array(bench.suspension.rack.axis)
    moved = rack * axis / np.linalg.norm(axis)
    expected["tie_rod_inner"] = bench.points["tie_rod_inner"] + moved
    for name, point in expected.items():
        assert at[name] == pytest.approx(point, rel=0.0, abs=POSE), name
    assert len(expected) == (6 if isinstance(bench, Wishbones) else 4)
    for name in {*bench.points} - {*expected}:
        assert np.array_equal(at[name], bench.points[name])


@pytest.mark.parametrize("place", PLACES, ids=str)
def test_gradients_and_motion(bench, found, place):
    values, turned = found[place], bench.rotation(place)
    contact = bench.contact(place)
    # the contact point as a point of the knuckle
    arm = turned.T @ (contact - bench.center(place))
    velocity = bench.by_travel(lambda p: bench.center(p) + bench.rotation(p) @ arm, place)
    # rotation about x: of the knuckle's y axis towards z
    turning = bench.by_travel(lambda p: bench.rotation(p) @ turned.T, place)
    roll = 0.5 * (turning[2, 1] - turning[1, 2])
    hub = bench.by_travel(bench.center, place)
    vehicle = bench.suspension.vehicle
    squat = vehicle.front_brake_share * vehicle.wheelbase_mm / vehicle.center_of_gravity_height_mm
    expected = {
        "camber_gradient": bench.by_travel(bench.camber, place),
        "bump_steer": bench.by_travel(bench.toe, place),
        "caster_gradient": bench.by_travel(bench.caster, place),
        "motion_ratio": -bench.by_travel(bench.spring, place),
        "roll_center_height_kinematic": contact[1] * velocity[1] / velocity[2],
        "side_view_swing_arm_angle": np.arctan(velocity[0] / velocity[2]),
        "side_view_hub_angle": np.arctan(hub[0] / hub[2]),
        "anti_dive": squat * velocity[0] / velocity[2],
    }
    expected["damper_motion_ratio"] = expected["motion_ratio"]
    for name, value in expected.items():
        assert float(values[name]) == pytest.approx(value, rel=SLOPE, abs=SLOPE), name
    # swing arms of up to 30 m: the curvature has the accuracy, not the radius
    curvature = bench.side * roll / velocity[2]
    found_curvature = 1.0 / float(values["swing_arm_length_kinematic"])
    assert found_curvature == pytest.approx(curvature, abs=SLOPE)


@pytest.mark.parametrize("place", PLACES, ids=str)
def test_wheel_rate_is_the_second_derivative_of_the_potential(bench, found, place):
    parameters = bench.suspension.parameters()

    def potential(travel):
        stretch = bench.free - bench.spring((travel, place[1]))
        return 0.5 * parameters["spring_rate"] * stretch**2

    # a step of 4 mm: rounding of 1e-13 J / (4e-3 m)^2, and the eighth power of the step
    slope = second_difference(lambda h: potential(place[0] + h), 4e-3)
    assert float(found[place]["wheel_rate"]) == pytest.approx(slope, rel=1e-7)
    series = 1.0 / (1.0 / slope + 1.0 / parameters["tyre_rate"])
    assert float(found[place]["ride_rate"]) == pytest.approx(series, rel=1e-7)


def test_wheel_rate_includes_a_stop_that_is_pressed():
    stop = {"clearance_mm": 20.0, "rate_N_per_m": 5e4, "progression_N_per_mm3": 0.02}
    stopped = CAR.with_changes({"bump_stop": stop})
    bench = Strut(CAR)
    seat = bench.spring((0.0, 0.0)) - 0.020

    def potential(travel):
        x = max(0.0, seat - bench.spring((travel, 0.0)))
        return 0.5 * 5e4 * x**2 + 0.25 * 0.02e9 * x**4

    found = characteristics.over(Model(stopped), "travel", [0.0, 0.05])["wheel_rate"].values
    plain = characteristics.over(MODEL, "travel", [0.0, 0.05])["wheel_rate"].values
    slope = difference(lambda h: difference(lambda k: potential(0.05 + h + k), 2e-3), 2e-3)
    assert found[0] == pytest.approx(plain[0], rel=1e-12)
    # 3e-11 J of rounding in the potential would be 1e-5 N/m
    assert found[1] - plain[1] == pytest.approx(slope, rel=1e-6)


@pytest.mark.parametrize("place", PLACES, ids=str)
def test_geometric_instant_centre_is_on_the_axis_of_the_links(bench, found, place):
    """About it two points of the knuckle move as the links guide them."""
    values, contact = found[place], bench.contact(place)
    y = contact[1] - bench.side * float(values["swing_arm_length_geometric"])
    # the roll centre is on the line from the contact to the instant centre
    rise = float(values["roll_center_height_geometric"]) / -contact[1]
    centre = np.array([bench.center(place)[0], y, contact[2] + rise * (y - contact[1])])
    guided = bench.guided(place)
    axis = np.cross(*(direction for _, direction in guided))
    axis /= np.linalg.norm(axis)
    for point, direction in guided:
        motion = np.cross(axis, point - centre)
        off = np.cross(motion, direction) / np.linalg.norm(direction)
        # arms of up to 30 m
        assert np.abs(off).max() < 1e-11 * max(1.0, np.linalg.norm(point - centre))


@pytest.mark.parametrize("place", PLACES, ids=str)
def test_steering(bench, place):
    travel, rack = place
    mirrored = type(bench)(bench.suspension.mirrored())
    found = characteristics.over(Model(bench.suspension), "rack", [rack], travel=travel)
    own, other = (b.by_rack(lambda p, b=b: -b.side * b.toe(p), place) for b in (bench, mirrored))
    assert float(found["steer_gradient"][0]) == pytest.approx(own, rel=SLOPE)
    per_turn = bench.suspension.rack.travel_per_turn_mm * 1e-3
    ratio = 2.0 * np.pi / per_turn / abs(0.5 * (own + other))
    assert float(found["steering_ratio"][0]) == pytest.approx(ratio, rel=SLOPE)
    left, right = (bench, mirrored) if bench.side > 0.0 else (mirrored, bench)
    for name, one in (("steer_left", left), ("steer_right", right)):
        assert float(found[name][0]) == pytest.approx(-one.side * one.toe(place), abs=POSE)


# -- both wheels ----------------------------------------------------------------------------------


@pytest.mark.parametrize("turn", [1.0, -1.0])
@pytest.mark.parametrize("radius", [6.0, 12.0, 200.0])
def test_wheels_that_roll_without_slip(turn, radius):
    """The axes of all wheels meet on the rear axle, at this distance from the centre plane."""
    wheelbase, track = 2.6, 1.5
    left, right = (
        np.array([np.arctan(wheelbase / (turn * radius - y))]) for y in (track / 2, -track / 2)
    )
    assert axle.ackermann_error(left, right, wheelbase, track)[0] == pytest.approx(0.0, abs=1e-15)
    assert axle.ackermann(left, right, wheelbase, track)[0] == pytest.approx(1.0, rel=1e-12)
    diameter = 2.0 * np.hypot(wheelbase, radius + track / 2)
    assert axle.turning_circle(left, right, wheelbase)[0] == pytest.approx(diameter, rel=1e-13)


def test_parallel_wheels_and_wheels_straight_ahead():
    parallel = np.array([0.2, -0.3, 0.0])
    error = axle.ackermann_error(parallel, parallel, 2.6, 1.5)
    assert (error[:2] > 0.0).all()
    assert error[2] == 0.0
    part = axle.ackermann(parallel, parallel, 2.6, 1.5)
    assert part[:2].tolist() == [0.0, 0.0]
    assert np.isnan(part[2])
    assert np.isinf(axle.turning_circle(parallel, parallel, 2.6)[2])
    assert np.isinf(axle.steering_ratio(np.zeros(1), np.zeros(1), 0.05)[0])


STEERED = {
    "a side": (MODEL, 2.6, 1.52),
    "an axle": (Axle.from_dict({"axle": "front", "side": CAR}), 2.6, 1.52),
    "a steered rigid axle": (kintrafo.load("steered_rigid_axle"), 3.0, 1.64),
}


@pytest.mark.parametrize("name", STEERED)
def test_ackermann_and_turning_circle_are_those_of_the_steer_angles(name):
    """Of wheels a track apart, each with its own angle from that of the rack in its middle."""
    subject, wheelbase, track = STEERED[name]
    found = flat(characteristics.over(subject, "rack", [-0.05, 0.0, 0.02]))
    left, right = (
        (found[f"steer_{side}"] - found[f"steer_{side}"][1]).values for side in ("left", "right")
    )
    inner, outer = np.where(left > 0.0, left, -right), np.where(left > 0.0, right, -left)
    for place in (0, 2):
        ideal = np.arctan(wheelbase / (wheelbase / np.tan(inner[place]) + track))
        wanted = {
            "ackermann_error": outer[place] - ideal,
            "ackermann": (inner[place] - outer[place]) / (inner[place] - ideal),
            "turning_circle": 2.0 * wheelbase / np.sin(outer[place]),
        }
        for key, value in wanted.items():
            # the poses of a steered rigid axle are iterated: 1e-12 rad of differences of 1e-3 rad
            assert float(found[key][place]) == pytest.approx(value, rel=1e-8), key


@pytest.mark.parametrize("name", ["reference_car", "double_wishbone_car", "multi_link_car"])
@pytest.mark.parametrize("travel", [0.0, -0.03])
def test_static_toe_and_bump_steer_steer_no_car(name, travel):
    """With toe-in, by hand from the angles that the rack adds; with two files, and many cars."""
    car = Suspension.load(name).with_changes(
        {"wheel.toe_deg": 0.4, "vehicle.wheelbase_mm": 2600.0, "vehicle.end": "front"}
    )
    racks = np.array([-0.02, -0.002, 0.0, 0.002, 0.02])
    found = characteristics.over(Model(car), "rack", racks, travel=travel)
    left, right = (found[f"steer_{side}"].values for side in ("left", "right"))
    left, right = left - left[2], right - right[2]
    to_left = left > 0.0
    inner, outer = np.where(to_left, [left, right], [-right, -left])
    track = -2e-3 * car.hardpoints.wheel_center[1]
    with np.errstate(divide="ignore", invalid="ignore"):
        ideal = np.arctan(2.6 / (2.6 / np.tan(inner) + track))
        part, circle = (inner - outer) / (inner - ideal), 5.2 / np.sin(outer)
    part[2] = np.nan
    # rounding of the angles, over differences of 1e-5 rad
    np.testing.assert_allclose(found["ackermann"], part, rtol=1e-8)
    np.testing.assert_allclose(
        found["ackermann_error"], np.where(part, outer - ideal, 0), atol=1e-14
    )
    np.testing.assert_allclose(found["turning_circle"], np.abs(circle), rtol=1e-11)
    # from 2 mm to 20 mm of rack it changes little
    assert abs(part[3] - part[4]) < 0.25 * abs(part[4]) + 0.25
    axle_file = Axle.from_dict({"axle": "front", "side": car})
    of_axle = characteristics.over(axle_file, "rack", racks, travel=travel)
    np.testing.assert_allclose(of_axle["ackermann"], found["ackermann"], rtol=1e-8)
    if not travel:
        many = variation.cars(
            car,
            {"wheel.toe_deg": [0.4, -0.4, 0.1]},
            names=["ackermann"],
            over="rack",
            positions=racks,
        )
        np.testing.assert_allclose(many["ackermann"][0], found["ackermann"], rtol=1e-8)


def test_sides_of_an_axle_have_a_static_toe_each():
    like, lopsided = (
        Axle.from_dict(
            {
                "axle": "front",
                "right": CAR.with_changes({"wheel.toe_deg": toe}),
                "left": CAR.mirrored(),
            }
        )
        for toe in (0.0, 0.5)
    )
    expected, found = (
        flat(characteristics.over(axle, "rack", [0.002, 0.03])) for axle in (like, lopsided)
    )
    # the turn about an inclined axis adds a little less or more where the wheel stands otherwise
    np.testing.assert_allclose(found["ackermann"], expected["ackermann"], atol=0.08)


def test_the_percentage_of_wheels_that_turn_to_different_sides_is_none():
    found = axle.ackermann(np.array([0.05, 0.05]), np.array([-0.001, 0.02]), 2.6, 1.5)
    assert np.isnan(found).tolist() == [True, False]


# -- signs, sides, models -------------------------------------------------------------------------

REVERSED_BY_MIRRORING = ("steer", "steer_left", "steer_right", "steer_gradient")


def assert_mirror_images(suspension):
    """Compare a suspension with its mirror image, the rack displaced the other way."""
    one, other = Model(suspension), Model(suspension.mirrored())
    travel = np.array([-0.04, 0.0, 0.05])
    pairs = [
        (
            characteristics.over(one, "travel", travel, rack_position=0.01),
            characteristics.over(other, "travel", travel, rack_position=-0.01),
        ),
        (
            characteristics.over(one, "rack", [0.0, 0.03], travel=0.02),
            characteristics.over(other, "rack", [0.0, -0.03], travel=0.02),
        ),
    ]
    for a, b in pairs:
        for name in a:
            first, second = a[name].values, b[name].values
            if name in ("steer_left", "steer_right"):
                second = b[{"steer_left": "steer_right", "steer_right": "steer_left"}[name]].values
            if name == "steer_gradient" or name not in REVERSED_BY_MIRRORING:
                expected = second
            else:
                expected = -second
            # one and the same arithmetic but for signs and roundings; lengths of up to km
            assert first == pytest.approx(expected, rel=1e-8, abs=1e-12, nan_ok=True), name


shift = st.floats(-20.0, 20.0)


@settings(max_examples=25, deadline=None)
@given(shift, shift, shift, st.floats(-3.0, 3.0), st.floats(-1.0, 1.0))
def test_any_sides_are_mirror_images(x, y, z, camber, toe):
    changes = {
        "hardpoints.strut_top.x": -28.0 + x,
        "hardpoints.tie_rod_outer.y": -690.0 + y,
        "hardpoints.ball_joint.z": 180.0 + z,
        "wheel.camber_deg": camber,
        "wheel.toe_deg": toe,
    }
    assert_mirror_images(CAR.with_changes(changes))


def test_free_rack_changes_no_characteristic():
    free = Model(CAR, free_rack=True)
    for a, b in (
        (characteristics.over(MODEL, "travel"), characteristics.over(free, "travel")),
        (characteristics.over(MODEL, "rack", [0.02]), characteristics.over(free, "rack", [0.02])),
    ):
        for name in a:
            assert a[name].values == pytest.approx(b[name].values, rel=1e-9, abs=1e-12), name


# -- a strut beside the ball joint, and a spring with an axis of its own --------------------------

OFFSET = CAR.with_changes(
    {
        "hardpoints.strut_lower": [-10.0, -640.0, 420.0],
        "hardpoints.spring_top": [-30.0, -570.0, 800.0],
        "hardpoints.spring_seat": [-12.0, -650.0, 480.0],
        "strut.spring_free_slide_mm": None,
        "strut.spring_free_length_mm": 420.0,
        "strut.length_max_mm": 600.0,
        "bump_stop": {"clearance_mm": 10.0, "rate_N_per_m": 3e4},
    }
)


@pytest.mark.parametrize("place", [(-0.05, 0.01), (0.04, 0.0)], ids=str)
def test_derivatives_are_those_of_the_curves(place):
    """The oracle has no such strut: slopes are compared with the curves that they belong to."""
    travel, rack = place
    model = Model(OFFSET)
    steps = np.array([0.0, *(k * 2e-3 for k in range(-4, 5) if k)])
    curves = characteristics.over(model, "travel", travel + steps, rack_position=rack)

    def slope(name):
        values = dict(zip(steps.round(9).tolist(), curves[name].values, strict=True))
        return difference(lambda h: values[round(h, 9)])

    at = curves.isel(wheel_travel=0)
    for name, of, sign in (
        ("camber_gradient", "camber", 1.0),
        ("bump_steer", "toe", 1.0),
        ("caster_gradient", "caster", 1.0),
        ("motion_ratio", "spring_length", -1.0),
        ("damper_motion_ratio", "damper_length", -1.0),
    ):
        assert float(at[name]) == pytest.approx(sign * slope(of), rel=SLOPE, abs=SLOPE), name
    # the spring's and the stop's force at the wheel, from the laws in the file
    seat = float(characteristics.over(model, "travel", [0.0])["damper_length"][0]) - 0.010
    pressed = np.maximum(0.0, seat - curves["damper_length"])
    curves["force"] = (
        25e3 * (0.420 - curves["spring_length"]) * curves["motion_ratio"]
        + 3e4 * pressed * curves["damper_motion_ratio"]
    )
    assert float(at["wheel_rate"]) == pytest.approx(slope("force"), rel=1e-9)


MIRRORED = {name: car for name, (_, car) in BENCHES.items()} | {
    "offset strut": OFFSET,
    **{name: Suspension.load(name) for name in ("push_rod_car", "pull_rod_car", "multi_link_car")},
}


@pytest.mark.parametrize("name", MIRRORED)
def test_sides_are_mirror_images(name):
    assert_mirror_images(MIRRORED[name])


def test_spring_and_damper_differ_where_the_spring_has_seats():
    at = characteristics.over(Model(OFFSET), "travel", [0.0]).isel(wheel_travel=0)
    # between the hardpoints, in mm
    seats, strut = [18.0, -80.0, -320.0], [18.0, -55.0, -400.0]
    assert float(at["spring_length"]) * 1e3 == pytest.approx(np.linalg.norm(seats), rel=1e-13)
    assert float(at["damper_length"]) * 1e3 == pytest.approx(np.linalg.norm(strut), rel=1e-13)
    assert float(at["motion_ratio"]) != pytest.approx(float(at["damper_motion_ratio"]), rel=1e-3)


# -- the datasets ---------------------------------------------------------------------------------


def both():
    return characteristics.over(MODEL, "travel"), characteristics.over(MODEL, "rack")


def test_every_variable_has_its_definition():
    factors = {
        ("rad", "deg"): 180.0 / np.pi,
        ("m", "mm"): 1e3,
        ("m", "m"): 1.0,
        ("N/m", "N/mm"): 1e-3,
        ("rad/m", "deg/mm"): 0.18 / np.pi,
        ("1", "1"): 1.0,
        ("1", "%"): 100.0,
    }
    for dataset in both():
        for variable in dataset.drop_vars("wheel").variables.values():
            words = variable.attrs
            assert words["long_name"]
            assert words["definition"]
            assert words["sign"]
            shown_in = words["units"], words["display_units"]
            assert words["display_factor"] == pytest.approx(factors[shown_in], rel=1e-15)


def test_coordinates_are_what_was_asked_for():
    travel, rack = np.array([0.02, -0.01, 0.02]), np.array([0.01, -0.01])
    a = characteristics.over(MODEL, "travel", travel, rack_position=0.005)
    b = characteristics.over(MODEL, "rack", rack, travel=-0.01)
    assert np.array_equal(a["wheel_travel"], travel)
    assert float(a["rack_position"]) == 0.005
    assert np.array_equal(b["rack_position"], rack)
    assert float(b["wheel_travel"]) == -0.01
    for dataset, name in ((a, "wheel_travel"), (b, "rack_position")):
        assert all(variable.dims == (name,) for variable in dataset.data_vars.values())


def test_a_double_wishbone_has_every_characteristic_of_a_strut():
    for strut, motion in zip(both(), ("travel", "rack"), strict=True):
        assert {*characteristics.over(Model(RODS), motion, [0.01])} == {*strut}


def test_default_ranges():
    travel, steering = both()
    assert travel["wheel_travel"].values[[0, -1]].tolist() == [-0.08, 0.08]
    assert steering["rack_position"].values[[0, -1]].tolist() == [-0.06, 0.06]


def test_without_data_of_the_vehicle_what_needs_them_is_left_out():
    changes = {
        "vehicle.wheelbase_mm": None,
        "vehicle.front_brake_share": None,
        "rack.travel_per_turn_mm": None,
    }
    bare = Model(CAR.with_changes(changes))
    full, less = both(), (characteristics.over(bare, "travel"), characteristics.over(bare, "rack"))
    assert set(full[0]) - set(less[0]) == {"anti_dive"}
    axle_only = {"ackermann_error", "ackermann", "turning_circle", "steering_ratio"}
    assert set(full[1]) - set(less[1]) == axle_only


def test_without_a_ground_the_contact_is_left_out():
    low = CHRONO.with_changes({"tyre.radius_mm": None})
    assert low.tyre_radius() is None
    found = characteristics.over(Model(low), "travel", [0.0])
    assert "camber" in found
    assert not {"trail", "half_track_change", "roll_center_height_kinematic"} & set(found)


def test_tyre_radius_is_the_height_of_the_wheel_unless_given():
    assert CAR.tyre_radius() == 0.3
    assert CAR.with_changes({"tyre.radius_mm": 312.5}).tyre_radius() == 0.3125


def test_an_instant_centre_at_infinity_is_infinite():
    flat = corner(MODEL, MODEL.design_state[0])
    still = flat.travel.per(np.array(1.0))
    still.turning[...] = 0.0
    still.velocity[...] = [0.0, 0.0, 1.0]
    rising = dataclasses.replace(flat, travel=still)
    assert np.isinf(wheel.swing_arm_length_kinematic(rising))
    assert wheel.roll_center_height_kinematic(rising) == 0.0


# -- refusals -------------------------------------------------------------------------------------


@pytest.mark.parametrize("wrong", [[], 0.01, [[0.0]], [np.nan], [np.inf]])
def test_what_is_no_row_of_numbers_is_refused(wrong):
    for motion in ("travel", "rack"):
        with pytest.raises(InputError, match="number"):
            characteristics.over(MODEL, motion, wrong)


# -- the page -------------------------------------------------------------------------------------

PAGE = (ROOT / "docs/suspension/characteristics.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "name", ["reference_car", "reference_axle", "rigid_axle", "twist_beam", "steered_rigid_axle"]
)
def test_every_characteristic_is_on_the_page(name):
    assembly = assembly_of(kintrafo.load(name))
    measures = [one for motion in assembly.motions for one in assembly.measures(motion)]
    written = set(re.findall(r"`(\w+)`", PAGE))
    for first, endings in re.findall(r"`(\w+)`((?:, `\.\.\._\w+`)+)", PAGE):
        written |= {f"{first}{ending}" for ending in re.findall(r"\.(_\w+)", endings)}
    written = {re.sub("_(left|right)$", "", one) for one in written}
    assert {re.sub("_(left|right)$", "", one.quantity.name) for one in measures} <= written


def test_examples_of_the_page_run(capsys):
    names = {}
    for block in re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL):
        exec(block, names)
    printed = capsys.readouterr().out.splitlines()
    assert float(printed[0]) == pytest.approx(np.deg2rad(-0.9139), abs=1e-6)
    assert printed[1] == "positive with the top outboard"
    assert printed[-1] == "12.35 Hz, damping ratio 0.233"
