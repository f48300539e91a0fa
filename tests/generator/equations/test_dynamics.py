"""Equations of motion against maximal coordinates with Lagrange multipliers.

The oracle refines its solutions in extended precision, so that its accelerations are good to about
1e-12; the closed form loses as much in differences of its terms. 1e-10 is asked for.
"""

from dataclasses import replace

import numpy as np
import pytest
from cars.instants import MODELS, At, Instant, car_parameters, counted_by, of_model, random_instants
from kintrafo.generated import macpherson, macpherson_general
from oracle.constraints import WHEEL
from oracle.newton import Mechanism, observe
from oracle.reference import (
    BETA1_DESIGN,
    DAMPER_SEGMENTS,
    EIGENVALUES_AT_REST,
    SPIN_RATE,
    reference_parameters,
)

SEEDS = range(8)  # 0 is the reference car; the others have full tensors and general hardpoints
POINTS = 4  # for each car

each_with_held_rack = pytest.mark.parametrize(
    "model", [macpherson, macpherson_general], ids=lambda model: model.NAME
)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("model", MODELS.values(), ids=MODELS.keys())
def test_accelerations(model, seed):
    parameters = car_parameters(seed, model)
    car = Mechanism(counted_by(model, parameters))
    constants = model.prepare(parameters)
    for instant in random_instants(np.random.default_rng(100 + seed), car, POINTS):
        at = At(model, instant, constants)
        expected = instant.solution(model, car).coordinate_accelerations[: at.size]
        # Relative to the acceleration itself, or to 1 rad/s² or m/s² where it happens to be small
        # beside the usual hundreds and thousands.
        assert at("rhs")[at.size :] == pytest.approx(expected, rel=1e-10, abs=1e-10)


def regimes(car, instant, solution):
    """Say on which side of every kink of the force laws an instant is."""
    given, seen = car.parameters, observe(car, instant.pose(car))
    knots = [given[f"damper_table_knot_{i}"] for i in range(DAMPER_SEGMENTS + 1)]
    found = {f"damper segment {np.searchsorted(knots, solution.strut_slide_rate)}"}
    found.add("bump stop" if seen.strut_length < given["bump_stop_length"] else "no bump stop")
    found.add(
        "rebound stop" if seen.strut_length > given["rebound_stop_length"] else "no rebound stop"
    )
    deflection = given["tyre_free_height"] + instant.road_height - seen.wheel_center[2]
    closing = instant.road_velocity - solution.twist[WHEEL - 1, 2]
    load = given["tyre_rate"] * deflection + given["tyre_damper_rate"] * closing
    in_air = "leaves the road" if load > 0.0 else "in the air"
    on_road = "pressed" if load > 0.0 else "pulled off"
    return found | {f"tyre {on_road if deflection > 0.0 else in_air}"}


def test_every_regime_of_the_force_laws():
    """Each segment of the damper, each stop, and all that a tyre can do, against the oracle."""
    model = macpherson_general
    parameters = car_parameters(1, model)
    car, constants = Mechanism(counted_by(model, parameters)), model.prepare(parameters)
    reached = set()
    for instant in random_instants(np.random.default_rng(0), car, 150):
        solution = instant.solution(model, car)
        reached |= regimes(car, instant, solution)
        found = At(model, instant, constants)("rhs")[2:]
        # as for all accelerations
        expected = solution.coordinate_accelerations[:2]
        assert found == pytest.approx(expected, rel=1e-10, abs=1e-10)
    assert reached == {
        *(f"damper segment {i}" for i in range(DAMPER_SEGMENTS + 2)),
        *("bump stop", "no bump stop", "rebound stop", "no rebound stop"),
        *(f"tyre {what}" for what in ("pressed", "pulled off", "in the air", "leaves the road")),
    }


@each_with_held_rack
@pytest.mark.parametrize("seed", SEEDS)
def test_held_rack(model, seed):
    """With the rack held, its velocity and acceleration are zero for any inputs."""
    parameters = car_parameters(seed, model)
    constants = model.prepare(parameters)
    rng = np.random.default_rng(seed)
    for instant in random_instants(rng, Mechanism(parameters), POINTS):
        state, inputs = instant.arrays(model)
        still = replace(instant, rack_rate=0.0, rack_acceleration=0.0).inputs(model)
        for function in ("rhs", "rhs_jacobian"):
            general = getattr(model, function)(state, still, constants)
            held = getattr(model, f"{function}_rack_held")(state, inputs, constants)
            # Another order of the same operations. Elements that are small beside the largest
            # (the tyre's rigidity over the mass) are differences of terms of its size.
            assert held == pytest.approx(general, rel=1e-11, abs=1e-13 * np.abs(general).max())


@each_with_held_rack
@pytest.mark.parametrize("seed", range(1, 4))
def test_masses_left_out(model, seed):
    """The models with a prescribed rack do not ask for masses that they leave out."""
    parameters = car_parameters(seed, model)
    constants = model.prepare(parameters)
    state, inputs = Instant(BETA1_DESIGN, 0.0, 0.01, 2.0, 50.0, 0.3).arrays(model)
    without = model.prepare(counted_by(model, parameters))
    assert model.rhs(state, inputs, constants).tolist() == (
        model.rhs(state, inputs, without).tolist()
    )


def test_defaults_are_the_reference_car():
    """In both models, so that a call without constants means the same car."""
    for model in MODELS.values():
        constants = model.prepare(of_model(model, reference_parameters()))
        # where the spring is free is a difference of lengths in one model and a length in the other
        assert pytest.approx(constants, rel=1e-15, abs=1e-16) == model.DEFAULT_CONSTANTS


def test_reference_car_rests_at_design():
    """Spring and tyre carry the car at a wheel height of 0.3 m, at any speed of the wheel."""
    for spin_rate in (0.0, SPIN_RATE):
        state = Instant(BETA1_DESIGN, spin_rate=spin_rate).state(macpherson)
        # Lengths of 1 m are rounded by 1e-16 m, times a tyre rate of 2e5 N/m at 0.4 m over an
        # inertia of 5 kg m²: some 1e-12 rad/s² remain.
        assert np.abs(macpherson.rhs_rack_held(state)[2:]).max() < 1e-11


def test_eigenvalues_at_rest():
    state = Instant(BETA1_DESIGN, spin_rate=SPIN_RATE).state(macpherson)
    matrix = macpherson.rhs_jacobian_rack_held(state)
    found = np.linalg.eigvals(matrix)
    vertical = found[np.abs(found) > 1.0]
    # given with eight decimals
    assert sorted(vertical, key=lambda value: -value.imag) == pytest.approx(
        EIGENVALUES_AT_REST, abs=1e-8
    )
    # Nothing depends on the spin angle, nor anything but the spin angle on the spin rate.
    rest = found[np.abs(found) <= 1.0]
    assert rest.tolist() == [0.0, 0.0]
    assert matrix[:, 1].tolist() == [0.0] * 4
    assert matrix[:, 3].tolist() == [0.0, 1.0, 0.0, 0.0]
