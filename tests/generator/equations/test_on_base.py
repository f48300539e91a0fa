"""Bodies on a moving base: exact derivatives, by corners that do not affect each other."""

import mpmath
import numpy as np
import pytest
from cars.driving_cars import car_on_arms
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.mechanisms import model_named
from kintrafo.vehicle.models.car.equations import declared
from mechanisms.free_bodies import freed
from support.models import derive
from support.symbolic import constants_of, derivatives_of, python


@pytest.fixture(scope="module")
def arms():
    """A car of trailing arms, whose body heaves, pitches and rolls."""
    return derive(declared(car_on_arms()))


@pytest.fixture(scope="module")
def strut():
    """A strut with a rack that moves, on a body in the air."""
    return generate(freed(model_named("macpherson")))


def values_of(model, seed=0, **changed):
    """Return constants, and a state and inputs near the design position."""
    random = np.random.default_rng(seed)
    names = [entry.name for entry in (*model.states.entries, *model.inputs)]
    values = dict(zip(names, random.uniform(-0.1, 0.1, len(names)), strict=True))
    at_design = {entry.name: entry.at_design for entry in model.states.entries}
    values = {name: value + float(at_design.get(name, 0.0)) for name, value in values.items()}
    defaults = {p.name: p.default for p in model.formulation.mechanism.parameters}
    found = constants_of(model, defaults | changed)
    start = dict(zip(model.design.labels, python(model.design)(found | defaults), strict=True))
    near = {n: mpmath.mpf(v) + start.get(n, 0) for n, v in values.items()}
    return found | near


@pytest.mark.parametrize("name", ["arms", "strut"])
def test_derivatives_are_exact(name, request):
    model = request.getfixturevalue(name)
    with mpmath.workdps(50):
        values = values_of(model)
        states = [entry.name for entry in model.states.entries]
        for function, by in (("rhs", states), ("signals", states[-1:])):
            expected = derivatives_of(model.functions[function], values, by)
            found = python(model.functions[f"{function}_jacobian"])(values)
            found = np.array(found, float).reshape(len(expected), -1)[:, -len(by) :]
            # the differences are of this accuracy; the derivatives are computed in 50 digits
            np.testing.assert_allclose(
                found, expected, rtol=0.0, atol=1e-15 * np.abs(expected).max()
            )


def test_a_corner_is_in_no_derivative_by_another(arms):
    corners = [f"{end}_{side}_" for end in ("front", "rear") for side in ("right", "left")]
    steps = [s.symbol.name.partition("__") for s in arms.functions["rhs_jacobian"].steps]
    for corner in corners:
        others = tuple(c for c in corners if c != corner)
        of_corner = [name for name, _, by in steps if by.startswith(corner)]
        assert of_corner
        mixed = [name for name in of_corner if name.startswith(others)]
        # by the solution of the whole, and nowhere else
        assert all("acceleration" in name or "more" in name for name in mixed), mixed


def test_a_body_may_be_without_mass(strut):
    """Its centre of mass is then its origin, and all is as with hardly any mass."""
    light = [p.name for p in strut.formulation.mechanism.parameters]
    light = [n for n in light if n.startswith("knuckle_") and n.endswith(("mass", "inertia"))]
    light += ["wheel_mass"]
    none, hardly = (
        np.array(python(strut.functions["rhs"])(values_of(strut, **dict.fromkeys(light, m))), float)
        for m in (0.0, 1e-12)
    )
    assert np.isfinite(none).all()
    np.testing.assert_allclose(none, hardly, rtol=1e-9, atol=1e-9 * np.abs(none).max())
