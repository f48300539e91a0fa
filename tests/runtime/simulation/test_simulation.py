"""`simulate`: results, inputs, and errors with their time and place."""

import pickle
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

import numpy as np
import pytest
from kintrafo import (
    InputError,
    Model,
    Samples,
    SignalEvent,
    SimulationError,
    Suspension,
    equilibrium,
    simulate,
    state_at_height,
)
from kintrafo.simulation.solvers import native_available, native_methods
from oracle.reference import DYNAMICS, SPIN_RATE
from scipy.interpolate import CubicSpline

MODEL = Model("reference_car")
START = state_at_height(MODEL, 0.325, spin_rate=SPIN_RATE)
TIMES = np.linspace(0.0, 1.0, 60)
BACKENDS = ["scipy", *(["sundials"] if native_available() else [])]
needs_sundials = pytest.mark.skipif(not native_available(), reason="built without SUNDIALS")


def reference_states():
    times, rise, rise_rate, spin, spin_rate = DYNAMICS[:, :5].T
    arm = MODEL.design_state[0] - rise
    return times, np.array([arm, spin, -rise_rate, spin_rate])


@pytest.mark.parametrize(
    "method", [*dict.fromkeys([*native_methods(), "BDF", "Radau", "LSODA", "RK45", "DOP853"])]
)
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


def test_signals_are_computed_when_asked_for(monkeypatch):
    result = simulate(MODEL, (0, 0.1), START)
    calls = []
    original = Model.signals
    monkeypatch.setattr(Model, "signals", lambda *given: calls.append(given) or original(*given))
    assert tuple(result.signals) == MODEL.signal_names
    assert "camber" in repr(result)
    assert not calls
    assert result.signals["camber"].shape == result.signals["toe"].shape == result.t.shape
    assert len(calls) == 1
    assert np.array_equal(pickle.loads(pickle.dumps(result)).signals["toe"], result.signals["toe"])


def test_rack_velocity_and_acceleration_follow_from_a_spline():
    spline = CubicSpline(TIMES, 0.02 * np.sin(4.0 * TIMES))
    by_spline = simulate(MODEL, (0, 0.2), START, inputs={"rack_position": spline})
    samples = Samples(TIMES, spline(TIMES), "spline")
    by_samples = simulate(MODEL, (0, 0.2), START, inputs={"rack_position": samples})
    assert np.array_equal(by_spline.y, by_samples.y)
    column = MODEL.input_names.index("rack_velocity")
    assert by_spline.inputs[:, column] == pytest.approx(spline(by_spline.t, 1), abs=1e-15)


def test_dense_output_and_events_are_those_of_scipy():
    def at_design(_, y):
        return y[0] - MODEL.design_state[0]

    at_design.terminal = True
    result = simulate(MODEL, (0, 1), START, events=at_design, dense_output=True, rtol=1e-8)
    assert result.status == 1
    assert result.sol(result.t_events[0][0])[0] == pytest.approx(MODEL.design_state[0], abs=1e-9)


@pytest.mark.parametrize(
    "arguments",
    [
        {"method": "Gear"},
        {"y0": [1.0, 2.0]},
        {"t_span": (0.0, 0.0)},
        {"t_span": (0.0, np.inf)},
        {"t_span": (1.7e9, 1.7e9 + 1.0)},
        {"inputs": {"rod_height": 1.0}},
        {"inputs": {"road_height": np.nan}},
        {"inputs": {"rack_velocity": 1.0}},
        {"inputs": {"rack_position": ([0, 0.5, 0.5, 1], [0, 0, 0.01, 0.01])}},
        {"inputs": {"road_height": lambda t: 0.0 if t < 0.3 else 0.01}},
        {"inputs": {"road_height": lambda t: np.nan if t > 0.1 else 0.0}},
        {"rtol": 1e-18},
        {"rtol": np.nan},
        {"atol": [1e-9, 1e-9]},
        {"atol": -1.0},
        {"max_step": 0.0},
        {"t_eval": [0.0, 2.0]},
        {"t_eval": [0.5, 0.2]},
        {"events": "wheel_leave_ground"},
        {"events": [SignalEvent("tire_force", 0.0)]},
        {"events": [3]},
        {"method": "Radau", "backend": "sundials"},
        {"inputs": {"road_height": (TIMES, TIMES[:-1])}},
        {"inputs": {"road_height": (TIMES[::-1], TIMES)}},
        {"inputs": {"road_height": (TIMES / 2, TIMES)}},
        {"inputs": {"road_height": (TIMES, TIMES * np.nan)}},
    ],
)
def test_bad_arguments_are_refused(arguments, refused):
    given = {"t_span": (0.0, 1.0), "y0": START} | arguments
    refused(InputError, lambda: simulate(MODEL, **given))


@pytest.mark.parametrize("method", ["DormandPrince", "BDF", "DOP853"])
def test_time_may_begin_far_from_zero(method):
    """Ten days: times rounded by 1e-10 s in each of a thousand steps, at 93 rad/s: 1e-5 rad."""
    near, far = (
        simulate(MODEL, (start, start + 0.5), START, method=method).y[:, -1]
        for start in (0.0, 864000.0)
    )
    np.testing.assert_allclose(far, near, rtol=0.0, atol=1e-5)


def test_loop_that_cannot_close_says_when_where_and_which():
    with pytest.raises(SimulationError, match="tie_rod") as caught:
        simulate(MODEL, (0, 1), START, inputs={"strut_force": -1e6})
    assert 0.0 < caught.value.time < 0.1
    assert np.all(np.isfinite(caught.value.state))


@pytest.mark.parametrize("backend", BACKENDS)
def test_partial_result_stays_available(backend):
    with pytest.raises(SimulationError) as caught:
        simulate(MODEL, (0, 1), START, inputs={"strut_force": -1e6}, backend=backend)
    partial = caught.value.partial
    assert not partial.success
    assert partial.t[0] == 0.0
    assert partial.t[-1] <= caught.value.time
    assert partial.signals["wheel_center_z"][0] == pytest.approx(0.325, abs=1e-12)


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("method", ["BDF", "DormandPrince"])
def test_first_and_greatest_step(backend, method):
    options = {"method": method, "backend": backend, "first_step": 1e-8, "max_step": 2e-3}
    options |= {"rtol": 1e-6, "atol": 1e-9}
    steps = np.diff(simulate(MODEL, (0, 0.05), START, **options).t)
    # differences of times are rounded as these are: to 1e-17
    assert steps[0] == pytest.approx(1e-8, abs=1e-17)
    assert 1.5e-3 < steps.max() <= 2e-3 + 1e-17


@pytest.mark.parametrize("backend", BACKENDS)
def test_absolute_tolerances_one_by_one(backend):
    def steps(*tolerances):
        return simulate(MODEL, (0, 0.3), START, rtol=1e-13, atol=tolerances, backend=backend).steps

    alike = steps(1e-6, 1e-6, 1e-6, 1e-6)
    assert steps(1e-3, 1e-6, 1e-3, 1e-6) < 0.85 * alike  # the arm
    assert steps(1e-6, 1e-6, 1e-6, 1e-9) > 1.4 * alike  # the spin


@needs_sundials
def test_too_many_steps_is_an_error_with_a_remedy():
    with pytest.raises(SimulationError, match=r"more than 30 steps\. Raise max_steps") as caught:
        simulate(MODEL, (0, 1), START, max_steps=30)
    assert caught.value.partial.t.size == 31


def test_scipy_gives_up_too(refused):
    refused(SimulationError, lambda: simulate(MODEL, (0, 1), START, max_steps=5, backend="scipy"))


def test_rack_that_drives_over_the_dead_point_ends_soon():
    with pytest.raises(SimulationError, match="knuckle"):
        simulate(MODEL, (0, 1), START, inputs={"rack_position": np.sin})


def test_free_rack_moves_under_its_force():
    free = Model("reference_car", free_rack=True)
    start = equilibrium(free)
    holding = -free.evaluate("forces", start)[2]
    still = simulate(free, (0, 0.2), start, inputs={"rack_force": float(holding)})
    assert np.abs(still.y[:, -1] - start).max() < 1e-6
    moved = simulate(free, (0, 0.2), start, inputs={"rack_force": float(holding) + 20.0})
    assert moved.y[2, -1] > 1e-3


# -- the two backends, and what only SUNDIALS does ------------------------------------------------


@needs_sundials
def test_backends_agree():
    inputs = {
        "road_height": ([0.0, 0.4, 0.4, 1.0], [0.0, 0.0, 0.02, 0.02]),
        "strut_force": lambda t: 100.0 * np.sin(20.0 * t),
        "rack_position": lambda t: 0.01 * np.sin(5.0 * t),
    }
    results = [
        simulate(
            MODEL, (0, 1), START, inputs=inputs, backend=b, rtol=1e-9, atol=1e-12, t_eval=TIMES
        )
        for b in BACKENDS
    ]
    assert [r.solver.split()[0] for r in results] == ["SciPy", "SUNDIALS"]
    scale = np.array([0.07, 93.0, 4.0, 93.0])
    # each is good to some hundred times its tolerance
    assert np.abs((results[0].y - results[1].y) / scale[:, None]).max() < 1e-6
    assert np.array_equal(results[0].inputs, results[1].inputs)


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_jump_of_the_road_restarts_the_integration(backend):
    road = ([0.0, 0.2, 0.2, 1.0], [0.0, 0.0, 0.03, 0.03])
    result = simulate(
        MODEL, (0, 0.5), equilibrium(MODEL), inputs={"road_height": road}, backend=backend
    )
    before, after = result.t < 0.2, result.t > 0.2
    column = MODEL.input_names.index("road_height")
    assert np.all(result.inputs[before, column] == 0.0)
    assert np.all(result.inputs[after, column] == 0.03)
    # at rest until the jump, to the integration's own tolerance
    assert np.abs(result.signals["wheel_center_z"][before] - 0.3).max() < 1e-8
    assert np.ptp(result.signals["wheel_center_z"][after]) > 0.03
    assert 0.2 in result.t


@pytest.mark.parametrize("backend", BACKENDS)
def test_physical_events_by_name(backend):
    result = simulate(
        MODEL,
        (0, 1),
        START,
        events=["wheel_touches_ground", "wheel_leaves_ground"],
        dense_output=True,
        rtol=1e-9,
        atol=1e-12,
        backend=backend,
    )
    (touch,), leave = result.t_events
    assert leave.size == 0  # released above the free height, it lands once
    # where the event is, is good to rounding: of 1e-16 s at 1e6 N/s
    assert MODEL.signal("tyre_force", result.sol(touch)) == pytest.approx(1e-3, abs=1e-6)
    assert result.y_events[0].shape == (1, 4)


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize(("side", "arm_rate"), [("bump", -12.0), ("rebound", 30.0)])
def test_strut_reaches_a_stop(backend, side, arm_rate):
    model = Model("offset_strut_car")
    start = equilibrium(model)
    start[2] = arm_rate  # a blow
    event = f"strut_reaches_{side}_stop"
    result = simulate(model, (0, 0.05), start, events=event, rtol=1e-9, atol=1e-12, backend=backend)
    (state,) = result.y_events[0]  # on the way into the stop, and not out of it
    # where the event is, is good to rounding
    touched = model.parameters[f"{side}_stop_length"]
    assert model.signal("strut_length", state) == pytest.approx(touched, abs=1e-12)
    assert (model.signal("strut_velocity", state) > 0.0) == (side == "rebound")
    force, before = result.signals[f"{side}_stop_force"], result.t < result.t_events[0][0]
    assert np.all(force[before] == 0.0)
    assert np.abs(force).max() > 100.0


def test_a_stop_that_there_is_not(refused):
    refused(InputError, lambda: simulate(MODEL, (0, 1), START, events="strut_reaches_bump_stop"))
    soft = Model(Suspension.load("offset_strut_car").with_changes({"bump_stop": None}))
    refused(
        InputError,
        lambda: simulate(soft, (0, 1), soft.design_state, events="strut_reaches_bump_stop"),
    )


@pytest.mark.parametrize("backend", BACKENDS)
def test_terminal_signal_event_ends_at_its_crossing(backend):
    third = SignalEvent("wheel_center_z", 0.3, terminal=3)
    result = simulate(MODEL, (0, 1), START, events=third, backend=backend, rtol=1e-9, atol=1e-12)
    assert result.status == 1
    assert len(result.t_events[0]) == 3
    assert result.signals["wheel_center_z"][-1] == pytest.approx(0.3, abs=1e-7)


@pytest.mark.parametrize("backend", BACKENDS)
def test_error_in_a_users_event_is_passed_on(backend):
    def broken(_, y):
        raise ZeroDivisionError(y)

    with pytest.raises(ZeroDivisionError):
        simulate(MODEL, (0, 1), START, events=broken, backend=backend)


@pytest.mark.parametrize("method", ["BDF", "Adams", "DormandPrince", "DOP853"])
def test_dense_output_is_as_good_as_the_steps(method):
    if method == "Adams" and not native_available():
        pytest.skip("built without SUNDIALS")
    options = {"method": method, "rtol": 1e-8, "atol": 1e-11}
    dense = simulate(MODEL, (0, 1), START, dense_output=True, **options)
    reference = simulate(
        MODEL, (0, 1), START, method="DOP853", t_eval=TIMES, rtol=1e-12, atol=1e-14
    )
    assert np.abs(dense.sol(TIMES) - reference.y)[0].max() < 2e-6
    assert dense.sol(dense.t[5]) == pytest.approx(dense.y[:, 5], abs=1e-12)


@needs_sundials
def test_stopping_at_outputs_takes_a_step_for_each():
    times = np.linspace(0.0, 0.1, 1001)
    options = {"method": "Verner", "t_eval": times}
    stopping = simulate(MODEL, (0, 0.1), START, stop_at_outputs=True, **options)
    assert stopping.steps >= 1000
    assert stopping.nfev >= 8 * 1000  # eight stages
    gear = simulate(MODEL, (0, 0.1), START, t_eval=times)
    assert gear.nfev < stopping.nfev / 20
    assert np.abs(gear.y - stopping.y)[0].max() < 1e-5


@needs_sundials
@pytest.mark.parametrize(
    ("method", "steps", "evaluations", "band"),
    # A wrong Jacobian still converges, only slower. The bands are a little wider than what changing
    # the spring rate by parts in 1e13 makes of the counts. Other versions of SUNDIALS choose other
    # steps: 7.5 a third more or fewer.
    [
        ("BDF", 219, 309, 0.08),
        ("DormandPrince", 94, 583, 0.04),
        ("Verner", 96, 907, 0.06),
        ("Adams", 126, 203, 0.2),
    ],
)
def test_effort_of_the_standard_run(method, steps, evaluations, band):
    result = simulate(MODEL, (0, 0.3), START, method=method, rtol=1e-6, atol=1e-9)
    known = result.solver == "kintrafo" or result.solver.startswith("SUNDIALS 6.")
    band = band if known else 0.4
    assert result.steps == pytest.approx(steps, rel=band)
    assert result.nfev == pytest.approx(evaluations, rel=band)


@needs_sundials
@pytest.mark.parametrize("method", native_methods())
def test_threads_give_the_same_bits(method):
    inputs = {"rack_position": lambda t: 0.01 * np.sin(5.0 * t)}

    def run(_):
        return simulate(MODEL, (0, 1), START, method=method, inputs=inputs)

    with ThreadPoolExecutor(4) as pool:
        first, *others = pool.map(run, range(8))
    for other in others:
        assert np.array_equal(other.y, first.y)
        assert other.signals["toe"].tobytes() == first.signals["toe"].tobytes()


@needs_sundials
def test_threads_integrate_at_the_same_time():
    """Each integration waits in an event's function until the other one has come there too."""
    meeting = Barrier(2, timeout=60.0)

    def run(_):
        met = []

        def event(_time, y):
            if not met:
                met.append(meeting.wait())
            return y[0] - 10.0

        return simulate(MODEL, (0, 0.1), START, events=event)

    with ThreadPoolExecutor(2) as pool:
        one, other = pool.map(run, range(2))
    assert np.array_equal(one.y, other.y)


@needs_sundials
@pytest.mark.parametrize(
    ("method", "order"), [("BDF", 5), ("Adams", 12), ("DormandPrince", 5), ("Verner", 6)]
)
def test_statistics_are_complete(method, order):
    result = simulate(MODEL, (0, 0.3), START, method=method, dense_output=True)
    implicit = method in ("BDF", "Adams")
    assert result.steps == result.t.size - 1
    assert result.nfev > result.steps
    assert 0 < result.error_test_failures < result.steps
    assert (result.njev > 0, result.nlu > 0) == (implicit, implicit)
    # a multistep method changes its order, and does not stay at the first
    assert 1 < result.order <= order if implicit else result.order == order


def test_steps_are_counted_without_sundials_too():
    result = simulate(MODEL, (0, 0.3), START, backend="scipy", events="wheel_touches_ground")
    assert result.steps == result.t.size - 1


def test_an_explanation_where_the_steps_become_too_small():
    with pytest.raises(SimulationError, match=r"(too small|cannot|overflows).*(Loosen|Try)"):
        simulate(MODEL, (0, 1), START, inputs={"strut_force": 1e300})


def test_steps_that_gain_nothing_end():
    """1e100 N: steps of 1e-50 s, for ever, where a clock at zero can still distinguish them."""
    with pytest.raises(SimulationError, match="too small"):
        simulate(MODEL, (0, 1), START, inputs={"strut_force": 1e100}, method="RK45")


@pytest.mark.parametrize("backend", BACKENDS)
def test_backward_in_time(backend):
    there = simulate(MODEL, (0, 0.05), START, rtol=1e-10, atol=1e-12, backend=backend)
    back = simulate(MODEL, (0.05, 0.0), there.y[:, -1], rtol=1e-10, atol=1e-12, backend=backend)
    assert back.y[:, -1] == pytest.approx(START, abs=1e-6)


def test_without_sundials_the_user_is_warned_once(monkeypatch):
    from kintrafo.simulation import simulate as simulation
    from kintrafo.simulation import solvers

    monkeypatch.setattr(solvers, "sundials", None)
    simulation._warn_once.cache_clear()
    with pytest.warns(RuntimeWarning, match="built without SUNDIALS") as warned:  # noqa: PT031
        first = simulate(MODEL, (0, 0.1), START)
        second = simulate(MODEL, (0, 0.1), START)
    assert len(warned) == 1
    assert first.solver == second.solver == "SciPy"
    with pytest.raises(InputError, match="needs SUNDIALS"):
        simulate(MODEL, (0, 0.1), START, method="Adams")
