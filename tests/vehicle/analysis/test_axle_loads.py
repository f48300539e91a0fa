"""Loads of whole axles: against balances of the whole, and work."""

import numpy as np
import pytest
from cars.axles import AXLE, BENT, placed
from kintrafo import Axle, AxleModel, System, loads
from kintrafo.systems.compile.compiler import find_compiler
from kintrafo.vehicle.assembly.axle_kinematics import AxleKinematics
from kintrafo.vehicle.models.points import carried
from kintrafo.vehicle.models.positions import arm_angles, design_height
from kintrafo.vehicle.models.reach import at_rest

SIDES = ("left", "right")
# Forces at both ends, on both wheels, of different sizes, the rack aside.
PUSHED = {
    "pushed": {
        "rack_mm": 8.0,
        "left": {"contact_N": [-1500.0, 700.0, 3900.0], "contact_Nm": [20.0, 5.0, -60.0]},
        "right": {"contact_N": [300.0, 1900.0, 5200.0], "center_N": [600.0, -50.0, 80.0]},
    }
}


def of(found, part, by="", point=""):
    """Return the loads on a part, of its first case."""
    rows = (found["part"] == part) & found["by"].str.startswith(by)
    return found.isel(case=0).isel(load=(rows & found["point"].str.startswith(point)).values)


def test_mounts_name_what_they_carry():
    found = loads.static(AXLE, PUSHED)
    by = dict(zip(found["mount"].values, found["total_by"].values, strict=True))
    assert by["rack_middle"] == "steering, rack"
    assert by["strut_top_left"] == "upper_strut_left, spring_left"


@pytest.mark.parametrize("axle", [AXLE, BENT], ids=["reference", "bent"])
def test_links_do_the_work_of_the_bar(axle):
    """Virtual work: force of a link on the path of its foot, against the energy of the bar."""
    found = loads.static(axle, PUSHED)
    travels = {side: float(found["travel"].sel(wheel=side)[0]) for side in SIDES}
    step = 1e-4  # of travel [m]: its square is the error of a slope, 1e-8 over lengths of 0.1 m
    here = AxleKinematics.at(axle, *([travels[s]] for s in SIDES), [0.008])
    np.testing.assert_allclose(found["bar_torque"], here.torque, rtol=1e-9)
    for side in SIDES:
        ends = [travels[s] + (s == side) * np.array([-step, step]) for s in SIDES]
        twist = AxleKinematics.at(axle, *ends, [0.008, 0.008]).twist
        model, half = axle.models[side], axle.halves[side]
        heights = design_height(model) + ends[SIDES.index(side)]
        state = at_rest(model, arm_angles(model, heights, 0.008), 0.008)
        feet = carried(model, {"foot": (half.body, half.foot)}, *state)["foot"]
        (force,) = of(found, f"{half.body}_{side}", "drop_link")["force"].values
        work = -float(here.torque[0] * (twist[1] - twist[0]))
        assert force @ (feet[1] - feet[0]) == pytest.approx(work, rel=1e-5)
        link = of(found, f"drop_link_{side}")
        along = np.diff(link["at"].values, axis=0)[0]
        assert np.linalg.norm(np.cross(along, force)) < 1e-9 * np.linalg.norm(force)


def test_the_steering_holds_both_tie_rods():
    """The axis of the rack points to the left, and the rods push it across only."""
    found = loads.static(AXLE, PUSHED)
    rods = of(found, "rack", "tie_rod")["force"].values
    assert rods.shape == (2, 3)
    assert float(found["rack_force"][0]) == pytest.approx(-rods[:, 1].sum(), abs=1e-9)


def test_a_bar_bends_where_one_wheel_is_held():
    """The free wheel goes along with the held one, less than it, and the road holds the other."""
    case = {"one": {"left": {"contact_g": [0.0, 0.0, 1.0]}, "right": {"travel_mm": 30.0}}}
    found = loads.static(AXLE, case)
    assert float(found["travel"].sel(wheel="right")[0]) == pytest.approx(0.03, abs=1e-9)
    assert 0.0 < float(found["travel"].sel(wheel="left")[0]) < 0.03
    alone = loads.static(AXLE.models["right"], {"one": {"travel_mm": 30.0}})
    assert float(found["wheel_load"].sel(wheel="right")[0]) > float(alone["wheel_load"][0]) + 100.0


@pytest.mark.parametrize("axle", [AXLE, BENT], ids=["reference", "bent"])
def test_the_axle_rests_in_the_position_of_the_equations(axle):
    """Forces of the compiled equations of the whole, by the work of vertical ones at the wheels."""
    if find_compiler() is None:
        pytest.skip("no C compiler")
    push = {"left": 3000.0, "right": 5500.0}
    case = {"rack_mm": 5.0} | {side: {"center_N": [0.0, 0.0, push[side]]} for side in SIDES}
    found = loads.static(axle, {"a": case})
    model = AxleModel(axle)
    zero = {name: 0.0 for name in model.parameters if name.endswith("tyre_rate")}
    without_tyres = System(model.equations, model.parameters | zero)
    travels = {side: found["travel"].sel(wheel=side).values for side in SIDES}
    states, inputs = placed(model, travels, np.array([0.005]))
    forces = without_tyres.evaluate("forces", states, inputs)
    for side, corner in axle.models.items():
        unit = states.copy()
        unit[:, model.state_names.index(f"{side}_{corner.names.arm}_rate")] = 1.0
        rise = model.signal(f"{side}_{axle.end}_wheel_velocity", unit, inputs)
        left = forces[:, model.state_names.index(f"{side}_{corner.names.arm}")] + push[side] * rise
        # 1e-12 m of travel by 1e5 N/m and a lever of 0.4 m
        np.testing.assert_allclose(left, 0.0, atol=1e-5)


def test_a_search_that_leads_out_of_reach_ends_no_other_case():
    """Newton's method may step to where the arm or a drop link does not reach."""
    awkward = {"left": {"contact_g": [0.0, 0.0, 0.2]}, "right": {"contact_g": [0.0, 1.5, 0.5]}}
    still = {"contact_g": [0.0, 0.0, 1.0]}
    found = loads.static(Axle.load("reference_axle"), {"awkward": awkward, "still": still})
    assert found["reason"].sel(case="still") == ""
    far = {"left": {"travel_mm": 400.0}, "right": still}
    found = loads.static(Axle.load("reference_axle"), {"far": far, "still": still})
    assert str(found["reason"].sel(case="far").values).startswith("left: ")
