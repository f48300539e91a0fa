"""Key figures of tyres, the command that prints them, and their curves."""

import json

import kintrafo
import numpy as np
import pytest
from kintrafo.vehicle.plots.tyres import write_tyre
from matplotlib.image import imread
from scipy.optimize import minimize_scalar

TYRE = kintrafo.tyres.load("passenger_205_55")
LOADS = [2500.0, 6000.0]


def test_friction_is_the_greatest_force():
    """Beside SciPy's search: the grid of 1e-3 rad misses a peak by 1e-6 of it."""
    found = kintrafo.tyres.key_figures(TYRE, LOADS)
    for i, load in enumerate(LOADS):

        def at(name, value, load=load):
            state = TYRE.evaluate(load, **{name: value})
            return -float(np.hypot(state.fx if name == "slip" else 0.0, state.fy)) / load

        sides = [minimize_scalar(lambda x: at("slip_angle", x), bounds=ends, method="bounded")
                 for ends in ((0.02, 0.5), (-0.5, -0.02))]  # fmt: skip
        assert found["friction_lateral"][i] == pytest.approx(max(-s.fun for s in sides), rel=1e-5)
        driving = max(TYRE.evaluate(load, slip=np.linspace(0.0, 1.0, 5001)).fx) / load
        assert found["friction_driving"][i] == pytest.approx(driving, rel=1e-5)
        state = TYRE.evaluate(load, slip=float(found["slip_of_braking"][i]))
        assert found["friction_braking"][i] == pytest.approx(-float(state.fx) / load, rel=1e-12)
    slope = np.gradient(kintrafo.tyres.key_figures(TYRE, np.linspace(2400, 2600, 5))
                        ["friction_lateral"].values, 50.0)[2]  # fmt: skip
    assert found["load_sensitivity"][0] == pytest.approx(slope, rel=1e-3)


def test_of_a_linear_tyre_they_are_its_numbers():
    tyre = kintrafo.tyres.LinearSlip(
        radius=0.3, effective_radius=0.29, vertical_stiffness=2e5, slip_stiffness=9e4,
        cornering_stiffness=7e4, camber_stiffness=3e3, trail=0.03,
    )  # fmt: skip
    found = kintrafo.tyres.key_figures(tyre)
    np.testing.assert_array_equal(found["load"], [2000.0, 4000.0, 6000.0])
    wanted = {"cornering_stiffness": 7e4, "slip_stiffness": 9e4, "camber_stiffness": 3e3,
              "trail": 0.03, "effective_radius": 0.29, "vertical_stiffness": 2e5}  # fmt: skip
    for name, value in wanted.items():
        np.testing.assert_allclose(found[name], value, rtol=1e-4, err_msg=name)


def test_the_command(kintrafo, tmp_path, ends):
    code, out, _ = kintrafo("tyre", "passenger_205_55", "--load", "3000,5000", "-o", "a.csv")
    assert code == 0
    assert "cornering stiffness" in out
    assert "Not used: [DIMENSION] WIDTH" in " ".join(out.split())
    assert (tmp_path / "a.csv").read_text(encoding="utf-8").count("\n") == 3
    code, out, _ = kintrafo("tyre", "passenger_205_55", "--json")
    assert code == 0
    assert "cornering_stiffness" in json.dumps(json.loads(out))
    ends(2, "tyre", "none.tir")
    for wrong in (["--load", "much"], ["--load", "90000"], ["--plot", "a.txt"]):
        ends(2, "tyre", "passenger_205_55", *wrong)


@pytest.mark.parametrize("ending", ["png", "svg"])
def test_curves_are_drawn(tmp_path, ending):
    path = write_tyre(TYRE, tmp_path / f"a.{ending}", title="a tyre")
    if ending == "png":
        assert imread(path).shape[0] > 1000
    else:
        text = path.read_text(encoding="utf-8")
        assert "<svg" in text
    with pytest.raises(kintrafo.InputError):
        write_tyre(TYRE, tmp_path / "a.txt")
