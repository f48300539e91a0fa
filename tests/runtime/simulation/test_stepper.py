"""Simulations that are advanced step by step: against `simulate`, and what they refuse."""

import runpy
import tracemalloc

import kintrafo
import numpy as np
import pytest
from kintrafo.generated import four_bar
from kintrafo.simulation.solvers import native_available
from scipy.interpolate import PPoly
from support.folders import ROOT

pytestmark = pytest.mark.skipif(not native_available(), reason="no compiled solver")

MODEL = kintrafo.Model("reference_car")
STEP = 1e-3
EXAMPLE = ROOT / "examples/active_damping.py"


def place(name):
    return MODEL.input_names.index(name)


def test_steps_have_the_bits_of_simulate():
    start = kintrafo.state_at_height(MODEL, 0.325, spin_rate=93.0)
    stepper = kintrafo.Stepper(MODEL, STEP, start)
    states = [stepper.step().copy() for _ in range(200)]
    # the rack may move in a stepper, so here too: equations for one that is held round otherwise
    still = {"rack_position": ([0.0, 0.2], [0.0, 0.0])}
    whole = kintrafo.simulate(MODEL, (0.0, 0.2), start, inputs=still, method="RK4", step=STEP)
    np.testing.assert_array_equal(states, whole.y[:, 1:].T)
    assert stepper.time == pytest.approx(0.2, abs=1e-15)
    stepper.reset(start)
    np.testing.assert_array_equal(stepper.step(), states[0])


def test_inputs_that_change_are_jumps_at_the_steps():
    rest = kintrafo.equilibrium(MODEL)
    stepper = kintrafo.Stepper(MODEL, STEP, rest)
    times, forces = [], []
    for count in range(50):
        stepper.inputs[place("strut_force")] = 100.0 * np.sin(count)
        times += [count * STEP, (count + 1) * STEP]
        forces += [100.0 * np.sin(count)] * 2
        stepper.step()
    whole = kintrafo.simulate(
        MODEL, (0.0, 50 * STEP), rest, method="RK4", step=STEP,
        inputs={"strut_force": (times, forces)},
    )  # fmt: skip
    # ends of steps are counted from each jump there: rounding of times
    np.testing.assert_allclose(stepper.state, whole.y[:, -1], rtol=0.0, atol=1e-13)


def test_an_input_goes_on_by_its_rate():
    """The rack accelerates: its place and velocity follow, and the motion is that of the curve."""
    rest = kintrafo.equilibrium(MODEL)
    stepper = kintrafo.Stepper(
        MODEL, STEP, rest, inputs={"rack_velocity": 0.05, "rack_acceleration": 0.1}
    )
    for _ in range(100):
        stepper.step()
    expected = {"rack_position": 0.05 * 0.1 + 0.05 * 0.01, "rack_velocity": 0.06}
    for name, value in expected.items():
        assert stepper.inputs[place(name)] == pytest.approx(value, rel=1e-13)
    curve = PPoly(np.array([[0.05], [0.05], [0.0]]), [0.0, 0.1])
    whole = kintrafo.simulate(
        MODEL, (0.0, 0.1), rest, method="RK4", step=STEP, inputs={"rack_position": curve}
    )
    np.testing.assert_allclose(stepper.state, whole.y[:, -1], rtol=0.0, atol=1e-13)


def test_tolerances_within_a_step():
    start = kintrafo.state_at_height(MODEL, 0.325)
    stepper = kintrafo.Stepper(MODEL, 0.02, start, method="DormandPrince", rtol=1e-9, atol=1e-12)
    for _ in range(25):
        stepper.step()
    truth = kintrafo.simulate(MODEL, (0.0, 0.5), start, method="DOP853", rtol=1e-12, atol=1e-14)
    np.testing.assert_allclose(stepper.state, truth.y[:, -1], rtol=0.0, atol=1e-7)
    signals = stepper.signals()
    assert signals["wheel_center_z"] == pytest.approx(truth.signals["wheel_center_z"][-1], abs=1e-8)


def test_no_step_allocates_memory_in_python():
    stepper = kintrafo.Stepper(MODEL, STEP, kintrafo.equilibrium(MODEL))
    stepper.step()
    tracemalloc.start()
    try:
        before = tracemalloc.get_traced_memory()[0]
        for _ in range(100):
            stepper.step()
        # a counter and a time, which take the place of those before
        assert tracemalloc.get_traced_memory()[0] - before < 200
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize(
    ("changed", "error"),
    [
        ({"strut_force": np.nan}, kintrafo.InputError),
        ({"strut_force": -2e5}, kintrafo.SimulationError),
    ],
)
def test_a_step_that_cannot_be_taken_changes_nothing(changed, error, refused):
    stepper = kintrafo.Stepper(MODEL, STEP, kintrafo.equilibrium(MODEL))
    for name, value in changed.items():
        stepper.inputs[place(name)] = value
    states = [stepper.state.copy()]
    refused(error, lambda: states.extend(stepper.step().copy() for _ in range(300)))
    np.testing.assert_array_equal(stepper.state, states[-1])
    assert stepper.time == (len(states) - 1) * STEP


def test_a_step_that_is_not_stable_names_one_that_is():
    stepper = kintrafo.Stepper(MODEL, 0.1, kintrafo.equilibrium(MODEL))
    with pytest.raises(kintrafo.SimulationError, match=r"not stable: .* steps of 0\.0"):
        stepper.step()


@pytest.mark.parametrize(
    "arguments",
    [
        {"step": 0.0},
        {"step": np.nan},
        {"step": STEP, "rtol": 1e-6},
        {"step": STEP, "method": "BDF"},
        {"step": STEP, "y0": [0.0, 1.0]},
        {"step": STEP, "y0": np.zeros((2, 4))},
        {"step": STEP, "inputs": {"strut_froce": 1.0}},
        {"step": STEP, "inputs": {"strut_force": np.inf}},
        {"step": STEP, "inputs": [1.0]},
        {"step": STEP, "t0": np.inf},
    ],
)
def test_what_cannot_be_stepped_is_refused(arguments, refused):
    refused(kintrafo.InputError, lambda: kintrafo.Stepper(MODEL, **arguments))


def test_what_is_assigned_is_copied():
    """A controller that assigns its inputs is obeyed, as one that writes into the array."""
    rest = kintrafo.equilibrium(MODEL)
    written, assigned, handed = (kintrafo.Stepper(MODEL, STEP, rest) for _ in range(3))
    inputs = np.zeros(len(MODEL.input_names))
    inputs[place("road_height")] = 0.01
    arrays = assigned.inputs, assigned.state
    assigned.inputs = inputs.tolist()
    written.inputs[:] = inputs
    handed.step(inputs)
    for stepper in (written, assigned):
        stepper.step()
    np.testing.assert_array_equal(assigned.state, written.state)
    np.testing.assert_array_equal(handed.state, written.state)
    assert not np.array_equal(written.state, rest)
    assigned.state = rest
    np.testing.assert_array_equal(arrays[1], rest)
    assert arrays[0] is assigned.inputs
    with pytest.raises(AttributeError):
        assigned.length = 0.5


def test_inputs_of_a_step_are_as_many_as_the_model_has(refused):
    """One number would be the place of the rack, and every other input."""
    stepper = kintrafo.Stepper(MODEL, STEP, kintrafo.equilibrium(MODEL))
    before = stepper.inputs.copy()
    wrong = np.zeros(4), np.zeros((1, 5))
    for inputs in (0.01, [0.01], *wrong, {"road_height": 0.01}, "road_height", [1j] * 5):
        with refused(kintrafo.InputError):
            stepper.step(inputs)
        with refused(kintrafo.InputError):
            stepper.inputs = inputs
    np.testing.assert_array_equal(stepper.inputs, before)
    assert stepper.time == 0.0


def test_any_mechanism_is_stepped():
    system = kintrafo.System(four_bar)
    start = system.state(crank_angle_rate=5.0)
    stepper = kintrafo.Stepper(system, STEP, start)
    for _ in range(100):
        stepper.step()
    whole = kintrafo.simulate(system, (0.0, 0.1), start, method="RK4", step=STEP)
    np.testing.assert_array_equal(stepper.state, whole.y[:, -1])


@pytest.mark.filterwarnings("ignore:.*WARN")  # no bounds, and nothing to render
def test_the_learning_environment_keeps_the_rules_of_gymnasium():
    checker = pytest.importorskip("gymnasium.utils.env_checker")
    module = runpy.run_path(str(EXAMPLE))
    environment = module["ActiveDamping"]()
    checker.check_env(environment)
    rewards = []
    for gain in (0.0, 0.5):
        observation, _ = environment.reset(seed=1)
        rewards.append(0.0)
        for _ in range(200):
            action = np.array([gain * observation[1]], np.float32)
            observation, reward, _, _, _ = environment.step(action)
            rewards[-1] += reward
    assert rewards[1] > rewards[0], "a damper keeps the wheel on the road"
