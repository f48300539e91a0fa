"""The multi-link suspension: five links that hold a knuckle, whose loops are closed by iteration.

`test_mechanisms` compares its equations with maximal coordinates, like those of every model.
"""

import numpy as np
import pytest
from kintrafo import InputError, Model, PositionError, Suspension, characteristics, state_at_height
from kintrafo.vehicle.analysis.sweep import positions
from kintrafo.vehicle.models.points import hardpoints
from kintrafo.vehicle.models.positions import arm_angles, design_height
from kintrafo.vehicle.models.reach import at_rest
from scipy.optimize import brentq, fsolve
from scipy.spatial.transform import Rotation

CAR = Suspension.load("multi_link_car")
MODEL = Model(CAR)
LINKS = ("front_upper_link", "rear_upper_link", "front_lower_link", "rear_lower_link", "tie_rod")
TRAVELS = np.linspace(-0.08, 0.08, 9)


def points_at(model, travels, rack=0.0):
    """Return the hardpoints at wheel travels."""
    angles = arm_angles(model, design_height(model) + travels, rack)
    return hardpoints(model, *at_rest(model, angles, rack))


# -- against a root finder ----------------------------------------------------------------------


@pytest.mark.parametrize("rack", [0.0, 0.015])
def test_the_knuckle_is_where_a_root_finder_puts_it(rack):
    """Lengths of five links and a height, in the shift and the turn of the knuckle."""
    design, found = CAR.hardpoints.at_design(), points_at(MODEL, TRAVELS, rack)
    center, ends = design["wheel_center"], np.array([design[f"{name}_outer"] for name in LINKS])
    inner = np.array([design[f"{name}_inner"] for name in LINKS])
    lengths = np.linalg.norm(ends - inner, axis=1)
    inner[-1, 1] += rack
    for i, travel in enumerate(TRAVELS):

        def moved(pose, places):
            turned = Rotation.from_rotvec(pose[3:]).apply(places - center)
            return center + pose[:3] + turned

        def misfit(pose, travel=travel):
            off = np.linalg.norm(moved(pose, ends) - inner, axis=1) - lengths
            return np.append(off, pose[2] - travel)

        pose, _, ended, words = fsolve(misfit, np.zeros(6), xtol=1e-14, full_output=True)
        assert np.abs(misfit(pose)).max() < 1e-13, (ended, words)
        for name, place in zip(LINKS, moved(pose, ends), strict=True):
            # roundings of lengths below 1 m, over a condition of some ten
            np.testing.assert_allclose(found[f"{name}_outer"][i], place, rtol=0.0, atol=1e-13)


# -- what it is as a suspension -----------------------------------------------------------------


def test_the_knuckle_turns_about_the_axis_that_is_reported():
    """When the rack moves and the spring keeps its length, no point moves along the axis alone."""
    travel, by = 0.04, 1e-4
    here = characteristics.over(MODEL, "travel", [travel])
    caster, kpi = float(here["caster"][0]), float(here["kingpin_inclination"][0])
    axis = np.array([-np.tan(caster), np.tan(kpi), 1.0])  # a right wheel's top leans to the left
    state = state_at_height(MODEL, design_height(MODEL) + travel)
    length = MODEL.signal("spring_length", state)

    def locked(rack):
        def stretched(angle):
            return float(MODEL.signal("spring_length", *at_rest(MODEL, angle, rack)) - length)

        angle = brentq(stretched, state[0] - 0.1, state[0] + 0.1, xtol=1e-15)
        return hardpoints(MODEL, *at_rest(MODEL, angle, rack))

    ahead, behind = locked(by), locked(-by)
    moved = {name: (ahead[name] - behind[name]) / (2.0 * by) for name in ahead}
    turned = 0.0
    for name in (f"{link}_outer" for link in LINKS):
        relative = moved[name] - moved["wheel_center"]
        # by^2 of the difference
        assert abs(relative @ axis) < 1e-6
        turned = max(turned, float(np.abs(relative).max()))
    assert turned > 0.5


@pytest.mark.parametrize(
    "changes",
    [
        # the toe link in the line of the front lower one
        {
            "hardpoints.tie_rod_inner": [230.0, -440.0, 225.0],
            "hardpoints.tie_rod_outer": [30.0, -705.0, 190.0],
        },
        {"hardpoints.rear_upper_link_inner": [-50.0, -680.0, 470.0]},
        {"hardpoints.rear_upper_link_inner": [-50.0, -680.0, 300.0]},
        {"bodies.front_upper_link": {"mass_kg": 1.0}},
        {"damper.length_min_mm": 600.0},
    ],
)
def test_what_cannot_be_is_refused(changes, refused):
    refused(InputError, lambda: CAR.with_changes(changes))


def test_words_are_those_of_the_kind(refused):
    found = positions(MODEL, [0.0], [0.0])
    assert "height sensor" in found["arm_angle"].attrs["long_name"]
    refused(PositionError, lambda: arm_angles(MODEL, design_height(MODEL), 0.15))


def test_a_spring_that_does_not_move_locks_nothing():
    """Then the motion of steering is not defined, and neither is its axis."""
    flat = CAR.with_changes({"hardpoints.spring_top": [-85.0, -800.0, 200.0]})
    found = characteristics.over(Model(flat), "travel", [0.0, 0.06])
    assert np.isnan(found["caster"][0])
    assert np.isfinite(found["toe"]).all()
    assert np.isfinite(found["caster"][1])
