"""Gravity along the normal of a plane does nothing to what moves in it, which nobody means."""

import kintrafo
import pytest
from kintrafo import generator as g

GROUND = g.Ground("ground")
MASS, ARM, INERTIA, GRAVITY = 2.0, 0.3, 0.05, 9.81


def pendulum(normal, **weight):
    """Return an arm on a hinge across a plane, its centre of mass along x."""
    arm = g.Body("arm", MASS, g.flat("com", (ARM, 0.0), normal=normal), INERTIA)
    pivot = g.hinge("A", GROUND, arm, g.flat("a", (0.0, 0.0), normal=normal))
    forces = (g.Weight(**weight),)
    return g.Mechanism(f"arm_{normal}", "t", (pivot,), forces, (pivot.angle("q", "angle"),))


def upward(*along):
    return {"upward": g.Direction("upward", fixed=along)}


@pytest.mark.parametrize(
    ("normal", "weight"),
    [("z", {}), ("z", upward(0, 0, -2)), ("y", upward(0, 1, 0))],
    ids=["up", "down", "left"],
)
def test_gravity_along_the_normal_is_refused(normal, weight, refused):
    refused(g.DeclarationError, lambda: pendulum(normal, **weight))


def test_so_it_is_where_things_slide_in_the_plane(refused):
    slider = g.Body("slider", 1.0, g.flat("com", (0.1, 0.0)), 0.01)
    rail = g.flat("rail_start", (0.0, 0.0)), g.flat("rail_end", (1.0, 0.5))
    guide = g.Prismatic("guide", GROUND, slider, g.Direction("rail", between=rail))
    named = (guide.slide("s", "slide"),)
    refused(g.DeclarationError, lambda: g.Mechanism("rail", "t", (guide,), (g.Weight(),), named))
    g.Mechanism("rail", "t", (guide,), (g.Weight(**upward(0, 1, 0)),), named)


@pytest.mark.parametrize(
    ("normal", "weight", "sense"), [("y", {}, 1.0), ("z", upward(0, 3, 0), -1.0)]
)
def test_gravity_in_the_plane_is_that_of_a_pendulum(normal, weight, sense, tmp_path):
    """About y, x turns away from z: gravity turns the arm forward."""
    module = kintrafo.compile(pendulum(normal, **weight), backend="numpy", folder=tmp_path)
    expected = sense * MASS * GRAVITY * ARM / (INERTIA + MASS * ARM**2)
    assert module.rhs([[0.0, 0.0]])[0, 1] == pytest.approx(expected, rel=1e-14)


def test_what_may_leave_the_plane_is_none_of_it():
    """An axis by three parameters is upright by its defaults alone."""
    arm = g.Body("arm", 1.0, (0.1, 0.0, 0.0), (0.1, 0.1, 0.1))
    axis = g.Direction("axis", (0.0, 0.0, 1.0))
    pivot = g.Revolute("A", GROUND, arm, g.Line(g.Point("a", (0.0, 0.0, 0.0)), axis))
    g.Mechanism("arm", "t", (pivot,), (g.Weight(),), (pivot.angle("q", "angle"),))
