"""Coefficients that are found again from forces with noise, and data that do not determine them."""

import kintrafo
import numpy as np
import pytest
from cars.tyre_files import OLDER

TRUTH = kintrafo.tyres.load("passenger_205_55")
NOISE = {"fy": 30.0, "mz": 1.5}
OFF = {"PCY1": 1.5, "PDY1": 1.2, "PDY2": -0.2, "PKY1": -15.0, "PKY2": 1.4, "PEY1": -0.3,
       "PVY1": 0.0, "PHY1": 0.0, "QBZ1": 9.0, "QDZ1": 0.12, "QEZ1": -1.0}  # fmt: skip


def lateral(loads=(1500.0, 3000.0, 4500.0, 6500.0), cambers=(-4.0, 0.0, 4.0)):
    """Return sweeps of the slip angle at loads and cambers."""
    grid = np.meshgrid(loads, np.radians(np.linspace(-14, 14, 41)), np.radians(cambers))
    load, angle, camber = (each.ravel() for each in grid)
    return {"load": load, "slip_angle": angle, "camber": camber}


def with_forces(states, *names, noise=0.0, tyre=TRUTH):
    state, random = vars(tyre.evaluate(**states)), np.random.default_rng(11)
    return states | {
        n: state[n] + noise * NOISE.get(n, 1.0) * random.standard_normal(len(state[n]))
        for n in names
    }


def test_noise_is_seen_through():
    """Errors over their standard errors have a mean square near one, and none is beyond 4."""
    data = with_forces(lateral(), "fy", "mz", noise=1.0)
    found = kintrafo.tyres.fit(data, TRUTH.with_changes(OFF))
    assert found.success
    assert found.at_bounds == ()
    names = [str(n) for n in found.table["coefficient"].values]
    assert set(OFF) <= set(names)
    truth = np.array([TRUTH.coefficients[name] for name in names])
    off = (found.table["value"].values - truth) / found.table["standard_error"].values
    assert np.abs(off).max() < 4.0
    assert 0.4 < np.mean(off**2) < 2.2
    for name, value in found.root_mean_square().items():
        assert value == pytest.approx(NOISE[name], rel=0.12)
    correlation = found.table["correlation"].values
    np.testing.assert_allclose(np.diag(correlation), 1.0)
    assert np.abs(correlation).max() <= 1.0 + 1e-12


def test_known_accuracy_gives_the_same_standard_errors():
    data = with_forces(lateral(), "fy", noise=1.0)
    names = ["PDY1", "PKY1", "PCY1"]
    one, two = (
        kintrafo.tyres.fit(data, TRUTH, names, accuracy=accuracy)
        for accuracy in (None, {"fy": 30.0})
    )
    np.testing.assert_allclose(one.table["value"], two.table["value"], rtol=1e-6)
    np.testing.assert_allclose(one.table["standard_error"], two.table["standard_error"], rtol=0.12)


@pytest.mark.parametrize("older", [False, True])
def test_combined_slip_is_found_again(older, tmp_path):
    tyre = TRUTH
    if older:
        (tmp_path / "older.tir").write_text(OLDER, encoding="utf-8")
        tyre = kintrafo.tyres.load(tmp_path / "older.tir")
    load, angle, slip = (
        each.ravel()
        for each in np.meshgrid([2000.0, 5000.0], np.radians([-8, -3, 0, 2, 6]),
                                np.linspace(-0.4, 0.4, 21))
    )  # fmt: skip
    data = with_forces({"load": load, "slip_angle": angle, "slip": slip}, "fx", "fy", tyre=tyre)
    wrong = {"RBX1": 10.0, "RBX2": 8.0, "RBY1": 9.0, "RBY2": 7.0, "PKX1": 20.0, "PDX1": 1.0}
    found = kintrafo.tyres.fit(data, tyre.with_changes(wrong), [*wrong])
    for name in wrong:
        value = float(found.table["value"].sel(coefficient=name))
        assert value == pytest.approx(tyre.coefficients[name], rel=1e-6), name


def test_a_file_in_other_units(tmp_path, refused):
    data = with_forces(lateral(), "fy")
    path = tmp_path / "rig.csv"
    rows = np.column_stack(
        [1e-3 * data["load"], np.degrees(data["slip_angle"]), np.degrees(data["camber"]),
         data["fy"], np.full(len(data["fy"]), 20.0)]
    )  # fmt: skip
    head = "load_kN,Slip Angle [deg],camber_deg,fy_N,temperature"
    np.savetxt(path, rows, delimiter=",", header=head, comments="", fmt="%.12g")
    found = kintrafo.tyres.fit(path, TRUTH.with_changes({"PDY1": 1.2, "PKY1": -15.0}),
                               ["PDY1", "PKY1"])  # fmt: skip
    np.testing.assert_allclose(found.table["value"], [0.98, -21.0], rtol=1e-6)
    for columns in (
        "load_kg,slip_angle_deg,camber_deg,fy_N,x",
        "load_N,slip_angle_deg,camber_deg,side_N,x",
        "load_N,slip_angle_N,camber_deg,fy_N,x",
        "load_N,slip_angle_deg,camber_deg,fy_N,fy_kN",
    ):
        np.savetxt(path, rows, delimiter=",", header=columns, comments="")
        with refused(kintrafo.InputError):
            kintrafo.tyres.fit(path, TRUTH)


@pytest.mark.parametrize(
    ("states", "names"),
    [
        (lateral(cambers=(0.0,)), ["PDY1", "PDY3"]),
        (lateral(), ["PKX1"]),
        (lateral(loads=(4000.0,)), ["PKY1", "PKY2", "PDY1"]),
        (lateral(), ["PDY1", "PCY1", "LCY"]),
        (lateral(), ["PDY1", "PDY1"]),
        (lateral(), []),
        (lateral(), ["PDY9"]),
    ],
)
def test_what_data_do_not_determine_is_refused_by_name(states, names, refused):
    refused(
        kintrafo.InputError, lambda: kintrafo.tyres.fit(with_forces(states, "fy"), TRUTH, names)
    )


def test_what_they_do_not_determine_is_left_out():
    data = with_forces(lateral(loads=(4000.0,), cambers=(0.0,)), "fy")
    found = kintrafo.tyres.fit(data, TRUTH)
    assert {"PDY2", "PDY3", "PKY3", "PVY3"} <= set(found.left_out)
    assert max(found.root_mean_square().values()) < 1e-3


def test_bounds_hold_and_are_named():
    data = with_forces(lateral(), "fy")
    found = kintrafo.tyres.fit(
        data, TRUTH.with_changes({"PDY1": 1.2}), ["PDY1", "PKY1"], bounds={"PDY1": (1.1, 1.5)}
    )
    assert found.at_bounds == ("PDY1",)
    assert found.tyre.coefficients["PDY1"] == pytest.approx(1.1, abs=1e-6)


@pytest.mark.parametrize(
    "arguments",
    [
        {"bounds": {"PDY1": (1.1, 1.5)}},
        {"bounds": {"PDY1": (1.5, 0.1)}},
        {"bounds": {"PKY1": (-50.0, -1.0)}},
        {"accuracy": {"fy": 0.0}},
        {"accuracy": {"fx": 1.0}},
        {"start": "passenger_205_55"},
        {"data": {"load": [1.0], "fy": [1.0, 2.0]}},
        {"data": {"load": [-1.0], "fy": [1.0]}},
        {"data": {"load": [1.0], "fq": [1.0]}},
        {"data": {"load": [1e3, 2e3], "slip_angle": [-4.0, 4.0], "fy": [9e2, -9e2]}},
        {"data": {"load": [3e3, 4e3], "slip_angle": [-0.1, 0.1], "fy": [-9e2, 9e2]}},
    ],
)
def test_arguments_are_refused_by_name(arguments, refused):
    usual = {"data": with_forces(lateral(), "fy"), "start": TRUTH, "coefficients": ["PDY1"]}
    refused(kintrafo.InputError, lambda: kintrafo.tyres.fit(**(usual | arguments)))


_BY_ELLIPSE = OLDER.replace("[DIMENSION]", "FE_METHOD = 'YES'\n[DIMENSION]")
_MF_5 = OLDER.replace("PROPERTY_FILE_FORMAT     = 'PAC2002'", "FITTYP = 5")


@pytest.mark.parametrize(
    "text", [None, OLDER, _BY_ELLIPSE, _MF_5], ids=["newer", "older", "ellipse", "MF 5"]
)
def test_a_tyre_that_is_written_is_the_same(tmp_path, text, refused):
    tyre = TRUTH
    if text is not None:
        (tmp_path / "older.tir").write_text(text, encoding="utf-8")
        tyre = kintrafo.tyres.load(tmp_path / "older.tir")
    path = kintrafo.tyres.write_tir(tyre, tmp_path / "own.tir", head="found\nby kintrafo")
    again = kintrafo.tyres.load(path)
    assert dict(again.coefficients) == dict(tyre.coefficients)
    assert (again.form, again.name, again.side) == (tyre.form, tyre.name, tyre.side)
    assert again.left_out == ()
    assert path.read_text(encoding="utf-8").startswith("$ found\n$ by kintrafo\n[UNITS]\n")
    refused(kintrafo.InputError, lambda: kintrafo.tyres.write_tir(tyre, tmp_path / "own.txt"))
