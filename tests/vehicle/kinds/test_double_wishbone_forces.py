"""Damper curve, friction, stops and a tyre that lifts off, in a double wishbone, over time.

The equations are compared with maximal coordinates in `test_mechanisms`. Here they are seen through
the input file, and over time: what they gain and lose is what the forces give and take.
"""

import kintrafo
import numpy as np
import pytest
from kintrafo import Model, Suspension
from kintrafo.generated import double_wishbone, double_wishbone_general
from kintrafo.generator.mechanisms.double_wishbone import MODELS
from own_models import Built
from scipy.integrate import solve_ivp

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


class Bench:
    """A wheel that hops over a road that it leaves, with the work of what is not conserved."""

    def __init__(self):
        car = with_sections(**STOPS).with_changes(
            CURVE
            | {
                "damper.friction_N": 50.0,
                "tyre.lifts_off": True,
                "tyre.damper_rate_N_s_per_m": 80.0,
            }
        )
        self.model = Model(car)
        self.built = Built(MODELS[1], self.model.equations, self.model.parameters)
        self.oracle = self.built.oracle

    def inputs(self, time):
        phase = 8.0 * np.pi * time
        road = {
            "road_height": 0.04 * np.sin(phase),
            "road_velocity": 0.04 * 8.0 * np.pi * np.cos(phase),
        }
        return self.model.inputs(road)

    def rate(self, time, state):
        """Return the rate of the state, and the power of damper, friction and tyre."""
        inputs = self.inputs(time)
        found = self.model.signals(state[:4], inputs)
        lost = (found["damper_force"] + found["friction_force"]) * found["spring_velocity"]
        # the tyre's force of `signals` is along the wheel's plane; its rise is what counts
        motion = self.built.motion(state[:4], inputs)
        tyre = self.oracle.wrench(motion, dict(zip(self.model.input_names, inputs, strict=True)))
        conserved = self.power_of_the_rest(motion)
        power = tyre @ motion.twist[1:].ravel() - conserved
        return np.append(self.model.evaluate("rhs", state[:4], inputs), [power, float(lost)])

    def power_of_the_rest(self, motion):
        """Return the power of weight, spring and stops: minus the rate of their energy."""
        found = self.model.parameters
        spring = self.oracle.mechanism.elements[0]
        length = self.oracle.length(motion, spring)
        x, rate = float(length.value[0]), float(length.rate[0])
        force = found["spring_rate"] * (found["spring_free_length"] - x)
        for side, sense in (("bump", 1.0), ("rebound", -1.0)):
            depth = max(sense * (found[f"{side}_stop_length"] - x), 0.0)
            stop = found[f"{side}_stop_rate"] * depth
            force += sense * (stop + found[f"{side}_stop_progression"] * depth**3)
        weight = -found["gravity"] * self.oracle.mass @ motion.twist[:, 2]
        return force * rate + weight


def test_energy_is_what_damper_friction_and_tyre_leave():
    bench = Bench()
    start = np.append(kintrafo.state_at_height(bench.model, 0.34, spin_rate=60.0), [0.0, 0.0])
    times = np.linspace(0.0, 0.3, 31)
    result = solve_ivp(
        bench.rate, (0.0, 0.3), start, t_eval=times, method="DOP853", rtol=1e-9, atol=1e-10,
        max_step=1e-3,
    )  # fmt: skip
    energies, loads, stopped = [], [], []
    for time, state in zip(times, result.y.T, strict=True):
        inputs = bench.inputs(time)
        energies.append(bench.oracle.energy(bench.built.motion(state[:4], inputs)))
        found = bench.model.signals(state[:4], inputs)
        loads.append(float(found["tyre_force"]))
        stopped.append(float(found["bump_stop_force"] - found["rebound_stop_force"]))
    work, lost = result.y[4], result.y[5]
    change = np.array(energies) - energies[0]
    # kilojoules to the tolerance of the integration, over kinks at landings and at the stops
    assert change == pytest.approx(work, abs=2e-5)
    assert lost[-1] < -100.0
    assert min(loads) == 0.0  # it was in the air
    assert max(stopped) > 100.0  # and at the stops
