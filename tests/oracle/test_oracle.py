"""The oracles: what they agree on with each other, and what they refuse."""

import numpy as np
import pytest

from oracle import laws
from oracle.multipliers import reduced_equations, solve_twist
from oracle.newton import AssemblyError, Mechanism, observe, residual_norm, solve_pose
from oracle.reference import (
    BETA1_DESIGN,
    GENERAL_BODIES,
    HARDPOINTS,
    STAND_INS,
    completed,
    general_parameters,
    inertia,
    mirrored_parameters,
    perturbed_parameters,
    reference_parameters,
    set_inertia,
    set_vector,
    vector,
)

ROUND_OFF = 1e-14


@pytest.fixture(scope="module")
def car():
    return Mechanism(reference_parameters())


@pytest.fixture(
    scope="module",
    params=[(make, seed) for make in (perturbed_parameters, general_parameters) for seed in (0, 1)],
    ids=lambda value: f"{value[0].__name__}-{value[1]}",
)
def other_car(request):
    make, seed = request.param
    return Mechanism(make(np.random.default_rng(seed)))


def central_difference(function, step):
    """Differentiate at zero with an error of the order of step**6."""
    total = np.zeros_like(function(0.0))
    for factor, weight in ((1, 45.0), (2, -9.0), (3, 1.0)):
        total = total + weight * (function(factor * step) - function(-factor * step))
    return total / (60.0 * step)


def partial_derivatives(function, size, step):
    """Differentiate at zero with respect to each of `size` arguments, along the first axis."""
    directions = np.broadcast_to(step, (size,))[:, None] * np.eye(size)

    def along(direction):
        length = float(np.linalg.norm(direction))
        return central_difference(lambda h: function(h / length * direction), length)

    return np.array([along(direction) for direction in directions])


class Path:
    """A smooth motion of the independent coordinates, known with its derivatives at t = 0."""

    value = np.array([0.1, 0.7, -0.015])  # added to the design angle, spin, rack
    rate = np.array([2.3, 60.0, 0.4])
    acceleration = np.array([-310.0, 45.0, 7.0])

    def __init__(self, mechanism):
        self._mechanism = mechanism
        self.start = self.pose(0.0)

    def pose(self, t):
        beta1, spin, rack = self.value + t * self.rate + 0.5 * t**2 * self.acceleration
        start = getattr(self, "start", None)
        return solve_pose(self._mechanism, self._mechanism.beta1_design + beta1, rack, spin, start)


def test_parameters_round_trip():
    parameters = perturbed_parameters(np.random.default_rng(7))
    copy = dict(parameters)
    for body in GENERAL_BODIES:
        tensor = inertia(parameters, body)
        assert np.linalg.eigvalsh(tensor).min() > 0.0
        set_inertia(copy, body, tensor)
    for name in HARDPOINTS:
        set_vector(copy, name, vector(parameters, name))
    assert copy == parameters
    general = general_parameters(np.random.default_rng(7))
    assert mirrored_parameters(mirrored_parameters(general)) == general
    assert completed(general) == general
    assert mirrored_parameters(mirrored_parameters(parameters)) == parameters


def test_design_position(car):
    assert car.beta1_design == pytest.approx(BETA1_DESIGN, abs=1e-15)
    assert car.joints.size == 33
    assert residual_norm(car, car.design) < ROUND_OFF


@pytest.mark.parametrize(("arm", "rack"), [(0.0, 0.3), (0.0, -0.3), (-1.44, 0.0)])
def test_refuses_what_cannot_be_assembled(car, arm, rack):
    with pytest.raises(AssemblyError):
        solve_pose(car, car.beta1_design + arm, rack)


def test_lagrange_equations_from_energies_alone(other_car):
    """d/dt (dT/dq') - dT/dq = Q, with T from the twists and no acceleration or Euler equation."""
    path = Path(other_car)
    q = np.array([other_car.beta1_design + path.value[0], path.value[1], path.value[2]])

    def mass_matrix(coordinates):
        pose = solve_pose(other_car, coordinates[0], coordinates[2], coordinates[1], path.start)
        unit = [solve_twist(other_car, pose, *column) for column in np.eye(3)]
        matrix = np.zeros((3, 3))
        for i in range(3):
            for j in range(3):
                for body in range(6):
                    rotation = pose.rotation[body]
                    local_i, local_j = (unit[k][body, 3:] @ rotation for k in (i, j))
                    matrix[i, j] += (
                        other_car.masses[body] * (unit[i][body, :3] @ unit[j][body, :3])
                        + local_i @ other_car.inertias[body] @ local_j
                    )
        return matrix

    gradient = partial_derivatives(lambda change: mass_matrix(q + change), 3, 2e-3)
    matrix_rate = np.einsum("kij,k->ij", gradient, path.rate)
    inertial = matrix_rate @ path.rate - 0.5 * np.einsum(
        "kij,i,j->k", gradient, path.rate, path.rate
    )
    reduced = reduced_equations(other_car, path.start, *path.rate)
    assert reduced.mass_matrix == pytest.approx(mass_matrix(q), rel=1e-12)
    assert reduced.inertial == pytest.approx(inertial, rel=1e-8, abs=1e-7)


def test_generalised_forces_are_virtual_work(other_car):
    """The forces again, from the points and directions in words, by displacing them."""
    path = Path(other_car)
    given = other_car.parameters
    inputs = {"rack_force": 55.0, "road_height": 0.05, "road_velocity": 0.4, "strut_force": 700.0}
    reduced = reduced_equations(other_car, path.start, *path.rate, **inputs)

    def length(t):
        return np.array(observe(other_car, path.pose(t)).strut_length)

    def height(t):
        return np.array(observe(other_car, path.pose(t)).wheel_center[2])

    now = observe(other_car, path.start)
    speed = -float(central_difference(length, 1e-4))
    push = (
        given["damper_rate"] * speed
        + laws.damper_curve(given)(speed)
        + given["strut_friction"] * speed / np.hypot(speed, given["strut_friction_speed"])
        + inputs["strut_force"]
    )
    for side, sense in (("bump", 1.0), ("rebound", -1.0)):
        depth = max(sense * (given[f"{side}_stop_length"] - now.strut_length), 0.0)
        rate, cubic = (given[f"{side}_stop_{name}"] for name in ("rate", "progression"))
        push += sense * (rate * depth + cubic * depth**3)
    coil = laws.spring_force(given, now.spring_length)
    squeeze = given["tyre_free_height"] + inputs["road_height"] - now.wheel_center[2]
    closing = inputs["road_velocity"] - float(central_difference(height, 1e-4))
    load = given["tyre_rate"] * squeeze + given["tyre_damper_rate"] * closing
    if given["tyre_lifts_off"]:
        load = max(load, 0.0) if squeeze > 0.0 else 0.0
    sine = now.spin_axis[2]
    tyre = load * (np.array([0.0, 0.0, 1.0]) - sine * now.spin_axis) / (1.0 - sine**2)

    def work(step):
        beta1, spin, rack = path.value + step
        pose = solve_pose(other_car, other_car.beta1_design + beta1, rack, spin, path.start)
        there = observe(other_car, pose)
        return np.array(
            push * there.strut_length
            + coil * there.spring_length
            + tyre @ there.wheel_center
            + inputs["rack_force"] * there.rack
            - given["gravity"] * other_car.masses @ pose.position[:, 2]
        )

    expected = partial_derivatives(work, 3, 1e-3)
    assert reduced.applied == pytest.approx(expected, rel=1e-9, abs=1e-8)


def test_absent_parts_are_the_papers_suspension():
    parameters = perturbed_parameters(np.random.default_rng(3))
    complete = completed(parameters)
    assert {name: complete[name] for name in parameters} == parameters
    for name, stand_in in STAND_INS.items():
        assert vector(complete, name).tolist() == vector(parameters, stand_in).tolist()
    for length in (0.0, 0.4, 0.85):
        for side in ("bump", "rebound"):
            assert laws.stop_force(complete, side, length) == 0.0
    assert laws.friction_force(complete, 0.3) == 0.0
    assert laws.damper_force(complete, 0.3) == 0.3 * parameters["damper_rate"]
    assert laws.tyre_load(complete, -0.01, 5.0) == -0.01 * parameters["tyre_rate"]
