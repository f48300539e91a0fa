"""The linearly implicit method of a fixed step: its numbers, its order, and what is stiff."""

from __future__ import annotations

import re
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

import kintrafo
import numpy as np
import pytest
import sympy as sp
from kintrafo import (
    InputError,
    Model,
    SimulationError,
    System,
    equilibrium,
    simulate,
    state_at_height,
)
from kintrafo import generator as g
from kintrafo.generator.declare.forces.force import Action, Force
from kintrafo.simulation.solvers import native_available
from support.folders import ROOT
from support.models import needs_gcc, own

pytestmark = pytest.mark.skipif(not native_available(), reason="nothing is integrated in C")

Matrix = list[list[Fraction]]
MODEL = Model("reference_car")
START = state_at_height(MODEL, 0.325, spin_rate=93.0)
SPAN = (0.0, 1.0)
TIMES = np.linspace(*SPAN, 101)


def run(step=1e-3, model=MODEL, start=START, **options):
    span = options.pop("span", SPAN)
    return simulate(model, span, start, method="RODASP", step=step, **options)


# -- the numbers, in exact arithmetic -------------------------------------------------------------

STAGES, GAMMA = 6, Fraction(1, 4)
# Numbers of 16 digits, up to 60, multiplied some times with each other.
ROUNDED = 1e-12


def numbers(name):
    """Return the rows of a table of the method as they are compiled, each of six numbers."""
    text = (ROOT / "runtime/simulation/native/rodasp.h").read_text(encoding="utf-8")
    body = re.search(rf" {name}\[.*?= \{{(.*?)\}};", text, flags=re.DOTALL).group(1)
    rows = re.findall(r"\{(.*?)\}", body, flags=re.DOTALL) or [body]
    found = [[Fraction(n) for n in row.replace("\n", " ").split(",") if n.strip()] for row in rows]
    return [row + [Fraction(0)] * (STAGES - len(row)) for row in found]


def times(a, b):
    return [
        [sum(x * y for x, y in zip(row, col, strict=True)) for col in zip(*b, strict=True)]
        for row in a
    ]


def coupling():
    """Return Gamma and alpha of the classical form: C = I / g - Gamma^-1, A = alpha Gamma^-1."""
    c = numbers("C")
    inverse = []
    for i in range(STAGES):  # (I / gamma - C) Gamma = I, row by row
        row = [
            GAMMA * ((i == j) + sum((c[i][k] * inverse[k][j] for k in range(i)), Fraction(0)))
            for j in range(STAGES)
        ]
        inverse.append(row)
    return inverse, times(numbers("A"), inverse)


GAMMAS, ALPHA = coupling()
BETA = [[a + b for a, b in zip(*rows, strict=True)] for rows in zip(ALPHA, GAMMAS, strict=True)]
NODE = [sum(row) for row in ALPHA]


def by(matrix, vector):
    return [sum(x * y for x, y in zip(row, vector, strict=True)) for row in matrix]


ONES = [Fraction(1)] * STAGES
BY_BETA = by(BETA, ONES)
SQUARES = [node**2 for node in NODE]
TREES = [
    (1, ONES, Fraction(1)),
    (2, BY_BETA, Fraction(1, 2)),
    (3, SQUARES, Fraction(1, 3)),
    (3, by(BETA, BY_BETA), Fraction(1, 6)),
    (4, [node**3 for node in NODE], Fraction(1, 4)),
    (4, [n * x for n, x in zip(NODE, by(ALPHA, BY_BETA), strict=True)], Fraction(1, 8)),
    (4, by(BETA, SQUARES), Fraction(1, 12)),
    (4, by(BETA, by(BETA, BY_BETA)), Fraction(1, 24)),
]
"""Order, product of a rooted tree, and what its weighted sum is (Hairer and Wanner, IV.7)."""


def weights(part):
    """Return the weights of the rates by which the state at a part of the step is found."""
    first, second = numbers("DENSE")
    end = [*numbers("A")[-1][:-1], Fraction(1)]
    of_stages = [
        part * m + part * (1 - part) * (one + part * two)
        for m, one, two in zip(end, first, second, strict=True)
    ]
    return [
        sum(w * row[j] for w, row in zip(of_stages, GAMMAS, strict=True)) for j in range(STAGES)
    ]


@pytest.mark.parametrize(
    ("part", "order"), [(Fraction(1), 4), (Fraction(1, 3), 3), (Fraction(7, 8), 3)]
)
def test_the_order_conditions_hold(part, order):
    """Of order 4 at the end of a step, of 3 within it."""
    for of, product, value in TREES:
        if of <= order:
            found = sum(b * x for b, x in zip(weights(part), product, strict=True))
            assert abs(found - value * part**of) < ROUNDED, (of, float(found))


def test_nodes_and_terms_by_time_are_sums_of_rows():
    for written, sums in ((numbers("NODES")[0], NODE), (numbers("BY_TIME")[0], by(GAMMAS, ONES))):
        assert max(abs(a - b) for a, b in zip(written, sums, strict=True)) < ROUNDED
    assert all(GAMMAS[i][i] == GAMMA for i in range(STAGES))


def test_it_is_l_stable_and_stiffly_accurate():
    """R = P / (1 - gamma z)^6 has a P of degree 5, and |R| <= 1 along the imaginary axis."""
    end = weights(Fraction(1))
    assert max(abs(b - beta) for b, beta in zip(end, BETA[-1], strict=True)) < ROUNDED
    assert abs(NODE[-1] - 1) < ROUNDED
    series, vector = [Fraction(1)], ONES
    for _ in range(STAGES):
        series.append(sum(b * x for b, x in zip(end, vector, strict=True)))
        vector = by(BETA, vector)
    z, y = sp.symbols("z y", real=True)
    below = sp.expand((1 - sp.Rational(1, 4) * z) ** STAGES)
    taylor = sum(sp.Rational(c.numerator, c.denominator) * z**k for k, c in enumerate(series))
    top = sp.Poly(sp.expand(below * taylor), z).all_coeffs()[::-1][: STAGES + 1]
    assert abs(top[STAGES]) < ROUNDED
    real = sum(c * (-1) ** (k // 2) * y**k for k, c in enumerate(top) if k % 2 == 0)
    imaginary = sum(c * (-1) ** (k // 2) * y**k for k, c in enumerate(top) if k % 2)
    left = sp.Poly(sp.expand((1 + y**2 / 16) ** STAGES - real**2 - imaginary**2), y).all_coeffs()
    powers = left[::-1]
    assert all(abs(c) < ROUNDED for c in powers[:6])  # order 4: what is left begins with y^6
    assert powers[6] > 0
    assert not sp.Poly(powers[6::2][::-1], y).count_roots(0)
    assert not any(powers[1::2])


# -- the order ------------------------------------------------------------------------------------


@pytest.mark.parametrize("road", [None, lambda t: 0.01 * np.sin(10.0 * np.pi * t)])
def test_it_is_of_fourth_order(road):
    """At ends of steps and within them; inputs that move cost two evaluations more."""
    inputs = {} if road is None else {"road_height": road}
    truth = simulate(
        MODEL,
        SPAN,
        START,
        method="DOP853",
        rtol=1e-13,
        atol=1e-15,
        dense_output=True,
        inputs=inputs,
    ).sol
    for at in (TIMES, np.linspace(*SPAN, 334)[1:]):
        found = [run(step, t_eval=at, inputs=inputs) for step in (8e-3, 4e-3, 2e-3)]
        errors = [np.abs(one.y[0] - truth(at)[0]).max() for one in found]
        # the next term of the error is a step times as large; steps end where the road turns
        assert all(a / b > 11.0 for a, b in pairwise(errors)), errors
        assert errors[-1] < 3e-7
    for one in found:
        assert one.nfev == (6 if road is None else 8) * one.steps + 1
        assert one.njev == one.nlu == one.steps
    assert found[0].order == 4


def test_it_is_of_fourth_order_backward_from_kinks():
    """The rate of an input at a kink is that on the side of the step."""
    times = np.linspace(0.0, 0.2, 5)
    road = kintrafo.Samples(times, np.array([0.0, 0.01, -0.005, 0.008, 0.0]), "linear")
    inputs, span, start = {"road_height": road}, (0.2, 0.0), equilibrium(MODEL)
    truth = simulate(MODEL, span, start, method="Verner", rtol=1e-12, atol=1e-13, inputs=inputs)
    found = [run(step, start=start, span=span, inputs=inputs) for step in (4e-4, 2e-4)]
    errors = [np.abs(one.y[:, -1] - truth.y[:, -1]).max() for one in found]
    # the next term of the error is a step times as large
    assert errors[0] / errors[1] > 11.0, errors


def test_events_are_found_by_the_polynomial():
    level = kintrafo.SignalEvent("wheel_center_z", 0.3)
    found = run(events=level, dense_output=True)
    heights = MODEL.signals(found.sol(found.t_events[0]).T)["wheel_center_z"]
    assert found.t_events[0].size > 5
    np.testing.assert_allclose(heights, 0.3, rtol=0.0, atol=1e-13)


def test_steps_of_a_stepper_have_the_same_bits():
    stepper = kintrafo.Stepper(MODEL, 1e-3, START, method="RODASP")
    states = [stepper.step().copy() for _ in range(200)]
    still = {"rack_position": ([0.0, 0.2], [0.0, 0.0])}  # equations for a rack that may move
    for _ in range(2):
        whole = run(span=(0.0, 0.2), inputs=still)
        np.testing.assert_array_equal(states, whole.y[:, 1:].T)


# -- stiff equations ------------------------------------------------------------------------------

BLOCK = g.Body("block", 2.0, (0.1, 0.0, 0.0))
GUIDE = g.Prismatic("way", g.Ground("base"), BLOCK, g.FORWARD)
TARGET, LAG = g.Input("target", "N", "what is followed"), g.TimeConstant("lag", 1e-2, "lag")
PULL = g.InternalState("pull", "N", "what follows")


@dataclass(frozen=True)
class Follower(Force):
    """A state that follows an input with a lag: the problem of Prothero and Robinson."""

    state: g.InternalState = PULL
    lag: g.TimeConstant = LAG
    target: g.Input = TARGET

    @property
    def identity(self):
        return "Follower", "pull"

    def act(self, at):
        rate = (sp.Symbol(self.target.name) - self.state.symbol) / self.lag.symbol
        return Action({at.coordinate("way"): sp.Integer(0)}, rates={"pull": rate})


SPRING = g.LinearSpring(
    g.SpringRate("stiffness", 400.0, "rate"), free_length=g.Displacement("free_slide", 0.0, "slide")
)
FOLLOWING = g.Formulation(
    "following",
    "a block, and a force that follows",
    g.Mechanism(
        "following",
        "a block, and a force that follows",
        joints=(GUIDE,),
        forces=(g.ForceElement("spring", g.AlongGuide(GUIDE), (SPRING,)), Follower(),
                g.JointForce(GUIDE, TARGET)),
        coordinates=(GUIDE.slide("slide", "slide of the block"),),
    ),
    independent=(GUIDE,),
)  # fmt: skip


@pytest.fixture(scope="module")
def following():
    return own(FOLLOWING)


@needs_gcc
def test_no_order_is_lost_on_what_is_stiff(following):
    """Prothero and Robinson: u' = (sin t + lag cos t - u) / lag has u = sin t for any lag."""
    errors = {}
    for lag in (1.0, 1e-2, 1e-4, 1e-7):
        system = System(following, {"lag": lag})
        inputs = {"target": lambda t, lag=lag: np.sin(t) + lag * np.cos(t)}
        errors[lag] = [
            abs(
                run(h, system, system.state(), span=(0.0, 1.2), inputs=inputs).y[2, -1]
                - np.sin(1.2)
            )
            for h in (0.4, 0.2, 0.1)
        ]
    gains = {lag: [a / b for a, b in pairwise(found)] for lag, found in errors.items()}
    assert min(gains[1.0]) > 11.0, errors
    # of steps that are longer than the lag the order is 3, and the error falls with the lag
    assert min(*gains[1e-2], *gains[1e-4], *gains[1e-7]) > 6.0, errors
    for longer, shorter in pairwise(errors.values()):
        assert all(a > b for a, b in zip(longer, shorter, strict=True)), errors


def test_a_stiff_strut_is_integrated_where_runge_kutta_is_not(refused):
    """A damper of 200 times the rate: 1 ms is three times too long, and the motion that of BDF."""
    model, start = System(MODEL.equations, MODEL.parameters | {"damper_rate": 3e5}), np.array(START)
    refused(SimulationError, lambda: simulate(model, SPAN, start, method="RK4", step=1e-3))
    truth = simulate(model, SPAN, start, method="BDF", rtol=1e-11, atol=1e-13, t_eval=TIMES).y
    errors = [
        np.abs(run(h, model, start, t_eval=TIMES).y[0] - truth[0]).max() for h in (5e-3, 1e-3)
    ]
    assert errors[0] < 1e-6
    assert errors[1] < 1e-9
    # what is too fast has gone within some steps, and what is left creeps
    hard = System(MODEL.equations, MODEL.parameters | {"damper_rate": 1e9})
    start[2] = 1.0
    moved = run(1e-3, hard, start, span=(0.0, 0.02)).y[2]
    assert abs(moved[1]) < 1e-3
    np.testing.assert_allclose(moved[5:], moved[-1], rtol=1e-3, atol=0.0)


def test_friction_is_passed_over_in_no_step(refused):
    """Friction that sticks: right by steps that see it, refused by those that jump over it."""
    found = {}
    for velocity in (1e-3, 1e-5):
        changes = {"strut.friction_N": 600.0, "strut.friction_velocity_m_per_s": velocity}
        found[velocity] = Model(MODEL.suspension.with_changes(changes))
    start = np.array(state_at_height(found[1e-3], 0.305))
    start[2] = 0.3  # sliding
    truth = simulate(found[1e-3], (0.0, 0.2), start, method="BDF", rtol=1e-9, atol=1e-12).y[0, -1]
    assert abs(run(1e-3, found[1e-3], start, span=(0.0, 0.2)).y[0, -1] - truth) < 2e-5
    with refused(SimulationError) as caught:
        run(1e-3, found[1e-5], start)
    assert 0.01 < caught.value.time < 0.2
    assert caught.value.partial.t.size > 10


@needs_gcc
def test_a_step_without_a_solution_is_refused(following, refused):
    """Back in time what lags grows, here with exactly the rate 1 / (gamma h): no pivot is left."""
    system = System(following, {"lag": 0.125})
    start = system.state(pull=0.1)
    refused(SimulationError, lambda: run(0.5, system, start, span=(1.0, 0.0)))
    assert run(0.01, system, start, span=(1.0, 0.9)).success


@pytest.mark.parametrize("wrong", [{"step": None}, {"step": 1e-9}, {"rtol": 1e-6, "max_step": 0.1}])
def test_what_cannot_be_used(wrong, refused):
    given = {"method": "RODASP", "step": 1e-3} | wrong
    refused(InputError, lambda: simulate(MODEL, SPAN, START, **given))


@pytest.mark.parametrize("method", ["RODASP", "RK4", "BDF"])
def test_equations_without_a_jacobian_are_refused(method, monkeypatch, refused):
    monkeypatch.delattr(MODEL.equations, "rhs_jacobian")
    step = {} if method == "BDF" else {"step": 1e-3}
    refused(InputError, lambda: simulate(MODEL, SPAN, START, method=method, **step))
    assert simulate(MODEL, (0.0, 0.01), START, method="DormandPrince").success
