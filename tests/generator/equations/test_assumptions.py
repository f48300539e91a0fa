"""Assumptions of the equations about the geometry: other geometry is refused.

Each case changes one number by which a plane is left, a shaft misses its rod or a rotor its
bearing. The amounts that the messages name are computed here from the numbers of the case.
"""

import re
from dataclasses import replace

import numpy as np
import pytest
from kintrafo import generator as g
from kintrafo.equations.errors import ParameterError
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.program.vectors import Vector
from mechanisms.every_closed_form import (
    NORMAL,
    Parts,
    askew,
    guide,
    heading,
    hinge,
    reported,
    spatial_four_bar,
)
from support.changes import changed, with_default
from support.models import Built, derive, has_gcc, own


def make(model):
    """Build a model over NumPy arrays, and as C where there is a compiler."""
    return [
        own(model, arrays=arrays, derivatives=False)
        for arrays in ([True, False] if has_gcc else [True])
    ]


def numbers(model):
    """Return the default parameters."""
    return {p.name: p.default for p in model.mechanism.parameters}


def moved(values, name, by):
    """Return parameters with a vector added to a point or a direction."""
    return dict(values) | {
        f"{name}_{axis}": values[f"{name}_{axis}"] + float(step)
        for axis, step in zip("xyz", by, strict=True)
    }


def vector(values, name):
    return np.array([values[f"{name}_{axis}"] for axis in "xyz"])


def unit(v):
    return np.asarray(v) / np.linalg.norm(v)


def accepted(modules, values):
    """See that parameters are taken by all builds of a model."""
    for module in modules:
        module.prepare(values)


def refusal(modules, values):
    """Return the message of `prepare` for refused parameters, which is the same in all builds."""
    messages = set()
    for module in modules:
        with pytest.raises(ParameterError) as caught:
            module.prepare(values)
        messages.add(str(caught.value))
    (text,) = messages
    return text


def amount(text, unit):
    """Return the number in front of a unit in a message."""
    found = re.search(rf"off by (\S+) {unit}", text)
    assert found is not None, text
    return float(found[1])


def with_joint(model, joint):
    """Return a model with another joint of the same name."""
    return changed(model, (model.mechanism.joint(joint.name), joint))


def declared(name, joints, points, directions, independent):
    """Return a model of the bodies that some joints connect, each with its centre of mass."""
    bodies = {"ground": g.Ground("ground")}
    for body in (b for joint in joints for b in (joint.first, joint.second)):
        if body not in bodies:
            bodies[body] = g.Body(body, 1.0, (0.1, 0.2, 0.1), (0.02, 0.03, 0.04))
    parts = Parts(
        bodies,
        {n: g.Point(n, place) for n, place in points.items()},
        {n: g.Direction(n, along) for n, along in directions.items()},
    )
    built = tuple(sketch.of(parts) for sketch in joints)
    mechanism = g.Mechanism(name, name, built, coordinates=reported(built))
    return g.Formulation(
        name, name, mechanism, independent=tuple(map(mechanism.joint, independent))
    )


def by_directions(model):
    """Give every hinge a direction of its own, every other one the other way round."""
    return _lines(model, lambda joint, place: g.Direction(f"{joint.name}_line", place))


def by_points(model):
    """Make every hinge a line through two points, every other one the other way round."""
    return _lines(model, lambda joint, place: g.Point(f"{joint.name}_line", place), by_points=True)


def _lines(model, towards, *, by_points=False):
    values, normal = numbers(model), np.array(NORMAL)
    hinges = [j for j in model.mechanism.joints if isinstance(j, g.Revolute)]
    for i, joint in enumerate(hinges):
        place = (-1.0) ** i * (0.3 + 0.2 * i) * normal
        if by_points:
            place += vector(values, joint.axis.through.name)
        end = towards(joint, tuple(place.tolist()))
        model = with_joint(model, replace(joint, axis=g.Line(joint.axis.through, end)))
    return model


def by_the_oracle(model, module, values):
    """Compare poses and accelerations with those in maximal coordinates."""
    built = Built.of(model, module, values)
    state = np.array([0.4, -0.7, 1.1, 0.8])
    motion = built.motion(state, np.zeros(0))
    # 1e-14, 1e-13: some roundings of lengths of 1 m, and of accelerations of about 10 m/s^2
    np.testing.assert_allclose(built.oracle.closure(motion).value, 0.0, atol=1e-14)
    angles = [built.oracle.driven(motion, joint.name).value[0] for joint in model.independent]
    np.testing.assert_allclose(angles, state[:2], atol=1e-14)
    expected = built.oracle.reduced(motion, {}, {}).accelerations
    assert np.abs(expected).min() > 1e-2  # both are moved by something
    np.testing.assert_allclose(built("rhs", state)[2:], expected, atol=1e-13)


# -- guides and the plane of their loop -----------------------------------------------------------

SLIDER_CRANK = declared(
    "oblique",
    (
        hinge("drive", "ground", "crank", "crank_bearing", "normal"),
        hinge("knee", "crank", "rod", "crank_pin", "normal"),
        hinge("wrist", "piston", "rod", "piston_pin", "normal"),
        guide("way", "ground", "piston", "way_axis"),
    ),
    {
        "crank_bearing": askew(0.0, 0.0, 0.05),
        "crank_pin": askew(0.0, 0.1, -0.02),
        "piston_pin": askew(0.3, 0.02, 0.03),
    },
    {"normal": NORMAL, "way_axis": heading(0.2)},
    ("drive",),
)


def test_a_guide_that_leaves_the_plane_of_its_loop_is_refused():
    modules, values = make(SLIDER_CRANK), numbers(SLIDER_CRANK)
    length = np.linalg.norm(vector(values, "way_axis"))
    for degrees in (-40.0, 1e-3, 1e-6, 0.0573):
        lean = length * np.tan(np.radians(degrees)) * unit(NORMAL)
        text = refusal(modules, moved(values, "way_axis", lean))
        assert "ground - crank - rod - piston" in text
        assert "guide way is not across the hinge drive" in text
        assert "turn the direction way_axis" in text
        assert amount(text, "degrees") == pytest.approx(abs(degrees), rel=5e-3)  # three digits


def test_rounding_of_a_direction_is_no_error():
    modules, values = make(SLIDER_CRANK), numbers(SLIDER_CRANK)
    for factor in (1e-9, 1.0 / 3.0, 1e9):  # a direction may have any length
        scaled = {k: factor * v if k.startswith("way_axis") else v for k, v in values.items()}
        accepted(modules, scaled)
    accepted(modules, moved(values, "way_axis", 1e-11 * np.array(NORMAL)))
    # nor are points far from the origin, where their coordinates have fewer digits
    far = dict(values)
    for name in ("crank_bearing", "crank_pin", "piston_pin", "crank_com", "rod_com", "piston_com"):
        far = moved(far, name, (1e4, -2e4, 3e3))
    accepted(modules, far)


def test_equations_do_not_read_what_must_be_zero():
    model = derive(SLIDER_CRANK, derivatives=False)
    (assumption,) = model.assumptions
    assert str(assumption.quantity) in model.prepare.labels
    for function in model.functions.values():
        assert assumption.quantity not in function.free_symbols


def crane(*, reverse=False):
    """Return a boom and a cylinder in an oblique plane; the guide is declared from pin to pin."""
    pins = ("barrel_pin", "piston_pin") if reverse else ("piston_pin", "barrel_pin")
    return declared(
        "crane",
        (
            hinge("foot", "ground", "barrel", "barrel_pin", "normal"),
            guide("bore", "piston", "barrel", pins),
            hinge("head", "piston", "boom", "piston_pin", "normal"),
            hinge("pivot", "ground", "boom", "boom_bearing", "normal"),
        ),
        {
            "boom_bearing": askew(0.0, 0.0, 0.05),
            "barrel_pin": askew(0.3, -0.05, 0.02),
            "piston_pin": askew(0.12, 0.25, 0.02),
        },
        {"normal": NORMAL},
        ("pivot",),
    )


def test_pins_of_a_cylinder_at_different_places_along_their_hinges_are_refused():
    model = crane()
    modules, values = make(model), numbers(model)
    span = vector(values, "piston_pin") - vector(values, "barrel_pin")
    beside = moved(values, "piston_pin", 0.05 * unit(NORMAL))
    text = refusal(modules, beside)
    assert "guide bore is not across the hinge" in text
    assert "move piston_pin or barrel_pin along the direction of that hinge" in text
    angle = np.degrees(np.arctan2(0.05, np.linalg.norm(span)))
    assert amount(text, "degrees") == pytest.approx(angle, rel=5e-3)
    # the remedy in the message: the other pin along its hinge, too
    both = moved(beside, "barrel_pin", 0.05 * unit(NORMAL))
    for module in modules:
        built = Built.of(model, module, both)
        motion = built.motion(np.array([0.1, 0.7]), np.zeros(0))
        # rounding of lengths below 1 m
        np.testing.assert_allclose(built.oracle.closure(motion).value, 0.0, atol=1e-14)


@pytest.mark.parametrize("reverse", [False, True])
def test_defaults_that_leave_the_plane_are_refused_before_anything_is_compiled(refused, *, reverse):
    model = crane(reverse=reverse)
    beside = moved(numbers(model), "barrel_pin", 0.05 * unit(NORMAL))
    refused(g.DeclarationError, lambda: generate(with_default(model, **beside)))


# -- shafts of crosses ----------------------------------------------------------------------------


@pytest.mark.parametrize("at_rocker", [False, True])
def test_a_shaft_that_is_not_the_line_of_its_rod_is_refused(*, at_rocker):
    model = spatial_four_bar("bent", cross_at_rocker=at_rocker)
    declared_cross = model.mechanism.joint("cross")
    assert isinstance(declared_cross, g.Universal)
    values = numbers(model)
    near, far = ("rocker_end", "crank_end") if at_rocker else ("crank_end", "rocker_end")
    along = vector(values, far) - vector(values, near)
    beyond = tuple((vector(values, near) + 1.3 * along).tolist())
    bent = replace(declared_cross, shaft=g.Line(declared_cross.at, g.Point("knee", beyond)))
    model = with_joint(model, bent)
    modules, values = make(model), numbers(model)  # on the line, if not at the pin: accepted
    across = 0.02 * unit(np.cross(along, (0.3, 0.5, -0.2)))
    text = refusal(modules, moved(values, "knee", across))
    assert f"shaft of universal joint cross must be the line of rod, but misses its end {far}" in (
        text
    )
    assert f"declare the shaft from {near} to {far}" in text
    # of a triangle: the distance of the end from the line to the knee
    knee = 1.3 * along + across
    beside = np.linalg.norm(along - unit(knee) * (along @ unit(knee)))
    assert amount(text, "mm") == pytest.approx(1e3 * beside, rel=5e-3)


# -- rotors ---------------------------------------------------------------------------------------


def fan(*, axis=(0.3, 0.9, -0.2), center=(0.1, 0.2, 0.3)):
    """Return a rotor in a bearing on an arm; the axis and the centre of the rotor are free."""
    foot, bearing = g.Point("foot", (0.0, 0.0, 0.0)), g.Point("bearing", (0.1, 0.2, 0.3))
    arm = g.Body("arm", 1.0, (0.05, 0.1, 0.1), (0.01, 0.01, 0.01))
    blades = g.Rotor(
        "blades",
        1.5,
        g.Point("blades_com", center),
        axis=g.Direction("blades_axis", axis),
        spin=0.03,
        diametral=0.02,
    )
    swing_line = g.Direction("swing_line", (1.0, 0.2, 0.1))
    spin_line = g.Direction("spin_line", (0.3, 0.9, -0.2))
    swing = g.Revolute(
        "swing", g.Ground("ground"), arm, g.Line(foot, swing_line), angle_from=g.FORWARD
    )
    spin = g.Revolute("spin", arm, blades, g.Line(bearing, spin_line), angle_from=g.FORWARD)
    joints = (swing, spin)
    mechanism = g.Mechanism("fan", "Fan", joints, (g.Weight(),), reported(joints))
    return g.Formulation("fan", "Fan", mechanism, independent=joints)


def test_a_rotor_beside_its_bearing_is_refused():
    modules, values = make(fan()), numbers(fan())
    accepted(modules, moved(values, "blades_com", 0.4 * np.array([0.3, 0.9, -0.2])))  # along it
    across = 0.004 * unit(np.cross((0.3, 0.9, -0.2), (0.0, 0.0, 1.0)))
    text = refusal(modules, moved(values, "blades_com", across))
    assert "centre of mass of rotor blades is beside its bearing spin" in text
    assert amount(text, "mm") == pytest.approx(4.0, rel=1e-6)
    lean = np.linalg.norm((0.3, 0.9, -0.2)) * np.tan(np.radians(2.0)) * unit(across)
    text = refusal(modules, moved(values, "blades_axis", lean))
    assert "axis of rotor blades is not along its bearing spin" in text
    assert amount(text, "degrees") == pytest.approx(2.0, rel=1e-6)


@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("tip", [None, (0.4, 0.1, 0.2), (-0.4, 0.3, 0.2)])
def test_the_axis_of_a_rotor_may_point_against_its_hinge(sense, tip):
    """The sense of the angle is that of the hinge: its line, or as an ``angle_to`` makes it."""
    x, y, z = (sense * component for component in (0.3, 0.9, -0.2))
    model = fan(axis=(x, y, z))
    if tip is not None:
        spin = model.mechanism.joint("spin")
        assert isinstance(spin, g.Revolute)
        model = with_joint(model, replace(spin, angle_to=g.Point("tip", tip)))
    by_the_oracle(model, own(model, derivatives=False), numbers(model))


def test_all_that_is_wrong_with_the_defaults_is_reported_at_once():
    wrong = fan(axis=(0.3, 0.9, 0.0), center=(0.1, 0.2, 0.31))
    with pytest.raises(g.DeclarationError) as caught:
        generate(wrong)
    assert len(caught.value.problems) == 2


# -- hinges of any direction ----------------------------------------------------------------------

EDGE_AT = g.Point("edge_at", (0.9, 0.4, 0.1))


def gate(line, **flap):
    """Return a leaf on a post with a flap at its end; no angle counts from or to anything."""
    model = declared(
        "gate",
        (
            hinge("post", "ground", "leaf", "pintle", "post_line"),
            hinge("edge", "leaf", "flap", "edge_at", "edge_line"),
        ),
        {"pintle": (0.0, 0.1, 0.2), "edge_at": EDGE_AT.place},
        {"post_line": line, "edge_line": (0.2, 0.5, 1.0)},
        ("post", "edge"),
    )
    return with_joint(model, replace(model.mechanism.joint("edge"), **flap))


def test_a_hinge_may_have_any_direction_then_and_later():
    """Upright with the defaults, and turned all around afterwards."""
    upright = gate((0.0, 0.0, 1.0))
    for module in make(upright):
        for line in (
            (0.0, 0.0, 1.0),
            (0.0, 0.0, -2.0),
            (1e-12, 0.0, 1.0),
            (0.0, -1e-9, -1.0),
            (1.0, 0.0, 0.0),
            (0.0, -1.0, 0.0),
            (0.3, 0.5, -0.2),
        ):
            turned = dict(zip(("post_line_x", "post_line_y", "post_line_z"), line, strict=True))
            by_the_oracle(upright, module, numbers(upright) | turned)


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 0), (0, 0, -1)])
def test_a_hinge_along_a_chassis_axis_needs_no_other_direction(axis):
    """Not even as a parameter: the direction that the angle would count from is not read."""
    fixed = g.Line(EDGE_AT, g.Direction("fixed", fixed=Vector.of(*axis)))
    models = [gate((0.1, 0.2, 1.0), axis=fixed, angle_from=start) for start in (g.UP, g.FORWARD)]
    texts = [str(generate(model, derivatives=False).functions["rhs"]) for model in models]
    assert texts[0] == texts[1]
    for module in make(models[0]):
        by_the_oracle(models[0], module, numbers(models[0]))


def test_an_angle_that_counts_from_along_its_hinge_is_refused_by_name(refused):
    refused(
        g.DeclarationError,
        lambda: gate(
            (0.0, 0.0, 1.0),
            axis=g.Line(EDGE_AT, g.UP),
            angle_from=g.UP,
            angle_to=g.Point("flap_tip", (1.2, 0.3, 0.5)),
        ),
    )


# -- hinges that are parallel by their numbers ----------------------------------------------------


def four_bar():
    """Return a four-bar in an oblique plane, its points at different heights."""
    return declared(
        "four_bar",
        (
            hinge("a", "ground", "crank", "at_a", "normal"),
            hinge("b", "coupler", "crank", "at_b", "normal"),
            hinge("c", "coupler", "rocker", "at_c", "normal"),
            hinge("d", "ground", "rocker", "at_d", "normal"),
        ),
        {
            "at_a": askew(0.0, 0.0, 0.02),
            "at_b": askew(0.0, 0.1, -0.03),
            "at_c": askew(0.24, 0.26, 0.04),
            "at_d": askew(0.3, 0.0, 0.0),
        },
        {"normal": NORMAL},
        ("a",),
    )


def driven_crane():
    """Return the crane with the stroke of its cylinder given."""
    model = crane()
    return replace(model, independent=(model.mechanism.joint("bore"),))


@pytest.mark.parametrize("lines", [by_directions, by_points])
@pytest.mark.parametrize("declare", [four_bar, lambda: SLIDER_CRANK, crane, driven_crane])
def test_hinges_parallel_or_opposite_by_their_numbers_make_a_plane(declare, lines):
    """Angles are right-handed about the axis of their own hinge, wherever that points."""
    model = lines(declare())
    built = Built.of(model, own(model, derivatives=False))
    for start, rate in ((0.0, 1.3), (0.12, -2.1), (-0.07, 0.9)):
        state = np.array([start, rate])
        motion = built.motion(state, np.zeros(0))
        closure = built.oracle.closure(motion)
        # rounding of lengths below 1 m, and of the speeds and accelerations that follow from them
        np.testing.assert_allclose(closure.value, 0.0, atol=1e-14)
        np.testing.assert_allclose(closure.rate, 0.0, atol=1e-13)
        jets = [
            built.oracle.coordinate(motion, c.joint, c.kind) for c in model.mechanism.coordinates
        ]
        np.testing.assert_allclose(
            built("relative_coordinates", state), [jet.value[0] for jet in jets], atol=1e-13
        )
        expected = built.oracle.reduced(motion, {}, {}).accelerations
        np.testing.assert_allclose(built("rhs", state)[1:], expected, rtol=1e-12)


@pytest.mark.parametrize("lines", [by_directions, by_points])
def test_a_hinge_that_leaves_the_others_is_refused(lines):
    model = lines(four_bar())
    modules, values = make(model), numbers(model)
    along = vector(values, "c_line")
    if lines is by_points:
        along = along - vector(values, "at_c")
    lean = np.linalg.norm(along) * np.tan(np.radians(0.2)) * unit(heading(0.7))
    text = refusal(modules, moved(values, "c_line", lean))
    assert "its hinges d and c are not parallel" in text
    assert amount(text, "degrees") == pytest.approx(0.2, rel=1e-2)
    accepted(modules, moved(values, "c_line", -2.0 * along))  # the other way round
