"""Loads of rigid axles: against work that a root finder sees, and balances.

The root finder of `test_rigid_axle` shares nothing with the equations or the balance of the parts.
"""

import math

import numpy as np
import pytest
from cars.rigid_axles import AXLE, LOPSIDED, MODEL, STOPPED, Found, each_axle, slopes
from kintrafo import (
    InputError,
    PositionError,
    RigidAxle,
    RigidAxleModel,
    equilibrium,
    loads,
    roads,
    simulate,
)
from kintrafo.vehicle.analysis.loads.sheets import overview
from kintrafo.vehicle.analysis.scenario import Scenario, run

SIDES = ("left", "right")
# Forces and moments at both places of both wheels, all of them different.
PUSHED = {
    "pushed": {
        "left": {"contact_N": [-1500.0, 700.0, 5900.0], "contact_Nm": [20.0, 5.0, -60.0]},
        "right": {
            "contact_N": [300.0, 1900.0, 8200.0],
            "center_N": [600.0, -50.0, 80.0],
            "center_Nm": [10.0, -90.0, 30.0],
        },
    },
    "held": {
        "left": {"travel_mm": 12.0, "contact_N": [800.0, -500.0, 0.0]},
        "right": {"contact_N": [-900.0, 400.0, 7000.0]},
    },
    "both held": {"travel_mm": -20.0, "contact_N": [0.0, 1000.0, 0.0]},
}
PUSHED = {name.replace(" ", "_"): case for name, case in PUSHED.items()}
each_case = pytest.mark.parametrize("case", PUSHED)


def on(found, part, by=""):
    """Return the loads on a part."""
    rows = (found["part"] == part) & found["by"].str.startswith(by)
    return found.isel(load=rows.values)


def where(axle, found):
    """Return heave and roll of one case."""
    left, right = (float(found["travel"].sel(wheel=side)) for side in SIDES)
    return 0.5 * (left + right), math.asin(0.5 * (left - right) / axle.half_track)


class Held(Found):
    """The root finder with one rod longer than it is."""

    def __init__(self, axle, rod=0, longer=0.0):
        super().__init__(axle)
        self.lengths = self.lengths + longer * np.eye(4)[rod]


def outside(found):
    """Return what acts on the wheels from outside."""
    rows = found["by"].str.startswith("road") | found["by"].str.startswith("drive")
    return found.isel(load=rows.values)


def work_of(axle, here, at):
    """Return what takes poses and tells energy less the work of the outside from one pose on."""
    middle, turn = Found(axle).pose(*at)
    pushes = outside(here)
    places = pushes["at"].values
    local = turn.inv().apply(places - middle)

    def potential(finder, heave, roll):
        moved, turned = finder.pose(heave, roll)
        ways = moved + turned.apply(local) - places
        # a small turn from the pose; its square is odd, and even ones the differences leave out
        angle = (turned * turn.inv()).as_rotvec()
        work = (pushes["force"].values * ways).sum() + (pushes["moment"].values @ angle).sum()
        return float(finder.energy(heave, roll) - work)

    return potential


# -- against work ---------------------------------------------------------------------------------


@each_axle
@each_case
def test_loads_do_as_much_work_as_springs_weight_and_bar(axle, case):
    """In heave and roll, of the road, held wheels and all."""
    here = loads.static(axle, {case: PUSHED[case]}).sel(case=case)
    at = where(axle, here)
    potential = work_of(axle, here, at)
    finder = Found(axle)
    # 1e-13 m of the root finder, by forces of 1e4 N, over the step of 1e-3, some of them
    left = slopes(lambda heave, roll: potential(finder, heave, roll), at)
    np.testing.assert_allclose(left, 0.0, atol=5e-5)


@each_axle
def test_a_rod_does_the_work_of_all_that_it_holds(axle):
    """Each rod cut in turn: its force over its growth, heave and roll held."""
    here = loads.static(axle, {"pushed": PUSHED["pushed"]}).sel(case="pushed")
    at = where(axle, here)
    potential = work_of(axle, here, at)
    step, weights = 1e-3, {-2: 1.0, -1: -8.0, 1: 8.0, 2: -1.0}
    for number, name in enumerate(axle.rods):
        by_length = sum(
            weight * potential(Held(axle, number, times * step), *at)
            for times, weight in weights.items()
        ) / (12.0 * step)
        # the fourth power of the step over lengths of half a metre, by forces of 1e4 N
        assert float(here["rod_force"].sel(rod=name)) == pytest.approx(-by_length, abs=2e-3)


# -- balances -------------------------------------------------------------------------------------


def test_a_rod_carries_a_force_along_it_and_no_moment():
    found = loads.static(LOPSIDED, PUSHED)
    for rod in LOPSIDED.rods:
        names = [
            f"{rod} at {rod}_{end} by {by}" for end, by in (("axle", "beam"), ("chassis",) * 2)
        ]
        # a cross could carry a moment about both of its axes: 1e-16 of 1e4 N m is left
        np.testing.assert_allclose(found["moment"].sel(load=names), 0.0, atol=1e-10)
        inner, outer = (found["at"].sel(load=name).values for name in names)
        along = (outer - inner) / np.linalg.norm(outer - inner, axis=-1, keepdims=True)
        pull = found["rod_force"].sel(rod=rod).values[:, None] * along
        np.testing.assert_allclose(found["force"].sel(load=names[1]), pull, rtol=1e-12, atol=1e-9)


def test_components_in_the_axes_of_a_part_are_turned():
    found = loads.static(LOPSIDED, PUSHED).sel(case="pushed")
    turn = Found(LOPSIDED).pose(*where(LOPSIDED, found))[1]
    beam = on(found, "beam")
    back = turn.apply(beam["force_in_part"].values)
    np.testing.assert_allclose(back, beam["force"].values, rtol=0.0, atol=1e-7)


# -- by hand --------------------------------------------------------------------------------------

LEVEL = AXLE.with_changes(
    {
        "rods.left_link": {"chassis": [620.0, 500.0, 310.0], "axle": [20.0, 500.0, 310.0]},
        "rods.right_link": {"chassis": [620.0, -500.0, 310.0], "axle": [20.0, -500.0, 310.0]},
        "rods.upper_link": {"chassis": [480.0, 0.0, 530.0], "axle": [-20.0, 0.0, 530.0]},
        "rods.panhard_rod": {"chassis": [0.0, -460.0, 400.0], "axle": [0.0, 460.0, 400.0]},
        "hardpoints.spring_top": [0.0, -500.0, 700.0],
        "hardpoints.spring_seat": [0.0, -500.0, 360.0],
        "spring.force_at_design_N": 0.0,
        "gravity.acceleration_m_per_s2": 0.0,
    }
)


def test_a_stop_carries_what_the_spring_does_not():
    """Upright dampers that end under the wheels: the rest of the load over the spring's."""
    axle = LEVEL.with_changes(
        {
            "hardpoints.damper_top": [0.0, -780.0, 800.0],
            "hardpoints.damper_seat": [0.0, -780.0, 360.0],
            "hardpoints.spring_top": [0.0, -780.0, 700.0],
            "hardpoints.spring_seat": [0.0, -780.0, 360.0],
            "bump_stop": {"clearance_mm": 20.0, "rate_N_per_m": 1e5},
        }
    )
    found = loads.static(axle, {"a": {"contact_N": [0.0, 0.0, 6000.0]}}).sel(case="a")
    travel = float(found["travel"].sel(wheel="left"))
    # seats that move by some 3 mm incline the springs by 1 %, times the slope of the links, 9 %
    assert 48000.0 * travel + 1e5 * (travel - 0.02) == pytest.approx(6000.0, rel=3e-3)
    push = float(on(found, "beam", "damper_left")["force"].sel(axis="z").item())
    assert push == pytest.approx(-1e5 * (travel - 0.02), rel=1e-3)


@pytest.mark.parametrize("pressed", [-1e-7, 0.0, 1e-8, 1e-6, 1e-3])
@pytest.mark.parametrize("rate", [1e5, 1e8])
def test_a_stop_that_is_hardly_touched_is_found(pressed, rate):
    """The forces of a held road, given as a load case, lead to the same position."""
    travel = 0.05
    model = RigidAxleModel(LEVEL)
    lengths = [
        float(model.signal("left_damper_length", model.states_at(way, way)))
        for way in (0.0, travel)
    ]
    clearance = 1e3 * (lengths[0] - lengths[1] - pressed)
    axle = LEVEL.with_changes({"bump_stop": {"clearance_mm": clearance, "rate_N_per_m": rate}})
    held = loads.static(axle, {"a": {"travel_mm": 1e3 * travel}}).sel(case="a")
    road = {
        side: {"contact_N": [0.0, 0.0, float(held["wheel_load"].sel(wheel=side))]} for side in SIDES
    }
    free = loads.static(axle, {"a": road}).sel(case="a")
    for side in SIDES:
        assert float(free["travel"].sel(wheel=side)) == pytest.approx(travel, abs=1e-10)


def test_a_static_load_is_that_which_is_given():
    given = loads.static(AXLE, static_load=6000.0).sel(case="static")
    assert float(given["wheel_load"].sel(wheel="left")) == pytest.approx(6000.0, rel=1e-12)


def test_usual_cases_are_all_carried_between_stops():
    found = loads.static(STOPPED)
    assert [*found["case"].values] == [*loads.standard_cases(AXLE)]
    assert not any(found["reason"].values)


# -- along a motion -------------------------------------------------------------------------------


def test_a_damper_pushes_with_its_friction_and_its_stops():
    model = RigidAxleModel(LOPSIDED.with_changes({"damper.friction_N": 60.0}))
    step = {"left_road_height": roads.step(0.03, at=0.01, end=0.03)}
    moving = simulate(model, (0.0, 0.03), equilibrium(model), inputs=step)
    force = on(loads.along(model, moving), "beam", "damper_left")["force"].values[:, 0]
    pushes = sum(
        moving.signals[f"left_damper_{name}"]
        for name in ("damper_force", "friction_force", "bump_stop_force", "rebound_stop_force")
    )
    np.testing.assert_allclose(np.linalg.norm(force, axis=-1), abs(pushes), atol=1e-9)


# -- unsupported loads, and errors ----------------------------------------------------------------


def test_no_spring_is_turned_upside_down():
    """Without stops a great load leads over a spring that lies across, which would carry it."""
    found = loads.static(AXLE, static_load=6350.0)
    for case in ("bump", "pothole"):
        reason = str(found["reason"].sel(case=case).values)
        assert "a spring or a damper has turned by a right angle" in reason
    assert (loads.static(STOPPED, static_load=6350.0)["reason"] == "").all()


def test_a_motion_through_a_dead_point_is_refused(monkeypatch, refused):
    motion = simulate(MODEL, (0.0, 0.01), equilibrium(MODEL))
    monkeypatch.setattr("kintrafo.vehicle.analysis.loads.balance._WORST_CONDITION", 1.0)
    refused(PositionError, lambda: loads.along(MODEL, motion))


def test_what_the_wheels_need_is_named(refused):
    low = {"hardpoints.wheel_center.z": 50.0, "tyre.free_height_mm": 77.6}
    refused(InputError, lambda: loads.static(AXLE.with_changes(low)))
    soft = AXLE.with_changes({"tyre.rate_N_per_m": 0.0, "spring.rate_N_per_m": 1.0})
    refused(InputError, lambda: loads.static(soft))


@pytest.mark.parametrize(
    "name", ["chassis", "beam", "wheel_left", "spring", "damper_right", "bar", "gravity", "road"]
)
def test_a_rod_is_not_called_like_another_part(name, refused):
    data = AXLE.to_dict()
    data["rods"][name] = data["rods"].pop("upper_link")
    refused(InputError, lambda: RigidAxle.from_dict(data))


# -- tables, pictures and commands ----------------------------------------------------------------


def test_each_rod_has_a_row_with_its_sign():
    found = loads.static(STOPPED)
    rows = {row[0]: row[1:] for row in overview(found, "").rows}
    column = [*found["case"].values].index("brake")
    assert int(rows["upper_link, pull"][column]) < -20000
    assert "upper_link_axle" not in rows
    assert "axle_middle" not in rows
    assert {"spring_left", "damper_right", "road_left", "wheel_center_right"} <= {*rows}
    part = {row[0] for row in overview(found, "", ["beam"]).rows}
    assert "upper_link_axle" in part
    ends = loads.envelope(found)
    extremes = ends["force_max"].sel(load="beam at upper_link_axle by upper_link", axis="x")
    assert float(extremes) == float(
        found["force"].sel(load="beam at upper_link_axle by upper_link", axis="x").max()
    )
    assert "reason" in loads.table(found)


@pytest.mark.usefixtures("first_page_of_curves", "one_picture")
def test_the_report_has_the_load_cases(kintrafo, tmp_path):
    text = "[cases.stop]\ncontact_g = [-1.0, 0.0, 1.2]\n"
    (tmp_path / "cases.toml").write_text(text, encoding="utf-8")
    soft = "[bushings.panhard_rod_chassis]\naxial_N_per_mm = 5000.0\n"
    (tmp_path / "soft.toml").write_text(soft, encoding="utf-8")
    given = ["--cases", "cases.toml", "--bushes", "soft.toml"]
    code, _, err = kintrafo("report", "rigid_axle", "one.html", *given)
    assert code == 0, err
    page = (tmp_path / "one.html").read_text(encoding="utf-8")
    assert "Load cases" in page
    assert "Free bodies in the load case stop" in page
    assert "panhard_rod, pull" in page
    assert ">Compliance<" in page
    assert ">Elastokinematics<" in page


def test_a_ride_has_its_loads():
    moving, _ = run(MODEL, Scenario(duration=0.02))
    found = loads.along(MODEL, moving)
    heave, roll = moving.y[0, -1], moving.y[1, -1]
    ways = {"left": heave + 0.78 * math.sin(roll), "right": heave - 0.78 * math.sin(roll)}
    held = {side: {"travel_mm": 1e3 * way} for side, way in ways.items()}
    still = loads.static(AXLE, {"a": held})
    # at rest tyres of 6.3 kN each push in planes that are inclined by some 2e-5
    np.testing.assert_allclose(
        found["rod_force"].isel(time=-1), still["rod_force"].isel(case=0), atol=0.3
    )
