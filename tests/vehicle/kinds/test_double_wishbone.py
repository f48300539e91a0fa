"""Positions, characteristics and equilibrium of the double wishbone, from its input file.

The oracle is a wheel carrier on five rods (`oracle.links`), of which everything is measured anew,
gradients by central differences; besides, arrangements that can be computed by hand.
"""

import kintrafo
import numpy as np
import pytest
from differences import difference, second_difference
from hypothesis import given, settings
from hypothesis import strategies as st
from kintrafo import Model, PositionError, Suspension, characteristics
from kintrafo.vehicle.models.points import hardpoints
from oracle.links import Carrier

CAR = Suspension.load("double_wishbone_car")
MODEL = Model(CAR)
OTHER = CAR.with_changes(
    {
        "hardpoints.lower_arm_front.z": 205.0,
        "hardpoints.upper_arm_rear.y": -445.0,
        "hardpoints.upper_ball_joint.x": -35.0,
        "hardpoints.tie_rod_inner.z": 270.0,
        "hardpoints.spring_seat.x": 25.0,
        "wheel.camber_deg": -1.5,
        "wheel.toe_deg": 0.3,
        "rack.axis": [0.05, 1.0, 0.02],
        "tyre.radius_mm": 310.0,
    }
)
CARS = {"packaged": CAR, "other": OTHER, "left": OTHER.mirrored()}
PLACES = [(-0.07, 0.0), (0.0, 0.0), (0.03, 0.025), (0.08, -0.03)]  # wheel travel, rack [m]
UP = np.array([0.0, 0.0, 1.0])

# Poses are rounded to some 1e-15; differences over 2 mm to 1e-12, and ratios of them follow.
POSE, SLOPE = 1e-13, 1e-9


class Bench:
    """A car on the oracle's test bench."""

    def __init__(self, suspension):
        self.suspension = suspension
        names = suspension.hardpoints.names()
        self.points = {name: suspension.hardpoints.metres(name) for name in names}
        self.side = np.sign(self.points["wheel_center"][1])
        self.carrier = Carrier(self.points, np.array(suspension.rack.axis))
        self.radius = suspension.tyre_radius()
        camber, toe = (np.radians(getattr(suspension.wheel, f"{a}_deg")) for a in ("camber", "toe"))
        # outboard, with the angles of docs/reference/conventions.md
        axis = np.array([np.tan(toe), self.side, -np.tan(camber)])
        self.design_axis = axis / np.linalg.norm(axis)
        self._poses = {}

    def pose(self, place):
        """Solve for a position, once: many quantities are differentiated there."""
        if place not in self._poses:
            self._poses[place] = self.carrier.at(*place)
        return self._poses[place]

    def axis(self, place):
        return self.pose(place).rotation @ self.design_axis

    def center(self, place):
        return self.pose(place).center

    def joint(self, name, place):
        return self.carrier.point(self.pose(place), name)

    def contact(self, place):
        axis = self.axis(place)
        down = np.cross(axis, np.cross(axis, UP))
        return self.center(place) + self.radius * down / np.linalg.norm(down)

    def camber(self, place):
        axis = self.axis(place)
        return np.arctan2(-axis[2], self.side * axis[1])

    def toe(self, place):
        axis = self.axis(place)
        return np.arctan2(axis[0], self.side * axis[1])

    def caster(self, place):
        along = self.joint("upper_ball_joint", place) - self.joint("lower_ball_joint", place)
        return np.arctan2(-along[0], along[2])

    def seat(self, place):
        return self.carrier.on_arm(self.pose(place), "lower", self.points["spring_seat"])

    def spring(self, place):
        return np.linalg.norm(self.seat(place) - self.points["spring_top"])

    def by_travel(self, quantity, place):
        return difference(lambda h: quantity((place[0] + h, place[1])))

    def by_rack(self, quantity, place):
        return difference(lambda h: quantity((place[0], place[1] + h)))


@pytest.fixture(scope="module", params=CARS, ids=str)
def bench(request):
    return Bench(CARS[request.param])


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


@pytest.mark.parametrize("place", PLACES, ids=str)
def test_angles_and_places(bench, found, place):
    values, side = found[place], bench.side
    low, high = (bench.joint(f"{end}_ball_joint", place) for end in ("lower", "upper"))
    center, contact = bench.center(place), bench.contact(place)
    expected = {
        "camber": bench.camber(place),
        "toe": bench.toe(place),
        "steer": -side * bench.toe(place),
        "caster": bench.caster(place),
        "kingpin_inclination": np.arctan2(-side * (high - low)[1], (high - low)[2]),
        "half_track_change": side * (contact - bench.contact((0.0, 0.0)))[1],
        "wheelbase_change": (center - bench.points["wheel_center"])[0],
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
def test_gradients_and_motion(bench, found, place):
    values, turned = found[place], bench.pose(place).rotation
    contact = bench.contact(place)
    # the contact point as a point of the knuckle
    arm = turned.T @ (contact - bench.center(place))
    velocity = bench.by_travel(lambda p: bench.center(p) + bench.pose(p).rotation @ arm, place)
    turning = bench.by_travel(lambda p: bench.pose(p).rotation @ turned.T, place)
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
    free, rate = parameters["spring_free_length"], parameters["spring_rate"]

    def potential(place):
        return 0.5 * rate * (free - bench.spring(place)) ** 2

    # a step of 4 mm: rounding of 1e-13 J / (4e-3 m)^2, and the eighth power of the step
    expected = second_difference(lambda h: potential((place[0] + h, place[1])), 4e-3)
    assert float(found[place]["wheel_rate"]) == pytest.approx(expected, rel=1e-7)
    series = 1.0 / (1.0 / expected + 1.0 / parameters["tyre_rate"])
    assert float(found[place]["ride_rate"]) == pytest.approx(series, rel=1e-7)


@pytest.mark.parametrize("place", PLACES, ids=str)
def test_geometric_instant_centre_is_on_the_axis_of_the_arms(bench, found, place):
    """About it each ball joint moves across the plane of its arm."""
    values, contact = found[place], bench.contact(place)
    y = contact[1] - bench.side * float(values["swing_arm_length_geometric"])
    # the roll centre is on the line from the contact to the instant centre
    rise = float(values["roll_center_height_geometric"]) / -contact[1]
    centre = np.array([bench.center(place)[0], y, contact[2] + rise * (y - contact[1])])
    balls = {arm: bench.joint(f"{arm}_ball_joint", place) for arm in ("lower", "upper")}
    planes = {
        arm: np.cross(
            bench.points[f"{arm}_arm_front"] - ball, bench.points[f"{arm}_arm_rear"] - ball
        )
        for arm, ball in balls.items()
    }
    axis = np.cross(planes["lower"], planes["upper"])
    axis /= np.linalg.norm(axis)
    for arm, ball in balls.items():
        motion = np.cross(axis, ball - centre)
        off = np.cross(motion, planes[arm]) / np.linalg.norm(planes[arm])
        # arms of up to 30 m
        assert np.abs(off).max() < 1e-11 * max(1.0, np.linalg.norm(ball - centre))


@pytest.mark.parametrize("place", PLACES, ids=str)
def test_steering(bench, place):
    travel, rack = place
    mirrored = Bench(bench.suspension.mirrored())
    found = characteristics.over(Model(bench.suspension), "rack", [rack], travel=travel)
    own, other = (b.by_rack(lambda p, b=b: -b.side * b.toe(p), place) for b in (bench, mirrored))
    assert float(found["steer_gradient"][0]) == pytest.approx(own, rel=SLOPE)
    ratio = 2.0 * np.pi / 0.05 / abs(0.5 * (own + other))
    assert float(found["steering_ratio"][0]) == pytest.approx(ratio, rel=SLOPE)
    left, right = (bench, mirrored) if bench.side > 0.0 else (mirrored, bench)
    for name, one in (("steer_left", left), ("steer_right", right)):
        assert float(found[name][0]) == pytest.approx(-one.side * one.toe(place), abs=POSE)


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
    bench, place = Bench(car), (0.03, 0.01)
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
    bench, model, p = Bench(car), Model(car), car.parameters()
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
