"""Data files, figures and sweeps: what is written is what was computed."""

import csv

import numpy as np
import pyarrow.parquet as pq
import pytest
import xarray as xr
from kintrafo import InputError, Model, PositionError, compare, export, plots, sweep
from kintrafo.core.files import replacing
from matplotlib.image import imread
from scipy.io import loadmat, whosmat

MODEL = Model("reference_car")
LINE = sweep.positions(MODEL, np.linspace(-0.06, 0.08, 8))
GRID = sweep.positions(MODEL, [-0.05, 0.0, 0.05], [-0.03, 0.0, 0.03, 0.05])


# -- sweeps: the links keep their lengths -------------------------------------------------------


def point(dataset, name):
    return np.stack([dataset[f"{name}_{axis}"].values for axis in "xyz"], axis=-1)


@pytest.mark.parametrize("dataset", [LINE, GRID], ids=["line", "grid"])
def test_positions_fulfil_the_joints(dataset):
    parameters = MODEL.suspension.parameters()

    def design(name):
        return np.array([parameters[f"{name}_{axis}"] for axis in "xyz"])

    def lengths(first, second):
        return np.linalg.norm(first - second, axis=-1)

    joints = ("ball_joint", "tie_rod_outer", "tie_rod_inner", "wheel_center")
    ball, outer, inner, wheel = (point(dataset, name) for name in joints)
    arms = [(ball, design(n), "ball_joint", n) for n in ("arm_front", "arm_rear")]
    rods = [(outer, inner, "tie_rod_outer", "tie_rod_inner")]
    knuckle = [
        (ball, outer, "ball_joint", "tie_rod_outer"),
        (ball, wheel, "ball_joint", "wheel_center"),
        (outer, wheel, "tie_rod_outer", "wheel_center"),
    ]
    for first, second, *names in (*arms, *rods, *knuckle):
        expected = lengths(*map(design, names))
        # a few roundings of coordinates of about 1 m
        assert lengths(first, second) == pytest.approx(expected, abs=1e-14)
    assert wheel[..., 2] == pytest.approx(heights(dataset), abs=1e-14)
    rack = design("tie_rod_inner")[1] + np.broadcast_to(dataset["rack_position"], wheel.shape[:-1])
    assert inner[..., 1] == pytest.approx(rack, abs=1e-15)


def heights(dataset):
    """Return the requested wheel heights, in the shape of the results."""
    (height, _) = xr.broadcast(0.3 + dataset["wheel_travel"], dataset["camber"])
    return height.values


def test_sweeps_stop_where_the_suspension_does(refused):
    assert sweep.usual_travel(MODEL)[[0, -1]].tolist() == [-0.08, 0.08]
    refused(PositionError, lambda: sweep.positions(MODEL, [0.0, 0.4]))
    with pytest.raises(InputError, match="finite"):
        sweep.positions(MODEL, [0.0, np.nan])


# -- data files ---------------------------------------------------------------------------------


@pytest.mark.parametrize("dataset", [LINE, GRID], ids=["line", "grid"])
def test_netcdf_keeps_everything(dataset, tmp_path):
    found = xr.load_dataset(export.write(dataset, tmp_path / "a.nc"), engine="scipy")
    xr.testing.assert_identical(found, dataset)


def test_parquet_keeps_values_and_descriptions(tmp_path):
    found = pq.read_table(export.write(GRID, tmp_path / "a.parquet"))
    flat = GRID["camber"].values.ravel()
    assert found["camber"].to_pylist() == flat.tolist()
    metadata = found.schema.field("camber").metadata
    assert metadata[b"units"] == b"rad"
    assert b"top" in metadata[b"sign"]
    assert found["rack_position"].to_pylist() == [-0.03, 0.0, 0.03, 0.05] * 3


def test_what_is_no_number_stays_none_in_every_format(tmp_path):
    values = np.array([1.0, np.nan, np.inf, -np.inf, 1e-30, -2.0])
    dataset = xr.Dataset({"a": ("i", values), "b": ("i", np.full(6, np.nan))}, {"i": range(6)})
    for ending in ("csv", "nc", "parquet"):
        export.write(dataset, tmp_path / f"a.{ending}")
    rows = list(csv.DictReader((tmp_path / "a.csv").read_text().splitlines()))
    assert [row["a"] for row in rows] == ["1", "", "inf", "-inf", "0", "-2"]
    assert {row["b"] for row in rows} == {""}
    with xr.open_dataset(tmp_path / "a.nc", engine="scipy") as read:
        np.testing.assert_array_equal(read["a"], values)
    np.testing.assert_array_equal(pq.read_table(tmp_path / "a.parquet")["a"].to_numpy(), values)


def test_matlab_keeps_values_and_descriptions(tmp_path):
    labels = ["brake", "caf\u00e9"]
    long = "a" * 70
    values = np.array([[1.0, np.nan, np.inf], [-2.5, 1e-300, 0.1]])
    dataset = xr.Dataset(
        {
            "2nd row": (("case", "i"), values, {"units": "N", "long_name": "force", "sign": "up"}),
            f"{long}1": ("i", [1, 2, 3]),
            f"{long}2": ("case", [True, False]),
            "reason": ("case", ["", ""]),
        },
        {"case": labels, "i": range(3)},
        {"title": "some"},
    )
    found = loadmat(export.write(dataset, tmp_path / "a.mat"), simplify_cells=True)
    data = found["data"]
    assert [*data] == ["xcase", "i", "x2nd_row", "a" * 63, f"{'a' * 61}_1", "reason"]
    np.testing.assert_array_equal(data["x2nd_row"], values.ravel())
    assert [*map(str.rstrip, data["xcase"])] == np.repeat(labels, 3).tolist()
    assert data["a" * 63].tolist() == [1, 2, 3] * 2
    assert data[f"{'a' * 61}_1"].tolist() == [1, 1, 1, 0, 0, 0]
    assert found["units"]["x2nd_row"] == "N"
    assert found["meanings"]["x2nd_row"] == "force, up"
    assert found["names"][f"{'a' * 61}_1"] == f"{long}2"
    assert found["about"] == {"title": "some"}
    assert whosmat(tmp_path / "a.mat")[0] == ("data", (1, 1), "struct")


def test_csv_is_in_the_units_of_people(tmp_path):
    path = export.write(GRID, tmp_path / "a.csv")
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0])[:2] == ["wheel_travel [mm]", "rack_position [mm]"]
    assert len(rows) == 12
    camber = [float(row["camber [deg]"]) for row in rows]
    # nine digits are written
    assert camber == pytest.approx(np.degrees(GRID["camber"].values.ravel()), rel=1e-8, abs=1e-11)


@pytest.mark.parametrize("name", ["a.csv", "a.nc", "a.parquet", "a.xlsx", "a.mat"])
def test_same_data_same_bytes(tmp_path, name):
    first = export.write(GRID, tmp_path / "1" / name).read_bytes()
    assert export.write(GRID, tmp_path / "2" / name).read_bytes() == first


def fail_half_way(path):
    with replacing(path, force=True) as temporary:
        temporary.write_text("half", encoding="utf-8")
        raise RuntimeError


def test_a_file_that_fails_leaves_the_old_one(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("old", encoding="utf-8")
    with pytest.raises(RuntimeError):
        fail_half_way(path)
    assert path.read_text(encoding="utf-8") == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_unknown_endings_are_refused(tmp_path, refused):
    refused(
        InputError,
        lambda: export.write(LINE, tmp_path / "a.ods"),
        lambda: export.write(LINE, tmp_path / "a"),
    )


# -- figures ------------------------------------------------------------------------------------


def test_a_figure_of_every_curve_and_a_page_of_every_group(tmp_path):
    files = plots.write(LINE[["camber", "toe", "wheel_center_x"]], tmp_path, formats=["png"])
    names = {file.stem for file in files}
    assert {"camber", "toe", "wheel_center_x"} < names
    assert sum(name.startswith("overview_") for name in names) == 2
    assert all(imread(file).std() > 0.01 for file in files)


@pytest.mark.parametrize("ending", plots.FORMATS)
def test_same_curves_same_picture(tmp_path, ending):
    pages = [
        plots.write_overview(GRID, tmp_path / f"{n}.{ending}", ["camber"]).read_bytes()
        for n in "ab"
    ]
    assert pages[0] == pages[1]


def test_axes_say_name_unit_and_sign():
    (axes,) = plots.figure(LINE, ["camber"]).axes
    assert axes.get_xlabel() == "camber [deg]\npositive with the top of the wheel outboard"
    assert axes.get_ylabel() == "wheel travel [mm]\npositive in bump"
    (line, *_) = axes.get_lines()
    assert line.get_ydata() == pytest.approx(np.linspace(-60.0, 80.0, 8))
    assert line.get_xdata() == pytest.approx(np.degrees(LINE["camber"].values))


def test_constants_and_poles_get_sensible_axes():
    travel = np.linspace(-1.0, 1.0, 201)
    pole = np.divide(1.0, travel, out=np.full(201, np.nan), where=travel != 0.0)
    curves = {"flat": 5.0 + 1e-15 * travel, "pole": pole, "none": np.full(201, np.nan)}
    data = {name: ("wheel_travel", values) for name, values in curves.items()}
    figure = plots.figure(xr.Dataset(data, {"wheel_travel": travel}), list(curves), alone=False)
    flat, pole, _ = (axes.get_xlim() for axes in figure.axes)
    assert flat == pytest.approx((4.75, 5.25))
    assert 5.0 < pole[1] < 50.0
    assert figure.axes[2].texts[0].get_text() == "not defined"


def test_nothing_connects_the_branches_of_a_pole():
    travel = np.linspace(-1.0, 1.0, 200)  # which passes over zero
    data = xr.Dataset({"pole": ("wheel_travel", 1.0 / travel)}, {"wheel_travel": travel})
    (line, *_) = plots.figure(data, ["pole"], alone=False).axes[0].get_lines()
    (gap,) = np.flatnonzero(np.isnan(line.get_xdata()))
    assert travel[gap] < 0.0 < travel[gap + 1]


# -- comparison -----------------------------------------------------------------------------------


def test_differences_are_those_of_the_characteristics():
    stiff = Model(MODEL.suspension.with_changes({"strut.spring_rate_N_per_m": 30000.0}))
    found = compare.differences(compare.compare({"a": MODEL, "b": stiff}))
    rates = {d.name: d for d in found}["wheel_rate"]
    assert rates.at_design > 0.0
    camber = {d.name: d for d in found}["camber"]
    assert camber.largest == 0.0  # the spring does not change the kinematics
