"""Where mechanisms rest, against potentials, and against what is known of suspensions."""

import kintrafo
import numpy as np
import pytest
from kintrafo import InputError, Model, System
from kintrafo.equations.errors import ClosureError
from kintrafo.generated import excavator, four_bar, slider_crank

LINKAGE = System(four_bar, {"damper_rate": 0.0})
CAR = Model("reference_car")


@pytest.mark.parametrize("torque", [-3.0, 0.0, 2.0])
@pytest.mark.parametrize("angle", [0.0, 1.0])
def test_a_spring_balances_a_torque(torque, angle):
    """The slope of its energy by the crank's angle, from differences, is the torque."""
    near = LINKAGE.state(crank_angle=angle, crank_angle_rate=5.0)
    found = kintrafo.rest(LINKAGE, near, {"crank_torque": torque})
    rate, free = LINKAGE.parameters["spring_rate"], LINKAGE.parameters["spring_free_length"]

    def energy(by):
        length = LINKAGE.signal("spring_length", LINKAGE.state(crank_angle=found[0] + by))
        return 0.5 * rate * (float(length) - free) ** 2

    slope = (energy(1e-4) - energy(-1e-4)) / 2e-4
    assert slope == pytest.approx(torque, abs=1e-6)
    assert found[1] == 0.0
    assert found.inputs.tolist() == [torque]
    # and it stays there
    motion = kintrafo.simulate(LINKAGE, (0.0, 0.1), found)
    np.testing.assert_allclose(motion.y[0], found[0], atol=1e-9)


def test_a_suspension_rests_where_equilibrium_has_it():
    expected = kintrafo.equilibrium(CAR, rack_position=0.01, road_height=0.02)
    near = expected.copy()
    near[:2] += 0.05, 0.3
    found = kintrafo.rest(CAR, near)
    assert found[0] == pytest.approx(expected[0], abs=1e-11)
    assert found[1] == expected[1] + 0.3  # the wheel is not driven back to any angle
    np.testing.assert_array_equal(found.inputs, expected.inputs)


def test_cylinders_hold_an_excavator():
    """Under the forces that hold it where it is, it rests there, and nowhere near without."""
    system = System(excavator)
    rates = system.evaluate("rhs", system.design_state)
    by_force = system.evaluate("rhs_input_jacobian", system.design_state)[3:]
    forces = np.linalg.solve(by_force, -rates[3:])
    held = dict(zip(system.input_names, forces.tolist(), strict=True))
    start = system.design_state + np.array([0.05, -0.03, 0.02, 0.0, 0.0, 0.0])
    found = kintrafo.rest(system, start, held)
    np.testing.assert_allclose(found, system.design_state, atol=1e-9)


def test_what_is_driven_round_has_no_rest(refused):
    refused(InputError, lambda: kintrafo.rest(System(slider_crank), inputs={"crank_torque": 1.0}))


def test_a_start_that_closes_no_loop_is_refused():
    long_crank = System(four_bar, {"crank_pin_y": 0.25})
    with pytest.raises(ClosureError):
        kintrafo.rest(long_crank, long_crank.state(crank_angle=1.5))


@pytest.mark.parametrize(
    "changes",
    [
        {"system": "four_bar"},
        {"near": [1.0]},
        {"near": [np.nan, 0.0]},
        {"inputs": [1.0]},
        {"inputs": {"torque": 1.0}},
        {"inputs": {"crank_torque": np.inf}},
        {"near": kintrafo.equilibrium(CAR)},
    ],
)
def test_bad_arguments_are_refused(changes, refused):
    refused(InputError, lambda: kintrafo.rest(**{"system": LINKAGE} | changes))
