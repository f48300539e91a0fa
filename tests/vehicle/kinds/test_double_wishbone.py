"""Positions, characteristics and equilibrium of the double wishbone, from its input file.

The oracle is a wheel carrier on five rods (`oracle.links`), whose poses are found anew.
"""

import kintrafo
import numpy as np
import pytest
from kintrafo import Model, Suspension, characteristics
from kintrafo.vehicle.models.points import hardpoints
from oracle.corners import SKEWED, Wishbones

CAR = Suspension.load("double_wishbone_car")
MODEL = Model(CAR)
CARS = {"packaged": CAR, "other": SKEWED, "left": SKEWED.mirrored()}
PLACES = [(-0.07, 0.0), (0.0, 0.0), (0.03, 0.025), (0.08, -0.03)]  # wheel travel, rack [m]

# Poses are rounded to some 1e-15.
POSE = 1e-13


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


# -- characteristics ------------------------------------------------------------------------------


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
