"""Our own Runge-Kutta method for one system: its order, its polynomial, its kin in lanes."""

from itertools import pairwise

import numpy as np
import pytest
from kintrafo import Model, SignalEvent, simulate, state_at_height
from kintrafo.simulation.solvers import native_available

pytestmark = pytest.mark.skipif(not native_available(), reason="nothing is integrated in C")

MODEL = Model("reference_car")
START = state_at_height(MODEL, 0.325, spin_rate=93.0)
SPAN = (0.0, 1.0)
TIMES = np.linspace(*SPAN, 101)
TRUTH = simulate(
    MODEL, SPAN, START, method="DOP853", t_eval=TIMES, rtol=1e-13, atol=1e-15, dense_output=True
)


def run(**options):
    return simulate(MODEL, SPAN, START, method="DormandPrince", **options)


def arm_error(found):
    return np.abs(found.y[0] - TRUTH.y[0]).max()


def test_it_is_of_fifth_order_and_its_polynomial_of_fourth():
    """Half the step makes the error of steps 32 times smaller; that of the polynomial, h^5 too."""
    loose = {"rtol": 0.5, "atol": 1e3}  # so that only the greatest step limits
    steps = [
        arm_error(run(max_step=1.0 / n, stop_at_outputs=True, t_eval=TIMES, **loose))
        for n in (200, 400, 800)
    ]
    within = []
    for n in (150, 300, 600):
        found = run(max_step=1.0 / n, t_eval=TIMES, dense_output=True, **loose)
        ends = np.linspace(*SPAN, n + 1)
        # the share of the polynomial alone: in the middle of steps, without what the steps have
        middles = (ends[1:] + ends[:-1]) / 2.0
        of_steps = (found.sol(ends) - TRUTH.sol(ends))[0]
        drift = (of_steps[1:] + of_steps[:-1]) / 2.0
        within.append(np.abs((found.sol(middles) - TRUTH.sol(middles))[0] - drift).max())
    for errors in (steps, within):
        gains = [a / b for a, b in pairwise(errors)]
        assert gains == pytest.approx([32.0, 32.0], rel=0.2), errors


def test_outputs_cost_nothing():
    few, many = run(t_eval=[0.0, 1.0]), run(t_eval=np.linspace(*SPAN, 10_001))
    assert few.nfev == many.nfev == 6 * (few.steps + few.error_test_failures) + 1
    assert few.y[:, -1].tolist() == many.y[:, -1].tolist()


def test_levels_are_passed_where_the_polynomial_passes_them():
    events = [SignalEvent("wheel_center_z", level) for level in np.linspace(0.297, 0.303, 7)]
    found = run(events=events, dense_output=True)
    for event, times in zip(events, found.t_events, strict=True):
        assert times.size
        heights = MODEL.signals(found.sol(times).T)["wheel_center_z"]
        # a velocity of 1 m/s at most, by the resolution of a second
        np.testing.assert_allclose(heights, event.level, rtol=0.0, atol=1e-13)


def test_the_way_back_leads_to_the_start():
    there = run(t_eval=TIMES, rtol=1e-10, atol=1e-13)
    back = simulate(
        MODEL, SPAN[::-1], there.y[:, -1], method="DormandPrince", t_eval=TIMES[::-1], rtol=1e-10,
        atol=1e-13,
    )  # fmt: skip
    # the error of both ways, which damping enlarges on the way back
    assert np.abs(back.y[0, ::-1] - there.y[0]).max() < 1e-6
