"""Measured curves: read as they were written, and characteristics at the same positions."""

import math

import numpy as np
import pytest
import xarray as xr
from kintrafo import (
    Axle,
    InputError,
    Model,
    PositionError,
    RigidAxle,
    characteristics,
    compare,
    compliance,
    export,
    rig,
)
from kintrafo.pictures.curves import _alone
from kintrafo.vehicle.assembly.by_wheel import flat

MODEL = Model("reference_car")
LOOP = """# a loop, as a rig records it
wheel_travel [mm];toe [deg];camber (rad);motion_ratio;wheel_rate [N/mm];remark [-]
-40;0,1;0,002;0,95;22,1;a
0;0;0;0,95;22,5;b
40;-0,1;-0,002;;22,9;c
0;0,02;0,0001;0,95;22,4;d
"""


@pytest.fixture
def loop(tmp_path):
    path = tmp_path / "rig.csv"
    path.write_text(LOOP, encoding="utf-8")
    return path


def test_units_and_order_are_those_of_the_file(loop):
    found = rig.measured_curves(loop)
    np.testing.assert_allclose(found["wheel_travel"], [-0.04, 0.0, 0.04, 0.0], rtol=1e-15)
    np.testing.assert_allclose(found["toe"], np.deg2rad([0.1, 0.0, -0.1, 0.02]), rtol=1e-15)
    assert found["camber"].values.tolist() == [0.002, 0.0, -0.002, 0.0001]
    np.testing.assert_allclose(found["wheel_rate"], [22.1e3, 22.5e3, 22.9e3, 22.4e3], rtol=1e-15)
    assert np.isnan(found["motion_ratio"].values).tolist() == [False, False, True, False]
    assert found.attrs["left_out"] == "remark [-]"


AXLE, RIGID_AXLE = Axle.load("reference_axle"), RigidAxle.load("rigid_axle")
SUBJECTS = {"car": MODEL, "axle": AXLE, "rigid axle": RIGID_AXLE}
OF_ALL = {
    "car": {"toe", "camber", "scrub_radius"},
    "axle": {"toe_left", "toe_right", "steer_right"},
    "rigid axle": {"toe_left", "axle_steer", "roll_stiffness"},
}


@pytest.mark.parametrize(
    ("name", "over"),
    [
        *(("car", over) for over in ("travel", "rack")),
        *(("axle", over) for over in ("bump", "roll", "steer", "rack")),
        *(("rigid axle", over) for over in ("bump", "roll")),
    ],
)
def test_what_is_exported_is_read_back(tmp_path, name, over):
    """Our own curves as CSV, in display units, are those of the file to the digits written."""
    subject, positions = SUBJECTS[name], [-0.03, 0.01, 0.03]
    written = characteristics.over(subject, over, positions)
    export.write(written, tmp_path / "a.csv")
    read = rig.measured_curves(tmp_path / "a.csv")
    assert {*map(str, read)} >= OF_ALL[name]
    both = rig.beside(read, {name: subject})
    assert both["data_set"].values.tolist() == ["measured", name]
    for curve in read:
        # nine digits are written
        np.testing.assert_allclose(both[curve][0], both[curve][1], rtol=1e-7, atol=1e-12)
    assert {*read} == {*flat(written)}
    if name == "rigid axle":
        return  # nothing is held
    # held elsewhere, they are those of there
    held = {"travel": 0.02} if over in {"rack", "steer"} else {"rack_position": 0.01}
    export.write(characteristics.over(subject, over, positions, **held), tmp_path / "b.csv")
    both = rig.beside(rig.measured_curves(tmp_path / "b.csv"), {name: subject})
    toe = "toe" if name == "car" else "toe_left"
    np.testing.assert_allclose(both[toe][0], both[toe][1], rtol=1e-7)


def test_characteristics_are_those_at_the_positions(loop):
    both = rig.beside(rig.measured_curves(loop), {"car": MODEL}, "rig")
    expected = characteristics.over(MODEL, "travel", [-0.04, 0.0, 0.04, 0.0])
    for name in ("toe", "camber", "wheel_rate"):
        np.testing.assert_array_equal(both[name].sel(data_set="car"), expected[name])
    toe = next(d for d in compare.differences(both) if d.name == "toe")
    off = expected["toe"].values - np.deg2rad([0.1, 0.0, -0.1, 0.02])
    worst = abs(off).argmax()
    assert (toe.where, toe.largest) == (expected["wheel_travel"].values[worst], off[worst])


WRONG = [
    "toe [deg]\n1\n2\n",
    "wheel_travel [mm],rack_position [mm],toe [deg]\n1,2,0\n2,3,0\n",
    "wheel_travel [mm],toe [deg]\n1,2\n1,3\n",
    "wheel_travel [mm],speed\n1,2\n2,3\n",
    "wheel_travel [mm],cambr [deg]\n1,2\n2,3\n",
    "wheel_travel [mm],toe\n1,2\n2,3\n",
    "wheel_travel [deg],toe [deg]\n1,2\n2,3\n",
    "wheel_travel [mm],toe [mm]\n1,2\n2,3\n",
    "wheel_travel [mm],toe [deg],toe [rad]\n1,2,3\n2,3,4\n",
    "wheel_travel [mm],toe [deg]\n1,2\n,3\n",
    "wheel_travel [mm],toe [deg]\n1,2\n2,x\n",
    "wheel_travel [mm],toe [deg]\n1,2\n",
    "",
    "wheel_travel [mm],toe [deg],toe [deg]\n1,2,3\n2,3,4\n",
    "wheel_travel [mm];wheel_rate [N/m]\n1;25,000\n2.5;26,000\n",
    "rack_position [mm],wheel_rate [N/mm]\n1,2\n2,3\n",
]


@pytest.mark.parametrize("text", WRONG)
def test_what_cannot_be_used(tmp_path, text, refused):
    path = tmp_path / "a.csv"
    path.write_text(text, encoding="utf-8")
    refused(InputError, lambda: rig.measured_curves(path))


def test_cells_of_spreadsheets(tmp_path):
    """Quoted cells, a held position that trembles, and what is infinite."""
    path = tmp_path / "a.csv"
    text = 'rack_position [mm],wheel_travel [mm],"toe [deg]","a; remark",turning_circle [m]\n'
    text += '-20,5.0,"1.5","a, b",11\n0,5.001,2.5,"",inf\n20,5.0,3.5,c,\n'
    path.write_text(text, encoding="utf-8")
    found = rig.measured_curves(path)
    np.testing.assert_allclose(np.rad2deg(found["toe"]), [1.5, 2.5, 3.5])
    assert np.isnan(found["turning_circle"].values).tolist() == [False, True, True]
    assert float(found["wheel_travel"]) == pytest.approx(0.005, abs=1e-6)


def test_differences_are_where_both_are_known(tmp_path, refused):
    path = tmp_path / "a.csv"
    path.write_text("wheel_travel [mm],toe [deg],camber [deg]\n40,,1\n0,,\n0,2,\n", "utf-8")
    both = rig.beside(rig.measured_curves(path), {"car": MODEL})
    toe, camber = compare.differences(both)
    assert np.rad2deg(toe.first) == pytest.approx(2.0)
    assert np.isnan([camber.first, camber.at_design]).all()
    assert camber.where == pytest.approx(0.04)
    refused(InputError, lambda: rig.beside(rig.measured_curves(path), {"measured": MODEL}))


def test_curves_of_another_assembly(tmp_path, refused):
    """A curve that is not computed keeps its values; without any other one, it is refused."""
    path = tmp_path / "rig.csv"
    text = "wheel_travel [mm],toe [deg],toe_left [deg]\n-40,0.1,0.3\n0,0,0.2\n40,-0.1,0.1\n"
    path.write_text(text, encoding="utf-8")
    _, found = compare.differences(rig.beside(rig.measured_curves(path), {"car": MODEL}))
    assert (found.name, found.where) == ("toe_left", 0.0)
    assert found.first == pytest.approx(np.deg2rad(0.2), rel=1e-15)
    assert np.isnan([found.other, found.largest]).all()
    refused(InputError, lambda: rig.beside(rig.measured_curves(path)[["toe"]], {"axle": AXLE}))


def test_points_with_gaps_are_drawn():
    values = np.array([1.0, np.nan, 2.0, 3.0, np.nan, 4.0])
    assert _alone(values).tolist() == [True, False, False, False, False, True]


def test_positions_out_of_reach(tmp_path, refused):
    path = tmp_path / "a.csv"
    path.write_text("wheel_travel [mm],toe [deg]\n0,0\n2000,1\n", encoding="utf-8")
    refused(PositionError, lambda: rig.beside(rig.measured_curves(path), {"car": MODEL}))


def test_the_command(kintrafo, loop, tmp_path, ends):
    code, out, err = kintrafo(
        "compare", "reference_car", loop.name, "--plot", "a.png", "-o", "a.csv"
    )
    assert (code, err) == (0, "")
    assert "reference_car compared with rig.csv" in " ".join(out.split())
    assert "columns that were not read: remark [-]" in out
    assert {path.name for path in tmp_path.iterdir()} == {"rig.csv", "a.png", "a.csv"}
    ends(2, "compare", "reference_car", loop.name, "--over", "rack")
    ends(2, "compare", loop.name, loop.name)


def test_units_may_have_brackets_of_their_own(tmp_path):
    file = tmp_path / "rig.csv"
    file.write_text("wheel_travel [mm],toe_by_aligning [deg/(100 N m)]\n-10,0.1\n10,0.2\n")
    found = rig.measured_curves(file)["toe_by_aligning"].values
    assert found == pytest.approx(np.deg2rad([0.1, 0.2]) / 100.0, rel=1e-15)
    file.write_text("wheel_travel (mm),toe_by_aligning (rad/(N m))\n-10,0.1\n10,0.2\n")
    assert rig.measured_curves(file)["toe_by_aligning"].values == pytest.approx(
        [0.1, 0.2], rel=1e-15
    )


@pytest.mark.parametrize(
    "text",
    [
        "Wheel Travel (mm),Toe (deg),Mr. X - left\n{0}",
        "WheelTravel [mm],TOE [Degrees],x\n{0}",
        "wheel_travel_mm,toe_deg,x\n{0}",
        "wheel travel,toe,x\nmm,deg,\n{0}",
        "wheel travel,toe,x\n[mm],[deg],-\n{0}",
        "# units: mm, deg\nwheel travel,toe,x\n{0}",
        "wheel-travel,toe,x\n# mm,deg,\n{0}",
        "# lengths in mm\nwheel travel,toe [deg],x\n{0}",
    ],
)
def test_names_and_units_of_rigs(tmp_path, text):
    path = tmp_path / "rig.csv"
    path.write_text(text.format("-20,0.5,1\n20,-0.5,2\n"), encoding="utf-8")
    found = rig.measured_curves(path)
    np.testing.assert_allclose(found["wheel_travel"], [-0.02, 0.02], rtol=1e-15)
    np.testing.assert_allclose(found["toe"], np.deg2rad([0.5, -0.5]), rtol=1e-15)
    assert found.attrs["left_out"] in ("x", "Mr. X - left")


@pytest.mark.parametrize(
    ("unit", "radians"),
    [("mrad", 1e-3), ("arcmin", math.pi / 10800.0), ("Minutes of arc", math.pi / 10800.0)],
)
def test_units_of_toe_on_alignment_benches(tmp_path, unit, radians):
    path = tmp_path / "rig.csv"
    path.write_text(f"wheel travel (mm),toe ({unit}),bump_steer ({unit}/mm)\n-20,4,1\n20,-4,2\n")
    found = rig.measured_curves(path)
    np.testing.assert_allclose(found["toe"], [4.0 * radians, -4.0 * radians], rtol=1e-15)
    np.testing.assert_allclose(found["bump_steer"], [1e3 * radians, 2e3 * radians], rtol=1e-15)


@pytest.mark.parametrize(
    "text",
    [
        "Wheel Travel (mm),toe [deg],TOE (rad)\n1,2,3\n2,3,4\n",
        "# units: mm, in\nwheel travel,toe [deg]\n1,2\n2,3\n",
        "# units: in\nwheel travel [mm],toe [deg]\n1,2\n2,3\n",
        "# units: mm, ells\nwheel travel,toe [deg]\n1,2\n2,3\n",
        "# units: mm\nwheel travel,toe\n1,2\n2,3\n",
        "wheel travel,toe\nmm,deg\nmm,deg\n1,2\n2,3\n",
    ],
)
def test_units_that_contradict_each_other(tmp_path, text, refused):
    path = tmp_path / "rig.csv"
    path.write_text(text, encoding="utf-8")
    refused(InputError, lambda: rig.measured_curves(path))


SOFT, SOFTER = (
    MODEL.suspension.with_changes({"bushings": {"arm_rear": {"radial_N_per_mm": stiffness}}})
    for stiffness in (1200.0, 600.0)
)


SOFT_ONES = {
    "car": (Model(SOFT), Model(SOFTER)),
    "axle": tuple(Axle.from_dict({"axle": "front", "side": side}) for side in (SOFT, SOFTER)),
    "rigid axle": tuple(
        RIGID_AXLE.with_changes({"bushings": {"panhard_rod_axle": {"axial_N_per_mm": stiffness}}})
        for stiffness in (5000.0, 2500.0)
    ),
}


@pytest.mark.parametrize("name", SOFT_ONES)
def test_compliance_of_several_is_compared(name):
    """That of each is what `compliance.linear` gives; what holds the wheels matters."""
    subjects = dict(zip("ab", SOFT_ONES[name], strict=True))
    travels = np.array([-0.02, 0.0, 0.02])
    for held in ("height", "spring"):
        found = compare.compare(subjects, travels, held=held)
        for label, subject in subjects.items():
            expected = compliance.linear(subject, None, travels, held=held)
            told = [n for n in expected.drop_dims(["moved", "by"]) if "_by_" in str(n)]
            assert len(told) > 5
            for quantity in told:
                np.testing.assert_array_equal(
                    found[quantity].sel(data_set=label), expected[quantity]
                )
            kinematic = characteristics.over(subject, None, travels)
            np.testing.assert_array_equal(found["toe"].sel(data_set=label), kinematic["toe"])


def test_a_single_bush_deflects_by_its_softness():
    models = dict(zip("ab", SOFT_ONES["car"], strict=True))
    travels = np.array([-0.02, 0.0, 0.02])
    locked = compare.differences(compare.compare(models, travels, held="locked"))
    toe = next(d for d in locked if d.name == "toe_by_lateral")
    assert toe.other == pytest.approx(2.0 * toe.first, rel=1e-9)  # nothing else deflects
    assert abs(toe.first) > 1e-7
    assert "toe_by_lateral" not in compare.compare(models, travels)


@pytest.mark.parametrize(
    ("models", "changes"),
    [
        ({"a": Model(SOFT), "b": MODEL}, {"held": "height"}),
        ({"a": Model(SOFT)} | {"b": Model(SOFT)}, {"held": "body"}),
        ({"a": Model(SOFT), "b": Model(SOFT)}, {"held": "height", "over": "rack"}),
    ],
)
def test_compliance_that_there_is_not(models, changes, refused):
    refused(InputError, lambda: compare.compare(models, **changes))


def test_an_axle_of_two_corners_is_compared_with_a_rigid_one(refused):
    """Common characteristics are compared; a suspension has no motion in common with them."""
    found = compare.compare({"two corners": AXLE, "rigid": RIGID_AXLE}, over="roll")
    assert {"camber", "roll_stiffness", "roll_center_height"} <= {*found}
    assert found["camber"].dims == ("data_set", "wheel", "roll_angle")
    assert "roll_steer" not in found  # of each wheel, and of the axle
    for label, axle in (("two corners", AXLE), ("rigid", RIGID_AXLE)):
        alone = characteristics.over(axle, "roll", found["roll_angle"])
        np.testing.assert_array_equal(found["camber"].sel(data_set=label), alone["camber"])
    refused(InputError, lambda: compare.compare({"a": MODEL, "b": AXLE}))


def test_curves_over_what_nothing_has_are_refused(tmp_path, refused):
    path = tmp_path / "rig.csv"
    path.write_text("roll_angle [deg],toe_left [deg]\n-1,0.1\n1,0.2\n", encoding="utf-8")
    refused(InputError, lambda: rig.beside(rig.measured_curves(path), {"a": MODEL}))


@pytest.mark.parametrize(
    "door",
    [
        lambda names: compare.compare(dict.fromkeys(names, MODEL)),
        lambda names: compare.compare({name: Axle.load("reference_axle") for name in names}),
        lambda names: compare.compare({name: RigidAxle.load("rigid_axle") for name in names}),
        lambda names: rig.beside(xr.Dataset(), dict.fromkeys(names, MODEL)),
    ],
)
def test_names_of_data_sets_differ_as_texts(door, refused):
    for names in (("1", 1), ("a", "a\0"), (1, 2)):
        with refused(InputError):
            door(names)


def test_compliance_by_the_command(kintrafo, tmp_path, ends):
    SOFT.save(tmp_path / "a.toml")
    SOFTER.save(tmp_path / "b.toml")
    (tmp_path / "rig.csv").write_text(
        "wheel_travel [mm],toe_by_lateral [deg/kN]\n-10,0.05\n10,0.06\n", encoding="utf-8"
    )
    told = {}
    for files in ("a.toml b.toml", "rig.csv a.toml"):
        for held in ("height", "locked"):
            line = f"compare {files} --of toe_by_lateral --held {held} --json"
            code, told[files, held], err = kintrafo(*line.split())
            assert code == 0, err
        assert told[files, "height"] != told[files, "locked"]
    ends(2, "compare", "reference_car", "a.toml", "--held", "height")
    ends(2, "compare", "reference_axle", "reference_axle", "--held", "height")
