"""Jacobians against differentiation of the program.

Complex steps cannot be taken through compiled real arithmetic. Instead the symbolic program is
differentiated in 50 digits by a central difference with a step of 1e-15, whose own error is below
1e-20 of the derivative: that comparison is as sharp as the arithmetic of the compiled function.
`test_mechanisms` compares the other Jacobians with the oracle.
"""

import mpmath
import numpy as np
import pytest
from cars.instants import MODELS, At, Instant, car_parameters, random_instants
from oracle.newton import Mechanism
from oracle.reference import BETA1_DESIGN
from support.symbolic import derivatives_of

SEEDS = range(4)  # 0 is the reference car
POINTS = 3  # for each car


DERIVATIVES = {
    "relative_jacobian": ("relative_coordinates", "STATE"),
    "rhs_jacobian": ("rhs", "STATE"),
    "rhs_jacobian_rack_held": ("rhs_rack_held", "STATE"),
    "rhs_input_jacobian": ("rhs", "INPUTS"),
    "signals_jacobian": ("signals", "STATE"),
    "signals_input_jacobian": ("signals", "INPUTS"),
}
"""Of each Jacobian, the function that it differentiates, and by what."""


def gradient_of_program(model, function, at, names):
    """Differentiate the symbolic program of a function by elements of state or inputs."""
    values = {}
    for keys, array in (
        (at.model.CONSTANTS, at.constants),
        (at.model.STATE, at.state),
        (at.model.INPUTS, at.inputs),
    ):
        values |= {key: mpmath.mpf(v) for key, v in zip(keys, array.tolist(), strict=True)}
    return derivatives_of(model.functions[function], values, names)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(
    ("name", "jacobian"),
    [(n, j) for n, model in MODELS.items() for j in DERIVATIVES if hasattr(model, j)],
)
def test_derivatives_of_the_program(derived, name, jacobian, seed):
    model, (function, by) = MODELS[name], DERIVATIVES[jacobian]
    parameters = car_parameters(seed, model)
    constants = model.prepare(parameters)
    rng = np.random.default_rng(seed)
    for instant in random_instants(rng, Mechanism(parameters), POINTS):
        at = At(model, instant, constants)
        found = at(jacobian)
        names = list(getattr(model, by))[: found.shape[1]]
        with mpmath.workdps(50):
            expected = gradient_of_program(derived(name), function, at, names)
        # Row by row, since a row has one unit: some hundred roundings of its largest element. Of
        # one where nothing acts (the spring's length by the rack, with a seat at the ball joint)
        # the roundings of what cancels remain.
        size = np.maximum(np.abs(expected).max(axis=1, keepdims=True), 1.0)
        assert (np.abs(found - expected) <= 1e-12 * size).all()


@pytest.mark.parametrize(
    ("parameter", "signal"),
    [
        ("bump_stop_length", "strut_length"),
        ("rebound_stop_length", "strut_length"),
        ("tyre_free_height", "wheel_center_z"),
    ],
)
def test_derivatives_on_both_sides_of_a_kink(derived, parameter, signal):
    """A nanometre from first touch, or from the air, the derivative is that of its own side."""
    name, touch = "macpherson_general", {"tyre_damper_rate": 0.0}
    instant = Instant(BETA1_DESIGN, 0.5, 0.01, 0.3, 50.0, 0.1)

    def at_kink(distance):
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
