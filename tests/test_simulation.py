"""`simulate`: results, inputs, and errors that say when and where."""

import numpy as np
import pytest
from kintrafo import InputError, Model, SimulationError, equilibrium, simulate, state_at_height
from oracle import multipliers, newton
from oracle.reference import DYNAMICS, SPIN_RATE, reference_parameters
from scipy.interpolate import CubicSpline

MODEL = Model("reference_car")
START = state_at_height(MODEL, 0.325, spin_rate=SPIN_RATE)
TIMES = np.linspace(0.0, 1.0, 60)


def reference_states():
    times, rise, rise_rate, spin, spin_rate = DYNAMICS[:, :5].T
    arm = MODEL.design_state[0] - rise
    return times, np.array([arm, spin, -rise_rate, spin_rate])


@pytest.mark.parametrize("method", ["BDF", "Radau", "LSODA", "RK45", "DOP853"])
def test_methods_agree_with_the_reference_trajectory(method):
    times, states = reference_states()
    result = simulate(MODEL, (0, 1), START, method=method, t_eval=times, rtol=1e-9, atol=1e-12)
    # global error of a method at rtol 1e-9 over 12 oscillations: below 1e-5 of the amplitudes
    scale = np.array([0.07, 93.0, 4.0, 93.0])
    assert np.abs((result.y - states) / scale[:, None]).max() < 1e-5
    assert result.success
    assert result.t.tolist() == times.tolist()


def test_bdf_converges_with_its_tolerance():
    times, states = reference_states()
    errors = [
        np.abs(simulate(MODEL, (0, 1), START, t_eval=times, rtol=r, atol=r * 1e-3).y - states)[0]
        for r in (1e-4, 1e-7, 1e-10)
    ]
    worst = [e.max() for e in errors]
    assert worst[0] > 30 * worst[1] > 900 * worst[2]


def test_signals_belong_to_the_states():
    result = simulate(MODEL, (0, 0.2), START)
    again = MODEL.signals(result.y.T)
    for name, values in result.signals.items():
        assert np.array_equal(values, again[name]), name
    assert set(result.signals) == set(MODEL.signal_names)
    assert result.signals["wheel_center_z"][0] == pytest.approx(0.325, abs=1e-12)


def test_wheel_velocity_and_acceleration_are_derivatives_of_the_height():
    result = simulate(
        MODEL, (0, 0.1), START, t_eval=np.linspace(0, 0.1, 401), rtol=1e-11, atol=1e-13
    )
    height = CubicSpline(result.t, result.signals["wheel_center_z"])
    inner = slice(20, -20)  # a spline's ends are its worst part
    # spline through steps of 0.25 ms of a 12 Hz motion: (75 * 2.5e-4)^3 / 24 of 1.4 m/s
    difference = height(result.t, 1) - result.signals["wheel_velocity"]
    assert np.abs(difference[inner]).max() < 2e-6
    difference = height(result.t, 2) - result.signals["wheel_acceleration"]
    assert np.abs(difference[inner]).max() < 2e-2


def test_prescribed_rack_motion_agrees_with_multipliers():
    rack = 0.02 * np.sin(4.0 * TIMES)
    inputs = {"rack_position": (TIMES, rack), "road_height": 0.005, "strut_force": 50.0}
    result = simulate(
        MODEL, (0, 0.3), START, inputs=inputs, method="DOP853", t_eval=[0.3], rtol=1e-11, atol=1e-12
    )
    spline = CubicSpline(TIMES, rack)
    oracle = multipliers.simulate(
        newton.Mechanism(reference_parameters()),
        np.array([0.0, 0.3]),
        np.array([START[0], START[1], spline(0.0)]),
        np.array([0.0, SPIN_RATE, spline(0.0, 1)]),
        rack_motion=lambda t: (float(spline(t)), float(spline(t, 1)), float(spline(t, 2))),
        road_height=lambda _: 0.005,
        strut_force=lambda _: 50.0,
        rtol=1e-11,
    )
    # both integrate with 1e-11 a step, about a hundred steps
    assert result.y[:2, -1] == pytest.approx(oracle.coordinates[-1, :2], rel=1e-9)


def test_rack_velocity_and_acceleration_follow_from_a_spline():
    spline = CubicSpline(TIMES, 0.02 * np.sin(4.0 * TIMES))
    by_spline = simulate(MODEL, (0, 0.2), START, inputs={"rack_position": spline})
    by_samples = simulate(MODEL, (0, 0.2), START, inputs={"rack_position": (TIMES, spline(TIMES))})
    assert np.array_equal(by_spline.y, by_samples.y)
    column = MODEL.input_names.index("rack_velocity")
    assert by_spline.inputs[:, column] == pytest.approx(spline(by_spline.t, 1), abs=1e-15)


def test_a_wheel_at_rest_follows_a_slow_road():
    road = {"road_height": lambda t: 0.01 * (1 - np.cos(np.pi * t)) / 2}
    result = simulate(MODEL, (0, 1), equilibrium(MODEL), inputs=road, rtol=1e-8)
    settled = equilibrium(MODEL, road_height=0.01)
    assert result.y[0, -1] == pytest.approx(settled[0], abs=2e-4)


def test_dense_output_and_events_are_those_of_scipy():
    def at_design(_, y):
        return y[0] - MODEL.design_state[0]

    at_design.terminal = True
    result = simulate(MODEL, (0, 1), START, events=at_design, dense_output=True, rtol=1e-8)
    assert result.status == 1
    assert result.sol(result.t_events[0][0])[0] == pytest.approx(MODEL.design_state[0], abs=1e-9)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"method": "Gear"}, "Gear.*BDF"),
        ({"y0": [1.0, 2.0]}, "beta5_rate"),
        ({"t_span": (0.0, 0.0)}, "two different"),
        ({"t_span": (0.0, np.inf)}, "finite"),
        ({"inputs": {"rod_height": 1.0}}, "Did you mean road_height"),
        ({"inputs": {"road_height": np.nan}}, "road_height.*finite"),
        ({"inputs": {"rack_velocity": 1.0}}, "follows from 'rack_position'"),
        ({"inputs": {"rack_position": np.sin}}, "derivative"),
        ({"inputs": {"road_height": (TIMES, TIMES[:-1])}}, "same length"),
        ({"inputs": {"road_height": (TIMES[::-1], TIMES)}}, "must increase"),
        ({"inputs": {"road_height": (TIMES / 2, TIMES)}}, "cover 0 s to 0.5 s"),
        ({"inputs": {"road_height": (TIMES, TIMES * np.nan)}}, "must be finite"),
    ],
)
def test_bad_arguments_are_refused(arguments, words):
    given = {"t_span": (0.0, 1.0), "y0": START} | arguments
    with pytest.raises(InputError, match=words):
        simulate(MODEL, **given)


def test_loop_that_cannot_close_says_when_where_and_which():
    with pytest.raises(SimulationError, match=r"cannot reach knuckle.*beta1 = ") as caught:
        simulate(MODEL, (0, 1), START, inputs={"strut_force": -1e6})
    assert 0.0 < caught.value.time < 0.1
    assert np.all(np.isfinite(caught.value.state))


def test_input_that_becomes_nan_is_named():
    with pytest.raises(SimulationError, match="NaN or infinite: road_height"):
        simulate(MODEL, (0, 1), START, inputs={"road_height": lambda t: np.nan if t > 0.1 else 0.0})


def test_free_rack_moves_under_its_force():
    free = Model("reference_car", free_rack=True)
    start = equilibrium(free)
    holding = -free.evaluate("forces", start)[2]
    still = simulate(free, (0, 0.2), start, inputs={"rack_force": float(holding)})
    assert np.abs(still.y[:, -1] - start).max() < 1e-6
    moved = simulate(free, (0, 0.2), start, inputs={"rack_force": float(holding) + 20.0})
    assert moved.y[2, -1] > 1e-3
