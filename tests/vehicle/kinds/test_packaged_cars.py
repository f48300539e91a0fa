"""The cars that come with kintrafo: they rest where they should, and do what their files say."""

import numpy as np
import pytest
from kintrafo import (
    Model,
    PositionError,
    SignalEvent,
    SimulationError,
    Suspension,
    equilibrium,
    simulate,
)
from kintrafo.generated import macpherson_general
from kintrafo.vehicle.analysis.checkup import checkup
from kintrafo.vehicle.data.starter import packaged
from kintrafo.vehicle.models.positions import state_at_height

OFFSET = Suspension.load("offset_strut_car")


@pytest.mark.parametrize("name", packaged())
def test_rests_at_design_with_the_wheel_on_the_ground(name):
    model = Model(name)
    at_rest = model.signals(equilibrium(model))
    design = model.signals(model.design_state)
    assert at_rest["wheel_center_z"] == pytest.approx(design["wheel_center_z"], abs=5e-4)
    assert at_rest["tyre_force"] > 500.0  # a racing car weighs little


@pytest.mark.parametrize("name", packaged())
def test_has_nothing_to_be_noted(name):
    assert not checkup(Model(name)).notes


@pytest.fixture(scope="module")
def model():
    return Model(OFFSET)


class TestOffsetStrut:
    def test_has_everything_the_format_has(self, model):
        assert model.equations is macpherson_general
        assert len(OFFSET.beyond_the_paper()) == 9

    def test_strut_axis_passes_30_mm_beside_the_ball_joint(self):
        lower, top, ball = (
            OFFSET.hardpoints.metres(n) for n in ("strut_lower", "strut_top", "ball_joint")
        )
        axis = (top - lower) / np.linalg.norm(top - lower)
        assert np.linalg.norm(np.cross(ball - lower, axis)) == pytest.approx(0.030, abs=3e-4)

    def test_stops_are_reached_before_the_dead_points(self, model):
        """Within 90 mm of travel either stop carries more than the wheel weighs."""
        rest = model.signals(equilibrium(model))
        for name, travel in (("bump_stop_force", 0.06), ("rebound_stop_force", -0.09)):
            there = state_at_height(model, float(rest["wheel_center_z"]) + travel)
            assert abs(model.signal(name, there)) > 1000.0
        with pytest.raises(PositionError):
            state_at_height(model, 1.0)


ROAD = {"road_height": ([0.0, 0.1, 0.1, 0.3, 0.3, 1.0], [0.0, 0.0, -0.06, -0.06, 0.02, 0.02])}
LANDINGS = ["wheel_leaves_ground", "wheel_touches_ground"]


class TestInTheAir:
    @pytest.mark.parametrize("backend", ["sundials", "scipy"])
    def test_leaves_the_ground_over_a_step_and_lands(self, model, backend):
        if backend == "sundials":
            pytest.importorskip("kintrafo.simulation.native._sundials")
        result = simulate(
            model, (0.0, 1.0), equilibrium(model), inputs=ROAD, events=LANDINGS, backend=backend
        )
        leaves, touches = result.t_events
        # the road falls away at 0.1 s at once, and kicks the wheel up at 0.3 s
        assert leaves[0] == 0.1
        assert 0.1 < touches[0] < 0.2
        assert 0.3 < leaves[1] < touches[1] < 0.4
        force = result.signals["tyre_force"]
        in_the_air = (result.t > leaves[0]) & (result.t < touches[0])
        assert in_the_air.any()
        assert (force[in_the_air] == 0.0).all()
        assert (force >= 0.0).all()

    def test_a_jump_may_end_the_simulation(self, model):
        event = SignalEvent("tyre_force", 1.0, direction=-1.0, terminal=True)
        result = simulate(model, (0.0, 1.0), equilibrium(model), inputs=ROAD, events=event)
        assert result.status == 1
        assert result.t_events[0].tolist() == [0.1]
        assert result.t[-1] == 0.1

    def test_a_jump_the_other_way_is_let_pass(self, model):
        event = SignalEvent("tyre_force", 1.0, direction=+1.0)
        result = simulate(model, (0.0, 0.12), equilibrium(model), inputs=ROAD, events=event)
        assert result.t_events[0].size == 0

    def test_an_event_that_stays_at_zero_is_named(self, model, refused):
        pytest.importorskip("kintrafo.simulation.native._sundials")
        event = SignalEvent("tyre_force", 0.0)
        refused(
            SimulationError,
            lambda: simulate(model, (0.0, 1.0), equilibrium(model), inputs=ROAD, events=event),
        )
