"""Struts in space, and rods on two ball joints: what `test_mechanisms` does not show of them."""

from dataclasses import replace

import numpy as np
import pytest
from kintrafo import generator as g
from kintrafo.equations.errors import ClosureError
from kintrafo.generator.loops.errors import NoClosedFormError
from kintrafo.generator.planning.plan import CataloguePlan
from mechanisms.every_closed_form import spatial_four_bar, turret
from support.changes import changed, named
from support.models import Built, own


def compiled(model):
    """Return a model with its default parameters."""
    return Built.of(model, own(model, derivatives=False))


# -- struts ---------------------------------------------------------------------------------------


def test_a_strut_is_as_long_as_the_way_between_its_ends():
    """All around, and down to a tenth of a millimetre before the ends meet: that alone is singular.

    From some hundredths of a millimetre on its direction would be worse than 1e-9, and is refused.
    """
    model = turret("whole_turn", "lift")
    built = compiled(model)
    bearing, eye = (
        np.array([built.parameters[f"{p}_{a}"] for a in "xyz"]) for p in ("boom_bearing", "eye")
    )
    axis = np.array([built.parameters[f"boom_line_{a}"] for a in "xyz"])
    axis /= np.linalg.norm(axis)
    half_round = bearing + 2 * axis * axis.dot(eye - bearing) - (eye - bearing)
    for beside in (1e-1, 1e-3, 1e-4):
        foot = half_round + np.array([beside, 0.0, 0.0])
        changed = dict(zip((f"foot_{a}" for a in "xyz"), foot, strict=True))
        near = replace(built, parameters={**built.parameters, **changed})
        start = np.linalg.norm(eye - foot)
        column = list(near.module.RELATIVE_COORDINATES).index("stroke_slide")
        for angle in (*np.linspace(-np.pi, np.pi, 25), np.pi - 1e-7):
            state = np.array([0.4, angle, 0.3, 1.0])
            motion = near.motion(state, np.zeros(len(near.module.INPUTS)))
            closure = near.oracle.closure(motion)
            # the line's direction is as exact as positions, 1e-16, over the length of the strut
            np.testing.assert_allclose(closure.value, 0.0, atol=1e-15 + 2e-16 / beside)
            across = eye - bearing - axis * axis.dot(eye - bearing)
            turned = across * np.cos(angle) + np.cross(axis, across) * np.sin(angle)
            length = np.linalg.norm(bearing + (eye - bearing - across) + turned - foot)
            slide = near("relative_coordinates", state)[column]
            assert slide == pytest.approx(length - start, abs=1e-15 + 1e-16 / beside)


def test_ends_that_meet_are_named(refused):
    built = compiled(turret("closed_strut", "stroke"))
    start = np.linalg.norm([0.8, -0.2, 1.1])  # from foot to eye, as declared
    refused(
        ClosureError,
        lambda: built("rhs", np.array([0.0, -1.01 * start, 0.0, 0.0])),
        lambda: built("rhs", np.array([0.0, 3.0, 0.0, 0.0])),
    )


# -- telescopes that may also turn ----------------------------------------------------------------


def telescope(name, *, ball_at_boom):
    """Return the turret with a telescope that may turn about its axis, from a cross to the boom."""
    model = turret(name, "lift")
    foot, eye, seat = (named(model, g.Point, name) for name in ("foot", "eye", "piston_seat"))
    mechanism = model.mechanism
    boom, barrel, piston = map(mechanism.body, ("boom", "barrel", "piston"))
    length = g.Distance("bore_length", 1.4, "length of the telescope at zero slide")
    tube = g.Cylindrical("stroke", barrel, piston, g.Line(eye, foot), length, angle_to=seat)
    mechanism = changed(mechanism, (mechanism.joint("stroke"), tube))
    if not ball_at_boom:
        axis = named(model, g.Direction, "slew_line")
        pin = g.Universal("pin", boom, piston, at=eye, shaft=g.Line(eye, foot), first_axis=axis)
        mechanism = changed(mechanism, (mechanism.joint("pin"), pin))
    massive = tuple(b for b in model.massive if b.name not in mechanism.passive_links)
    return replace(model, mechanism=mechanism, massive=massive)


def test_two_crosses_hold_a_telescope_that_turns():
    built = compiled(telescope("two_crosses", ball_at_boom=False))
    rng = np.random.default_rng(0)
    for state in rng.uniform(-0.4, 0.4, (20, 4)) * [1.0, 1.0, 5.0, 5.0]:
        inputs = np.zeros(len(built.module.INPUTS))
        motion = built.motion(state, inputs)
        closure = built.oracle.closure(motion)
        np.testing.assert_allclose(closure.value, 0.0, atol=2e-15)
        np.testing.assert_allclose(closure.rate, 0.0, atol=2e-14)
        expected = built.oracle.reduced(motion, built.named(inputs), {}).accelerations
        found = built("rhs", state)[2:]
        np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12 * np.abs(expected).max())


def test_a_piston_without_mass_may_turn_as_it_likes():
    model = telescope("free_piston", ball_at_boom=True)
    assert [body.name for body in model.massive] == ["turret", "boom", "barrel"]
    (spring,) = model.mechanism.elements
    eye = model.mechanism.body("boom"), named(model, g.Point, "eye")
    seat = replace(spring, path=g.AlongLine(spring.path.first, eye))
    built = compiled(changed(model, (spring, seat)))
    for state in np.random.default_rng(0).uniform(-0.4, 0.4, (10, 4)):
        closure = built.oracle.closure(built.motion(state, np.zeros(len(built.module.INPUTS))))
        np.testing.assert_allclose(closure.value, 0.0, atol=2e-15)
        np.testing.assert_allclose(closure.rate, 0.0, atol=5e-15)


# -- rods on two ball joints ----------------------------------------------------------------------


def on_two_balls(massive):
    """Return a spatial four-bar whose rod has a ball joint in place of its cross."""
    model = spatial_four_bar("two_balls")
    cross = model.mechanism.joint("cross")
    ball = g.Spherical("cross", cross.first, cross.second, at=cross.center)
    (spring,) = model.mechanism.elements
    end = model.mechanism.body("rocker"), named(model, g.Point, "rocker_end")
    other = replace(spring, path=g.AlongLine(spring.path.first, end))
    bodies = tuple(map(model.mechanism.body, massive))
    return replace(
        changed(replace(model, massive=bodies[:1]), (cross, ball), (spring, other)), massive=bodies
    )


def test_a_rod_without_mass_on_two_balls_is_like_one_with_a_cross():
    model = on_two_balls(("crank", "rocker"))
    balls = compiled(model)
    crossed = spatial_four_bar("with_cross")
    mechanism = replace(crossed.mechanism, forces=model.mechanism.forces)
    crossed = replace(crossed, mechanism=mechanism, massive=model.massive)
    other = compiled(crossed)
    rng = np.random.default_rng(0)
    for angle in np.linspace(-0.5, 0.5, 9):
        state = np.array([angle, rng.normal()])
        assert (balls("rhs", state) == other("rhs", state)).all()
        motion = balls.motion(state, np.zeros(len(balls.module.INPUTS)))
        closure = balls.oracle.closure(motion)
        np.testing.assert_allclose(closure.value, 0.0, atol=1e-15)
        np.testing.assert_allclose(closure.rate, 0.0, atol=1e-14)
        rotation = motion.rotation[2]
        np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=2e-15)
        step = np.array([1e-6, 0.0])
        inputs = np.zeros(len(balls.module.INPUTS))
        ahead, behind = (balls.motion(state + s * step, inputs).rotation[2] for s in (1, -1))
        spin = (ahead - behind) / 2e-6 * state[1] @ rotation.T
        # 1e-8: of the differences
        found = [spin[2, 1], spin[0, 2], spin[1, 0]]
        np.testing.assert_allclose(found, motion.twist[2, 3:], atol=1e-8)


def test_a_rod_with_mass_on_two_balls_is_refused(refused):
    refused(g.DeclarationError, lambda: on_two_balls(("crank", "rod", "rocker")))


def leg_on_a_plate(along):
    """A plate on a hinge, held by a leg of a Stewart platform: cross, guide and ball joint."""
    inertia = (1e-3, 2e-3, 1.5e-3)
    ground = g.Ground("ground")
    plate = g.Body("plate", 1.0, g.Point("plate_com", (0.2, 0.0, 1.0)), inertia)
    tube = g.Body("tube", 1.0, g.Point("tube_com", (0.32, 0.06, 0.3)), inertia)
    piston = g.Body("piston", 1.0, g.Point("piston_com", (0.38, 0.09, 0.8)), inertia)
    line = g.Line(g.Point("bearing", (0.0, 0.0, 1.0)), g.Direction("side", fixed=(0.0, 1.0, 0.0)))
    hinge = g.Revolute("hinge", ground, plate, line)
    joints = (
        hinge,
        g.Universal("cross", ground, tube, FOOT, g.Line(FOOT, along)),
        g.Prismatic("bore", tube, piston, along),
        g.Spherical("ball", plate, piston, HEAD),
    )
    angle = hinge.angle("tilt", "tilt of the plate")
    mechanism = g.Mechanism("plate", "A plate on a leg", joints, (), (angle,))
    return g.Formulation("plate", "A plate on a leg", mechanism, (hinge,))


FOOT, HEAD = g.Point("foot", (0.3, 0.05, 0.0)), g.Point("head", (0.4, 0.1, 1.0))


@pytest.mark.parametrize("numbers", [(0.1, 0.05, 1.0), (-0.1, -0.05, -0.99)])
def test_a_strut_whose_direction_is_given_as_numbers_must_be_between(numbers, refused):
    """The remedy in the message leads to a closed form."""
    elsewhere = (0.3, 0.05, 1.0)  # it may be meant to point there
    for way in ({"fixed": numbers}, {"along": numbers}, {"fixed": elsewhere}):
        with refused(NoClosedFormError):
            CataloguePlan.of(leg_on_a_plate(g.Direction("leg", **way)))
    assert CataloguePlan.of(leg_on_a_plate(g.Direction("leg", between=(FOOT, HEAD)))).transformers
