"""Loops without a closed form: the block that iterates, what surrounds it, and what is refused.

The oracles: maximal coordinates, and the program itself in 50 digits.
"""

from dataclasses import replace
from functools import cache
from pathlib import Path

import kintrafo
import mpmath
import numpy as np
import pytest
import sympy as sp
from kintrafo.equations.errors import ClosureError, ModelError
from kintrafo.equations.following import ITERATIONS
from kintrafo.generated import double_wishbone
from kintrafo.generator import Line, Revolute
from kintrafo.generator.backends.report.markdown import markdown
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.loops.errors import NoClosedFormError
from kintrafo.generator.mechanisms import held_by_rods
from kintrafo.generator.mechanisms.held_by_rods import CONTROL_ARM, FIVE_LINK, MODELS
from kintrafo.generator.planning.plan import CataloguePlan
from kintrafo.generator.program import ConstantStage, Program
from kintrafo.generator.program.newton import adjugate
from support import models
from support.changes import changed
from support.models import Built, needs_gcc, own
from support.symbolic import constants_of, derivatives_of, python

ARM, FIVE, STRUT = MODELS
BY_NAME = {model.name: model for model in MODELS}
RODS = {
    ARM.name: ("upper_link", "camber_link", "toe_link"),
    FIVE.name: ("upper_link", "camber_link", "toe_link", "front_link", "lower_link", "push_rod"),
}
RODS[STRUT.name] = ("strut_tube", *RODS[FIVE.name][:-1])
TRAVEL = {ARM.name: 0.35, FIVE.name: 0.5, STRUT.name: 0.08}
"""How far the independent joint goes from the design position, rad or m: more than a car uses."""


@pytest.fixture(scope="session")
def derive():
    return lambda name: models.derive(BY_NAME[name], derivatives=False)


@pytest.fixture(scope="session")
def built():
    """Return a compiled model."""

    @cache
    def found(name):
        model = BY_NAME[name]
        return Built.of(model, own(model, derivatives=name == ARM.name))

    return found


def states(built, count, seed=0):
    """Return random states within the travel, and inputs: rack within 30 mm."""
    rng = np.random.default_rng(seed)
    q = built.design + np.column_stack(
        (TRAVEL[built.model.name] * rng.uniform(-1, 1, count), rng.uniform(-3, 3, count))
    )
    inputs = np.zeros((count, len(built.module.INPUTS)))
    inputs[:, :3] = rng.uniform(-1, 1, (count, 3)) * [0.03, 0.3, 3.0]
    return np.hstack((q, rng.normal(size=(count, 2)) * [2.0, 90.0])), inputs


MODEL_NAMES = pytest.mark.parametrize("name", [ARM.name, FIVE.name])
WITH_STRUT = pytest.mark.parametrize("name", [ARM.name, FIVE.name, STRUT.name])


# -- linear algebra of the block ------------------------------------------------------------------


@pytest.mark.parametrize("size", [1, 2, 3, 4, 6])
def test_adjugate_and_determinant_in_integers(size):
    rng = np.random.default_rng(size)
    numbers = sp.Matrix(size, size, [int(n) for n in rng.integers(-9, 10, size * size)])
    numbers[size - 1, :] = numbers[0, :] if size == 4 else numbers[size - 1, :]  # a singular one
    matrix = [[sp.Symbol(f"a_{i}{j}") for j in range(size)] for i in range(size)]
    program = Program(ConstantStage(()))
    inverse, value = adjugate(program, matrix)
    outputs = [*(entry for row in inverse for entry in row), value]
    function = program.function("f", "", {str(i): e for i, e in enumerate(outputs)})
    values = {matrix[i][j]: numbers[i, j] for i in range(size) for j in range(size)}
    for step in function.steps:
        values[step.symbol] = step.expression.xreplace(values)
    *found, last = [e.xreplace(values) for e in function.results]
    assert sp.Matrix(size, size, found) == numbers.adjugate()
    assert last == numbers.det()


# -- against maximal coordinates ------------------------------------------------------------------


@WITH_STRUT
def test_bodies_fulfil_all_joints(name, built):
    model = built(name)
    for state, inputs in zip(*states(model, 30), strict=True):
        closure = model.oracle.closure(model.motion(state, inputs))
        np.testing.assert_allclose(closure.value, 0.0, atol=1e-15 * 10)  # lengths below 1 m
        np.testing.assert_allclose(closure.rate, 0.0, atol=1e-15 * 10 * np.abs(state[2:]).max())


def test_a_strut_is_as_long_as_its_slide_says(built, refused):
    model = built(STRUT.name)
    (state, *_), (inputs, *_) = states(model, 1)
    slide = model.oracle.driven(model.motion(state, inputs), "strut_guide")
    # some roundings of lengths below 1 m, and of the quotient with a rate
    assert slide.value[0] == pytest.approx(state[0], abs=1e-15)
    assert slide.rate[0] == pytest.approx(state[2], rel=1e-14)
    span = -0.01, 0.16, 0.52  # as declared
    drawn_in = np.array([1.01 * np.linalg.norm(span), 0.0, 0.0, 0.0])
    refused(ClosureError, lambda: model("rhs", drawn_in))


@WITH_STRUT
def test_accelerations_are_those_of_the_maximal_coordinates(name, built):
    model = built(name)
    for state, inputs in zip(*states(model, 30), strict=True):
        motion = model.motion(state, inputs)
        oracle = model.oracle.reduced(motion, model.named(inputs), {"rack_guide": inputs[2]})
        inverse = np.abs(np.linalg.inv(oracle.mass_matrix))
        scale = (inverse @ (np.abs(oracle.applied) + np.abs(oracle.inertial))).max()
        found = model("rhs", state, inputs)[2:]
        # rounding, a thousandfold and more by the condition of six rods and that of the oracle
        np.testing.assert_allclose(found, oracle.accelerations, rtol=0.0, atol=1e-11 * scale)
        # a hundred roundings of the largest entry: nothing is solved for with it yet
        scale = np.abs(oracle.mass_matrix).max()
        np.testing.assert_allclose(
            model("mass_matrix", state, inputs), oracle.mass_matrix, rtol=0.0, atol=2e-14 * scale
        )


# -- derivatives ----------------------------------------------------------------------------------


@pytest.mark.parametrize("by", ["state", "inputs"])
def test_jacobians_are_exact(by, built, derive):
    # differences in 50 digits: every perturbed state is solved again, to 50 digits. Those of a
    # carrier on more rods are compared in `test_mechanisms`.
    model, derived = built(ARM.name), derive(ARM.name)
    state, inputs = (values[0] for values in states(model, 1, seed=3))
    found = model("rhs_jacobian" if by == "state" else "rhs_input_jacobian", state, inputs)
    with mpmath.workdps(50):
        values = constants_of(derived, model.parameters)
        values |= {n: mpmath.mpf(v) for n, v in model.named(inputs).items()}
        values |= dict(zip(model.module.STATE, map(mpmath.mpf, state), strict=True))
        names = model.module.STATE if by == "state" else model.module.INPUTS
        expected = derivatives_of(derived.functions["rhs"], values, names)
    scale = np.abs(expected).max(axis=1, keepdims=True)
    scale[scale == 0.0] = 1.0
    # a hundred roundings leave two digits for the condition of the loops
    np.testing.assert_allclose(found / scale, expected / scale, rtol=0.0, atol=1e-12)


# -- where it fails -------------------------------------------------------------------------------


@MODEL_NAMES
def test_out_of_reach_is_an_error_with_the_loop(name, built, refused):
    model = built(name)
    state = np.array([*model.design, 0.0, 0.0])
    inputs = np.array([1.5, 0.0, 0.0, 0.0])  # the rack: no toe link is that long
    error = refused(ClosureError, lambda: model("rhs", state, inputs))
    assert error.margins["carrier_closure"] < 0.0


@MODEL_NAMES
def test_wherever_it_is_asked_it_closes_or_says_that_it_does_not(name, built):
    model, rng = built(name), np.random.default_rng(1)
    closed = refused = 0
    for _ in range(80):
        state = np.array([*(model.design + rng.uniform(-np.pi, np.pi, 2)), 1.0, 1.0])
        inputs = np.array([rng.uniform(-0.5, 0.5), 1.0, 1.0, 0.0])
        try:
            motion = model.motion(state, inputs)
        except ClosureError:
            refused += 1
            continue
        closed += 1
        assert np.isfinite(motion.twist).all()
        # next to a singular position as well: positions are as exact as the lengths of the rods
        assert np.abs(model.oracle.closure(motion).value).max() < 1e-12
    assert min(closed, refused) > 10


def test_up_to_the_end_of_the_reach(built):
    """Bisection for the angle at which the rods lose their hold: closed before, refused behind."""
    model = built(ARM.name)
    inside, outside = 0.3, 0.9

    def margin(angle):
        state = np.array([model.design[0] + angle, 0.0, 0.0, 0.0])
        return float(model("margins", state)[0])

    for _ in range(60):
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if margin(middle) > 0.0 else (inside, middle)
    assert 0.3 < inside < 0.9
    for distance in (1e-2, 1e-4, 1e-6, 1e-8):
        assert 0.0 < margin(inside - distance) < np.sqrt(distance)  # a square root, as at any fold
        assert margin(inside + distance) < 0.0
        state = np.array([model.design[0] + inside - distance, 0.0, 0.0, 0.0])
        motion = model.motion(state, np.zeros(len(model.module.INPUTS)))
        # what the iteration may leave
        assert np.abs(model.oracle.closure(motion).value).max() < 1e-13


def test_what_is_not_finite_is_refused(built):
    model = built(ARM.name)
    for value in (np.nan, np.inf):
        with pytest.raises(ModelError, match="arm_angle"):
            model("rhs", np.array([value, 0.0, 0.0, 0.0]))


# -- C --------------------------------------------------------------------------------------------


@needs_gcc
def test_c_computes_what_numpy_computes(built):
    compiled = built(ARM.name)
    arrays = replace(compiled, module=own(ARM, arrays=True))
    state, inputs = states(arrays, 200)
    for function in ("rhs", "rhs_jacobian", "positions", "signals", "margins"):
        found, expected = compiled(function, state, inputs), arrays(function, state, inputs)
        # the last digits of sines and cosines differ, and with them when an iteration ends
        atol = 1e-12 * np.abs(expected).max(axis=0)
        assert (np.abs(found - expected) <= atol).all(), function
    state[:, 0] += np.linspace(-1.5, 1.5, len(state))
    closed, expected = (
        (model("margins", state, inputs) > 0.0).all(axis=1) for model in (compiled, arrays)
    )
    assert (closed == expected).all()
    assert min(np.sum(closed), np.sum(~closed)) > 20
    # both refuse by their margins
    for one, given, closes in zip(state[::20], inputs[::20], closed[::20], strict=True):
        for model in (arrays, compiled):
            if closes:
                model("positions", one, given)
            else:
                with pytest.raises(ClosureError, match="carrier"):
                    model("positions", one, given)
    text = Path(compiled.module.__file__).with_name(f"{ARM.name}.c").read_text()
    assert text.count("for (int i = 0; i < ITERATIONS; ++i)") == 1  # for all loops
    assert f"#define ITERATIONS {ITERATIONS}\n" in text
    rest = kintrafo.System(compiled.module).state()
    result = kintrafo.simulate(kintrafo.System(compiled.module), (0.0, 0.2), rest)
    assert np.isfinite(result.y).all()


def test_documents_say_that_it_iterates(built):
    module = built(ARM.name).module
    assert "Some loops of this model are solved by iteration." in module.__doc__
    assert f"held by {', '.join(RODS[ARM.name])}" in " ".join(module.__doc__.split())
    assert "iterates: pose_of_carrier" in module.rhs.__doc__
    assert "iterates" not in module.relative_coordinates.__doc__
    assert "not free of iteration" not in double_wishbone.__doc__


def test_report_names_the_equations_of_the_loops(derive):
    text = markdown(derive(ARM.name))
    assert "Some loops of this model are solved by iteration." in text
    for rod in RODS[ARM.name]:
        assert f"|{rod}_outer - {rod}_inner| = length of {rod}" in text
    assert text.count("no closed form: 3 equations for the pose of carrier") == 3


def test_angles_of_the_links_can_be_reported():
    cross = CONTROL_ARM.joint("upper_link_cross")
    angles = (
        cross.azimuth("link_azimuth", "azimuth"),
        cross.elevation("link_elevation", "elevation"),
    )
    mechanism = replace(CONTROL_ARM, coordinates=(*CONTROL_ARM.coordinates, *angles))
    massive = tuple(map(mechanism.body, ("carrier", "wheel")))
    derived = generate(
        replace(ARM, mechanism=mechanism, massive=massive, held={}), derivatives=False
    )
    values = constants_of(derived, {p.name: p.default for p in mechanism.parameters})
    values |= {"arm_angle": 1.5, "rack_position": 0.02, "spin_angle": 0.1}
    shown = derived.functions["relative_coordinates"]
    beta = dict(zip(shown.labels, python(shown)(values), strict=True))
    residuals = derived.functions["residuals"]
    given = {f"given_{name}": value for name, value in beta.items()}
    for left in python(residuals)(values | given):
        assert abs(left) < 1e-14  # of sines
    default = {p.name: p.default for p in mechanism.parameters}
    start, end = (
        np.array([default[f"upper_link_{end}_{a}"] for a in "xyz"]) for end in ("inner", "outer")
    )
    design = {**values, "rack_position": 0.0, "arm_angle": design_angle(derived)}
    beta = dict(zip(shown.labels, python(shown)(design), strict=True))
    x, y, z = (end - start) / np.linalg.norm(end - start)
    # some roundings of a quotient of lengths
    assert float(beta["link_elevation"]) == pytest.approx(np.arcsin(z), abs=1e-14)
    assert float(beta["link_azimuth"]) == pytest.approx(np.arctan2(-x, y), abs=1e-14)


def design_angle(derived):
    """Return the angle of the arm at the design position."""
    parameters = {p.name: p.default for p in derived.formulation.mechanism.parameters}
    return float(Built(derived.formulation, None, parameters).design[0])


# -- errors ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("model", MODELS, ids=lambda m: m.name)
def test_without_permission_the_loop_is_refused(model):
    with pytest.raises(NoClosedFormError) as caught:
        CataloguePlan.of(replace(model, allow_iteration=False))
    text = str(caught.value)
    assert "has no closed form in the catalogue" in text
    assert "leaves 1 equation(s)" in text
    count = len(RODS[model.name])
    assert f"held by {', '.join(RODS[model.name])} together: {count} equations remain" in text
    assert "allow_iteration=True" in text
    with pytest.raises(kintrafo.MechanismError, match="allow_iteration=True"):
        kintrafo.compile(replace(model, allow_iteration=False))


def test_a_hinge_in_place_of_a_ball_joint_has_no_block(refused):
    """A loop that is neither in the catalogue nor of a body on rods is refused in any case."""
    ball, line = held_by_rods.LOWER_BALL, Line(held_by_rods.ARM_BALL, held_by_rods.SPIN_AXIS)
    hinge = Revolute("lower_ball", held_by_rods.LOWER_ARM, held_by_rods.CARRIER, axis=line)
    model = changed(ARM, (ball, hinge))
    refused(NoClosedFormError, lambda: CataloguePlan.of(model))


def test_rods_on_the_ground_only_cannot_move(refused):
    """The body they hold is a part of the ground, and its inertia is none of the equations'."""
    crosses = [FIVE_LINK.joint(f"{rod}_cross") for rod in ("toe_link", "push_rod")]
    model = changed(FIVE, *((c, replace(c, first=held_by_rods.CHASSIS)) for c in crosses))
    refused(NoClosedFormError, lambda: generate(model))
