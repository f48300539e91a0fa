"""No motion is reflected at a dead point, by any method, and those that turn before one go on."""

import re
from pathlib import Path

import numpy as np
import pytest
from kintrafo import Model, SimulationError, System, equilibrium, simulate
from kintrafo.equations.errors import ClosureError
from kintrafo.generated import four_bar, slider_crank
from kintrafo.simulation import trust
from kintrafo.simulation.solvers import native_available, native_methods
from kintrafo.systems.compile.build import compile_mechanism
from kintrafo.vehicle.analysis.excitation import TimeProfile, excitation
from scipy.integrate import solve_ivp

_EXPLICIT = "Verner" if native_available() else "DOP853"
METHODS = tuple(dict.fromkeys([*native_methods(), "BDF", "Radau", "LSODA", "RK45", "DOP853"]))


def ended(system, start, end, **options):
    with pytest.raises(SimulationError, match=r"dead point|cannot close") as caught:
        simulate(system, (0.0, end), start, **options)
    return caught.value


def test_scipy_and_c_go_by_the_same_numbers():
    header = (Path(trust.__file__).parent / "native/trust.h").read_text()
    found = re.findall(r"KT_(\w+) (?:= )?(\(1\.0 / 256\.0\)|[\d.e-]+)", header)
    known = {name: value for name, value in vars(trust).items() if name.isupper()}
    numbers = {name: 1.0 / 256.0 if "/" in text else float(text) for name, text in found}
    assert numbers.pop("LITTLE") == 0.125  # SciPy's steps are looked at each
    assert numbers == known


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    ("car", "step", "time"),
    [("double_wishbone_car", -0.15, 0.164132), ("reference_car", 0.3, 0.1427227)],
)
def test_all_methods_end_at_the_same_time(method, car, step, time):
    model = Model(car)
    road = excitation({"road_height": TimeProfile(step=step, step_at=0.1)}, 0.5, None)
    error = ended(model, equilibrium(model), 0.5, method=method, inputs=road)
    # rtol of a state that changes some ten times in this time
    assert error.time == pytest.approx(time, abs=5e-6)
    assert "beyond its dead point" in error.reason
    partial = error.partial
    assert not partial.success
    # the last height is a 100,000th of its greatest, 0.4 m, and is used up at 0.2 m/s or more
    assert partial.t[-1] == pytest.approx(error.time, abs=2e-5)
    assert all(np.isfinite(values).all() for values in partial.signals.values())


LONG_CRANK = {
    "crank_pin_x": 0.2,
    "crank_pin_y": 0.1,
    "crank_com_x": 0.1,
    "crank_com_y": 0.05,
    "spring_rate": 5000.0,
    "damper_rate": 0.0,
}
"""A crank that does not go round: it ends at dead points of the rocker, 2.4 rad back and 1.5 on."""


def crank(rate):
    """Return a four-bar whose crank is turned towards the dead point of its rocker."""
    system = System(four_bar, LONG_CRANK)
    return system, system.state(crank_angle_rate=rate)


def least_margin(system, states):
    return float(system.evaluate("margins", states)[:, 1].min())


def finishes(rate, method=_EXPLICIT, rtol=1e-10):
    system, start = crank(rate)
    try:
        return simulate(system, (0.0, 0.3), start, method=method, rtol=rtol, atol=1e-3 * rtol)
    except SimulationError:
        return None


@pytest.fixture(scope="module")
def turning():
    """Return the greatest rate with which the four-bar still turns before its dead point."""
    low, high = 0.0, 64.0
    assert finishes(low) is not None
    assert finishes(high) is None
    for _ in range(24):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if finishes(middle) is not None else (low, middle)
    return low


@pytest.mark.parametrize("method", METHODS)
def test_what_turns_before_a_dead_point_goes_on(turning, method):
    rate = turning * (1.0 - 1e-4)
    system, start = crank(rate)
    bare = solve_ivp(
        lambda _, y: system.evaluate("rhs", y),
        (0.0, 0.3),
        start,
        "DOP853",
        rtol=1e-12,
        atol=1e-13,
        max_step=1e-3,
    )
    usual = system.usual_margins[1]
    assert least_margin(system, bare.y.T) < 1e-2 * usual
    result = finishes(rate, method, rtol=1e-8)
    assert result.y[:, -1] == pytest.approx(bare.y[:, -1], abs=1e-3)


@pytest.mark.parametrize("method", METHODS)
def test_a_little_faster_ends(turning, method):
    system, start = crank(turning * (1.0 + 1e-4))
    error = ended(system, start, 1.0, method=method, rtol=1e-9, atol=1e-12)
    assert "rocker" in error.reason


@pytest.mark.parametrize("method", METHODS)
def test_an_input_that_moves_the_dead_point(method):
    """A rack that is pushed out of reach, with a model that is at rest otherwise."""
    model = Model("reference_car")
    times = np.linspace(0.0, 1.0, 50)
    rack = {"rack_position": (times, 0.4 * times**2)}
    error = ended(model, equilibrium(model), 1.0, method=method, inputs=rack)
    one = ended(model, equilibrium(model), 1.0, method="DOP853", inputs=rack, rtol=1e-10)
    assert error.time == pytest.approx(one.time, abs=1e-5)


@pytest.mark.parametrize("method", METHODS)
def test_backwards(method):
    system, start = crank(20.0)
    start[1] = -start[1]
    error = ended(system, start, -1.0, method=method)
    forward, again = crank(20.0)
    assert error.time == pytest.approx(-ended(forward, again, 1.0).time, abs=1e-5)


def test_functions_of_arrays_end_too():
    from kintrafo.generator.mechanisms.four_bar import FOUR_BAR

    system = System(compile_mechanism(FOUR_BAR, backend="numpy"), LONG_CRANK)
    start = system.state(crank_angle_rate=20.0)
    compiled, _ = crank(20.0)
    expected = ended(compiled, start, 1.0, method="DOP853").time
    assert ended(system, start, 1.0, method="BDF").time == pytest.approx(expected, abs=1e-5)


def test_a_crank_that_goes_round_is_not_ended():
    system = System(slider_crank)
    start = system.state(crank_angle_rate=30.0)
    for method in METHODS:
        assert simulate(system, (0.0, 1.0), start, method=method).success


def test_the_error_is_that_of_the_loop(refused):
    system, start = crank(20.0)
    error = ended(system, start, 1.0)
    message = "the rod coupler cannot reach rocker, beyond its dead point (rocker_closure = "
    assert message in error.reason
    refused(ClosureError, lambda: system.evaluate("rhs", [error.state[0] + 1e-3, 0.0]))


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("rack", [0.2, 2.0])  # m
def test_what_is_open_from_the_beginning_ends_there(method, rack):
    model = Model("reference_car")
    error = ended(model, model.design_state, 1.0, method=method, inputs={"rack_position": rack})
    assert error.time == 0.0
    assert "the loop" in error.reason


def test_steps_that_gain_nothing_before_a_dead_point_end():
    """A rounding error does not become smaller with the step."""
    model = Model("double_wishbone_car")
    start = np.array([2.186686, 0.520921, 0.0, 0.0])
    with pytest.raises(SimulationError, match="too small") as caught:
        simulate(model, (0.0, 100.0), start, method="Radau", rtol=8e-10, atol=8e-13)
    other = ended(model, start, 100.0, method="DOP853", rtol=1e-10)
    assert caught.value.time == pytest.approx(other.time, abs=1e-5)


@pytest.mark.parametrize("method", ["BDF", "LSODA", "DOP853"])
def test_what_scipy_found_until_then_stays(method):
    """Outputs between its steps, events and polynomials, as far as it came."""
    system, start = crank(-20.0)
    span, times = (0.0, 0.5), np.linspace(0.0, 0.5, 2001)

    def watched(_, state):
        return state[0] + 0.05

    options = {"t_eval": times, "events": watched, "dense_output": True, "backend": "scipy"}
    with pytest.raises(SimulationError, match="rocker") as caught:
        simulate(system, span, start, method=method, **options)
    partial, reached = caught.value.partial, caught.value.time
    assert partial.t.size == np.searchsorted(times, reached) > 20
    np.testing.assert_array_equal(partial.t, times[: partial.t.size])
    # interpolated to the tolerance of the steps, 1e-6
    np.testing.assert_allclose(partial.sol(partial.t), partial.y, rtol=1e-9, atol=1e-12)
    ((passed,), (state,)) = *partial.t_events, *partial.y_events
    assert state[0] == pytest.approx(-0.05, abs=1e-6)
    assert 0.0 < passed < reached


def test_scipy_ends_where_steps_are_used_up_with_what_it_has():
    system = System(slider_crank)
    start, times = system.state(crank_angle_rate=30.0), np.linspace(0.0, 10.0, 4001)
    with pytest.raises(SimulationError, match="more than 50 steps") as caught:
        simulate(system, (0.0, 10.0), start, method="DOP853", max_steps=50, t_eval=times)
    partial = caught.value.partial
    assert 1 < partial.t.size < times.size
    np.testing.assert_array_equal(partial.t, times[: partial.t.size])
