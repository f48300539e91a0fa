"""The wheel as a rotor folded into its carrier, against the wheel as any other rigid body.

A wheel that is declared with a rotor axis gives its mass and its transverse inertia to the knuckle,
and only its spin is kept apart. Declared without one, it is a body with a full tensor that turns
with the spin angle. Where the tensor is that of a body of revolution both must be equal, exactly;
where it is not, the unfolded equations must still be those of the oracle.
"""

from dataclasses import replace
from functools import cache

import mpmath
import numpy as np
import pytest
from cars.instants import MODELS, car_parameters, counted_by, random_instants
from kintrafo.generator import Body, Motion, Rotor
from kintrafo.generator.mechanisms import MODELS as DECLARED
from mechanisms.every_closed_form import oblique_four_bar
from oracle.constraints import WHEEL
from oracle.newton import Mechanism
from oracle.random_states import check_with_the_oracle
from oracle.reference import INERTIA_ELEMENTS, inertia
from support.changes import changed, named
from support.models import derive
from support.symbolic import constants_of, python

SEEDS = range(3)  # 0 is the reference car
POINTS = 2  # for each car

pytestmark = pytest.mark.slow


def without_rotor(model):
    """Return a model whose wheel is a body with a full inertia tensor."""
    wheel = named(model, Rotor, "wheel")
    return changed(model, (wheel, Body("wheel", wheel.mass.default, wheel.center, (0.0, 0.0, 0.0))))


@cache
def unfolded(name):
    """Derive a model without the rotor."""
    return derive(
        without_rotor(next(model for model in DECLARED if model.name == name)), derivatives=False
    )


def with_tensor(parameters, tensor):
    """Return parameters whose wheel has a tensor (chassis axes at design) instead of moments."""
    given = {k: v for k, v in parameters.items() if not k.startswith("wheel_inertia")}
    for element in INERTIA_ELEMENTS:
        row, column = ("xyz".index(axis) for axis in element)
        given[f"wheel_inertia_{element}"] = tensor[row][column]
    return given


def exact_tensor(parameters):
    """Return the tensor of the wheel of revolution in mpmath's precision."""
    axis = mpmath.matrix([parameters[f"spin_axis_{a}"] for a in "xyz"])
    axis /= mpmath.norm(axis)
    spin, across = (parameters[f"wheel_inertia_{kind}"] for kind in ("spin", "diametral"))
    tensor = across * mpmath.eye(3) + (mpmath.mpf(spin) - across) * axis * axis.T
    return tensor.tolist()


def evaluate(model, constants, function, state, inputs):
    """Evaluate a function of a derived model in mpmath's precision."""
    values = dict(constants)
    values |= zip([e.name for e in model.state], map(mpmath.mpf, state.tolist()), strict=True)
    values |= zip([e.name for e in model.inputs], map(mpmath.mpf, inputs.tolist()), strict=True)
    return python(model.functions[function])(values)


def instants(name, seed):
    parameters = car_parameters(seed, MODELS[name])
    car = Mechanism(parameters)
    return parameters, random_instants(np.random.default_rng(50 + seed), car, POINTS)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", MODELS)
def test_folding_is_exact(derived, name, seed):
    parameters, at_instants = instants(name, seed)
    with mpmath.workdps(50):
        general = with_tensor(parameters, exact_tensor(parameters))
        one, other = (
            (derived(name), constants_of(derived(name), parameters)),
            (unfolded(name), constants_of(unfolded(name), general)),
        )
        for instant in at_instants:
            arrays = instant.arrays(MODELS[name])
            for function in ("rhs", "mass_matrix", "bias", "forces"):
                folded, expected = (evaluate(*m, function, *arrays) for m in (one, other))
                # fifty digits, of which the differences of terms take a few
                allowed = mpmath.mpf(10) ** -40 * max(map(abs, folded))
                pairs = zip(folded, expected, strict=True)
                assert all(abs(a - b) <= allowed for a, b in pairs), function


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", MODELS)
def test_unbalanced_wheel(name, seed):
    """A wheel that is no body of revolution: the equations depend on the spin angle."""
    parameters, at_instants = instants(name, seed)
    tensor = inertia(parameters, "wheel") + np.array(
        [[0.10, 0.03, -0.05], [0.03, 0.02, 0.04], [-0.05, 0.04, 0.15]]
    )
    car = Mechanism(counted_by(MODELS[name], parameters))
    car.inertias[WHEEL - 1] = tensor
    constants = constants_of(unfolded(name), with_tensor(parameters, tensor.tolist()))
    for instant in at_instants:
        arrays = instant.arrays(MODELS[name])
        found = evaluate(unfolded(name), constants, "rhs", *arrays)
        count = len(found) // 2
        solution = instant.solution(MODELS[name], car)
        expected = solution.coordinate_accelerations[:count]
        # as for the other comparisons of accelerations with the oracle
        assert np.array(found[count:], dtype=float) == pytest.approx(expected, rel=1e-10, abs=1e-10)


def test_a_rotor_whose_spin_is_given_carries_its_inertia_like_any_body(tmp_path):
    model = oblique_four_bar()
    (spinning,) = (joint for joint in model.independent if joint.name == "spinning")
    driven = replace(
        model,
        name="driven_wheel",
        independent=tuple(joint for joint in model.independent if joint != spinning),
        prescribed={spinning: Motion("spin", "rad", "turn of the wheel")},
    )
    check_with_the_oracle(driven, tmp_path, reach=0.2)
