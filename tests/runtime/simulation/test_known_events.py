"""Functions of time alone as events: their zeros are known for every motion."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
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
from kintrafo.simulation.solvers import native_methods

MODEL = Model("reference_car")
START = state_at_height(MODEL, 0.325, spin_rate=93.0)
METHODS = [*native_methods(), "RK45"]
each_method = pytest.mark.parametrize("method", METHODS)
# Solvers distinguish times that differ by some hundred roundings of a second; SciPy's by 4e-12.
RESOLVED = 1e-11


def sine(frequency, phase, *, direction=0.0, terminal=False):
    """Return an event with zeros at (phase + k) / frequency, which rises where k is even."""

    def event(time, _):
        return float(np.sin(np.pi * (frequency * time - phase)))

    event.direction, event.terminal = direction, terminal
    return event


def zeros(frequency, phase, direction, last):
    """Return the times of its zeros after the begin."""
    number = np.arange(np.floor(-phase), np.ceil(frequency * last - phase) + 1.0)
    if direction:
        number = number[(number % 2.0 == 0.0) == (direction > 0.0)]
    return (phase + number) / frequency


@each_method
@given(
    st.lists(
        st.tuples(st.floats(5.0, 40.0), st.floats(0.0, 1.0), st.sampled_from([-1.0, 0.0, 1.0])),
        min_size=1,
        max_size=4,
    )
)
@example([(8.0, 0.0, 0.0), (16.7, 3e-308, 1.0)])  # SUNDIALS' own search goes on for ever
def test_every_zero_is_found(method, drawn):
    """Several in a step, and none twice: no step is longer than the time between two of one."""
    last = 0.2
    events = [sine(f, p, direction=d) for f, p, d in drawn]
    found = simulate(MODEL, (0.0, last), START, method=method, events=events, max_step=0.02)
    for both in zip(found.t_events, [zeros(*one, last) for one in drawn], strict=True):
        # a zero next to an end of the time may be seen or not
        times, known = (t[(t > 1e-9) & (t < last - 1e-9)] for t in both)
        np.testing.assert_allclose(times, known, rtol=0.0, atol=RESOLVED)


@each_method
def test_backward_in_time(method):
    event = sine(20.0, 0.25)
    found = simulate(MODEL, (0.0, -0.1), START, method=method, events=event, max_step=0.02)
    expected = (0.25 + np.array([-1.0, -2.0])) / 20.0
    np.testing.assert_allclose(found.t_events[0], expected, rtol=0.0, atol=RESOLVED)


@each_method
def test_the_third_crossing_ends_the_motion(method):
    event = sine(20.0, 0.5, terminal=3)
    found = simulate(MODEL, (0.0, 0.4), START, method=method, events=event, max_step=0.02)
    np.testing.assert_allclose(found.t_events[0], [0.025, 0.075, 0.125], rtol=0.0, atol=RESOLVED)
    assert found.t[-1] == found.t_events[0][-1]
    np.testing.assert_array_equal(found.y[:, -1], found.y_events[0][-1])


BROKEN = Samples([0.0, 0.1, 0.1, 0.2, 0.2, 1.0], [0.0, 0.0, 0.01, 0.01, 0.0, 0.0], "linear")


@each_method
def test_crossings_are_counted_over_all_segments(method):
    """A road that jumps at 0.1 s and 0.2 s does not restart the counting."""
    event = sine(20.0, 0.5, terminal=5)
    found = simulate(
        MODEL, (0.0, 0.4), START, method=method, events=event, max_step=0.02,
        inputs={"road_height": BROKEN},
    )  # fmt: skip
    expected = [0.025, 0.075, 0.125, 0.175, 0.225]
    np.testing.assert_allclose(found.t_events[0], expected, rtol=0.0, atol=RESOLVED)
    assert found.t[-1] == found.t_events[0][-1]


@each_method
@pytest.mark.parametrize("count", [1, 2])
def test_what_jumps_across_a_level_counts_once(method, count):
    """A road that falls by 10 mm takes the tyre from where it rests over 5 mm less."""
    rest = equilibrium(MODEL)
    level = float(MODEL.signals(rest)["tyre_force"]) - 0.005 * MODEL.parameters["tyre_rate"]
    fall = Samples(BROKEN.times, -np.array(BROKEN.values), "linear")
    found = simulate(
        MODEL, (0.0, 0.3), rest, method=method, inputs={"road_height": fall},
        events=SignalEvent("tyre_force", level, terminal=count),
    )  # fmt: skip
    assert found.status == 1
    assert found.t_events[0].size == count
    assert found.t_events[0][0] == 0.1


@pytest.mark.parametrize("method", native_methods())
def test_what_jumps_onto_a_level_has_reached_it(method):
    """A tyre that lifts off has a force of exactly nothing."""
    car = Model(Suspension.load("reference_car").with_changes({"tyre.lifts_off": True}))
    fall = Samples([0.0, 0.1, 0.1, 1.0], [0.0, 0.0, -0.1, -0.1], "linear")
    found = simulate(
        car, (0.0, 0.11), equilibrium(car), method=method, inputs={"road_height": fall},
        events=SignalEvent("tyre_force", 0.0),
    )  # fmt: skip
    assert found.t_events[0].tolist() == [0.1]


@each_method
def test_steps_are_counted_over_all_segments(method):
    options = {"method": method, "inputs": {"road_height": BROKEN}}
    steps = simulate(MODEL, (0.0, 0.4), START, **options).steps
    if method in native_methods():
        with pytest.raises(SimulationError, match=f"more than {steps - 1} steps"):
            simulate(MODEL, (0.0, 0.4), START, max_steps=steps - 1, **options)


@each_method
def test_the_first_step_may_be_longer_than_a_segment(method):
    found = simulate(
        MODEL, (0.0, 0.4), START, method=method, first_step=0.3, inputs={"road_height": BROKEN}
    )
    assert found.t[-1] == 0.4


@each_method
def test_what_an_event_does_to_its_state_moves_nothing(method):
    def event(_, state):
        state[:] = 99.0
        return 1.0

    found, plain = (
        simulate(MODEL, (0.0, 0.1), START, method=method, events=one)
        for one in (event, lambda *_: 1.0)
    )
    np.testing.assert_array_equal(found.y, plain.y)


@each_method
def test_the_state_of_an_event_is_on_the_way(method):
    event = sine(20.0, 0.5)
    found = simulate(
        MODEL, (0.0, 0.4), START, method=method, events=event, dense_output=True, rtol=1e-6
    )
    np.testing.assert_allclose(found.y_events[0].T, found.sol(found.t_events[0]), rtol=1e-12)


@each_method
def test_a_zero_next_to_a_border_is_not_lost(method):
    """0.1 + 0.2 is 6e-17 more than the 0.3 at which the road, and so a segment, breaks off."""
    road = Samples([0.0, 0.3, 0.3, 1.0], [0.0, 0.0, 0.01, 0.01], "linear")
    for late in (-1e-16, 0.0, 1e-16):

        def event(time, _, late=late):
            return time - (0.1 + 0.2) - late

        found = simulate(
            MODEL, (0.0, 0.4), START, method=method, events=event, inputs={"road_height": road}
        )
        np.testing.assert_allclose(found.t_events[0], [0.3], rtol=0.0, atol=RESOLVED)


@each_method
def test_a_function_that_is_zero_at_first_waits(method):
    def event(time, _):
        return max(0.0, time - 0.1) if time < 0.15 else 0.2 - time

    found = simulate(MODEL, (0.0, 0.3), START, method=method, events=event, max_step=0.02)
    np.testing.assert_allclose(found.t_events[0], [0.2], rtol=0.0, atol=RESOLVED)


@pytest.mark.parametrize("method", native_methods())
def test_a_function_of_few_digits_is_zero_for_a_while(method):
    """As is the distance of a state from a level, for some 1e-16 of it: that is no error."""

    def event(time, _):
        return round((time - 0.1) * 1e12) * 1e-12

    found = simulate(MODEL, (0.0, 0.3), START, method=method, events=event, max_step=0.02)
    np.testing.assert_allclose(found.t_events[0], [0.1], rtol=0.0, atol=1e-12)


@each_method
def test_a_function_that_stays_zero_is_an_error(method, refused):
    refused(
        SimulationError,
        lambda: simulate(
            MODEL, (0.0, 0.3), START, method=method, events=lambda time, _: min(0.0, time - 0.1)
        ),
    )


@pytest.mark.parametrize("method", native_methods())
def test_an_event_that_gives_up_in_the_middle(method, refused):
    def event(time, _):
        return np.nan if time > 0.1 else 1.0

    refused(InputError, lambda: simulate(MODEL, (0.0, 0.3), START, method=method, events=event))


@pytest.mark.parametrize("method", native_methods())
@pytest.mark.parametrize("terminal", [False, 2])
def test_what_passes_together_passes_once(method, terminal):
    """Zeros that differ by less than is resolved, and values with noise of more than that."""

    def late(by, noise):
        def event(time, _):
            return time - 0.1 - by + noise * np.sin(1e17 * time)

        event.terminal = terminal
        return event

    events = [late(by, noise) for by in (-3e-16, 0.0, 2e-16, 1e-13) for noise in (0.0, 1e-13)]
    found = simulate(MODEL, (0.0, 0.2), START, method=method, events=events, max_step=0.02)
    for times in found.t_events:
        np.testing.assert_allclose(times, [0.1], rtol=0.0, atol=RESOLVED)
    assert found.t[-1] == 0.2
