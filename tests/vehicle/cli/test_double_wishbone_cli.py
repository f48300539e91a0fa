"""Every command of ``kintrafo`` with a double wishbone, and what runs behind them."""

import json
import re

import numpy as np
import pytest
import xarray as xr
from folders import ROOT
from kintrafo import InputError, Model, Suspension, equilibrium, linearise, simulate, travel_range
from kintrafo.vehicle.analysis import scenario
from kintrafo.vehicle.analysis.checkup import checkup
from kintrafo.vehicle.analysis.compare import compare
from kintrafo.vehicle.input.toml_writer import toml_text, write_toml
from kintrafo.vehicle.plots.overview import write_overview
from matplotlib.image import imread

CAR = "double_wishbone_car"
MODEL = Model(CAR)


# -- beginning ------------------------------------------------------------------------------------


def test_new_file_is_the_packaged_one(kintrafo, tmp_path):
    assert kintrafo("new", "mine.toml", "--suspension", "double_wishbone")[0] == 0
    mine = Suspension.load(tmp_path / "mine.toml").to_dict()
    limits = [mine.pop(f"{side}_stop") for side in ("bump", "rebound")]
    limits += [mine["damper"].pop(f"length_{end}_mm") for end in ("min", "max")]
    assert all(limits)
    assert mine["tyre"].pop("lifts_off")
    assert Suspension.from_dict(mine) == Suspension.load(CAR)
    code, out, _ = kintrafo("check", "mine.toml")
    assert code == 0
    assert "No problems found." in out
    assert "[damper]" in out  # what limits the travel: not taken for mark-up


def test_what_is_wrong_in_a_file_is_told(kintrafo, tmp_path):
    text = (tmp_path / "mine.toml").write_text
    kintrafo("new", "mine.toml", "--suspension", "double_wishbone")
    good = (tmp_path / "mine.toml").read_text(encoding="utf-8")
    text(good.replace('suspension = "double_wishbone"', 'suspension = "duble_wishbone"'), "utf-8")
    code, out, _ = kintrafo("check", "mine.toml")
    assert code == 1
    assert "Did you mean double_wishbone?" in " ".join(out.split())
    text(good.replace("force_at_design_N", "force_at_desing_N"), "utf-8")
    code, out, _ = kintrafo("check", "mine.toml", "--json")
    assert code == 1
    assert any("Did you mean force_at_design_N?" in p for p in json.loads(out)["problems"])


def test_check_names_what_this_suspension_has(kintrafo):
    code, out, _ = kintrafo("check", CAR, "--json")
    found = json.loads(out)
    assert code == 0
    assert found["suspension"] == "double wishbone suspension"
    geometry = found["geometry"]
    # from the file: 10 mm down over 360 mm; the hinge of the lower arm is along x
    assert geometry["lower_arm_length"] == pytest.approx(np.hypot(0.36, 0.01), rel=1e-14)
    assert geometry["spring_length"] == pytest.approx(np.sqrt(0.02**2 + 0.1**2 + 0.42**2))
    assert geometry["tie_rod_length"] == pytest.approx(np.sqrt(0.01**2 + 0.286**2 + 0.002**2))
    assert "strut_length" not in geometry
    assert found["travel"]["strut_fully_extended"] is None
    assert found["travel"]["bump"] == pytest.approx(travel_range(MODEL).height[1] - 0.3)
    assert found["equilibrium"]["frequency"] == pytest.approx(12.73, abs=0.01)
    assert checkup(MODEL).notes == ()


def test_topology(kintrafo):
    code, out, _ = kintrafo("mechanism", "topology", CAR, "--json")
    found = json.loads(out)
    assert code == 0
    assert found["mobility"] == 3
    assert [len(loop) for loop in found["loops"]] == [4, 5]


# -- computing ------------------------------------------------------------------------------------


def test_positions(kintrafo, tmp_path):
    line = ["--positions", "-o", "path.nc", "--plot", "path.png", "--step", "20"]
    assert kintrafo("characteristics", CAR, *line)[0] == 0
    path = xr.load_dataset(tmp_path / "path_travel.nc")
    at_design = path.sel(wheel_travel=0.0)
    expected = {
        "lower_ball_joint_z": 0.185,
        "upper_ball_joint_x": -0.025,
        "tie_rod_inner_y": -0.414,
    }
    for name, value in expected.items():
        assert float(at_design[name]) == pytest.approx(value, abs=1e-14)
    assert imread(tmp_path / "path_travel.png").std() > 0.01
    code, out, _ = kintrafo("characteristics", CAR, "--positions", "--over", "both", "--step", 20)
    assert code == 0
    assert "9 wheel_travel x 7 rack_position" in out


@pytest.mark.usefixtures("first_page_of_curves")
def test_characteristics(kintrafo, tmp_path):
    code, out, _ = kintrafo("characteristics", CAR, "--step", 20, "-o", "c.csv", "--plot", "c.pdf")
    assert code == 0
    assert "motion ratio" in out
    for name in ("c_travel.csv", "c_rack.csv", "c_travel.pdf", "c_rack.pdf"):
        assert (tmp_path / name).stat().st_size > 500


def test_compare_with_a_strut(kintrafo):
    code, out, _ = kintrafo("compare", "reference_car", CAR, "--json")
    found = {difference["name"]: difference for difference in json.loads(out)}
    assert code == 0
    assert found["caster"]["other"] == pytest.approx(np.arctan2(30.0, 320.0))
    assert found["caster"]["first"] == pytest.approx(np.arctan2(33.0, 640.0))
    dataset = compare({"strut": Model("reference_car"), "arms": MODEL}, over="rack")
    assert dataset.sizes["data_set"] == 2


def test_simulate(kintrafo, tmp_path):
    step = ("--road-step", "20", "--road-step-at", "0.1", "--duration", "1.5")
    assert kintrafo("simulate", CAR, *step, "-o", "bump.nc", "--plot", "bump.png")[0] == 0
    motion = xr.load_dataset(tmp_path / "bump.nc")
    rest = equilibrium(MODEL, road_height=0.02)
    expected = float(MODEL.signal("wheel_center_z", rest))
    # 1.4 s of a mode that decays by exp(-23 /s t), and the tolerance of the integration
    assert float(motion["wheel_center_z"][-1]) == pytest.approx(expected, abs=1e-6)


def test_measured_actuator(kintrafo, tmp_path):
    (tmp_path / "m.csv").write_text("time_s,spring_actuator_N\n0,500\n1,500\n2,500\n")
    assert kintrafo("simulate", CAR, "--measured", "m.csv", "-o", "m.nc")[0] == 0
    motion = xr.load_dataset(tmp_path / "m.nc")
    rest = equilibrium(MODEL, strut_force=500.0)
    expected = float(MODEL.signal("wheel_center_z", rest))
    # it rests from the start; 1e-9 is the tolerance of the integration
    assert motion["wheel_center_z"].values == pytest.approx(expected, abs=1e-9)


def test_scenario_starts_at_rest_with_its_actuator():
    result, motion = scenario.run(
        MODEL, scenario.Scenario(duration=0.1, inputs={"spring_actuator": 300.0})
    )
    moved = float(motion["wheel_center_z"].max() - motion["wheel_center_z"].min())
    assert moved < 1e-9
    assert result.success


def test_events_of_a_strut_are_refused():
    with pytest.raises(InputError, match=r"come with its forces\. Known are: wheel_leaves_ground"):
        simulate(MODEL, (0.0, 0.1), MODEL.design_state, events="strut_fully_extended")


def test_linearisation_knows_the_wheel_hop_and_the_spinning_wheel():
    rest = equilibrium(MODEL, spin_rate=60.0)
    linear = linearise(MODEL, rest)
    assert linear.steady
    assert linear.mode_of(MODEL.names.arm).oscillates
    slow = linear.frequency_response([0.01], "road_height")["wheel_center_z"][0]
    # a slow road lifts the wheel from one position of rest to the next
    low, high = (
        float(MODEL.signal("wheel_center_z", equilibrium(MODEL, road_height=road)))
        for road in (-1e-4, 1e-4)
    )
    # the square of 1e-4 m over the size of the suspension
    assert abs(slow) == pytest.approx((high - low) / 2e-4, rel=1e-6)


# -- the page of the documentation ---------------------------------------------------------------

PAGE = (ROOT / "docs/suspension/types.md").read_text(encoding="utf-8")


def test_the_documented_code_prints_what_it_says(capsys):
    blocks = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)
    code = "".join(blocks)
    exec(compile(code, "types.md", "exec"), {})
    said = re.findall(r"print.*# (.*)\n", code)
    assert len(said) == len(blocks)
    assert capsys.readouterr().out.splitlines() == said


# -- handing over ---------------------------------------------------------------------------------


def test_written_file_is_read_again(tmp_path):
    car = Suspension.load(CAR).with_changes({"bodies.upper_arm.mass_kg": 3.0})
    path = write_toml(car, tmp_path / "mine.toml", head=["Mine."])
    assert Suspension.load(path) == car
    assert toml_text(car).startswith('suspension = "double_wishbone"')


def test_paper_figures_and_overview(kintrafo, tmp_path):
    code, out, _ = kintrafo("paper", "out", "--data", CAR)
    assert code == 0
    assert "right double wishbone suspension" in out
    assert imread(tmp_path / "out/overview.png").std() > 0.01
    write_overview(Model(Suspension.load(CAR).mirrored()), tmp_path / "left.png")
    assert imread(tmp_path / "left.png").std() > 0.01
