"""The oracles against the reference car, and against themselves where two ways lead to a value."""

from collections.abc import Callable
from functools import partial

import numpy as np
import numpy.typing as npt
import pytest
from scipy.interpolate import PchipInterpolator

from oracle import laws
from oracle.constraints import KNUCKLE, RACK, WHEEL, Array, Pose
from oracle.multipliers import (
    Solution,
    reduced_equations,
    simulate,
    solve_free,
    solve_prescribed,
    solve_twist,
)
from oracle.newton import (
    AssemblyError,
    Mechanism,
    observe,
    residual_norm,
    solve_pose,
    solve_pose_at_height,
)
from oracle.reference import (
    BETA1_DESIGN,
    DYNAMICS,
    EIGENVALUES_AT_REST,
    GENERAL_BODIES,
    HARDPOINTS,
    KINEMATICS,
    SPIN_RATE,
    STAND_INS,
    completed,
    general_parameters,
    inertia,
    mirrored_parameters,
    perturbed_parameters,
    reference_parameters,
    set_damper_curve,
    set_inertia,
    set_vector,
    vector,
)

ROUND_OFF = 1e-14


@pytest.fixture(scope="module")
def car() -> Mechanism:
    return Mechanism(reference_parameters())


@pytest.fixture(
    scope="module",
    params=[(make, seed) for make in (perturbed_parameters, general_parameters) for seed in (0, 1)],
    ids=lambda value: f"{value[0].__name__}-{value[1]}",
)
def other_car(request: pytest.FixtureRequest) -> Mechanism:
    make, seed = request.param
    return Mechanism(make(np.random.default_rng(seed)))


def central_difference(function: Callable[[float], Array], step: float) -> Array:
    """Differentiate at zero with an error of the order of step**6."""
    total = np.zeros_like(function(0.0))
    for factor, weight in ((1, 45.0), (2, -9.0), (3, 1.0)):
        total = total + weight * (function(factor * step) - function(-factor * step))
    return total / (60.0 * step)


def partial_derivatives(
    function: Callable[[Array], Array], size: int, step: npt.ArrayLike
) -> Array:
    """Differentiate at zero with respect to each of `size` arguments, along the first axis."""
    directions = np.broadcast_to(step, (size,))[:, None] * np.eye(size)

    def along(direction: Array) -> Array:
        length = float(np.linalg.norm(direction))
        return central_difference(lambda h: function(h / length * direction), length)

    return np.array([along(direction) for direction in directions])


class Path:
    """A smooth motion of the independent coordinates, known with its derivatives at t = 0."""

    value = np.array([0.1, 0.7, -0.015])  # added to the design angle, spin, rack
    rate = np.array([2.3, 60.0, 0.4])
    acceleration = np.array([-310.0, 45.0, 7.0])

    def __init__(self, mechanism: Mechanism) -> None:
        self._mechanism = mechanism
        self.start = self.pose(0.0)

    def pose(self, t: float) -> Pose:
        beta1, spin, rack = self.value + t * self.rate + 0.5 * t**2 * self.acceleration
        start = getattr(self, "start", None)
        return solve_pose(self._mechanism, self._mechanism.beta1_design + beta1, rack, spin, start)

    def twist(self, t: float) -> Array:
        rates = self.rate + t * self.acceleration
        return solve_twist(self._mechanism, self.pose(t), *rates)


def test_parameters_round_trip() -> None:
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


def test_design_position(car: Mechanism) -> None:
    assert car.beta1_design == pytest.approx(BETA1_DESIGN, abs=1e-15)
    assert car.joints.size == 33
    assert residual_norm(car, car.design) < ROUND_OFF


@pytest.mark.parametrize("row", KINEMATICS, ids=lambda row: f"{row[0]:.3f}m")
def test_kinematics_of_the_reference_car(car: Mechanism, row: Array) -> None:
    for pose in (
        solve_pose_at_height(car, row[0], spin=2.0),
        solve_pose(car, car.beta1_design - row[3], spin=-1.0),
    ):
        seen = observe(car, pose)
        found = [
            seen.wheel_center[2],
            seen.wheel_center[0],
            seen.wheel_center[1],
            car.beta1_design - seen.beta1,
            *np.rad2deg([seen.camber, seen.toe, seen.steer]),
            seen.strut_length,
        ]
        assert found == pytest.approx(row, rel=0.0, abs=1e-12)


@pytest.mark.parametrize("arm", [-0.3, 0.0, 0.25])
@pytest.mark.parametrize("rack", [-0.04, 0.03])
def test_residuals_are_at_round_off(other_car: Mechanism, arm: float, rack: float) -> None:
    spin = 41.0
    pose = solve_pose(other_car, other_car.beta1_design + arm, rack, spin)
    assert residual_norm(other_car, pose) < ROUND_OFF
    seen = observe(other_car, pose)
    assert seen.beta1 == pytest.approx(other_car.beta1_design + arm, abs=ROUND_OFF)
    assert seen.rack == pytest.approx(rack, abs=ROUND_OFF)
    assert np.exp(1j * seen.spin) == pytest.approx(np.exp(1j * spin), abs=ROUND_OFF)


def test_pose_does_not_depend_on_the_way_to_it(other_car: Mechanism) -> None:
    there = solve_pose(other_car, other_car.beta1_design - 0.2, -0.03, 1.0)
    far = solve_pose(other_car, other_car.beta1_design + 0.3, 0.05, 5.0)
    again = solve_pose(other_car, other_car.beta1_design - 0.2, -0.03, 1.0, start=far)
    assert again.position == pytest.approx(there.position, abs=1e-14)
    assert again.rotation == pytest.approx(there.rotation, abs=1e-14)


@pytest.mark.parametrize(("arm", "rack"), [(0.0, 0.3), (0.0, -0.3), (-1.44, 0.0)])
def test_refuses_what_cannot_be_assembled(car: Mechanism, arm: float, rack: float) -> None:
    with pytest.raises(AssemblyError):
        solve_pose(car, car.beta1_design + arm, rack)


def test_twists_are_the_rates_of_the_poses(other_car: Mechanism) -> None:
    path = Path(other_car)
    twist = path.twist(0.0)
    speed = central_difference(lambda t: path.pose(t).position, 1e-4)
    spin = central_difference(lambda t: path.pose(t).rotation, 1e-4)
    omega = spin @ path.start.rotation.swapaxes(1, 2)
    assert twist[:, :3] == pytest.approx(speed, abs=1e-9)
    assert twist[:, 3:] == pytest.approx(
        np.stack((omega[:, 2, 1], omega[:, 0, 2], omega[:, 1, 0]), axis=1), abs=1e-8
    )
    _, constraint = other_car.joints.evaluate(path.start)
    assert np.abs(constraint @ twist.ravel()).max() < 1e-13


def test_accelerations_satisfy_the_joints(other_car: Mechanism) -> None:
    # Any accelerations of the coordinates will do; take those that follow from the forces.
    path = Path(other_car)
    solution = solve_free(other_car, path.start, *path.rate)
    path.acceleration = solution.coordinate_accelerations
    numerical = central_difference(path.twist, 2e-5)
    assert solution.acceleration == pytest.approx(numerical, rel=1e-8, abs=1e-6)
    _, constraint = other_car.joints.evaluate(path.start)
    drift = other_car.joints.convective(path.start, solution.twist)
    assert np.abs(constraint @ solution.acceleration.ravel() + drift).max() < 1e-11


def test_prescribed_rack_moves_as_prescribed(other_car: Mechanism) -> None:
    path = Path(other_car)
    solution = solve_prescribed(other_car, path.start, *path.rate, rack_acceleration=7.5)
    assert solution.rack_acceleration == pytest.approx(7.5, abs=1e-12)
    assert solution.twist[RACK - 1, :3] @ other_car.rack_axis == pytest.approx(0.4, abs=1e-14)


def test_free_rack_under_its_driving_force_moves_as_prescribed(other_car: Mechanism) -> None:
    path = Path(other_car)
    driven = solve_prescribed(
        other_car,
        path.start,
        *path.rate,
        rack_acceleration=7.5,
        road_height=0.01,
        strut_force=900.0,
    )
    freed = solve_free(
        other_car,
        path.start,
        *path.rate,
        rack_force=driven.rack_drive_force,
        road_height=0.01,
        strut_force=900.0,
    )
    assert freed.coordinate_accelerations == pytest.approx(
        driven.coordinate_accelerations, rel=1e-12, abs=1e-11
    )


def projected_accelerations(
    mechanism: Mechanism, pose: Pose, rates: npt.ArrayLike, rack_force: float
) -> Array:
    reduced = reduced_equations(mechanism, pose, *np.asarray(rates), rack_force=rack_force)
    accelerations: Array = np.linalg.solve(
        reduced.mass_matrix, reduced.applied - reduced.inertial
    ).astype(float)
    return accelerations


def test_multipliers_agree_with_projection(other_car: Mechanism) -> None:
    path = Path(other_car)
    solution = solve_free(other_car, path.start, *path.rate, rack_force=120.0)
    projected = projected_accelerations(other_car, path.start, path.rate, 120.0)
    assert solution.coordinate_accelerations == pytest.approx(projected, rel=1e-12, abs=1e-11)


def test_lagrange_equations_from_energies_alone(other_car: Mechanism) -> None:
    """d/dt (dT/dq') - dT/dq = Q, with T from the twists and no acceleration or Euler equation."""
    path = Path(other_car)
    q = np.array([other_car.beta1_design + path.value[0], path.value[1], path.value[2]])

    def mass_matrix(coordinates: Array) -> Array:
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


def test_generalised_forces_are_virtual_work(other_car: Mechanism) -> None:
    """The forces again, from the points and directions in words, by displacing them."""
    path = Path(other_car)
    given = other_car.parameters
    inputs = {"rack_force": 55.0, "road_height": 0.05, "road_velocity": 0.4, "strut_force": 700.0}
    reduced = reduced_equations(other_car, path.start, *path.rate, **inputs)

    def length(t: float) -> Array:
        return np.array(observe(other_car, path.pose(t)).strut_length)

    def height(t: float) -> Array:
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

    def work(step: Array) -> Array:
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


def test_powers(other_car: Mechanism) -> None:
    path = Path(other_car)
    inputs = {"road_height": 0.015, "strut_force": 500.0}
    solution = solve_prescribed(other_car, path.start, *path.rate, rack_acceleration=7.5, **inputs)
    # Kinetic energy: its rate by the accelerations is the power of all forces.
    path.acceleration = solution.coordinate_accelerations

    def later(t: float) -> Solution:
        rates = path.rate + t * path.acceleration
        return solve_prescribed(other_car, path.pose(t), *rates, rack_acceleration=7.5, **inputs)

    def potential(cause: str, t: float) -> Array:
        return np.array(later(t).potential_energy[cause])

    rate = central_difference(lambda t: np.array(later(t).kinetic_energy), 2e-5)
    total = sum(solution.power.values())
    assert rate == pytest.approx(total, rel=1e-7)
    for cause in ("gravity", "spring", "bump_stop", "rebound_stop"):
        rate = central_difference(partial(potential, cause), 1e-4)
        assert solution.power[cause] == pytest.approx(-rate, rel=1e-9)
    slide_rate = solution.strut_slide_rate
    given = other_car.parameters
    for cause, force in (
        ("damper", given["damper_rate"] * slide_rate + laws.damper_curve(given)(slide_rate)),
        (
            "friction",
            given["strut_friction"]
            * np.tanh(np.arcsinh(slide_rate / given["strut_friction_speed"])),
        ),
    ):
        assert solution.power[cause] == pytest.approx(-force * slide_rate, rel=1e-12)
    assert solution.power["actuator"] == pytest.approx(-500.0 * slide_rate, rel=1e-12)


def test_massless_bodies_are_the_limit_of_light_ones(car: Mechanism) -> None:
    coordinates, rates = (car.beta1_design - 0.1, 0.02, 3.0), (2.0, SPIN_RATE, 0.3)
    pose = solve_pose(car, *coordinates)
    massless = solve_free(car, pose, *rates, rack_force=10.0).coordinate_accelerations
    differences = []
    for share in (1e-5, 1e-6):
        light = reference_parameters()
        for body in ("tie_rod", "rack", "upper_strut"):
            light[f"{body}_mass"] = share
            set_inertia(light, body, 0.02 * share * np.eye(3))
        solution = solve_free(Mechanism(light), pose, *rates, rack_force=10.0)
        differences.append(solution.coordinate_accelerations - massless)
    assert differences[1] == pytest.approx(0.1 * differences[0], rel=1e-3, abs=1e-7)
    assert np.abs(massless - projected_accelerations(car, pose, rates, 10.0)).max() < 1e-11


def test_other_side_is_the_mirror_image(other_car: Mechanism) -> None:
    left = Mechanism(mirrored_parameters(other_car.parameters))
    assert left.side == -other_car.side == 1.0
    rates = Path.rate
    poses = [solve_pose(car, car.beta1_design + 0.1, 0.02, 0.5) for car in (other_car, left)]
    right_seen, left_seen = (
        observe(car, pose) for car, pose in zip((other_car, left), poses, strict=True)
    )
    assert left_seen.camber == pytest.approx(right_seen.camber, abs=1e-13)
    assert left_seen.toe == pytest.approx(right_seen.toe, abs=1e-13)
    assert left_seen.steer == pytest.approx(-right_seen.steer, abs=1e-13)
    right_solution, left_solution = (
        solve_free(car, pose, *rates, rack_force=40.0)
        for car, pose in zip((other_car, left), poses, strict=True)
    )
    assert left_solution.coordinate_accelerations == pytest.approx(
        right_solution.coordinate_accelerations, rel=1e-12, abs=1e-11
    )


def test_strut_line(other_car: Mechanism) -> None:
    """The strut top stays on the axis that is drawn on the knuckle at design."""
    for arm, rack in ((0.2, 0.02), (-0.3, -0.03), (0.0, 0.05)):
        pose = solve_pose(other_car, other_car.beta1_design + arm, rack)
        design = other_car.points["strut_top"] - other_car.points["strut_lower"]
        axis = pose.rotation[KNUCKLE - 1] @ design
        now = other_car.points["strut_top"] - other_car.point(pose, "strut_lower", KNUCKLE)
        assert np.abs(np.cross(axis, now)).max() < ROUND_OFF
        assert axis @ now > 0.0


def test_absent_parts_are_the_papers_suspension() -> None:
    parameters = perturbed_parameters(np.random.default_rng(3))
    complete = completed(parameters)
    assert {name: complete[name] for name in parameters} == parameters
    for name, stand_in in STAND_INS.items():
        assert vector(complete, name).tolist() == vector(parameters, stand_in).tolist()
    for length in (0.0, 0.4, 0.85):
        for side in ("bump", "rebound"):
            assert laws.stop_force(complete, side, length) == 0.0
            assert laws.stop_energy(complete, side, length) == 0.0
    assert laws.friction_force(complete, 0.3) == 0.0
    assert laws.damper_force(complete, 0.3) == 0.3 * parameters["damper_rate"]
    assert laws.tyre_load(complete, -0.01, 5.0) == -0.01 * parameters["tyre_rate"]


@pytest.mark.parametrize("count", [2, 3, 8, 11])
def test_damper_curve(count: int) -> None:
    """The coefficients are those of SciPy's curve, with straight lines outside."""
    rng = np.random.default_rng(count)
    knots = np.cumsum(rng.uniform(0.05, 0.6, count)) - 1.0
    curve = PchipInterpolator(knots, np.cumsum(rng.uniform(-100.0, 500.0, count)))
    parameters = completed(reference_parameters())
    set_damper_curve(parameters, curve)
    found = laws.damper_curve(parameters)
    for v in (*rng.uniform(-3.0, 4.0, 50), *knots):
        inside = np.clip(v, knots[0], knots[-1])
        expected = curve(inside) + curve.derivative()(inside) * (v - inside)
        # a few roundings of up to 1e4 N
        assert found(v) == pytest.approx(expected, rel=1e-13, abs=1e-11)


def test_tyre_that_lifts_off() -> None:
    """It neither pulls nor damps in the air, and does not stick to the road on the way up."""
    given = completed(reference_parameters()) | {"tyre_damper_rate": 1000.0, "tyre_lifts_off": 1.0}
    assert laws.tyre_load(given, 0.01, 0.5) == 2500.0
    assert laws.tyre_load(given, 0.001, -0.5) == 0.0
    assert laws.tyre_load(given, -0.001, 5.0) == 0.0


def test_reference_car_rests_at_its_design_height(car: Mechanism) -> None:
    solution = solve_prescribed(car, car.design, 0.0, SPIN_RATE)
    assert np.abs(solution.coordinate_accelerations).max() < 1e-9
    assert car.design.position[WHEEL - 1, 2] == 0.3


def test_eigenvalues_of_the_reference_car(car: Mechanism) -> None:
    def derivative(state: Array) -> Array:
        pose = solve_pose(car, car.beta1_design + state[0], 0.0, state[1])
        solution = solve_prescribed(car, pose, state[2], SPIN_RATE + state[3])
        return np.concatenate((state[2:], solution.coordinate_accelerations[:2]))

    matrix = partial_derivatives(derivative, 4, (1e-3, 1e-2, 1e-2, 1e-1)).T
    eigenvalues = sorted(np.linalg.eigvals(matrix), key=abs)[2:]
    assert sorted(eigenvalues, key=lambda value: -value.imag) == pytest.approx(
        EIGENVALUES_AT_REST, abs=1e-7
    )


def test_motion_of_the_reference_car(car: Mechanism) -> None:
    rows = DYNAMICS[DYNAMICS[:, 0] <= 0.02]
    start = solve_pose_at_height(car, 0.325)
    motion = simulate(car, rows[:, 0], (car.beta1(start), 0.0, 0.0), (0.0, SPIN_RATE, 0.0))
    found = np.column_stack(
        (
            motion.time,
            car.beta1_design - motion.coordinates[:, 0],
            -motion.rates[:, 0],
            motion.coordinates[:, 1],
            motion.rates[:, 1],
            [pose.position[WHEEL - 1, 2] for pose in motion.poses],
            [solution.twist[WHEEL - 1, 2] for solution in motion.solutions],
        )
    )
    assert found[:, :6] == pytest.approx(rows[:, :6], rel=0.0, abs=1e-11)
    assert found[:, 6] == pytest.approx(rows[:, 6], rel=0.0, abs=1e-9)


@pytest.mark.parametrize("make", [perturbed_parameters, general_parameters])
def test_kinetic_energy_is_the_work_done(
    make: Callable[[np.random.Generator], dict[str, float]],
) -> None:
    other_car = Mechanism(make(np.random.default_rng(1)))
    motion = simulate(
        other_car,
        np.linspace(0.0, 0.03, 4),
        (other_car.beta1_design, 0.0, 0.0),
        (0.0, 50.0, 0.0),
        rack_motion=None,
        rack_force=lambda t: 40.0 * np.sin(90.0 * t),
        road_height=lambda t: 0.01 * np.sin(60.0 * t),
        road_velocity=lambda t: 0.6 * np.cos(60.0 * t),
        strut_force=lambda t: 4000.0 * t,
        rtol=1e-10,
    )
    kinetic = np.array([solution.kinetic_energy for solution in motion.solutions])
    assert kinetic - kinetic[0] == pytest.approx(motion.work, abs=1e-6)
    assert np.ptp(motion.coordinates[:, 2]) > 1e-4


def test_moving_rack_in_a_simulation(car: Mechanism) -> None:
    def rack_motion(t: float) -> tuple[float, float, float]:
        phase = 50.0 * t
        return (0.01 * np.sin(phase) ** 2, 0.5 * np.sin(2.0 * phase), 50.0 * np.cos(2.0 * phase))

    motion = simulate(
        car,
        np.linspace(0.0, 0.03, 3),
        (car.beta1_design, 0.0, 0.0),
        (0.0, SPIN_RATE, 0.0),
        rack_motion=rack_motion,
        rtol=1e-9,
    )
    kinetic = np.array([solution.kinetic_energy for solution in motion.solutions])
    assert kinetic - kinetic[0] == pytest.approx(motion.work, abs=1e-5)
    assert [car.rack(pose) for pose in motion.poses] == pytest.approx(
        [rack_motion(t)[0] for t in motion.time], abs=1e-14
    )
