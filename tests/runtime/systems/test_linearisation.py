"""Linearisation: against the oracle and SciPy."""

import re

import numpy as np
import pytest
import scipy.signal
from cars.instants import MODELS, Instant
from kintrafo import InputError, Model, Suspension, equilibrium, linearise, state_at_height
from kintrafo.systems.modes import eigenvalues_of, mode_of_states, modes_of, modes_of_motions
from oracle.multipliers import solve_free, solve_prescribed
from oracle.newton import Mechanism, solve_pose
from oracle.reference import EIGENVALUES_AT_REST, SPIN_RATE, reference_parameters
from support.folders import ROOT

CAR = Suspension.load("reference_car")
HELD = Model(CAR)
FREE = Model(CAR, free_rack=True)
REST = equilibrium(HELD, spin_rate=SPIN_RATE)


def accelerations_of_the_oracle(free, coordinates, rates):
    """Return the accelerations in maximal coordinates; order: arm, spin, rack."""
    car = Mechanism(reference_parameters())
    arm, spin, rack = coordinates
    pose = solve_pose(car, arm, rack, spin)
    solve = solve_free if free else solve_prescribed
    found = solve(car, pose, rates[0], rates[1], rates[2])
    return np.array([found.beta1_acceleration, found.spin_acceleration, found.rack_acceleration])


@pytest.mark.parametrize("model", [HELD, FREE], ids=["held", "free"])
def test_state_matrix_is_that_of_the_oracle(model):
    """Accelerations differentiated numerically in a model that shares no code with ours."""
    size = 3 if model.free_rack else 2
    state = equilibrium(model, spin_rate=SPIN_RATE)
    point, rates = np.zeros(3), np.zeros(3)
    point[:size], rates[:size] = state[:size], state[size:]
    linear = linearise(model, state)
    for column in range(2 * size):
        step = np.zeros(6)
        step[column if column < size else 3 + column - size] = 1e-4

        def at(factor, step=step):
            moved = point + factor * step[:3], rates + factor * step[3:]
            return accelerations_of_the_oracle(model.free_rack, *moved)[:size]

        # five-point formula: error of the order of step**4
        expected = (8.0 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12.0 * 1e-4)
        # elements of up to 6e3; the oracle's accelerations are rounded to 1e-10 over a step of 1e-4
        assert linear.A[size:, column] == pytest.approx(expected, rel=1e-7, abs=2e-5)
    assert linear.A[:size] == pytest.approx(np.eye(size, 2 * size, k=size), rel=0.0, abs=0.0)


def test_wheel_hop_of_the_reference_car():
    linear = linearise(HELD, REST)
    hop = linear.mode_of("beta1")
    # eight decimals are stored
    assert hop.eigenvalues == pytest.approx(EIGENVALUES_AT_REST, abs=1e-8)
    assert linear.eigenvalues[0] == pytest.approx(EIGENVALUES_AT_REST[0], abs=1e-8)
    size = abs(hop.eigenvalues[0])
    assert hop.natural_frequency == pytest.approx(size / (2 * np.pi), rel=1e-15)
    assert hop.damping_ratio == pytest.approx(-hop.eigenvalues[0].real / size, rel=1e-15)
    assert hop.oscillates
    assert "12.35 Hz, damping ratio 0.233" in hop.text


def test_the_other_modes_are_the_zeros_of_the_spin():
    modes = linearise(HELD, REST).modes
    assert [len(mode.eigenvalues) for mode in modes] == [2, 1, 1]
    for mode in modes[1:]:
        assert mode.eigenvalues == (0.0,)
        assert np.isnan(mode.damping_ratio)
        assert np.abs(mode.shape[[0, 2]]).max() == 0.0


@pytest.mark.parametrize("model", [HELD, FREE], ids=["held", "free"])
def test_mode_shapes_are_eigenvectors(model):
    linear = linearise(model, equilibrium(model, spin_rate=SPIN_RATE))
    modes = [*linear.modes, linear.mode_of("beta1")]
    assert sum(len(mode.eigenvalues) for mode in modes[:-1]) == len(linear.A)
    for mode in modes:
        residual = linear.A @ mode.shape - mode.eigenvalues[0] * mode.shape
        # elements of A are up to 6e3 and known to 1e-12
        assert np.abs(residual).max() < 1e-8
        assert np.abs(mode.shape).max() == pytest.approx(1.0, rel=1e-15)


def test_wheel_hop_with_a_free_rack_is_not_the_steering_mode():
    linear = linearise(FREE, equilibrium(FREE, spin_rate=SPIN_RATE))
    hop = linear.mode_of("beta1")
    # gyroscopic coupling and the rack's mass change it by less than 1 %
    assert hop.natural_frequency == pytest.approx(12.35, rel=0.01)
    steering = [mode for mode in linear.modes if mode.oscillates and mode.natural_frequency < 5.0]
    assert len(steering) == 1
    names = linear.state_names
    rack, arm = (abs(steering[0].shape[names.index(n)]) for n in ("beta9_rate", "beta1_rate"))
    # a rack that moves by 1 m/s turns the arm by less than 1 rad/s in that mode
    assert rack > arm


def test_wheel_hop_is_found_among_overdamped_modes():
    stiff = Model(CAR.with_changes({"strut.damper_rate_N_s_per_m": 20e3}))
    linear = linearise(stiff, equilibrium(stiff))
    hop = linear.mode_of("beta1")
    assert not hop.oscillates
    assert sorted(v.real for v in hop.eigenvalues) == sorted(np.linalg.eigvals(linear.A).real)[:2]
    assert hop.damping_ratio > 1.0
    assert "overdamped" in hop.text


def test_mode_of_states_does_not_depend_on_units():
    linear = linearise(FREE, equilibrium(FREE, spin_rate=SPIN_RATE))
    units = np.diag([1e3, 1.0, 1e-3, 1e3, 1.0, 1e-3])  # mrad, rad, km
    scaled = units @ linear.A @ np.linalg.inv(units)
    found = mode_of_states(scaled, linear.state_names, (0, 3))
    assert found.eigenvalues == pytest.approx(linear.mode_of("beta1").eigenvalues, rel=1e-9)


def test_frequency_response_is_scipys():
    linear = linearise(HELD, equilibrium(HELD))
    frequencies = np.array([0.1, 1.0, 12.0, 80.0])
    # SciPy takes transfer functions that do not vanish at high frequency
    for source, name in (("road_height", "tyre_force"), ("strut_force", "wheel_acceleration")):
        found = linear.frequency_response(frequencies, source)
        column, row = linear.input_names.index(source), linear.output_names.index(name)
        system = scipy.signal.StateSpace(
            linear.A, linear.B[:, [column]], linear.C[[row]], linear.D[[row]][:, [column]]
        )
        _, expected = scipy.signal.freqresp(system, 2 * np.pi * frequencies)
        # SciPy goes through the coefficients of polynomials
        assert found[name] == pytest.approx(expected, rel=1e-7), name
    space = linear.state_space()
    for name in "ABCD":
        assert np.array_equal(getattr(space, name), getattr(linear, name))


def test_rack_moves_with_its_velocity_and_acceleration():
    """At low frequency the wheel follows the rack as the positions do."""
    linear = linearise(HELD, equilibrium(HELD), outputs=["steer"])
    slow = linear.frequency_response(1e-3, "rack_position")["steer"]
    step = 1e-4
    ends = [
        HELD.signal("steer", equilibrium(HELD, rack_position=r), HELD.inputs({"rack_position": r}))
        for r in (step, -step)
    ]
    # central difference: error of the order of step**2
    assert slow.real == pytest.approx((ends[0] - ends[1]) / (2 * step), rel=1e-5)
    fast = linear.frequency_response(10.0, "rack_position")["steer"]
    alone = linear.state_space()
    s = 2j * np.pi * 10.0
    resolvent = np.linalg.inv(s * np.eye(4) - alone.A)
    names = linear.input_names
    columns = [names.index(f"rack_{rate}") for rate in ("position", "velocity", "acceleration")]
    moving = np.array([1.0, s, s * s])
    expected = alone.C @ resolvent @ alone.B[:, columns] @ moving + alone.D[:, columns] @ moving
    assert fast == pytest.approx(expected[0], rel=1e-12)


def test_a_state_that_is_no_equilibrium_is_said_to_be_none():
    state = state_at_height(HELD, 0.325)
    linear = linearise(HELD, state)
    assert not linear.steady
    assert linear.rate == pytest.approx(HELD.evaluate("rhs", state), rel=0.0, abs=0.0)
    assert linearise(HELD, REST).steady
    assert linearise(HELD, REST).rate[1] == SPIN_RATE
    # released, the rack would move
    assert not linearise(FREE, equilibrium(FREE)).steady


def test_names_units_and_shapes():
    linear = linearise(HELD, REST, outputs=["camber", "tyre_force"])
    assert linear.output_names == ("camber", "tyre_force")
    assert linear.output_units == ("rad", "N")
    assert linear.state_units == ("rad", "rad", "rad/s", "rad/s")
    assert len(linear.input_units) == len(linear.input_names)
    assert linear.B.shape == (4, len(linear.input_names))
    assert linear.C.shape == (2, 4)
    assert linear.D.shape == (2, len(linear.input_names))
    everything = linearise(HELD, REST)
    rows = [everything.output_names.index(name) for name in linear.output_names]
    assert np.array_equal(everything.C[rows], linear.C)
    assert np.array_equal(everything.outputs[rows], linear.outputs)


def test_eigenvalues_of_the_model_are_those_of_the_linearisation():
    for model in (HELD, FREE):
        state = equilibrium(model)
        assert np.array_equal(model.eigenvalues(state), linearise(model, state).eigenvalues)
    assert eigenvalues_of(np.diag([-1.0, -3.0])).tolist() == [-3.0, -1.0]


def test_an_eigenvalue_that_is_zero_has_words():
    """The turn of the wheel about its axis: nothing holds it, and it has no time constant."""
    hop, *spin = linearise(HELD, equilibrium(HELD)).modes
    assert hop.text == "12.35 Hz, damping ratio 0.233"
    assert {mode.text for mode in spin} == {"neither oscillates nor decays: an eigenvalue is zero"}


@pytest.mark.parametrize(
    ("stiffness", "damping", "text"),
    [
        (3.0, 0.4, "0.28 Hz, damping ratio 0.115"),
        (3.0, -0.4, "0.28 Hz, damping ratio -0.115"),
        (3.0, 4.0, "0.28 Hz, damping ratio 1.155: overdamped, time constants 333 ms and 1 s"),
        (
            3.0,
            -4.0,
            "does not oscillate: grows by the factor e in 1 s, grows by the factor e in 333 ms",
        ),
        (
            -3.0,
            2.0,
            "does not oscillate: decays by the factor e in 333 ms, grows by the factor e in 1 s",
        ),
    ],
)
def test_what_falls_over_is_no_oscillator(stiffness, damping, text):
    """x'' + damping x' + stiffness x = 0: an inverted pendulum has no frequency."""
    matrix = np.array([[0.0, 1.0], [-stiffness, -damping]])
    mode = mode_of_states(matrix, ("x", "x_rate"), (0, 1))
    assert mode.text == text
    assert np.isnan(mode.natural_frequency) == (stiffness < 0.0)
    assert np.isnan(mode.damping_ratio) == (stiffness < 0.0)
    for alone in modes_of(matrix, ("x", "x_rate")):
        grows = alone.eigenvalues[0].real > 0.0
        assert alone.oscillates or ("grows" in alone.text) == grows


def test_examples_of_the_page_run(capsys):
    page = (ROOT / "docs/simulation/modes.md").read_text(encoding="utf-8")
    exec("\n".join(re.findall(r"```python\n(.*?)```", page, re.DOTALL)), {})
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "12.35 Hz, damping ratio 0.233"
    assert float(lines[3].split()[0]) == pytest.approx(12.35, abs=0.01)
    assert lines[5].startswith("(4, 4)")
    assert [line.split()[-1] for line in lines[6:]] == ["0.155", "0.233", "0.311"]


def test_inputs_change_the_point():
    raised = HELD.inputs({"road_height": 0.01})
    linear = linearise(HELD, equilibrium(HELD, road_height=0.01), raised)
    assert linear.steady
    assert np.array_equal(linear.inputs, raised)


@pytest.mark.parametrize("arguments", [{"outputs": ["tire_force"]}, {"state": np.zeros((3, 4))}])
def test_what_cannot_be_linearised_is_refused(arguments, refused):
    refused(InputError, lambda: linearise(HELD, **({"state": REST} | arguments)))


def test_unknown_source_and_resonance_of_the_spin_are_refused(refused):
    linear = linearise(HELD, REST)
    refused(InputError, lambda: linear.frequency_response([1.0], "road"))
    with pytest.raises(InputError, match="0 Hz"):
        linear.frequency_response([0.0], "road_height")


def test_instants_and_models_name_the_same_states():
    """The order of coordinates that the oracle assumes."""
    for name, model in (("macpherson", HELD), ("macpherson_free_rack", FREE)):
        instant = Instant(beta1=1.0, spin=2.0, rack=3.0)
        assert instant.state(MODELS[name])[: len(model.state_names) // 2].tolist() == (
            [1.0, 2.0, 3.0] if model.free_rack else [1.0, 2.0]
        )


def test_motions_that_only_creep_have_their_modes_too():
    """Two bodies on dampers so strong that nothing oscillates."""
    matrix = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.diag([1.0, 2.0]), -9.0 * np.eye(2)]])
    found = modes_of_motions(
        matrix, ("a", "b", "a_rate", "b_rate"), np.eye(2, 4), np.array([1.0, 1.0])
    )
    wanted = [np.sqrt(value) / (2.0 * np.pi) for value in (1.0, 2.0)]
    np.testing.assert_allclose([m.natural_frequency for m, _ in found], wanted, rtol=1e-12)
    np.testing.assert_allclose([part for _, part in found], 1.0, rtol=1e-12)


def test_motions_share_out_what_oscillates_and_what_creeps():
    """Four oscillators by themselves, two of them overdamped, beside a coordinate that is free."""
    rates, damping = np.array([1.0, 4.0, 9.0, 2.0, 0.0]), np.array([0.2, 5.0, 1.0, 9.0, 0.0])
    matrix = np.block([[np.zeros((5, 5)), np.eye(5)], [-np.diag(rates), -np.diag(damping)]])
    # motions that are each a little of the next one
    motions = np.eye(4, 5) + 0.1 * np.eye(4, 5, k=1) * [1.0, 1.0, 1.0, 1.0, 0.0]
    names = tuple("abcde") + tuple(f"{name}_rate" for name in "abcde")
    rows = np.hstack([motions, np.zeros((4, 5))])
    found = [mode for mode, _ in modes_of_motions(matrix, names, rows, np.ones(4))]
    roots = np.sqrt(rates[:4])
    np.testing.assert_allclose(
        [mode.natural_frequency for mode in found], roots / (2.0 * np.pi), rtol=1e-9
    )
    ratios = [mode.damping_ratio for mode in found]
    np.testing.assert_allclose(ratios, damping[:4] / (2.0 * roots), rtol=1e-9)


def test_what_rounding_leaves_of_a_zero_neither_grows_nor_decays():
    """A body with a damper and without a spring, in coordinates whose matrix has no zeros."""
    matrix = np.array([[0.0, 1.0], [0.0, -0.7]])
    for angle in np.linspace(0.1, 3.0, 25):
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        mode = mode_of_states(turn @ matrix @ turn.T, ("q", "q_rate"), [0, 1])
        assert mode.natural_frequency == 0.0
        assert mode.text == "neither oscillates nor decays: an eigenvalue is zero"


def test_a_real_eigenvalue_makes_no_pair_with_one_of_an_oscillation():
    """A coordinate that relaxes, moved by an oscillator: three states, and one real eigenvalue."""
    matrix = np.array([[-5.0, 0.1, 0.0], [0.0, 0.0, 1.0], [0.0, -100.0, -1.0]])
    names, alone = ("a", "q", "q_rate"), (-5.0 + 0.0j,)
    assert mode_of_states(matrix, names, [0]).eigenvalues == pytest.approx(alone)
    # nor with that of a motion in which the coordinate has no part
    apart = np.diag([-5.0, -7.0])
    assert mode_of_states(apart, ("a", "b"), [0]).eigenvalues == pytest.approx(alone)
