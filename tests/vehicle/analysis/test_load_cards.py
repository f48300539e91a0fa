"""Loads as cards of programs for strength."""

import kintrafo
import numpy as np
import pytest
import xarray as xr
from cars.axles import AXLE
from cars.rigid_axles import AXLES as RIGID
from kintrafo import InputError, Model, loads
from oracle.load_cards import READERS, wrench, wrenches

CAR = Model("reference_car")
TURN = {"left": {"contact_N": [0, 900, 3000]}, "right": {"contact_N": [400, 2000, 5000]}}
SUBJECTS = {"corner": CAR, "axle": AXLE, "rigid": RIGID["lopsided"]}
# Numbers of the cards have 10 digits, and points of 1 m carry forces of 1e4 N: some tens of them.
FORCE, MOMENT = 1e-4, 1e-4


@pytest.fixture(scope="module")
def found():
    """Loads of all subjects; the rack of the first is moved."""
    one = {
        "bump": {"travel_mm": 30.0, "contact_N": [900.0, 400.0, 0.0], "rack_mm": 9.0},
        "far": {"contact_N": [0.0, 0.0, 9e5]},
        "1g": {"contact_g": [0.0, 0.0, 1.0]},
    }
    return {
        name: loads.static(subject, one if name == "corner" else {"turn": TURN})
        for name, subject in SUBJECTS.items()
    }


@pytest.mark.parametrize("ending", READERS)
@pytest.mark.parametrize(("axes", "length"), [("part", "mm"), ("vehicle", "m")])
@pytest.mark.parametrize("name", SUBJECTS)
def test_cards_carry_what_the_dataset_does(tmp_path, found, name, axes, length, ending):
    """Every part, and by its file it is in equilibrium."""
    dataset = found[name]
    scale = {"mm": 1e3, "m": 1.0}[length]
    files = loads.write_cards(dataset, tmp_path / f"l{ending}", axes=axes, length=length)
    parts = [*dict.fromkeys(str(part) for part in dataset["part"].values)]
    assert [file.name for file in files] == [f"l_{part}{ending}" for part in parts]
    names = [str(case) for case in dataset["case"].values]
    for part, file in zip(parts, files, strict=True):
        own = dataset.isel(load=(dataset["part"] == part).values)
        if axes == "part":
            own = own.assign({n: own[f"{n}_in_part"] for n in ("force", "moment", "at")})
        expected = dict(zip(names, wrench(own), strict=True))
        for case, (*force, mx, my, mz) in wrenches(file).items():
            which = names[int(case) - 1] if ending == ".bdf" else case
            there = expected[which]
            np.testing.assert_allclose(force, there[:3], atol=FORCE)
            np.testing.assert_allclose(np.array([mx, my, mz]) / scale, there[3:], atol=MOMENT)
            if part != "chassis":
                np.testing.assert_allclose(there, 0.0, atol=1e-7)


def test_points_of_a_part_are_its_hardpoints_at_design(tmp_path, found):
    (file,) = loads.write_cards(found["corner"], tmp_path / "l.inp", ["control_arm"])
    nodes, steps = READERS[".inp"](file)
    points = CAR.suspension.hardpoints
    wanted = [1e3 * np.array(points.metres(p)) for p in ("arm_front", "arm_rear", "ball_joint")]
    for at in wanted:
        assert any(np.abs(at - node).max() < 1e-9 for node in nodes.values())
    assert [*steps] == ["bump", "1g"]
    text = file.read_text(encoding="ascii")
    assert "Units: N, mm, N mm." in text
    assert "** Not carried: far: " in text


def test_the_mount_of_a_strut_carries_rod_and_spring(tmp_path, found):
    (file,) = loads.write_cards(found["corner"], tmp_path / "l.bdf", ["chassis"])
    nodes, sets = READERS[".bdf"](file)
    text = file.read_text(encoding="ascii")
    assert "$ strut_top, by upper_strut, spring" in text
    top = 1e3 * np.array(CAR.suspension.hardpoints.metres("strut_top"))
    (node,) = (number for number, at in nodes.items() if np.abs(at - top).max() < 1e-6)
    total = found["corner"]["total_force"].sel(case="1g", mount="strut_top").values
    forces = [force for number, force, _ in sets["3"] if number == node]
    np.testing.assert_allclose(sum(forces), total, rtol=1e-9, atol=1e-6)


def test_inertia_keeps_parts_of_a_motion_in_equilibrium(tmp_path):
    start = kintrafo.state_at_height(CAR, 0.325)
    motion = kintrafo.simulate(CAR, (0.0, 0.05), start, t_eval=np.array([0.0, 0.02, 0.05]))
    moving = loads.along(CAR, motion)
    (file,) = loads.write_cards(moving, tmp_path / "l.inp", ["knuckle"], length="m")
    sums = wrenches(file)
    assert [*sums] == ["output_1", "output_2", "output_3"]
    assert "inertia" in file.read_text(encoding="ascii")
    # the balance of the parts of a motion is kept to 1e-9 of forces of 1e4 N
    np.testing.assert_allclose([*sums.values()], 0.0, atol=1e-5)


def test_what_cannot_be_written(tmp_path, found, refused):
    for changes in (
        {"path": "loads.txt"},
        {"parts": ["wing"]},
        {"parts": []},
        {"axes": "road"},
        {"length": "in"},
        {"dataset": xr.Dataset()},
        {"dataset": 3},
    ):
        given = {"dataset": found["corner"], "path": "loads.inp"} | changes
        with refused(InputError):
            loads.write_cards(**given | {"path": tmp_path / given["path"]})
        assert not [*tmp_path.iterdir()]


def test_files_of_others_stay(tmp_path, found, refused):
    (tmp_path / "l_rack.bdf").write_text("mine", encoding="utf-8")
    refused(InputError, lambda: loads.write_cards(found["corner"], tmp_path / "l.bdf"))
    assert [file.read_text(encoding="utf-8") for file in tmp_path.iterdir()] == ["mine"]
    assert len(loads.write_cards(found["corner"], tmp_path / "l.bdf", force=True)) == 7


def test_the_command(request, tmp_path, ends):
    command = request.getfixturevalue("kintrafo")
    line = "loads reference_car --part knuckle,total --axes-of part -o l.bdf -o l.inp -o l.csv"
    code, out, err = command(*line.split(), "--units", "m")
    assert code == 0, err
    assert "l_knuckle.bdf" in out
    assert sorted(file.name for file in tmp_path.iterdir()) == [
        "l.csv", "l_knuckle.bdf", "l_knuckle.inp",
    ]  # fmt: skip
    assert "$ Units: N, m, N m." in (tmp_path / "l_knuckle.bdf").read_text(encoding="ascii")
    assert ",part as at design: x forward" in (tmp_path / "l.csv").read_text(encoding="utf-8")
    for wrong in ("--axes-of part", "--units m -o l.csv", "--units yard -o k.inp"):
        ends(2, "loads", "reference_car", *wrong.split())
