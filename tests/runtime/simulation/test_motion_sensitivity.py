"""Derivatives of a motion over time.

Against the gradient backwards, motions of complex numbers, and, where they are found in lanes, the
same in NumPy and in other lanes.
"""

import kintrafo
import numpy as np
import pytest
from kintrafo import InputError, Samples
from kintrafo.generator.mechanisms import MODELS
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
from kintrafo.simulation import forwards
from kintrafo.simulation.lanes import directions
from kintrafo.simulation.lanes.library import widths
from mechanisms.iterated_loops import STEPHENSON
from scipy.integrate import solve_ivp
from support.complex_numbers import STEP, printed

CAR = kintrafo.Model("reference_car")
SHIPPED = {model.name: model for model in MODELS}
SPAN, TIMES = (0.0, 0.3), np.linspace(0.0, 0.3, 31)
START = np.array(kintrafo.state_at_height(CAR, 0.325, spin_rate=93.0))
ROAD = {"road_height": Samples([0.0, 0.1, 0.1, 0.3], [0.0, 0.01, 0.03, 0.0], "linear")}
NAMES = ["tie_rod_inner_z", "wheel_center_x", "damper_rate", "gravity", "beta1", "strut_force"]
SIGNALS = ["toe", "wheel_acceleration", "tyre_force"]
TIGHT = {"rtol": 1e-11, "atol": 1e-13}


@pytest.fixture(scope="module")
def system():
    module = kintrafo.compile(SHIPPED[CAR.equations.NAME], parameter_derivatives=True)
    return kintrafo.System(module, CAR.parameters)


def test_it_is_the_transpose_of_the_gradient(system):
    weights = np.cos(40.0 * TIMES)
    of = dict.fromkeys([*SIGNALS, "beta1"], weights)
    names = [*NAMES, "spring_rate", "beta1_rate"]
    asked = {"inputs": ROAD, "t_eval": TIMES}
    back = kintrafo.motion_gradient(system, SPAN, START, of, **asked)
    found = kintrafo.motion_sensitivity(system, SPAN, START, names, **asked)
    for name in names:
        forward = sum(weights @ found.by[name][signal] for signal in of)
        assert forward == pytest.approx(back.by[name], rel=1e-9)
    np.testing.assert_array_equal(found.motion.t, back.motion.t)


def test_directions_of_several(system):
    together = {"raised": {"tie_rod_inner_z": 2.0, "damper_rate": -1.0, "beta1": 0.5}}
    found = kintrafo.motion_sensitivity(system, SPAN, START, together, t_eval=TIMES)
    alone = kintrafo.motion_sensitivity(system, SPAN, START, [*together["raised"]], t_eval=TIMES)
    wanted = sum(part * alone.by[name]["toe"] for name, part in together["raised"].items())
    np.testing.assert_allclose(found.by["raised"]["toe"], wanted, rtol=1e-9, atol=1e-12)
    assert set(found.values) == {*system.state_names, *system.signal_names}


needs_lanes = pytest.mark.skipif(not widths(), reason="built without lanes")
Changed = kintrafo.MotionSensitivity


def in_lanes(monkeypatch, width, *, done=True):
    """Let directions be followed in so many lanes, without any in NumPy; see that it is done."""

    def found(*given):
        followed = directions.followed(*given, width) if width else None
        assert (followed is not None) is (done and bool(width))
        return followed

    monkeypatch.setattr(forwards, "in_lanes", found)


def same(one, other, rounding=0.0):
    """Demand the same derivatives along the directions of one of them."""
    for name, rows in one.by.items():
        for wanted, row in rows.items():
            most = rounding * np.abs(row).max()
            np.testing.assert_allclose(other.by[name][wanted], row, rtol=0.0, atol=most)


@needs_lanes
def test_in_lanes_as_in_numpy(system, monkeypatch):
    """Over a jump of the road, and a kink: the tyre leaves it."""
    found = []
    for width in (None, widths()[-1]):
        in_lanes(monkeypatch, width)
        found.append(
            kintrafo.motion_sensitivity(system, SPAN, START, NAMES, inputs=ROAD, t_eval=TIMES)
        )
    assert found[0].values["tyre_force"].min() <= 0.0
    same(*found, rounding=1e-11)  # of some hundred steps


@needs_lanes
def test_what_iterates_in_lanes_as_in_numpy(monkeypatch):
    system = kintrafo.System(kintrafo.compile(STEPHENSON, parameter_derivatives=True))
    masses = {name: 0.1 for name in system.parameters if name.endswith("_mass")}
    found = []
    for width in (None, widths()[-1]):
        in_lanes(monkeypatch, width)
        by = {"heavier": masses, "turned": {system.state_names[0]: 1.0}}
        found.append(kintrafo.motion_sensitivity(system, (0.0, 0.1), system.design_state, by))
    same(*found, rounding=1e-11)


@pytest.fixture(scope="module")
def four_bar():
    return kintrafo.System(kintrafo.compile(FOUR_BAR, parameter_derivatives=True))


@needs_lanes
def test_the_same_bits_in_any_lanes(four_bar, monkeypatch):
    """The bits depend neither on the width nor on other directions."""
    start, names = four_bar.state(), [*four_bar.parameters][8:17]  # one more than the widest has
    in_lanes(monkeypatch, widths()[0])
    several = kintrafo.motion_sensitivity(four_bar, (0.0, 0.3), start, names)
    for width in widths():
        in_lanes(monkeypatch, width)
        for group in (names, names[::-1], names[3:4]):
            same(kintrafo.motion_sensitivity(four_bar, (0.0, 0.3), start, group), several)


@needs_lanes
def test_what_lanes_refuse_is_found_in_numpy(four_bar, monkeypatch):
    """They have no sine of so great an angle."""
    start = four_bar.state(crank_angle=0.3 + 2e6 * np.pi)
    in_lanes(monkeypatch, widths()[-1], done=False)
    found = kintrafo.motion_sensitivity(four_bar, (0.0, 0.1), start, ["crank_mass"])
    start = four_bar.state(crank_angle=0.3)
    in_lanes(monkeypatch, widths()[-1])
    # the angle is rounded by 1e-9
    same(kintrafo.motion_sensitivity(four_bar, (0.0, 0.1), start, ["crank_mass"]), found, 1e-5)


def test_against_a_motion_of_complex_numbers(four_bar, monkeypatch):
    """By another method, of the printed NumPy."""
    model = printed(FOUR_BAR, monkeypatch)
    moved = {"crank_mass": 1.0, "rocker_bearing_x": 1e-2, "spring_rate": -30.0, "crank_angle": 0.1}
    parameters = np.array([v + STEP * moved.get(n, 0.0) for n, v in four_bar.parameters.items()])
    start = four_bar.state(crank_angle=0.3) + STEP * np.array([moved["crank_angle"], 0.0])
    constants, times = np.array(model.prepare(parameters)[0]), np.linspace(0.0, 0.5, 11)

    def rates(_, state):
        return np.array(model.rhs(constants, state, np.zeros(1))[0])

    exact = solve_ivp(
        rates, (0.0, 0.5), start, method="DOP853", t_eval=times, rtol=1e-13, atol=1e-14
    )
    found = kintrafo.motion_sensitivity(
        four_bar, (0.0, 0.5), start.real, {"moved": moved}, t_eval=times, **TIGHT
    )
    for row, name in zip(exact.y, four_bar.state_names, strict=True):
        along = row.imag / STEP.imag
        # some hundred times what both tolerate
        most = 1e-9 * np.abs(along).max()
        np.testing.assert_allclose(found.by["moved"][name], along, rtol=0.0, atol=most)


@pytest.mark.parametrize(
    "changes",
    [
        {"by": ["no_such"]},
        {"by": {}},
        {"by": []},
        {"by": ["road_height"], "inputs": ROAD},
        {"by": ["gravity"], "t_span": (1.0, 0.0)},
        {"by": ["gravity"], "signals": ["nothing"]},
        {"by": {"a": {"gravity": np.nan}}},
        {"by": ["gravity"], "rtol": -1.0},
    ],
)
def test_what_cannot_be_used_is_refused(system, changes, refused):
    asked = {"t_span": SPAN, "y0": START, **changes}
    refused(InputError, lambda: kintrafo.motion_sensitivity(system, **asked))
