"""Masses that only some coordinates together move: rounding is not taken for one."""

import kintrafo
import numpy as np
import pytest
from kintrafo import generator as g
from kintrafo.systems.compile.compiler import find_compiler

pytestmark = pytest.mark.skipif(find_compiler() is None, reason="no C compiler")

ALONG = g.Direction("along", (0.6, 0.0, 0.8))
MASSES = np.random.default_rng(0).uniform(0.1, 100.0, 50)  # kg


def compiled(name, first, second):
    reported = [j.slide if isinstance(j, g.Prismatic) else j.angle for j in (first, second)]
    shown = tuple(
        name_in(j.name, j.name) for name_in, j in zip(reported, (first, second), strict=True)
    )
    mechanism = g.Mechanism(name, "Two bodies in a row", (first, second), (g.Weight(),), shown)
    model = g.Formulation(name, "Two bodies in a row", mechanism, (first, second))
    return kintrafo.System(kintrafo.compile(model))


@pytest.fixture(scope="module")
def slides():
    """A slide on a slide, on one line: the mass matrix is a constant."""
    bodies = (g.Body(n, 1.0, (0.0, 0.0, 0.0), (0.1, 0.1, 0.1)) for n in ("a", "b"))
    ground, (a, b) = g.Ground("ground"), bodies
    return compiled(
        "slides", g.Prismatic("low", ground, a, ALONG), g.Prismatic("high", a, b, ALONG)
    )


@pytest.fixture(scope="module")
def pendulum():
    """A pendulum on a pendulum, which moves the other way when both are in line."""
    ground, across = g.Ground("ground"), g.Direction("across", (0.0, 1.0, 0.0))
    a = g.Body("a", 1.0, (0.0, 0.0, -0.3), (0.1, 0.1, 0.1))
    b = g.Body("b", 1.0, (0.0, 0.0, -1.0), (0.1, 0.1, 0.1))
    top, middle = g.Point("top", (0.0, 0.0, 0.0)), g.Point("middle", (0.0, 0.0, -0.3))
    return compiled(
        "pendulums",
        g.Revolute("upper", ground, a, g.Line(top, across)),
        g.Revolute("lower", a, b, g.Line(middle, across)),
    )


def of(system, mass):
    """Return parameters by which the second body alone has mass, in a point."""
    light = {n: 0.0 for n in system.parameters if n.endswith("_mass") or "_inertia" in n}
    return light | {"b_mass": float(mass)}


def test_a_constant_mass_matrix(slides):
    """Each mass is refused, for any rounding; the smallest mass between is enough."""
    for mass in MASSES:
        with pytest.raises(kintrafo.ParameterError, match="'high'"):
            kintrafo.System(slides.equations, of(slides, mass))
    light = kintrafo.System(slides.equations, of(slides, 49.0) | {"a_mass": 1e-9})
    falling = light.evaluate("rhs", light.state())
    # both fall along the line at g sin, the second not at all on the first; 49e9 roundings
    np.testing.assert_allclose(falling[2:], [-9.81 * 0.8, 0.0], atol=1e-4)


def test_one_that_varies(pendulum):
    """Refused in line, where only both together move the mass; not where they are not."""
    for mass in MASSES:
        point = kintrafo.System(pendulum.equations, of(pendulum, mass))
        for angle in (0.0, 0.7, 2.0):
            with pytest.raises(kintrafo.ModelError, match="lower"):
                point.evaluate("rhs", point.state(upper=angle))
        assert np.isfinite(point.evaluate("rhs", point.state(upper=0.3, lower=0.5))).all()
