"""Gradients of motions through their steps: against the same steps in complex numbers.

And the sweep through compiled equations against that through functions over NumPy arrays.
"""

import ctypes
from itertools import pairwise

import kintrafo
import numpy as np
import pytest
from kintrafo import ModelError, Samples
from kintrafo.generator.mechanisms import MODELS
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
from kintrafo.simulation import _steps
from kintrafo.simulation.retraced import STAGES, RetracedSteps
from kintrafo.simulation.signals import time_inputs
from kintrafo.simulation.sweep import Sweep
from scipy.integrate import RK45
from support.complex_numbers import STEP, printed

SPAN, TIMES = (0.0, 0.4), np.linspace(0.0, 0.4, 23)
WEIGHTS = np.cos(40.0 * TIMES)
OF = {"crank_angle": WEIGHTS, "spring_force": 0.01 * WEIGHTS}
ANGLE = 0.3
JUMP, BEFORE, BEHIND = 0.15, 2.0, -0.5
TORQUE = Samples([0.0, JUMP, JUMP, 0.4], [0.0, BEFORE, BEHIND, BEHIND], "linear")


def torque(time, *step):
    """Return the torque within a step, none of which passes over the jump."""
    return BEFORE * time / JUMP if sum(step) < 2.0 * JUMP else BEHIND


def through(model, constants, state, borders, torque_at):
    """Return the number, of the same steps by SciPy's coefficients of the method."""
    weighted = 0.0j
    for begin, end in pairwise(borders):
        length, rates = end - begin, np.zeros((7, 2), dtype=complex)
        for stage, (row, node) in enumerate(zip(RK45.A, RK45.C, strict=True)):
            at = state + length * row[:stage] @ rates[:stage]
            given = np.array([torque_at(begin + node * length, begin, end)])
            rates[stage] = model.rhs(constants, at, given)[0]
        after = state + length * RK45.B @ rates[:-1]
        rates[-1] = model.rhs(constants, after, np.array([torque_at(end, begin, end)]))[0]
        for time, weight in zip(TIMES, WEIGHTS, strict=True):
            # the first time, and those up to the end of the step
            if begin < time <= end or time == begin == SPAN[0]:
                powers = ((time - begin) / length) ** np.arange(1, 5)
                there = state + length * (RK45.P @ powers) @ rates
                given = np.array([torque_at(time, begin, end)])
                force = model.signals(constants, there, given)[0][2]
                weighted += weight * (there[0] + 0.01 * force)
        state = after
    return weighted


@pytest.mark.parametrize("backend", ["c", "numpy"])
@pytest.mark.parametrize("varies", [False, True], ids=["held", "over a jump"])
def test_against_the_same_steps_in_complex_numbers(monkeypatch, backend, *, varies):
    """By everything: they share neither derivatives nor the coefficients of the method."""
    module = kintrafo.compile(FOUR_BAR, parameter_derivatives=True, backend=backend)
    system = kintrafo.System(module)
    assert system.signal_names[2] == "spring_force"
    start = system.state(crank_angle=ANGLE)
    inputs = {"crank_torque": TORQUE if varies else 0.5}
    found = kintrafo.motion_gradient(system, SPAN, start, OF, inputs=inputs, t_eval=TIMES)
    model = printed(FOUR_BAR, monkeypatch)
    exact = {}
    for name in (name for name, value in found.by.items() if not np.isnan(value)):
        by = {name: STEP}
        values = np.array([v + by.get(n, 0.0) for n, v in system.parameters.items()])
        state = start + np.array([by.get(n, 0.0) for n in system.state_names])
        held = 0.5 + by.get("crank_torque", 0.0)
        number = through(
            model, np.array(model.prepare(values)[0]), state, found.motion.t,
            torque if varies else lambda *_, held=held: held,
        )  # fmt: skip
        exact[name] = number.imag / STEP.imag
        assert number.real == pytest.approx(found.value, rel=1e-12)
    assert len(exact) > 20
    for name, value in exact.items():
        # the rounding of some dozen steps, of numbers up to some hundred
        assert found.by[name] == pytest.approx(value, rel=1e-11, abs=1e-13), name


def test_compiled_as_over_arrays(monkeypatch):
    """Of a car over a jump of the road, to the rounding of some hundred steps."""
    car = kintrafo.Model("reference_car")
    same = next(model for model in MODELS if model.name == car.equations.NAME)
    system = kintrafo.System(kintrafo.compile(same, parameter_derivatives=True), car.parameters)
    start = kintrafo.state_at_height(car, 0.325, spin_rate=93.0)
    of = {"wheel_acceleration": "rms", "toe": "mean", "beta1": WEIGHTS}
    road = {"road_height": Samples([0.0, 0.1, 0.1, 0.4], [0.0, 0.01, 0.03, 0.0], "linear")}

    def found():
        return kintrafo.motion_gradient(system, SPAN, start, of, inputs=road, t_eval=TIMES)

    compiled, refused = found(), []
    for name in ("go_through", "go_back"):
        monkeypatch.setattr(_steps, name, lambda *_, name=name: bool(refused.append(name)))
    over_arrays = found()
    assert refused == ["go_through", "go_back"]
    assert compiled.value == pytest.approx(over_arrays.value, rel=1e-13)
    most = 1e-12 * max(map(abs, compiled.by.values()))
    assert compiled.by == pytest.approx(over_arrays.by, rel=1e-10, abs=most)


def test_what_is_refused_on_the_way_is_reported(refused):
    """With its place, as by the functions themselves."""
    four_bar = kintrafo.System(kintrafo.compile(FOUR_BAR, parameter_derivatives=True))
    start = four_bar.state(crank_angle=ANGLE)
    motion = kintrafo.simulate(four_bar, SPAN, start, method="DormandPrince")
    courses = time_inputs(four_bar, None, SPAN)
    steps = RetracedSteps(four_bar, motion, courses)
    places = steps.places(TIMES)
    point = steps.point(*places)
    steps.states[2, 1, 0] = np.nan
    refused(
        ModelError,
        lambda: Sweep(four_bar, steps).backwards(places, point, {"crank_angle": WEIGHTS}),
    )
    motion.y[0, 3] = np.nan
    refused(ModelError, lambda: RetracedSteps(four_bar, motion, courses))


@pytest.mark.usefixtures("interruptible")
def test_an_interrupt_is_seen_on_the_way():
    """The function that is called at every stage does nothing but send one."""
    interrupt = ctypes.cast(ctypes.pythonapi.PyErr_SetInterrupt, ctypes.c_void_p).value
    count, (one, none) = 10_000, (np.ones(1), np.zeros(0))
    lengths, restarts = np.ones(count), np.zeros(count, np.uint8)
    restarts[0] = 1
    shape = (count, len(STAGES), 1)
    inputs, states, rates = np.zeros((*shape[:2], 0)), np.zeros(shape), np.zeros(shape)
    states[:, 0] = 1.0
    with pytest.raises(KeyboardInterrupt):
        _steps.go_through(interrupt, one, STAGES, lengths, restarts, inputs, states, rates)
    assert not states[-1, 1].any()
    by_start = np.zeros(1)
    with pytest.raises(KeyboardInterrupt):
        _steps.go_back(
            interrupt, one, STAGES, lengths, restarts, inputs, states, np.ones((count, 1)),
            np.zeros(shape), np.zeros(1), by_start, none,
        )  # fmt: skip
    assert 0.0 < by_start[0] < count
