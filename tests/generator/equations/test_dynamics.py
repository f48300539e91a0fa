"""Equations of motion against maximal coordinates with Lagrange multipliers.

The oracle refines its solutions in extended precision, so that its accelerations are good to about
1e-12; the closed form loses as much in differences of its terms. 1e-10 is asked for.
"""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from cases import (
    MODELS,
    At,
    Instant,
    car_parameters,
    counted_by,
    is_prescribed,
    of_model,
    random_instants,
)
from kintrafo.generated import macpherson, macpherson_general
from oracle.constraints import WHEEL
from oracle.multipliers import ReducedEquations, Solution, reduced_equations
from oracle.newton import Mechanism, observe
from oracle.reference import (
    BETA1_DESIGN,
    DAMPER_SEGMENTS,
    EIGENVALUES_AT_REST,
    SPIN_RATE,
    reference_parameters,
    set_inertia,
)

SEEDS = range(8)  # 0 is the reference car; the others have full tensors and general hardpoints
POINTS = 4  # for each car

each_with_held_rack = pytest.mark.parametrize(
    "model", [macpherson, macpherson_general], ids=lambda model: model.NAME
)


@dataclass(frozen=True)
class Compared(At):
    """A model at an instant, with the results of the oracle."""

    solution: Solution
    reduced: ReducedEquations


@pytest.fixture(
    scope="module",
    params=[(name, seed) for name in MODELS for seed in SEEDS],
    ids=lambda value: f"{value[0]}-car{value[1]}",
)
def compared(request: pytest.FixtureRequest) -> list[Compared]:
    name, seed = request.param
    model = MODELS[name]
    parameters = car_parameters(seed, model)
    car = Mechanism(counted_by(model, parameters))
    constants = model.prepare(parameters)
    return [
        Compared(model, instant, constants, instant.solution(model, car), instant.reduced(car))
        for instant in random_instants(np.random.default_rng(100 + seed), car, POINTS)
    ]


def test_accelerations(compared: list[Compared]) -> None:
    for case in compared:
        expected = case.solution.coordinate_accelerations[: case.size]
        found = case("rhs")[case.size :]
        # Relative to the acceleration itself, or to 1 rad/s² or m/s² where it happens to be small
        # beside the usual hundreds and thousands.
        assert found == pytest.approx(expected, rel=1e-10, abs=1e-10)


def test_rates(compared: list[Compared]) -> None:
    """The first half of the right-hand side is the second half of the state, bit for bit."""
    for case in compared:
        assert case("rhs")[: case.size].tolist() == case.state[case.size :].tolist()


def test_mass_matrix(compared: list[Compared]) -> None:
    for case in compared:
        matrix = case("mass_matrix")
        expected = case.reduced.mass_matrix[: case.size, : case.size]
        # some hundred roundings of the largest element
        assert matrix == pytest.approx(expected, rel=1e-13, abs=1e-13 * np.abs(expected).max())
        assert matrix.tolist() == matrix.T.tolist()
        assert np.linalg.eigvalsh(matrix).min() > 0.0


def test_bias(compared: list[Compared]) -> None:
    for case in compared:
        expected = case.reduced.inertial[: case.size].copy()
        if is_prescribed(case.model):  # the prescribed acceleration of the rack is part of B
            column = case.reduced.mass_matrix[: case.size, 2]
            expected += column * case.instant.rack_acceleration
        # the terms of B are of the size of its largest element, which all elements share
        assert case("bias") == pytest.approx(expected, rel=0.0, abs=1e-11 * np.abs(expected).max())


def test_forces(compared: list[Compared]) -> None:
    for case in compared:
        expected = case.reduced.applied[: case.size]
        # Spring and tyre, up to 30 kN at an arm of 0.4 m, may nearly balance (3e-11 N m at worst).
        assert case("forces") == pytest.approx(expected, rel=1e-11, abs=1e-9)


def regimes(car: Mechanism, instant: Instant, solution: Solution) -> set[str]:
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


def test_every_regime_of_the_force_laws() -> None:
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


@pytest.mark.parametrize(
    "parameter",
    [
        "spring_rate",
        "damper_rate",
        "damper_table_first_force",
        "strut_friction",
        "bump_stop_rate",
        "bump_stop_progression",
        "rebound_stop_rate",
        "rebound_stop_progression",
        "tyre_rate",
        "tyre_damper_rate",
    ],
)
def test_each_force_by_itself(parameter: str) -> None:
    """A parameter changes Q by its own force alone: no other force can hide its error."""
    model = macpherson_general
    parameters = car_parameters(1, model)
    car = Mechanism(parameters)
    acted = False
    for instant in random_instants(np.random.default_rng(7), car, 8):
        changed = parameters | {parameter: 3.0 * parameters[parameter]}
        found, expected = [], []
        for each in (parameters, changed):
            other = Mechanism(each)
            found.append(At(model, instant, model.prepare(each))("forces"))
            expected.append(instant.reduced(other).applied[:2])
        change = expected[1] - expected[0]
        acted |= bool(np.abs(change).max() > 1.0)
        # differences of sums of up to 1e5 N m
        assert found[1] - found[0] == pytest.approx(change, rel=1e-9, abs=1e-9)
    assert acted


def test_equations_of_motion(compared: list[Compared]) -> None:
    """M q'' + B = Q: forward dynamics solves what M, B and Q say."""
    for case in compared:
        inertia = case("mass_matrix") @ case("rhs")[case.size :]
        bias, forces = case("bias"), case("forces")
        size = max(np.abs(inertia).max(), np.abs(bias).max(), np.abs(forces).max())
        # two derivations of the same sums: some hundred roundings of the largest term
        assert np.abs(inertia + bias - forces).max() < 1e-13 * size


@each_with_held_rack
@pytest.mark.parametrize("seed", SEEDS)
def test_held_rack(model, seed: int) -> None:
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
def test_masses_left_out(model, seed: int) -> None:
    """The models with a prescribed rack do not ask for masses that they leave out."""
    parameters = car_parameters(seed, model)
    constants = model.prepare(parameters)
    state, inputs = Instant(BETA1_DESIGN, 0.0, 0.01, 2.0, 50.0, 0.3).arrays(model)
    without = model.prepare(counted_by(model, parameters))
    assert model.rhs(state, inputs, constants).tolist() == (
        model.rhs(state, inputs, without).tolist()
    )


@pytest.mark.parametrize("element", ["xx", "yy", "zz", "xy", "xz", "yz"])
@pytest.mark.parametrize("body", ["control_arm", "knuckle", "tie_rod", "rack", "upper_strut"])
def test_every_element_of_inertia_counts(body: str, element: str) -> None:
    """Each single element changes M like that of the oracle, where the body turns about it.

    The rack only slides, and the arm only turns about its hinge (here along x): the other elements
    must not matter.
    """
    model = MODELS["macpherson_free_rack"]
    parameters = car_parameters(0)
    instant = Instant(BETA1_DESIGN - 0.2, 0.0, 0.02)
    tensor = np.diag([0.3, 0.3, 0.3])
    matrices = []
    for addition in (0.0, 0.1):
        i, j = ("xyz".index(axis) for axis in element)
        tensor[i, j] += addition
        tensor[j, i] = tensor[i, j]
        set_inertia(parameters, body, tensor)
        found = model.mass_matrix(*instant.arrays(model), model.prepare(parameters))
        car = Mechanism(parameters)
        expected = reduced_equations(car, instant.pose(car), 0.0, 0.0).mass_matrix
        # some hundred roundings of elements of up to 10 kg m²
        assert found == pytest.approx(expected, rel=1e-12, abs=1e-12)
        matrices.append(found)
    change = np.abs(matrices[1] - matrices[0]).max()
    idle = body == "rack" or (body == "control_arm" and element != "xx")
    assert (change == 0.0) if idle else (change > 1e-6)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_papers_suspension_is_a_special_case(seed: int) -> None:
    """With an axis through the ball joint and without the rest, the general model is the other.

    Two derivations in different axes: lengths agree to a few roundings of 1e-16 m, which the tyre's
    2e5 N/m, over a mass of some 40 kg, makes some 1e-11 m/s² of.
    """
    shared = car_parameters(seed)
    special, general = macpherson, macpherson_general
    theirs, ours = special.prepare(shared), general.prepare(of_model(general, shared))
    for instant in random_instants(np.random.default_rng(seed), Mechanism(shared), POINTS):
        for name in (
            *("rhs", "rhs_jacobian", "rhs_rack_held", "rhs_jacobian_rack_held"),
            *("mass_matrix", "bias", "forces", "relative_coordinates", "relative_jacobian"),
            *("absolute_jacobian", "global_jacobian"),
            *("positions", "orientations", "velocities"),
        ):
            expected = At(special, instant, theirs)(name)
            found = At(general, instant, ours)(name)
            assert found == pytest.approx(expected, rel=1e-11, abs=1e-12 * np.abs(expected).max())
        expected = dict(zip(special.SIGNALS, At(special, instant, theirs)("signals"), strict=True))
        found = dict(zip(general.SIGNALS, At(general, instant, ours)("signals"), strict=True))
        assert {name: found[name] for name in expected} == pytest.approx(
            expected, rel=1e-11, abs=1e-10
        )
        for name in ("friction_force", "bump_stop_force", "rebound_stop_force"):
            assert found[name] == 0.0


def test_defaults_are_the_reference_car() -> None:
    """In both models, so that a call without constants means the same car."""
    for model in MODELS.values():
        constants = model.prepare(of_model(model, reference_parameters()))
        # where the spring is free is a difference of lengths in one model and a length in the other
        assert pytest.approx(constants, rel=1e-15, abs=1e-16) == model.DEFAULT_CONSTANTS


def test_reference_car_rests_at_design() -> None:
    """Spring and tyre carry the car at a wheel height of 0.3 m, at any speed of the wheel."""
    for spin_rate in (0.0, SPIN_RATE):
        state = Instant(BETA1_DESIGN, spin_rate=spin_rate).state(macpherson)
        # Lengths of 1 m are rounded by 1e-16 m, times a tyre rate of 2e5 N/m at 0.4 m over an
        # inertia of 5 kg m²: some 1e-12 rad/s² remain.
        assert np.abs(macpherson.rhs_rack_held(state)[2:]).max() < 1e-11


def test_eigenvalues_at_rest() -> None:
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


def test_gyroscopic_couple() -> None:
    """A turning steer adds to the arm's acceleration in proportion to the spin rate."""
    accelerations = [
        macpherson.rhs(*Instant(BETA1_DESIGN, 0.0, 0.01, 0.0, rate, 0.5).arrays(macpherson))[2]
        for rate in (0.0, 50.0, 100.0)
    ]
    first, second = np.diff(accelerations)
    assert abs(first) > 0.1
    # a difference of accelerations of some 10 rad/s², each good to 1e-13
    assert second == pytest.approx(first, rel=1e-10)
