"""Derivatives by parameters: along directions and backwards, against 50 digits and each other.

The oracle differentiates the symbolic programs of `prepare` and of a function, one behind the
other, by a difference in 50 digits: it knows no derivative of a step. Adjoints are held against
tangents: the weighted sum of one is that of the other.
"""

import re

import kintrafo
import mpmath
import numpy as np
import pytest
from kintrafo import variation
from kintrafo.core.errors import InputError
from kintrafo.equations.errors import ClosureError
from kintrafo.generator.backends.counting import operations_of
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.mechanisms import MODELS
from mechanisms.iterated_loops import STEPHENSON
from mechanisms.scotch_yokes import WHEEL_ON_A_YOKE
from support.folders import ROOT
from support.models import derive
from support.symbolic import constants_of, python

SHIPPED = {model.name: model for model in MODELS}
# closed forms in a plane and in space, hinges whose angle at design depends on points, iterations
MECHANISMS = [*(SHIPPED[n] for n in ("four_bar", "macpherson")), STEPHENSON]
# Some thousand roundings of 1.1e-16, as parts of the greatest element.
ROUNDED = 1e-12
STEP = mpmath.mpf("1e-22")


def system_of(mechanism, backend="c"):
    """Return a mechanism with its defaults."""
    module = kintrafo.compile(mechanism, parameter_derivatives=True, backend=backend)
    return kintrafo.System(module)


def place_and_direction(system):
    """Return a state beside the design position, inputs, and a direction of everything."""
    random = np.random.default_rng(7)
    state = system.design_state + random.uniform(-0.05, 0.05, system.design_state.size)
    inputs = random.uniform(-0.005, 0.005, len(system.input_names))
    along = {
        name: float(random.normal()) * (0.1 * abs(value) or 0.01)
        for name, value in system.parameters.items()
    }
    along |= {name: float(random.normal()) for name in (*system.state_names, *system.input_names)}
    return state, inputs, along


def by_differences(model, system, at, along):
    """Differentiate the programs of all functions along a direction in 50 digits."""
    state, inputs = at
    names = (*system.parameters, *system.state_names, *system.input_names)
    values = map(float, (*system.parameters.values(), *state, *inputs))

    with mpmath.workdps(50):
        here = {name: mpmath.mpf(value) for name, value in zip(names, values, strict=True)}

        def moved(step):
            place = {name: value + step * along.get(name, 0.0) for name, value in here.items()}
            return place | constants_of(model, {name: place[name] for name in system.parameters})

        places = moved(STEP), moved(mpmath.mpf(0))
        for function in system.equations.DIRECTIONS.of:
            run = python(model.functions[function])
            pairs = zip(*map(run, places), strict=True)
            yield function, np.array([float((a - b) / STEP) for a, b in pairs])


@pytest.fixture(scope="module", params=MECHANISMS, ids=lambda m: m.name)
def mechanism(request):
    return request.param


def test_along_a_direction(mechanism):
    system, model = system_of(mechanism), derive(mechanism)
    state, inputs, along = place_and_direction(system)
    for function, expected in by_differences(model, system, (state, inputs), along):
        found = kintrafo.derivative(system, function, along, state, inputs).reshape(-1)
        assert np.abs(expected).max() > 1e-3, function  # there is something to see
        assert np.abs(found - expected).max() <= ROUNDED * np.abs(expected).max(), function


def test_backwards_is_forwards(mechanism):
    system = system_of(mechanism)
    state, inputs, along = place_and_direction(system)
    random = np.random.default_rng(3)
    for function in system.equations.DIRECTIONS.of:
        weights = random.normal(size=getattr(system.equations, function).shape)
        by = kintrafo.gradient(system, function, weights, state, inputs)
        terms = np.array([by[name] * amount for name, amount in along.items()])
        forward = weights * kintrafo.derivative(system, function, along, state, inputs)
        scale = max(np.abs(terms).sum(), np.abs(forward).sum())
        assert abs(terms.sum() - forward.sum()) <= ROUNDED * scale, function


def test_states_and_inputs_as_the_jacobians_have_them(mechanism):
    system = system_of(mechanism)
    state, inputs, _ = place_and_direction(system)
    for jacobian, names in (
        ("rhs_jacobian", system.state_names),
        ("rhs_input_jacobian", system.input_names),
    ):
        expected = system.evaluate(jacobian, state, inputs)
        columns = [kintrafo.derivative(system, "rhs", {n: 1.0}, state, inputs) for n in names]
        scale = np.abs(expected).max()
        assert np.abs(np.transpose(columns) - expected).max() <= ROUNDED * scale


def test_numpy_as_c():
    four_bar = SHIPPED["four_bar"]
    compiled, arrays = system_of(four_bar), system_of(four_bar, "numpy")
    state, inputs, along = place_and_direction(compiled)
    states = np.array([state, 1.1 * state])
    for function in compiled.equations.DIRECTIONS.of:
        ones = np.ones(getattr(compiled.equations, function).shape)
        one, other = (
            kintrafo.derivative(s, function, along, states, inputs) for s in (compiled, arrays)
        )
        assert np.allclose(one, other, rtol=1e-13, atol=1e-13)
        one, other = (
            kintrafo.gradient(s, function, ones, states, inputs) for s in (compiled, arrays)
        )
        assert all(np.allclose(one[name], other[name], rtol=1e-12, atol=1e-12) for name in one)


def test_many_directions_at_once():
    system = system_of(SHIPPED["four_bar"])
    state, inputs, along = place_and_direction(system)
    names = [*along][:5]
    at_once = {name: np.eye(5)[i] for i, name in enumerate(names)}
    found = kintrafo.derivative(system, "positions", at_once, state, inputs)
    for name, row in zip(names, found, strict=True):
        assert np.array_equal(
            row, kintrafo.derivative(system, "positions", {name: 1.0}, state, inputs)
        )


def test_mirrored_direction_mirrors():
    """The left wheel of a mirrored car moves as the right one does when both change alike."""
    module = kintrafo.compile(SHIPPED["macpherson"], parameter_derivatives=True)
    across = {n for n in module.PARAMETERS if n.endswith("_y")}
    turned = {n for n in module.PARAMETERS if "axis" in n}
    values = {n: e["default"] for n, e in module.PARAMETERS.items()}
    mirrored = {n: -v if n in across - turned else v for n, v in values.items()}
    systems = [kintrafo.System(module, v) for v in (values, mirrored)]
    along = {
        n: 0.001 * (1 + i % 3) for i, n in enumerate(sorted(across - turned)) if "inertia" not in n
    }
    other = {n: -v for n, v in along.items()}
    one, two = (
        kintrafo.derivative(system, "positions", direction, system.design_state)
        for system, direction in zip(systems, (along, other), strict=True)
    )
    assert np.abs(one).max() > 1e-4
    assert np.abs(one * [1.0, -1.0, 1.0] - two).max() <= 1e-12


def test_the_design_position_moves_along():
    """An angle that is measured to a point follows that point: the arm is where it was drawn."""
    system = system_of(SHIPPED["macpherson"])
    named = {"ball_joint_z": 1.0}
    moving = kintrafo.design_derivative(system, named)
    step = 1e-6
    ends = [
        kintrafo.System(
            system.equations,
            system.parameters | {"ball_joint_z": system.parameters["ball_joint_z"] + by},
        )
        for by in (-step, step)
    ]
    expected = (ends[1].design_state - ends[0].design_state) / (2.0 * step)
    assert np.allclose([*moving.values()], expected, rtol=1e-8, atol=1e-8)
    assert abs(expected[0]) > 1.0
    still = kintrafo.derivative(system, "orientations", named | moving, system.design_state)
    assert np.abs(still[0]).max() <= ROUNDED


def test_what_leaves_the_equations_is_refused(refused):
    system = system_of(WHEEL_ON_A_YOKE)
    assumed = [a for a in system.equations.equations.manifest["assumptions"] if "least" not in a]
    assert {"slot_out_of_plane", "wheel_rotor_askew"} <= {a["quantity"] for a in assumed}
    at = system.design_state
    weights = np.ones(system.equations.rhs.shape)
    by = kintrafo.gradient(system, "rhs", weights, at)
    broken = [name for name, value in by.items() if np.isnan(value)]
    assert 0 < len(broken) < len(by) / 2
    for name in broken:
        with refused(InputError):
            kintrafo.derivative(system, "rhs", {name: 1.0}, at)
    # also together with a parameter that may change alone by any amount
    free = next(
        n for n, e in system.equations.PARAMETERS.items() if e["unit"] == "m" and n not in broken
    )
    refused(
        InputError, lambda: kintrafo.derivative(system, "rhs", {free: 1.0, broken[0]: 1e-6}, at)
    )
    kept = next(name for name in system.parameters if name.endswith("mass"))
    found = kintrafo.derivative(system, "rhs", {kept: 1.0}, at)
    assert np.isclose(weights @ found, by[kept], rtol=1e-10)


def test_a_loop_that_cannot_close_is_refused():
    system = system_of(SHIPPED["four_bar"])
    system = kintrafo.System(system.equations, system.parameters | {"crank_pin_y": 0.35})
    far = system.state(crank_angle=1.5)
    with pytest.raises(ClosureError) as expected:
        system.evaluate("positions", far)
    for call, given in (
        (kintrafo.derivative, {}),
        (kintrafo.gradient, np.ones(system.equations.positions.shape)),
    ):
        with pytest.raises(ClosureError) as found:
            call(system, "positions", given, far)
        assert found.value.margins == expected.value.margins


def test_arguments_are_refused_by_name(refused):
    system = system_of(SHIPPED["four_bar"])
    at = system.design_state
    for given in (
        (system, "rhs", {"crank_mas": 1.0}, at),
        (system, "rhss", {}, at),
        (system, "rhs", {"crank_mass": np.nan}, at),
        (system, "rhs", {"crank_mass": [1.0, 2.0], "coupler_mass": [1.0] * 3}, at),
        (kintrafo.Model("reference_car"), "rhs", {}, at),
    ):
        with refused(InputError):
            kintrafo.derivative(*given)
    with pytest.raises(InputError, match="weights"):
        kintrafo.gradient(system, "rhs", [1.0], at)


@pytest.fixture(scope="module")
def page():
    """Return what the examples of the page find."""
    found = {}
    text = (ROOT / "docs/simulation/derivatives.md").read_text(encoding="utf-8")
    exec("\n".join(re.findall(r"```python\n(.*?)```", text, re.DOTALL)), found)
    return found


def test_kinematics_as_the_study_has_them(page):
    """Toe with the wheel centre held, by hardpoints, and the cars of `sensitivity`."""
    car = kintrafo.Suspension.load("reference_car")
    travel = np.linspace(-0.06, 0.06, 13)
    points = ["hardpoints.tie_rod_inner", "hardpoints.ball_joint", "hardpoints.arm_rear"]
    study = variation.sensitivity(car, points, positions=travel, names=["toe"])["toe"]
    names = [str(p).removeprefix("hardpoints.").replace(".", "_") for p in study["place"].values]
    exact = np.array([page["held"][name] for name in names])
    # differences of fourth order with steps of 0.5 mm, see `sensitivity`
    assert np.abs(exact - study.values).max() <= 1e-9 * np.abs(exact).max()


def test_gradients_cost_three_times_the_function():
    model = generate(SHIPPED["four_bar"], parameter_derivatives=True)
    functions = {f.name: f for f in (*model.functions.values(), model.prepare)}
    derivatives = (*model.by_parameters.functions, *model.by_parameters.of_parameters)
    for derivative in (f for f in derivatives if not f.name.startswith("design_state")):
        name, _, _ = derivative.name.rpartition("_")
        own, original = (operations_of(f).total() for f in (derivative, functions[name]))
        assert own < 3.3 * original, derivative.name
