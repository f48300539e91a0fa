"""Loads in load cases as curves of studies, and names of all wheels of an assembly."""

import json

import numpy as np
import pytest
import xarray as xr
from cars.rigid_axles import FIVE
from kintrafo import Axle, InputError, Suspension, compliance, load, loads, variation
from kintrafo.vehicle.analysis.loads.columns import columns
from kintrafo.vehicle.analysis.loads.sheets import once
from kintrafo.vehicle.assembly.by_wheel import flat
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.cli import app
from kintrafo.vehicle.models.reach import PositionError
from kintrafo.vehicle.report import goals_chapter
from kintrafo.vehicle.studies.evaluation import values_of
from typer.testing import CliRunner

CAR = Suspension.load("reference_car")
ROD = "tie_rod at tie_rod_outer by knuckle"
PLACE = "hardpoints.tie_rod_outer.x"
BRAKE = {"over": "load", "case": "brake"}
ASSEMBLIES = ["reference_car", "reference_axle", "rigid_axle", "twist_beam", "steered_rigid_axle"]


def rod_force(car, case="brake"):
    """Return the size of the force at the outer end of the tie rod [N]."""
    found = loads.static(car, {case: loads.standard_cases(car)[case]})
    return float(np.linalg.norm(found["force"].sel(load=ROD).values))


def rod_force_at(x):
    return rod_force(CAR.with_changes({PLACE: x}))


@pytest.mark.parametrize("name", ASSEMBLIES)
def test_curves_are_the_loads_of_the_same_case(name):
    subject = load(name)
    case = loads.standard_cases(subject)["brake"]
    half = {key: [0.5 * number for number in row] for key, row in case.items()}
    found = loads.static(subject, {"half": half, "brake": case})
    curves = values_of(assembly_of(subject), "load:case=brake", np.array([0.5, 1.0]))
    single = flat(found)
    for row in once(single):
        part, point, by = (str(single[key].values[row]) for key in ("part", "point", "by"))
        acts = by.split("_")[0] in ("spring", "damper", "road", "drive", "steering", "bar")
        stem, mark, side = (by if acts else point).rpartition("_")
        stem, side = (stem, f"_{side}") if side in ("left", "right") else (stem + mark + side, "")
        for kind in ("force", "moment"):
            vectors = single[kind].values[:, row]
            size = curves[f"{stem}_{kind}{side}"]
            assert (size == np.linalg.norm(vectors, axis=1)).all(), (part, point, by)
            for axis, numbers in zip("xyz", vectors.T, strict=True):
                assert (curves[f"{stem}_{kind}_{axis}{side}"] == numbers).all()
    for key in ("rack_force", "bar_torque", "pitman_moment", "drag_link_force", "track_rod_force"):
        if key in found:
            np.testing.assert_allclose(curves[key], found[key], rtol=1e-12, atol=1e-9)
    for rod in found["rod"].values if "rod" in found else ():
        np.testing.assert_allclose(
            curves[f"{rod}_force"], found["rod_force"].sel(rod=rod), rtol=1e-12, atol=1e-9
        )
    for key in ("travel", "wheel_load"):
        for wheel in assembly_of(subject).wheels:
            end = f"_{wheel}" if "wheel" in found.dims else ""
            assert (curves[f"{key}{end}"] == single[f"{key}{end}"]).all()


@pytest.mark.parametrize("name", ["multi_link_car", "formula_student", "trailing_arm_car"])
def test_each_joint_has_a_name_of_its_own(name):
    found = loads.static(load(name), {"static": {"contact_g": [0.0, 0.0, 1.0]}})
    named = [key for key in columns(found) if key.endswith("_force_x")]
    assert len(named) == len(once(found))


def test_a_rod_has_its_force_along_it():
    curves = values_of(assembly_of(CAR), "load:case=brake", np.ones(1))
    # a braking force at the wheel ahead of its steering axis presses a tie rod behind it
    assert curves["tie_rod_force"] == pytest.approx(-rod_force(CAR), rel=1e-12)


def test_sensitivities_are_slopes_of_the_loads():
    found = variation.sensitivity(CAR, [PLACE], over="load:case=brake", names=["tie_rod_force"])
    x, step = CAR.to_dict()["hardpoints"]["tie_rod_outer"][0], 0.05
    slope = (rod_force_at(x + step) - rod_force_at(x - step)) / (2e-3 * step)
    # the difference has an error of (0.05 mm / 100 mm)^2, and loads one of 1e-9
    assert -float(found["tie_rod_force"].item()) == pytest.approx(slope, rel=1e-5)


def test_a_limit_of_a_force_is_kept():
    limit = {"tie_rod_force": BRAKE | {"least": -400.0}}
    found = variation.optimise(CAR, {PLACE: 15.0}, {"bump_steer": {"value": 0.0, "within": 1.0}},
                               limit)  # fmt: skip
    assert found.success
    # changes cost something, so that the limit is just kept
    assert rod_force(found.suspension) == pytest.approx(400.0, rel=1e-5)
    assert rod_force(found.suspension) <= 400.0
    before, after = (
        variation.judge(car, variation.goals({"limits": limit}))[0]
        for car in (CAR, found.suspension)
    )
    assert before.beyond == pytest.approx(rod_force(CAR) - 400.0, rel=1e-9)
    assert (before.met, after.met) == (False, True)


CASES = """
static_load_N = 3000.0
[cases.kerb]
rack_mm = 5.0
left = { contact_g = [0.0, 0.5, 1.0] }
right = { contact_N = [-500.0, 900.0, 3300.0], center_Nm = [0.0, 40.0, 0.0] }
"""


def test_goals_name_a_file_of_load_cases(tmp_path):
    """The path is relative to the file of goals, and the case is read once."""
    axle = Axle.load("reference_axle")
    (tmp_path / "cases.toml").write_text(CASES, encoding="utf-8")
    (tmp_path / "goals.toml").write_text(
        '[limits.spring_force]\nover = "load"\ncase = "kerb"\ncases = "cases.toml"\nmost = 3000.0\n'
        "at_percent = [80, 100]\n",
        encoding="utf-8",
    )
    given = variation.read(tmp_path / "goals.toml")
    wanted = variation.goals(given, ["bump", "load"])
    (tmp_path / "cases.toml").unlink()
    verdicts = variation.judge(axle, wanted)
    assert [verdict.name for verdict in verdicts] == ["spring_force_left", "spring_force_right"]
    right = {"contact_N": [-500.0, 900.0, 3300.0], "center_Nm": [0.0, 40.0, 0.0]}
    described = {"rack_mm": 5.0, "left": {"contact_N": [0.0, 1500.0, 3000.0]}, "right": right}
    found = loads.static(axle, {"kerb": described})
    for verdict in verdicts:
        side = verdict.name.rpartition("_")[2]
        force = found["force"].sel(load=f"chassis at spring_top_{side} by spring_{side}")
        size = float(np.linalg.norm(force.values))
        assert (verdict.beyond, verdict.at) == (pytest.approx(size - 3000.0, rel=1e-9), 1.0)
    inline = {"spring_force_left": {"over": "load", "case": "kerb", "most": 3000.0,
                                    "cases": {"kerb": described}}}  # fmt: skip
    (verdict,) = variation.judge(axle, variation.goals({"limits": inline}, ["bump", "load"]))
    assert verdict.beyond == pytest.approx(verdicts[0].beyond, rel=1e-9)


def test_tolerances_and_fronts_have_limits_and_objectives_of_loads():
    most = rod_force(CAR)
    limits = {"tie_rod_force": BRAKE | {"least": -most}}
    found = variation.tolerance(CAR, {PLACE: 3.0}, limits=limits, count=4, names=["toe"],
                                positions=[0.0], over="travel")  # fmt: skip
    there = [rod_force_at(1e3 * x) <= most for x in found["value_of"].values[:, 0]]
    assert found["within_limits"].values.tolist() == there
    pytest.importorskip("pymoo")
    front = variation.pareto(
        CAR, {PLACE: 15.0}, {"bump_steer": {"value": 0.0}}, maximise={"tie_rod_force": BRAKE},
        population=4, generations=1,
    )  # fmt: skip
    assert [*front.before][1] == "tie_rod_force_over_load_case_brake_least"
    assert [*front.before.values()][1] == pytest.approx(-most, rel=1e-9)


@pytest.mark.parametrize(
    "call",
    [
        lambda: variation.sensitivity(CAR, [PLACE], over="load:case=bump"),
        lambda: variation.sensitivity(CAR, [PLACE], over="load:casse=brake"),
        lambda: variation.sensitivity(CAR, [PLACE], over="load", names=["tie_rod_strength"]),
        lambda: variation.sensitivity(load("reference_vehicle"), over="load:case=brake"),
        lambda: variation.goals({"limits": {"tie_rod": BRAKE | {"most": 1.0}}}),
        lambda: variation.goals({"limits": {"rod_force": BRAKE | {"cases": {}, "most": 1.0}}}),
        lambda: variation.goals({"limits": {"rod_force": BRAKE | {"cases": "{", "most": 1.0}}}),
        lambda: variation.judge(
            CAR, variation.goals({"limits": {"push_rod_force": BRAKE | {"most": 1.0}}})
        ),
    ],
)
def test_loads_that_are_not_known_are_refused(call, refused):
    refused(InputError, call)


def test_a_case_without_equilibrium_is_an_error(refused):
    heavy = {"heavy": {"contact_N": [0.0, 0.0, 1e6]}}
    wanted = variation.goals(
        {"limits": {"spring_force": {"over": "load", "case": "heavy", "cases": heavy, "most": 1.0}}}
    )
    refused(PositionError, lambda: variation.judge(CAR, wanted))


def called(*words):
    return CliRunner().invoke(app, [*words])


def test_commands_vary_loads():
    done = called("sensitivity", "reference_car", "--over", "load:case=brake", "--place", PLACE,
                  "--of", "tie_rod_force", "--json")  # fmt: skip
    assert done.exit_code == 0, done.exception
    done = called("sweep", "reference_car", f"{PLACE}=-130,-120", "--over", "load:case=brake",
                  "--of", "tie_rod_force", "--json")  # fmt: skip
    assert done.exit_code == 0, done.exception
    found = json.loads(done.stdout)["variables"]["tie_rod_force"]["values"]
    assert found == pytest.approx([-rod_force_at(x) for x in (-130.0, -120.0)], rel=1e-9)
    done = called(
        "sweep", "reference_car", f"{PLACE}=-130,-120", "--of", "toe", "--keep", "toe:max"
    )
    assert done.exit_code == 2


# -- names of all wheels ---------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["reference_axle", "twist_beam", "reference_vehicle"])
def test_names_without_a_wheel_are_those_of_all_wheels(name):
    subject = load(name)
    wheels = [f"toe_{wheel}" for wheel in assembly_of(subject).wheels]
    place = "wheel.toe_deg" if name == "twist_beam" else "side.wheel.toe_deg"
    if name == "reference_vehicle":
        place = f"front.{place}"
    asked = {"names": ["toe"], "positions": [0.0]}
    assert [*variation.sensitivity(subject, [place], **asked)] == wheels
    assert [*variation.cars(subject, {place: [0.1]}, **asked)] == [*wheels, "reason"]
    found = variation.tolerance(subject, {place: 0.1}, count=2, **asked)
    assert {*wheels} <= {*found}
    target = {"toe": {"value": 0.1, "within": 0.01}}
    found = variation.optimise(subject, {place: 1.0}, target)
    assert [one.name for one in found.targets] == wheels


def test_a_fit_names_curves_and_accuracies_of_both_wheels():
    axle = Axle.load("reference_axle")
    place = "side.wheel.toe_deg"
    built = axle.with_changes({place: 0.3})
    over = np.array([-0.02, 0.0, 0.02])
    curves = values_of(assembly_of(built), "bump", over, ["toe_left", "toe_right"])
    curves = {name: ("wheel_travel", values) for name, values in curves.items()}
    measured = xr.Dataset(curves, {"wheel_travel": over})
    found = variation.fit(axle, measured, {place: 0.6}, names=["toe"], accuracy={"toe": 0.001})
    assert [curve.name for curve in found.curves] == ["toe_left", "toe_right"]
    assert {round(np.rad2deg(curve.within), 9) for curve in found.curves} == {0.001}


def test_commands_take_names_of_all_wheels():
    done = called("sensitivity", "twist_beam", "--of", "toe", "--place", "wheel.toe_deg", "--json")
    assert done.exit_code == 0, done.exception
    assert {"toe_left", "toe_right"} <= {*json.loads(done.stdout)["variables"]}


# -- compliance of cars ----------------------------------------------------------------------------


def test_compliance_of_a_car_is_that_of_its_axles_on_bushes():
    bushes = {"arm_rear": {"axial_N_per_mm": 400.0, "radial_N_per_mm": 900.0}}
    car = load("reference_vehicle").with_changes({"front.side.bushings": bushes})
    place = "front.side.bushings.arm_rear.radial_N_per_mm"
    at, name = [0.0, 0.02], "toe_by_lateral_opposed"
    found = variation.cars(car, {place: [900.0]}, held="height", names=[name], positions=at)
    expected = compliance.linear(car.axles["front"], None, at)[name]
    for side in ("left", "right"):
        curve = found[f"{name}_front_{side}"].values[0]
        np.testing.assert_allclose(curve, expected.sel(wheel=side).values, rtol=1e-12)
    assert not any("rear" in str(name) for name in found)
    wanted = variation.goals({"limits": {f"{name}_front_left": {"most": 1e-3}}}, ["heave"])
    (verdict,) = variation.judge(car, wanted)
    worst = np.rad2deg(float(expected.sel(wheel="left")[0])) * 1e3 - 1e-3
    assert np.rad2deg(verdict.beyond) * 1e3 == pytest.approx(worst, rel=1e-9)


def test_five_rods_have_no_loads_with_rigid_joints():
    with pytest.raises(InputError):
        variation.sensitivity(FIVE, over="load", names=["panhard_rod_force"])


def test_a_goal_without_a_wheel_is_drawn_for_both(tmp_path):
    path, plot = tmp_path / "goals.toml", tmp_path / "curves.png"
    path.write_text("[limits.camber]\nmost = 1.0\n", encoding="utf-8")
    words = ["--over", "bump", "--goals", str(path), "--plot", str(plot), "--json"]
    done = called("characteristics", "twist_beam", *words)
    assert [goal["name"] for goal in json.loads(done.stdout)["goals"]] == [
        "camber_left", "camber_right"
    ]  # fmt: skip
    assert [*tmp_path.glob("curves*.png")]
    wanted = variation.goals({"limits": {"camber": {"most": 1.0}}}, ["heave"])
    chapter = goals_chapter(load("reference_vehicle"), wanted)
    assert len(chapter.tables[0].rows) == 4
