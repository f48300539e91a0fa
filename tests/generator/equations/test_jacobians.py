"""Jacobians: against differentiation of the program, of the compiled functions, and the oracle.

Complex steps cannot be taken through compiled real arithmetic. Instead the symbolic program is
differentiated in 50 digits by a central difference with a step of 1e-15, whose own error is below
1e-20 of the derivative: that comparison is as sharp as the arithmetic of the compiled function.
Differences of the compiled functions themselves are coarser, but see the whole path.
"""

from collections.abc import Callable

import mpmath
import numpy as np
import pytest
from cases import MODELS, At, Instant, car_parameters, is_prescribed, random_instants
from kintrafo.generator.equations.outputs import Derivation
from oracle.constraints import BODIES, Array
from oracle.multipliers import reduced_equations, solve_twist
from oracle.newton import Mechanism
from oracle.reference import BETA1_DESIGN
from symbolic import derivatives_of

SEEDS = range(4)  # 0 is the reference car
POINTS = 3  # for each car


def places(name: str, seed: int) -> tuple[Mechanism, list[At]]:
    """Return the oracle of a car, and a model of it at random instants."""
    model = MODELS[name]
    parameters = car_parameters(seed, model)
    car, constants = Mechanism(parameters), model.prepare(parameters)
    instants = random_instants(np.random.default_rng(seed), car, POINTS)
    return car, [At(model, instant, constants) for instant in instants]


@pytest.fixture(
    scope="module",
    params=[(name, seed) for name in MODELS for seed in SEEDS],
    ids=lambda value: f"{value[0]}-car{value[1]}",
)
def car_and_places(request: pytest.FixtureRequest) -> tuple[Mechanism, list[At]]:
    return places(*request.param)


DERIVATIVES = {
    "relative_jacobian": ("relative_coordinates", "STATE"),
    "rhs_jacobian": ("rhs", "STATE"),
    "rhs_jacobian_rack_held": ("rhs_rack_held", "STATE"),
    "rhs_input_jacobian": ("rhs", "INPUTS"),
    "signals_jacobian": ("signals", "STATE"),
    "signals_input_jacobian": ("signals", "INPUTS"),
}
"""Of each Jacobian, the function that it differentiates, and by what."""


@pytest.fixture(
    scope="module",
    params=[
        (name, jacobian, seed)
        for name, model in MODELS.items()
        for jacobian in DERIVATIVES
        if hasattr(model, jacobian)
        for seed in SEEDS
    ],
    ids=lambda value: "-".join(map(str, value)),
)
def jacobian_and_places(request: pytest.FixtureRequest) -> tuple[str, list[At]]:
    name, jacobian, seed = request.param
    return jacobian, places(name, seed)[1]


def difference(function: Callable[[float], Array], step: float) -> Array:
    """Differentiate at zero with an error of the order of step**8."""
    total = np.zeros_like(function(0.0))
    for k, weight in enumerate((672.0, -168.0, 32.0, -3.0), 1):
        total += weight * (function(k * step) - function(-k * step))
    return total / (840.0 * step)


def gradient(function: Callable[[Array], Array], steps: Array) -> Array:
    """Differentiate at zero by each argument with its own step, along the last axis."""

    def along(direction: Array, step: float) -> Array:
        return difference(lambda h: function(h * direction), step)

    columns = [along(row, step) for row, step in zip(np.eye(len(steps)), steps, strict=True)]
    return np.stack(columns, axis=-1)


def gradient_of_program(model: Derivation, function: str, at: At, names: list[str]) -> Array:
    """Differentiate the symbolic program of a function by elements of state or inputs."""
    values: dict[str, mpmath.mpf] = {}
    for keys, array in (
        (at.model.CONSTANTS, at.constants),
        (at.model.STATE, at.state),
        (at.model.INPUTS, at.inputs),
    ):
        values |= {key: mpmath.mpf(v) for key, v in zip(keys, array.tolist(), strict=True)}
    return derivatives_of(model.functions[function], values, names)


def test_derivatives_of_the_program(
    derived: Callable[[str], Derivation], jacobian_and_places: tuple[str, list[At]]
) -> None:
    jacobian, at_places = jacobian_and_places
    for at in at_places:
        found = at(jacobian)
        function, by = DERIVATIVES[jacobian]
        names = list(getattr(at.model, by))[: found.shape[1]]
        model = derived(at.model.NAME)
        with mpmath.workdps(50):
            expected = gradient_of_program(model, function, at, names)
        # Row by row, since a row has one unit: some hundred roundings of its largest element. Of
        # one where nothing acts (the spring's length by the rack, with a seat at the ball joint)
        # the roundings of what cancels remain.
        size = np.maximum(np.abs(expected).max(axis=1, keepdims=True), 1.0)
        assert (np.abs(found - expected) <= 1e-12 * size).all()


def test_derivatives_of_the_compiled_functions(jacobian_and_places: tuple[str, list[At]]) -> None:
    jacobian, at_places = jacobian_and_places
    for at in at_places:
        found = at(jacobian)
        name, by = DERIVATIVES[jacobian]
        function = getattr(at.model, name)
        width = found.shape[1]

        def moved(
            change: Array, at: At = at, function=function, by: str = by, width: int = width
        ) -> Array:
            arrays = {"STATE": at.state, "INPUTS": at.inputs}
            arrays[by][:width] += change
            return function(arrays["STATE"], arrays["INPUTS"], at.constants)

        place = {"STATE": at.state, "INPUTS": at.inputs}[by][:width]
        expected = gradient(moved, 2e-4 * np.maximum(1.0, np.abs(place)))
        # The function's roundings over the step, some 1e-15 / 2e-4, and the ninth derivative times
        # the eighth power of the step. No instant is so near to a kink of a force that a step
        # crosses it.
        size = np.maximum(np.abs(expected).max(axis=1, keepdims=True), 1.0)
        assert (np.abs(found - expected) <= 1e-9 * size).all()


@pytest.mark.parametrize(
    ("parameter", "signal"),
    [
        ("bump_stop_length", "strut_length"),
        ("rebound_stop_length", "strut_length"),
        ("tyre_free_height", "wheel_center_z"),
    ],
)
def test_derivatives_on_both_sides_of_a_kink(
    derived: Callable[[str], Derivation], parameter: str, signal: str
) -> None:
    """A nanometre from first touch, or from the air, the derivative is that of its own side."""
    name, touch = "macpherson_general", {"tyre_damper_rate": 0.0}
    instant = Instant(BETA1_DESIGN, 0.5, 0.01, 0.3, 50.0, 0.1)

    def at_kink(distance: float) -> At:
        model, parameters = MODELS[name], car_parameters(1, MODELS[name]) | touch
        now = At(model, instant, model.prepare(parameters))("signals")
        place = now[list(model.SIGNALS).index(signal)]
        return At(model, instant, model.prepare(parameters | {parameter: place + distance}))

    sides = [at_kink(distance) for distance in (-1e-9, 1e-9)]
    before, behind = (at("rhs_jacobian") for at in sides)
    for at, found in zip(sides, (before, behind), strict=True):
        with mpmath.workdps(50):
            expected = gradient_of_program(derived(name), "rhs", at, list(at.model.STATE))
        size = np.abs(expected).max(axis=1, keepdims=True)
        assert (np.abs(found - expected) <= 1e-12 * size + 1e-12).all()
    assert np.abs(behind - before).max() > 100.0  # rigidities over the mass, in 1/s²


def test_derivatives_of_the_closure(car_and_places: tuple[Mechanism, list[At]]) -> None:
    """The equations g(beta, q) = 0 differentiated implicitly: g_beta beta' + g_q = 0."""
    for at in car_and_places[1]:
        beta = at("relative_coordinates")

        def by_beta(change: Array, at: At = at, beta: Array = beta) -> Array:
            return at.model.residuals(beta + change, at.state, at.inputs, at.constants)

        def by_coordinates(change: Array, at: At = at, beta: Array = beta) -> Array:
            state = at.state
            state[: at.size] += change
            return at.model.residuals(beta, state, at.inputs, at.constants)

        of_beta = gradient(by_beta, np.full(len(beta), 1e-3))
        of_coordinates = gradient(by_coordinates, np.full(at.size, 1e-3))
        # roundings of the residuals, 1e-16, over the step, times rates of up to about 5
        assert np.abs(of_beta @ at("relative_jacobian") + of_coordinates).max() < 1e-11


def test_absolute_times_relative_is_global(car_and_places: tuple[Mechanism, list[At]]) -> None:
    for at in car_and_places[1]:
        product = at("absolute_jacobian") @ at("relative_jacobian")
        # two ways of ten products each, of rates of up to about 5
        assert np.abs(product - at("global_jacobian")).max() < 1e-13


def test_global_jacobian_is_the_oracles(car_and_places: tuple[Mechanism, list[At]]) -> None:
    car, at_places = car_and_places
    for at in at_places:
        reduced = reduced_equations(car, at.instant.pose(car), 0.0, 0.0)
        expected = [
            np.vstack((block[3:], block[:3]))[:, : at.size]
            for body, block in zip(BODIES, reduced.jacobian, strict=True)
            if body in at.model.MASSIVE_BODIES
        ]
        # a linear system of 36 equations, refined, against some hundred operations
        assert at("global_jacobian") == pytest.approx(np.concatenate(expected), rel=0.0, abs=1e-12)


def test_velocities_are_the_oracles(car_and_places: tuple[Mechanism, list[At]]) -> None:
    car, at_places = car_and_places
    for at in at_places:
        instant = at.instant
        rates = instant.beta1_rate, instant.spin_rate, instant.rack_rate
        twist = solve_twist(car, instant.pose(car), *rates)
        expected = np.concatenate((twist[:, 3:], twist[:, :3]), axis=1)
        # spin rates of 100 rad/s and more
        assert at("velocities") == pytest.approx(expected, rel=1e-12, abs=1e-11)


def test_velocities_are_the_rates_of_the_poses(car_and_places: tuple[Mechanism, list[At]]) -> None:
    """Along a motion of all coordinates at once, the rack included."""
    for at in car_and_places[1]:

        def later(function: str, time: float, at: At = at) -> Array:
            now = at.instant
            moved = Instant(
                now.beta1 + time * now.beta1_rate,
                now.spin + time * now.spin_rate,
                now.rack + time * now.rack_rate,
            )
            return At(at.model, moved, at.constants)(function)

        # the wheel turns by 0.02 rad in a step
        step = 0.02 / max(100.0, abs(at.instant.spin_rate))
        linear = difference(lambda t, later=later: later("positions", t), step)
        turning = difference(lambda t, later=later: later("orientations", t), step)
        cross = turning @ at("orientations").swapaxes(1, 2)
        angular = np.stack((cross[:, 2, 1], cross[:, 0, 2], cross[:, 1, 0]), axis=1)
        found = at("velocities")
        # roundings of the poses, 1e-15, over a step of 1e-4 s
        assert found[:, :3] == pytest.approx(angular, rel=0.0, abs=1e-9)
        assert found[:, 3:] == pytest.approx(linear, rel=0.0, abs=1e-9)


def test_global_jacobian_gives_the_velocities(car_and_places: tuple[Mechanism, list[At]]) -> None:
    """With the rack at rest the twists of the massive bodies are the Jacobian times the rates."""
    for at in car_and_places[1]:
        model, state, inputs = at.model, at.state, at.inputs
        if is_prescribed(model):
            inputs[list(model.INPUTS).index("rack_velocity")] = 0.0
        rows = [model.BODIES.index(body) for body in model.MASSIVE_BODIES]
        twists = model.velocities(state, inputs, at.constants)[rows].ravel()
        # sums of a few products of up to 300 rad/s
        assert at("global_jacobian") @ state[at.size :] == pytest.approx(twists, rel=0, abs=1e-12)


def test_mass_matrix_from_the_global_jacobian(car_and_places: tuple[Mechanism, list[At]]) -> None:
    """Eq. 3: M is the sum of J^T Xi J over the bodies that carry mass."""
    car, at_places = car_and_places
    for at in at_places:
        jacobians = at("global_jacobian").reshape(-1, 6, at.size)
        total = np.zeros((at.size, at.size))
        for name, jacobian in zip(at.model.MASSIVE_BODIES, jacobians, strict=True):
            body = BODIES.index(name)
            rotation = at("orientations")[body]
            tensor = rotation @ car.inertias[body] @ rotation.T
            angular, linear = jacobian[:3], jacobian[3:]
            total += car.masses[body] * linear.T @ linear + angular.T @ tensor @ angular
        # some hundred roundings of elements of up to 50 kg
        assert at("mass_matrix") == pytest.approx(total, rel=1e-13, abs=1e-13)
