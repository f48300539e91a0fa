"""Output of commands for a double wishbone, and the functions that they call."""

import json
import re

import numpy as np
import pytest
import xarray as xr
from kintrafo import InputError, Model, Suspension, equilibrium, simulate, travel_range
from kintrafo.vehicle.analysis.checkup import checkup
from support.folders import ROOT

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


def test_measured_actuator(kintrafo, tmp_path):
    (tmp_path / "m.csv").write_text("time_s,spring_actuator_N\n0,500\n1,500\n2,500\n")
    assert kintrafo("simulate", CAR, "--measured", "m.csv", "-o", "m.nc")[0] == 0
    motion = xr.load_dataset(tmp_path / "m.nc")
    rest = equilibrium(MODEL, strut_force=500.0)
    expected = float(MODEL.signal("wheel_center_z", rest))
    # it rests from the start; 1e-9 is the tolerance of the integration
    assert motion["wheel_center_z"].values == pytest.approx(expected, abs=1e-9)


def test_events_of_a_strut_are_refused(refused):
    refused(
        InputError,
        lambda: simulate(MODEL, (0.0, 0.1), MODEL.design_state, events="strut_fully_extended"),
    )


# -- the page of the documentation ---------------------------------------------------------------

PAGE = (ROOT / "docs/suspension/types.md").read_text(encoding="utf-8")


def test_the_documented_code_prints_what_it_says(capsys):
    blocks = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)
    code = "".join(blocks)
    exec(compile(code, "types.md", "exec"), {})
    expected = re.findall(r"print.*# (.*)\n", code)
    assert len(expected) == len(blocks)
    assert capsys.readouterr().out.splitlines() == expected
