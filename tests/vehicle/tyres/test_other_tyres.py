"""TMeasy and a linear tyre on arrays."""

import itertools
import json
import re
from pathlib import Path

import kintrafo
import numpy as np
import pytest
from oracle import tmeasy as oracle

FILE = Path(__file__).parents[2] / "data/chrono/TMeasyTire.json"
DATA = json.loads(re.sub(r"//.*", "", FILE.read_text(encoding="utf-8")))
LINEAR = {
    "radius": 0.3, "effective_radius": 0.29, "vertical_stiffness": 2e5, "slip_stiffness": 9e4,
    "cornering_stiffness": 7e4, "camber_stiffness": 3e3, "trail": 0.03, "friction": 0.9,
}  # fmt: skip


@pytest.fixture
def load(tmp_path):
    def read(data):
        path = tmp_path / "own.json"
        path.write_text(json.dumps(data), encoding="utf-8")
        return kintrafo.tyres.load(path)

    return read


def changed(place, value):
    """Return the file with another value, or without a key."""
    data = json.loads(json.dumps(DATA))
    holder = data
    for key in place[:-1]:
        holder = holder[key]
    if value is None:
        del holder[place[-1]]
    else:
        holder[place[-1]] = value
    return data


@pytest.mark.parametrize("sliding", [[3000.0, 5800.0], [500.0, 900.0]], ids=["parabolas", "cubic"])
def test_tmeasy_is_what_its_pieces_say(load, sliding):
    """To 1e-6 of the load, that divide it by 1e-6 N more than it is."""
    data = changed(("Parameters", "Longitudinal", "Sliding Fx Load [N]"), sliding)
    data["Parameters"]["Longitudinal"]["Slip sx where sliding begins"] = [0.2, 0.25]
    tyre = load(data).with_friction(0.7)
    states = itertools.product(
        (500.0, 3500.0, 8000.0),
        (-0.9, -0.25, -0.02, 0.0, 0.05, 0.4),
        (-0.99, -0.3, -0.12, -0.01, 0.02, 0.5),
        (0.0, 0.1),
    )
    for state in states:
        found = tyre.evaluate(*state)
        wanted = oracle.evaluate(data, *state, friction=0.7)
        got = [float(found.fx), float(found.fy), float(found.mz)]
        np.testing.assert_allclose(got, wanted, rtol=1e-7, atol=1e-6 * state[0], err_msg=str(state))


@pytest.mark.parametrize("axis", ["x", "y"])
def test_stiffnesses_of_tmeasy_are_slopes_however_flat_the_file_says(load, axis):
    """A slope below twice the secant to the maximum is that, in forces and in what is reported."""
    section = {"x": "Longitudinal", "y": "Lateral"}[axis]
    key = f"Initial Slopes dF{axis}/ds{axis} [N]"
    tyre = load(changed(("Parameters", section, key), [12e3, 20e3]))
    slip = 1e-4 * np.array([1.0, -1.0])
    if axis == "x":
        (more, less), told = tyre.evaluate(3500.0, slip=slip).fx, "slip_stiffness"
    else:
        (less, more), told = tyre.evaluate(3500.0, slip).fy, "cornering_stiffness"
    # to some 1e-3: the part of the maximum's slip that the step is
    assert getattr(tyre.evaluate(3500.0), told) == pytest.approx((more - less) / 2e-4, rel=2e-3)


def test_tmeasy_rolls_backward():
    """The same slip velocities of tread and wheel, seen from behind."""
    tyre = kintrafo.tyres.load(FILE)
    ahead, back = tyre.evaluate(3000.0, 0.05, 0.1), tyre.evaluate(3000.0, 0.05, -0.1, speed=-10.0)
    assert back.fx == pytest.approx(-float(ahead.fx), rel=1e-12)
    assert back.fy == pytest.approx(float(ahead.fy), rel=1e-12)
    assert back.mz == pytest.approx(-float(ahead.mz), rel=1e-12)


def test_tmeasy_figures():
    tyre = kintrafo.tyres.load(FILE)
    found = tyre.evaluate([3500.0, 7000.0])
    np.testing.assert_allclose(found.slip_stiffness, [85e3, 155e3], rtol=1e-8)
    np.testing.assert_allclose(found.cornering_stiffness, [62e3, 100e3], rtol=1e-8)
    np.testing.assert_allclose(found.vertical_stiffness, [190e3, 206e3], rtol=1e-12)
    np.testing.assert_allclose(found.relaxation_y, [62e3 / 150e3, 100e3 / 150e3], rtol=1e-8)
    deflection = 0.316 - found.loaded_radius
    np.testing.assert_allclose(found.effective_radius, 0.316 - [0.625, 0.25] * deflection)
    assert (tyre.radius, tyre.nominal_load, tyre.ranges) == (0.316, 3500.0, {"load": (0.0, 9000.0)})
    assert "Design > Mass [kg]" in tyre.left_out
    assert "Parameters > Tire Damping" in tyre.left_out
    assert "load" in tyre.evaluate(9500.0).outside


@pytest.mark.parametrize("by_curve", [False, True])
def test_the_newer_form_of_the_template(load, by_curve):
    """One stiffness or a curve, one resistance, no carcass; R_eff = (2 R0 + static) / 3."""
    older = load(changed(("Parameters", "Tire Load", "Maximum Vertical Force [N]"), 3.5 * 3500.0))
    data = changed(("Parameters", "Tire Stiffness"), None)
    for key in ("Tire Load", "Dynamic Radius Weighting Coefficients", "Tire Damping"):
        del data["Parameters"][key]
    del data["Rolling Resistance Coefficients"]
    data["Rolling Resistance Coefficient"] = 0.012
    first, second = np.sqrt(2 * 190e3**2 - 206e3**2), (206e3**2 - 190e3**2) / (4 * 3500.0)
    curve = [[x, first * x + second * x * x] for x in (0.0, 0.01, 0.02, 0.04)]
    stiff = (
        {"Tire Spring Curve Data": curve} if by_curve else {"Vertical Tire Stiffness [N/m]": 2e5}
    )
    data["Parameters"]["Vertical"] = {"Nominal Vertical Force [N]": 3500.0} | stiff
    tyre = load(data)
    found, wanted = tyre.evaluate(4000.0, 0.05, 0.1), older.evaluate(4000.0, 0.05, 0.1)
    assert found.fx == pytest.approx(float(wanted.fx), rel=1e-12)
    assert found.fy == pytest.approx(float(wanted.fy), rel=1e-12)
    assert np.isnan(found.relaxation_x)
    if by_curve:
        assert found.loaded_radius == pytest.approx(float(wanted.loaded_radius), rel=1e-12)
    else:
        assert found.loaded_radius == pytest.approx(0.316 - 4000.0 / 2e5)
    assert 3.0 * found.effective_radius == pytest.approx(2 * 0.316 + float(found.loaded_radius))
    assert not [key for key in tyre.left_out if "Vertical" in key or "Resistance" in key]


@pytest.mark.parametrize("tyre", [kintrafo.tyres.load(FILE), kintrafo.tyres.LinearSlip(**LINEAR)])
def test_they_oppose_the_slip_and_are_symmetric(tyre):
    angles, slips = np.meshgrid(np.linspace(-0.6, 0.6, 13), np.linspace(-1.0, 1.0, 13))
    found = tyre.evaluate(3000.0, angles, slips)
    assert np.all(found.fx * -slips + found.fy * np.tan(angles) <= 0.0)
    mirrored = tyre.mirrored().evaluate(3000.0, -angles, slips)
    np.testing.assert_allclose(mirrored.fx, found.fx, atol=1e-9)
    np.testing.assert_allclose(mirrored.fy, -found.fy, atol=1e-9)
    none = tyre.evaluate(0.0, 0.1, 0.1, 0.05)
    assert abs(none.fx) < 1e-5
    assert abs(none.fy) < 1e-5


def test_the_linear_tyre_is_linear_and_ends_at_the_friction(refused):
    tyre = kintrafo.tyres.LinearSlip(**LINEAR)
    found = tyre.evaluate(4000.0, 1e-4, 1e-4, 1e-3)
    assert found.fx == pytest.approx(9.0, rel=1e-5)
    assert found.fy == pytest.approx(-10.0, rel=1e-5)
    assert found.mz == pytest.approx(0.3, rel=1e-4)
    sliding = tyre.evaluate(4000.0, 0.7, -0.9)
    assert np.hypot(sliding.fx, sliding.fy) == pytest.approx(3600.0, rel=1e-3)
    assert found.loaded_radius == 0.3 - 4000.0 / 2e5
    for name in ("friction", "relaxation_x", "relaxation_y", "nominal_load"):
        with refused(kintrafo.InputError):
            kintrafo.tyres.LinearSlip(**(LINEAR | {name: -1.0}))


@pytest.mark.parametrize(
    ("place", "value"),
    [
        (("Template",), "FialaTire"),
        (("Design", "Width [m]"), None),
        (("Parameters",), None),
        (("Parameters", "Tire Load"), None),
        (("Coefficient of Friction",), "much"),
        (("Coefficient of Friction",), 0.0),
        (("Parameters", "Aligning", "Normalized Trail at Zero Slip sy"), [0.1]),
        (("Parameters", "Lateral", "Slip sy at Maximum Fy"), [0.8, 0.9]),
        (("Parameters", "Lateral", "Sliding Fy Load [N]"), [4e3, 5e3]),
        (("Parameters", "Lateral", "Initial Slopes dFy/dsy [N]"), [6e4, 2e4]),
        (("Parameters", "Tire Stiffness", "Vertical [N/m]"), [1e5, 2e5]),
    ],
)  # fmt: skip
def test_mistakes_are_refused_by_name(load, place, value, refused):
    refused(kintrafo.InputError, lambda: load(changed(place, value)))
