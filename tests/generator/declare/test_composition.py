"""Copies and mirror images of declarations, and the twist between two hinges.

The mirror is tested by what it means: at the same coordinates, rates and inputs the image of a
mechanism has the same accelerations, and its bodies are where a mirror shows those of the original.
"""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from kintrafo import generator as g
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.mechanisms import double_wishbone, four_bar, macpherson, slider_crank
from kintrafo.generator.mechanisms.suspension import RACK_FORCE
from oracle.maximal import Motion, Oracle
from oracle.reference import completed, general_parameters
from support.changes import changed
from support.models import Built, shipped
from support.symbolic import constants_of, python

IMAGE = np.diag([1.0, -1.0, 1.0])
DECLARED = {
    m.name: m
    for m in (*four_bar.MODELS, *slider_crank.MODELS, *double_wishbone.MODELS, macpherson.MODELS[2])
}


def image_of(model):
    """Return the mirror image of a model, under other names."""
    image = g.Copy(model.mechanism, "m_", mirrored=True)
    return replace(
        model,
        mechanism=image.mechanism,
        independent=image.of(model.independent),
        prescribed=image.of(model.prescribed),
        massive=image.of(model.massive),
        held={},
    )


def parameters_of(model):
    """Return the declared parameters, or for a general strut those of a car that uses them all."""
    names = [p.name for p in model.mechanism.parameters]
    if model.name.startswith("macpherson"):
        car = completed(general_parameters(np.random.default_rng(5), offset=0.03))
        return {name: car[name] for name in names}
    return {p.name: p.default for p in model.mechanism.parameters}


def evaluated(derived, function, values):
    """Evaluate a function of the symbolic program."""
    return np.array([float(x) for x in python(derived.functions[function])(values)])


# -- the mirror ------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", DECLARED)
def test_a_mirror_image_moves_as_a_mirror_shows(name):
    model = DECLARED[name]
    built = Built.of(model, shipped(model), parameters_of(model))
    rng = np.random.default_rng([*name.encode()])
    size = built.size
    state = np.concatenate((built.design + rng.uniform(-0.1, 0.1, size), rng.normal(size=size)))
    inputs = 0.02 * rng.standard_normal(len(built.module.INPUTS))

    image = generate(image_of(model), derivatives=False)
    named = [e.name for e in (*image.state, *image.inputs)]
    values = dict(zip(named, [*state, *inputs], strict=True))
    values |= constants_of(image, built.parameters)

    expected = built("rhs", state, inputs)
    # the same numbers in other axes: some hundred roundings
    scale = 1e-12 * np.abs(expected).max()
    np.testing.assert_allclose(evaluated(image, "rhs", values), expected, rtol=0.0, atol=scale)
    places = evaluated(image, "positions", values).reshape(-1, 3)
    np.testing.assert_allclose(places, built("positions", state, inputs) @ IMAGE, atol=1e-13)
    turns = evaluated(image, "orientations", values).reshape(-1, 3, 3)
    expected = IMAGE @ built("orientations", state, inputs) @ IMAGE
    np.testing.assert_allclose(turns, expected, atol=1e-13)


def test_the_image_of_an_image_is_the_original():
    source = double_wishbone.DOUBLE_WISHBONE
    once = g.Copy(source, "a_", mirrored=True).mechanism
    twice = g.Copy(once, "b_", mirrored=True).mechanism
    own = [p for p in source.parameters if p.name != "gravity"]  # the weight is that of all
    assert len(twice.derived) == len(own)
    for parameter in own:
        assert twice.derived[f"b_a_{parameter.name}"] == sp.Symbol(parameter.name)
    axis = twice.joint("b_a_upper_hinge").axis.vector.x  # turned round twice, too
    start, end = (sp.Symbol(f"b_a_upper_arm_{where}_x") for where in ("rear", "front"))
    assert axis == end - start


def test_fixed_directions_that_are_their_own_image_stay():
    source = macpherson.mechanism()
    image = g.Copy(source, "m_", mirrored=True).mechanism
    assert image.joint("m_C").first_axis is source.joint("C").first_axis
    assert image.joint("m_OA").angle_from is source.joint("OA").angle_from


# -- parameters and names --------------------------------------------------------------------------


def test_copies_read_the_parameters_of_the_declaration():
    source = macpherson.mechanism()
    shared = (macpherson.RACK, RACK_FORCE)
    left = g.Copy(source, "left_", mirrored=True, shared=shared).mechanism
    assert left.parameters == source.parameters
    read = left.derived
    assert read["left_ball_joint_x"] == sp.Symbol("ball_joint_x")
    assert read["left_ball_joint_y"] == -sp.Symbol("ball_joint_y")
    assert read["left_spin_axis_x"] == -sp.Symbol("spin_axis_x")
    assert read["left_spin_axis_y"] == sp.Symbol("spin_axis_y")
    assert read["left_knuckle_inertia_xy"] == -sp.Symbol("knuckle_inertia_xy")
    assert read["left_knuckle_inertia_xz"] == sp.Symbol("knuckle_inertia_xz")
    assert read["left_wheel_inertia_spin"] == sp.Symbol("wheel_inertia_spin")
    assert left.joint("y") == source.joint("y")
    assert "rack_force" in left.input_names
    assert "left_road_height" in left.input_names


def test_a_copy_may_have_parameters_of_its_own():
    source = macpherson.mechanism()
    own_ones = (macpherson.SPRING_RATE, macpherson.BALL_JOINT)
    left = g.Copy(source, "left_", mirrored=True, own=own_ones).mechanism
    own = {p.name: p.default for p in left.parameters if p.name.startswith("left_")}
    ball_joint = {"left_ball_joint_x": 0.005, "left_ball_joint_y": 0.71, "left_ball_joint_z": 0.18}
    assert own == {"left_spring_rate": 25000.0} | ball_joint
    assert "left_spring_rate" not in left.derived
    assert "spring_rate" not in {p.name for p in left.parameters}


def test_what_parts_have_in_common_is_there_once():
    source = macpherson.mechanism()
    shared = (macpherson.RACK, RACK_FORCE)
    parts = [g.Copy(source, p, shared=shared) for p in ("a_", "b_")]
    whole = g.combined("pair", "Two on one rack", parts)
    names = [b.name for b in whole.bodies]
    assert names.count("rack") == names.count("chassis") == 1
    assert len(names) == 2 * len(source.bodies) - 2
    assert list(whole.numbers.values()) == list(range(1, len(names) + 1))
    assert sum(isinstance(f, g.Weight) for f in whole.forces) == 1
    assert sum(isinstance(f, g.JointForce) for f in whole.forces) == 1
    assert [c.name for c in whole.coordinates].count("beta9") == 1
    assert len(whole.parameters) == len(source.parameters)


@pytest.mark.parametrize(
    "asked", [{"shared": (g.Input("track", "m", "track"),)}, {"own": (macpherson.STRUT_LOWER,)}]
)
def test_what_a_copy_does_not_know(asked, refused):
    refused(g.DeclarationError, lambda: g.Copy(macpherson.mechanism(), "left_", **asked))


def test_a_direction_that_the_mirror_would_turn_both_ways(refused):
    source = macpherson.mechanism()
    hinge = source.joint("OA")
    skew = replace(hinge, axis=g.Line(hinge.axis.through, macpherson.RACK_AXIS))
    refused(
        g.DeclarationError, lambda: g.Copy(changed(source, (hinge, skew)), "left_", mirrored=True)
    )


def test_a_prefix_that_makes_the_name_of_a_parameter(refused):
    source = macpherson.mechanism()
    clash = replace(macpherson.TYRE_RATE, name="left_spring_rate")
    refused(
        g.DeclarationError, lambda: g.Copy(changed(source, (macpherson.TYRE_RATE, clash)), "left_")
    )


# -- twist -----------------------------------------------------------------------------------------

PIVOT = g.Point("pivot", (0.0, 0.0, 1.0))
ELBOW = g.Point("elbow", (0.3, 0.1, 0.9))
TIP = g.Point("tip", (0.5, 0.3, 0.6))
UPPER = g.Body("upper", 1.5, (0.2, 0.05, 0.95), (0.02, 0.03, 0.01))
LOWER = g.Body("lower", 0.8, (0.4, 0.2, 0.7), (0.01, 0.02, 0.015))
HINGES = {
    "shoulder": g.Revolute(
        "shoulder",
        g.Ground("ground"),
        UPPER,
        axis=g.Line(PIVOT, g.Direction("shoulder_axis", (0.1, 1.0, 0.2))),
        angle_to=ELBOW,
    ),
    "elbow": g.Revolute(
        "elbow", UPPER, LOWER, axis=g.Line(ELBOW, g.Direction("elbow_axis", (1.0, 0.2, -0.1)))
    ),
}
LAWS = (
    g.LinearSpring(
        g.TorsionRate("rate", 30.0, "rate"), free_length=g.Angle("free", 0.2, "free angle")
    ),
    g.LinearDamper(g.TorsionDamperRate("damper", 0.4, "damping")),
    g.Friction(
        g.MomentLevel("friction", 0.7, "friction"),
        g.AngularSpeed("speed", 0.5, "speed of friction"),
    ),
    g.Stop(
        side="bump",
        length=g.Angle("stop", 1.0, "stop"),
        rate=g.TorsionRate("stop_rate", 50.0, "rate of the stop"),
        progression=g.TorsionProgression("stop_growth", 20.0, "progression of the stop"),
    ),
    g.Actuator(g.Input("motor", "N m", "moment of a motor")),
)


def pendulum(first, second):
    """Return a double pendulum about oblique axes, with everything between its two hinges."""
    shoulder, elbow = HINGES.values()
    mechanism = g.Mechanism(
        name="pendulum",
        title="Double pendulum",
        joints=(shoulder, elbow),
        forces=(
            g.Weight(),
            g.ForceElement("bar", g.TwistOfHinges(HINGES[first], HINGES[second]), LAWS),
        ),
        coordinates=(
            shoulder.angle("q1", "angle of the shoulder"),
            elbow.angle("q2", "angle of the elbow"),
        ),
    )
    return g.Formulation("pendulum", "Double pendulum", mechanism, (shoulder, elbow))


@pytest.mark.parametrize("order", [("shoulder", "elbow"), ("elbow", "shoulder")])
def test_moments_between_hinges_are_those_of_their_angles(order):
    """Both hinges are driven, so the moment acts on the coordinates as it is, with both signs."""
    model = pendulum(*order)
    derived = generate(model, derivatives=False)
    given = {p.name: p.default for p in model.mechanism.parameters}
    sense = 1.0 if order[1] == "elbow" else -1.0
    q, rates = np.array([1.2, 0.6]), np.array([1.5, -0.8])
    values = dict(zip(("q1", "q2", "q1_rate", "q2_rate"), [*q, *rates], strict=True))
    values |= constants_of(derived, given) | {"motor": 1.3}
    forces = evaluated(derived, "forces", values)
    calm = dict.fromkeys(("rate", "damper", "friction", "stop_rate", "stop_growth"), 0.0)
    weight = constants_of(derived, given | calm) | {"motor": 0.0}
    weight = evaluated(derived, "forces", values | weight)
    twist, speed = sense * (q[1] - q[0]), sense * (rates[1] - rates[0])
    pressed = max(1.0 - twist, 0.0)
    moment = 30.0 * (0.2 - twist) - 0.4 * speed - 0.7 * speed / np.hypot(speed, 0.5)
    moment += 50.0 * pressed + 20.0 * pressed**3 + 1.3
    expected = moment * sense * np.array([-1.0, 1.0])
    np.testing.assert_allclose(forces - weight, expected, rtol=1e-13)
    signals = dict(
        zip(derived.functions["signals"].labels, evaluated(derived, "signals", values), strict=True)
    )
    assert signals["bar_angle"] == pytest.approx(twist, rel=1e-14)
    assert signals["bar_angular_velocity"] == pytest.approx(speed, rel=1e-14)
    assert signals["bar_spring_moment"] == pytest.approx(30.0 * (0.2 - twist), rel=1e-13)
    assert {s.unit for s in derived.signals} == {"rad", "rad/s", "N m"}


# -- parts in axes of their own --------------------------------------------------------------------


def pair_of_pendulums(*, roped):
    """Return a double pendulum and its mirror image, also with a spring from tip to tip."""
    one = pendulum("shoulder", "elbow")
    a, b = g.Copy(one.mechanism, "a_"), g.Copy(one.mechanism, "b_", mirrored=True)
    rope = g.ForceElement(
        "rope",
        g.AlongLine((a.of(LOWER), a.of(TIP)), (b.of(LOWER), b.of(TIP))),
        (
            g.LinearSpring(
                g.SpringRate("rope_rate", 80.0, "rate of the rope"),
                free_length=g.Length("rope_length", 0.3, "free length of the rope"),
            ),
        ),
    )
    both = g.combined("pendulums", "Two pendulums", (a, b), forces=(rope,) if roped else ())
    joints = a.of(one.independent) + b.of(one.independent)
    return g.Formulation("pendulums", "Two pendulums", both, joints)


def test_a_spring_between_parts_is_that_of_the_maximal_coordinates():
    model = pair_of_pendulums(roped=True)
    derived = generate(model, derivatives=False)
    given = {p.name: p.default for p in model.mechanism.parameters}
    state = [1.2, 0.6, 0.9, -0.4, 1.5, -0.8, 0.3, 2.0]
    values = dict(zip([e.name for e in derived.state], state, strict=True))
    inputs = {"a_motor": 1.3, "b_motor": -0.7}
    values |= constants_of(derived, given) | inputs
    twists = evaluated(derived, "velocities", values).reshape(-1, 6)
    motion = Motion(
        np.concatenate((np.zeros((1, 3)), evaluated(derived, "positions", values).reshape(-1, 3))),
        np.concatenate(
            (np.eye(3)[None], evaluated(derived, "orientations", values).reshape(-1, 3, 3))
        ),
        np.concatenate((np.zeros((1, 6)), np.roll(twists, 3, axis=1))),
    )
    oracle = Oracle(model, given)
    np.testing.assert_allclose(oracle.closure(motion).value, 0.0, atol=1e-14)
    found, expected = evaluated(derived, "rhs", values)[4:], oracle.reduced(motion, inputs, {})
    scale = 1e-12 * np.abs(expected.accelerations).max()
    np.testing.assert_allclose(found, expected.accelerations, rtol=0.0, atol=scale)
    length = oracle.length(motion, model.mechanism.elements[-1])
    signals = dict(
        zip(derived.functions["signals"].labels, evaluated(derived, "signals", values), strict=True)
    )
    assert signals["rope_length"] == pytest.approx(length.value[0], rel=1e-14)
    assert signals["rope_velocity"] == pytest.approx(length.rate[0], rel=1e-13)


def test_a_mirror_image_has_the_constants_of_the_original():
    one, both = (
        generate(m) for m in (pendulum("shoulder", "elbow"), pair_of_pendulums(roped=False))
    )
    # what two parts have alike is one step, with any signs
    assert len(both.prepare.steps) == len(one.prepare.steps)
    assert len(both.prepare.results) == len(one.prepare.results)
