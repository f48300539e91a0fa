"""Ends of simulations and their messages: interrupts, too many steps, impossible paths."""

import os
import pickle
import re
import signal
import threading
from concurrent.futures import ThreadPoolExecutor
from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest
from kintrafo import InputError, Model, SimulationError, System, simulate, state_at_height
from kintrafo.generated import front_axle, slider_crank
from kintrafo.simulation import solvers
from kintrafo.simulation.solvers import native_available, native_methods
from kintrafo.simulation.validity import bounds_of
from kintrafo.vehicle.cli import app
from typer.testing import CliRunner

needs_sundials = pytest.mark.skipif(not native_available(), reason="built without SUNDIALS")
CRANK = System(slider_crank)
simulation = import_module("kintrafo.simulation.simulate")
TURNING = CRANK.state(crank_angle_rate=30.0)
METHODS = tuple(dict.fromkeys([*native_methods(), "Radau", "LSODA", "RK45", "DOP853"]))


def endless():
    """Integrate for more steps than any machine takes in a minute."""
    simulate(CRANK, (0.0, 1e9), TURNING, t_eval=[1e9], max_step=1e-3, max_steps=10**10)


@needs_sundials
@pytest.mark.skipif(os.name == "nt", reason="signals are sent to processes")
@pytest.mark.usefixtures("interruptible")
@pytest.mark.parametrize("elsewhere", [False, True], ids=["here", "with a run in a thread"])
def test_an_interrupt_is_seen_at_once(elsewhere):
    stop = threading.Event()

    def other():
        while not stop.is_set():
            simulate(CRANK, (0.0, 5.0), TURNING)

    with ThreadPoolExecutor(1) as pool:
        if elsewhere:
            pool.submit(other)
        timer = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        try:
            with pytest.raises(KeyboardInterrupt):
                endless()
        finally:
            stop.set()


@pytest.mark.parametrize("method", ["BDF", "DOP853"])
def test_a_dense_result_can_be_pickled(method):
    result = simulate(CRANK, (0.0, 0.1), TURNING, method=method, dense_output=True)
    again = pickle.loads(pickle.dumps(result))
    times = np.linspace(0.0, 0.1, 7)
    assert np.array_equal(again.sol(times), result.sol(times))


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("end", [0.1, -0.1], ids=["forwards", "backwards"])
def test_a_dense_result_ends_where_the_motion_does(method, end):
    options = {"step": 1e-4} if method == "RK4" else {}
    sol = simulate(CRANK, (0.0, end), TURNING, method=method, dense_output=True, **options).sol
    assert (sol.t_min, sol.t_max) == (min(0.0, end), max(0.0, end))
    assert sol([]).shape == (TURNING.size, 0)
    assert np.isfinite(sol([0.0, end, np.nextafter(end, 10 * end)])).all()
    for beyond in (-0.01 * end, 1.01 * end, [0.0, 1e9], np.nan):
        with pytest.raises(InputError, match=r"from -?0.*s to|numbers|a finite number is needed"):
            sol(beyond)


def test_of_a_motion_that_ends_early_only_that_is_known(refused):
    with pytest.raises(SimulationError) as caught:
        simulate(CRANK, (0.0, 1.0), TURNING, dense_output=True, max_steps=20)
    sol, reached = caught.value.partial.sol, caught.value.time
    assert sol.t_max == reached
    refused(InputError, lambda: sol(1.0))


def test_a_broken_native_module_is_not_called_missing(monkeypatch):
    def broken(name):
        raise ImportError(f"{name}: file too short")

    monkeypatch.setattr(solvers, "import_module", broken)
    module, why = solvers._load_native()
    assert module is None
    assert "cannot be loaded" in why
    assert "file too short" in why
    assert "without" not in why

    def missing(name):
        raise ModuleNotFoundError(name)

    monkeypatch.setattr(solvers, "import_module", missing)
    assert "built without SUNDIALS" in solvers._load_native()[1]


@pytest.mark.parametrize("stop", [False, True])
@pytest.mark.parametrize("method", [*solvers.NATIVE_METHODS, "Radau", "RK45"])
@pytest.mark.parametrize("backend", ["auto", "sundials", "scipy"])
@pytest.mark.parametrize("compiled", [True, False], ids=["compiled", "arrays"])
@pytest.mark.parametrize("moves", [True, False], ids=["moves", "prescribed"])
@pytest.mark.parametrize("release", ["7.5.0", "6.4.1", "none"])
def test_who_follows_the_advice_is_not_refused(
    monkeypatch, release, moves, compiled, backend, method, stop
):
    """The method and backend that a message advises are available in every build."""
    linked = None if release == "none" else SimpleNamespace(version=lambda: release)
    monkeypatch.setattr(solvers, "sundials", linked)
    monkeypatch.setattr(simulation, "_warn_once", lambda: None)
    model = SimpleNamespace(
        equations=SimpleNamespace(ADDRESSES={"rhs": 1} if compiled else {}),
        state_names=("q",) if moves else (),
    )

    def choose(backend, method, stop):
        options = SimpleNamespace(method=method, stop_at_outputs=stop)
        return simulation._choose_backend(model, backend, options)

    try:
        choose(backend, method, stop)
    except InputError as error:
        (message,) = error.problems
        others = dict(re.findall(r"(method|backend) '(\w+)'", advice(message)))
        out = re.findall(r"leave out (.*):", advice(message).lower())
        left = out[0].split(" and ") if out else []
        other = others.get("method", method)
        found = choose(
            others.get("backend", backend), other, stop and "stop_at_outputs" not in left
        )
        in_c = found is simulation.solve_native
        may_be = compiled and moves and linked is not None
        assert in_c == ("are then integrated in C" in message) == may_be
        assert other == "RK4" or method != "RK4" or "step" in left


def advice(message):
    """Return the last sentence."""
    return re.search(r"[.] ([^.]*)[.]$", message)[1]


def run(*arguments):
    return CliRunner().invoke(app, ["simulate", "reference_car", *arguments])


def test_the_command_line_names_its_own_options():
    ended = run("--height", "325", "--max-steps", "20")
    text = " ".join(str(ended.exception or ended.output).split())
    assert ended.exit_code != 0
    assert "Raise --max-steps" in text
    assert "--rtol" in text
    assert run("--height", "305", "--max-step", "5", "--duration", "0.1").exit_code == 0


def test_a_motion_that_no_car_can_go_is_reported():
    """A tyre that pulls and a strut that comes apart: exit code 1, with times and amounts."""
    ended = run("--road-sine", "200", "--road-frequency", "6", "--duration", "0.3")
    assert ended.exit_code == 1
    text = " ".join(ended.output.split()) + " ".join(ended.stderr.split())
    assert "the tyre pulls at the road" in text
    assert "the strut is longer than it can be" in text
    assert "850 mm" in text
    assert run("--road-step", "20", "--duration", "0.3").exit_code == 0


def test_excursions_are_in_the_result():
    model = Model("reference_car")
    start = state_at_height(model, 0.325)
    quiet = simulate(model, (0.0, 0.05), start, inputs={"road_height": 0.02})
    assert quiet.validity == ()
    times = np.linspace(0.0, 0.1, 101)
    low = simulate(model, (0.0, 0.1), start, inputs={"road_height": -0.2}, t_eval=times)
    pulls = next(found for found in low.validity if found.bound.signal == "tyre_force")
    force = low.signals["tyre_force"]
    assert pulls.worst == force.min() < -1000.0
    assert pulls.time == times[force.argmin()]
    assert pulls.spans[0][0] == times[np.flatnonzero(force < 0.0)[0]]
    assert "N at" in str(pulls)


def test_bounds_are_those_of_the_data():
    bounds = {(b.signal, b.above): b for b in bounds_of(Model("offset_strut_car"))}
    assert bounds["strut_velocity", False].possible
    assert bounds["strut_velocity", True].limit > 0.0
    assert not bounds["strut_length", True].possible


def test_either_side_of_an_axle_has_its_bounds_and_events():
    axle = System(front_axle)
    sides = ("right_", "left_")
    assert set(axle.event_names) == {
        f"{side}{event}"
        for side in sides
        for event in (
            "strut_fully_extended",
            "front_wheel_leaves_ground",
            "front_wheel_touches_ground",
        )
    }
    bounds = {(b.signal, b.above): b for b in bounds_of(axle)}
    for side in sides:
        longest = bounds[f"{side}strut_length", True]
        assert longest.limit == axle.parameters["strut_length_max"]
        assert longest.words == f"the {side.rstrip('_')} strut is longer than it can be"
        assert bounds[f"{side}strut_length", False].limit == 0.0
        assert bounds[f"{side}front_tyre_force", False].limit < 0.0


@needs_sundials
def test_defaults_of_the_methods():
    """BDF has tighter ones, since it damps by its error; a long run names a better method."""
    model = Model("reference_car")
    start = state_at_height(model, 0.325)
    by_default = simulate(model, (0.0, 0.1), start)
    assert np.array_equal(by_default.y, simulate(model, (0.0, 0.1), start, rtol=1e-8, atol=1e-10).y)
    by_default = simulate(model, (0.0, 0.1), start, method="Verner")
    same = simulate(model, (0.0, 0.1), start, method="Verner", rtol=1e-6, atol=1e-9)
    assert np.array_equal(by_default.y, same.y)
    long = simulate(CRANK, (0.0, 250.0), TURNING, t_eval=[250.0], max_step=1e-3)
    assert "Verner" in long.message


@pytest.mark.parametrize("method", [*native_methods(), "RK45", "LSODA"])
def test_an_error_reports_the_last_step_and_not_the_last_output(method):
    """For any number of outputs."""
    with pytest.raises(SimulationError) as error:
        simulate(CRANK, (0.0, 1.0), TURNING, method=method, t_eval=[0.0, 1.0], max_steps=30)
    assert 0.0 < error.value.time < 1.0
    assert error.value.state != pytest.approx(TURNING, abs=1e-3)


@pytest.mark.parametrize("method", [*native_methods()[:2], "RK45"])
@pytest.mark.parametrize("given", [np.nan, np.inf, None, "x", 1j, np.ones(2)], ids=str)
def test_an_event_without_a_number_ends_the_motion(method, given, refused):
    """A solver takes NaN for "no crossing", and calls it a success."""

    def height(time, _state):
        return given if time > 0.01 else 1.0

    refused(InputError, lambda: simulate(CRANK, (0.0, 0.1), TURNING, method=method, events=height))


def test_what_an_event_says_of_itself_is_checked(refused):
    def height(*_):
        return 1.0

    height.direction, height.terminal = "up", -1
    refused(InputError, lambda: simulate(CRANK, (0.0, 0.1), TURNING, events=height))


@needs_sundials
def test_first_steps_of_a_motion_followed_backwards():
    forward = simulate(CRANK, (0.0, 0.1), TURNING, first_step=1e-4)
    back = simulate(CRANK, (0.1, 0.0), forward.y[:, -1], first_step=1e-4)
    # errors of some hundred steps at rtol 1e-8
    assert back.y[:, -1] == pytest.approx(TURNING, abs=1e-4)
