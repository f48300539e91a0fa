"""Damper curve, friction, stops and a tyre that lifts off, in the input file of a double wishbone.

The equations are compared with maximal coordinates in `test_mechanisms`.
"""

import kintrafo
import numpy as np
import pytest
from kintrafo import Model, Suspension
from kintrafo.generated import double_wishbone, double_wishbone_general

CAR = Suspension.load("double_wishbone_car")
PLAIN = Model(CAR)
VELOCITIES = (-1.0, -0.3, -0.05, 0.0, 0.05, 0.3, 1.0)
FORCES = (-2500.0, -1300.0, -400.0, 0.0, 250.0, 600.0, 1100.0)
CURVE = {
    "damper.rate_N_s_per_m": None,
    "damper.velocity_m_per_s": list(VELOCITIES),
    "damper.force_N": list(FORCES),
}
STOPS = {
    "bump_stop": {"clearance_mm": 20.0, "rate_N_per_m": 2e4, "progression_N_per_mm3": 0.02},
    "rebound_stop": {"clearance_mm": 30.0, "rate_N_per_m": 5e4},
}


def with_sections(**sections):
    return Suspension.from_dict(CAR.to_dict() | sections)


@pytest.mark.parametrize(
    "changes",
    [
        CURVE,
        {"damper.friction_N": 10.0},
        {"tyre.lifts_off": True},
        {"tyre.damper_rate_N_s_per_m": 5.0},
    ],
    ids=lambda changes: next(iter(changes)),
)
def test_only_what_has_more_is_solved_by_longer_equations(changes):
    assert PLAIN.equations is double_wishbone
    model = Model(CAR.with_changes(changes))
    assert model.equations is double_wishbone_general
    assert set(model.suspension.parameters()) == set(double_wishbone_general.PARAMETERS)
    assert len(model.suspension.beyond_the_plain()) == 1


def test_with_all_of_it_switched_off_the_numbers_are_those_of_the_plain_one():
    off = with_sections(bump_stop={"clearance_mm": 20.0, "rate_N_per_m": 0.0})
    model, random = Model(off), np.random.default_rng(3)
    assert model.equations is double_wishbone_general
    for _ in range(20):
        state = PLAIN.design_state + random.normal(size=4) * [0.1, 3.0, 2.0, 50.0]
        values = random.normal(size=5) * [0.02, 0.3, 5.0, 300.0, 0.01]
        given = dict(zip(PLAIN.input_names, values, strict=True))
        found = model.evaluate("rhs", state, model.inputs(given))
        expected = PLAIN.evaluate("rhs", state, PLAIN.inputs(given))
        # a longer sum of the same forces, of which accelerations are small differences
        assert found == pytest.approx(expected, rel=1e-11, abs=1e-9)


def test_events_of_the_stops():
    model = Model(with_sections(**STOPS))
    start = kintrafo.state_at_height(model, 0.2)
    events = ("spring_reaches_bump_stop", "spring_reaches_rebound_stop")
    result = kintrafo.simulate(model, (0.0, 0.5), start, events=events)
    design = float(model.signal("spring_length", model.design_state))
    for times, states, reached in zip(
        result.t_events, result.y_events, (design - 0.02, design + 0.03), strict=True
    ):
        for _, state in zip(times, states, strict=True):
            assert float(model.signal("spring_length", state)) == pytest.approx(reached, abs=1e-7)
    assert len(result.t_events[0]) >= 1  # let go in rebound, it is thrown up to the other stop
