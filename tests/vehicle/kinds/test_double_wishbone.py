"""Positions, characteristics and equilibrium of the double wishbone, from its input file.

The oracle is a wheel carrier on five rods (`oracle.links`), of which everything is measured anew,
gradients by central differences.
"""

import kintrafo
import numpy as np
import pytest
from benches import SKEWED, Wishbones
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


# -- at rest and in motion ------------------------------------------------------------------------


def test_packaged_car_rests_at_its_design_position():
    rest = kintrafo.equilibrium(MODEL)
    # the force at design is given to a thousandth of a newton
    assert float(MODEL.signal("wheel_center_z", rest)) == pytest.approx(0.3, abs=1e-8)
