"""The most natural mistakes in a declaration: each is told by its name, its value and a remedy.

Every row is what somebody may write, with words that the message must have. Nothing is derived.
"""

from __future__ import annotations

import re
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import kintrafo
import numpy as np
import pytest
import sympy as sp
from kintrafo.generated import double_wishbone, front_axle, macpherson_general
from kintrafo.generated import four_bar as four_bar_equations
from kintrafo.generator import (
    UP,
    AlongLine,
    AlongTelescope,
    Body,
    DamperTable,
    DeclarationError,
    Direction,
    ForceElement,
    Friction,
    Input,
    JointForce,
    Line,
    LinearDamper,
    LinearSpring,
    LinearTyre,
    Parameter,
    Point,
    Prismatic,
    Revolute,
    Spherical,
    Stop,
    TwistOfHinges,
    Weight,
    backends,
    direction,
    point,
    rigid_body,
)
from kintrafo.generator.mechanisms.double_wishbone import DOUBLE_WISHBONE
from kintrafo.generator.mechanisms.double_wishbone import MODELS as WISHBONES
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
from kintrafo.generator.mechanisms.four_bar import MODELS as FOUR_BARS
from kintrafo.generator.mechanisms.planar import flat
from own_models import needs_gcc, own

(FOUR, WISHBONE) = (FOUR_BARS[0], WISHBONES[0])
A, B = Point("a"), Point("b")
AXIS = Line(A, UP)
BETWEEN = AlongLine(("crank", A), ("rocker", B))
SPRING = LinearSpring(rate="spring_rate", free_length="spring_free_length")
(COIL, TORQUE) = FOUR_BAR.forces
(TYRE,) = (f for f in DOUBLE_WISHBONE.forces if isinstance(f, LinearTyre))
COORDINATE = FOUR_BAR.coordinates[0]


def four_bar(**changes):
    """Return the four-bar with changes."""
    return replace(FOUR_BAR, **changes)


def with_force(*forces, **changes):
    """Return the four-bar with more forces."""
    return four_bar(forces=(*FOUR_BAR.forces, *forces), **changes)


def with_parameter(name, /, **changes):
    """Return the four-bar with a parameter changed."""
    parameters = [replace(p, **changes) if p.name == name else p for p in FOUR_BAR.parameters]
    return four_bar(parameters=tuple(parameters))


def with_joint(number, /, **changes):
    """Return the four-bar with a joint changed."""
    joints = list(FOUR_BAR.joints)
    joints[number] = replace(joints[number], **changes)
    return four_bar(joints=tuple(joints))


def with_body(number, /, **changes):
    """Return the four-bar with a body changed."""
    bodies = list(FOUR_BAR.bodies)
    bodies[number] = replace(bodies[number], **changes)
    return four_bar(bodies=tuple(bodies))


def model(**changes):
    """Return the model of the four-bar with changes."""
    return replace(FOUR, **changes)


def telescope(**changes):
    """Return a force element along the double wishbone's joints, with changes."""
    element = ForceElement(name="extra", path=AlongTelescope("lower_hinge"), laws=(SPRING,))
    changed = replace(element, **changes)
    return replace(DOUBLE_WISHBONE, forces=(*DOUBLE_WISHBONE.forces, changed))


MISTAKES = {
    # -- types: one thing in the place of another
    "star forgotten": (
        lambda: four_bar(parameters=(*FOUR_BAR.parameters, point("a", (0, 0, 0), "a"))),
        ["four_bar", "parameters[25]", "write a star", "*point(...)"],
    ),
    "direction for an axis": (
        lambda: Revolute(name="A", first="a", second="b", axis=Direction("x")),
        ["Revolute 'A'", "axis", "a Line is needed", "Line(point, direction)"],
    ),
    "point for an axis": (
        lambda: Revolute(name="A", first="a", second="b", axis=A),
        ["Revolute 'A'", "axis", "a Line is needed"],
    ),
    "text for a point": (
        lambda: Spherical(name="B", first="a", second="b", at="ball"),
        ["Spherical 'B'", "at", "write Point('ball')"],
    ),
    "line for a direction": (
        lambda: Prismatic(name="P", first="a", second="b", direction=AXIS),
        ["Prismatic 'P'", "direction", "a Direction is needed"],
    ),
    "text for a direction": (
        lambda: Body("wheel", 1, center=A, rotor_axis="spin"),
        ["Body 'wheel'", "rotor_axis", "write Direction('spin')"],
    ),
    "text for a centre": (
        lambda: Body("wheel", 1, center="wheel_com"),
        ["Body 'wheel'", "center", "write Point('wheel_com')"],
    ),
    "place for a point": (
        lambda: Body("wheel", 1, center=(0.0, 0.0, 0.0)),
        ["Body 'wheel'", "center is (0.0, 0.0, 0.0)", "a Point is needed"],
    ),
    "body for its name": (
        lambda: Revolute(name="A", first=Body("crank", 1, center=A), second="b", axis=AXIS),
        ["Revolute 'A'", "first", "a text is needed", "'crank'"],
    ),
    "point for its name": (
        lambda: AlongLine((A, "crank"), ("rocker", B)),
        ["AlongLine", "first[0]", "a text", "first[1]", "a Point"],
    ),
    "number for a parameter's name": (
        lambda: LinearSpring(rate=400.0, free_length="l"),
        ["LinearSpring", "rate is 400.0", "a text is needed"],
    ),
    "parameter for its name": (
        lambda: Weight(gravity=Parameter("g", 9.81, "m/s^2", "gravity")),
        ["Weight", "gravity", "a text is needed", "'g'"],
    ),
    "class for an object": (
        lambda: Line(A, Direction),
        ["Line", "towards", "write Direction(...)"],
    ),
    "joint for its name": (
        lambda: AlongTelescope(FOUR_BAR.joints[0]),
        ["AlongTelescope", "joint", "a text is needed", "'A'"],
    ),
    "law for a force": (
        lambda: with_force(SPRING),
        ["four_bar", "forces[2]", "LinearSpring", "a law acts in an element", "laws="],
    ),
    "none for a force": (lambda: with_force(None), ["forces[2] is None", "Weight", "JointForce"]),
    "text for a force": (lambda: with_force("spring"), ["forces[2] is 'spring'", "ForceElement"]),
    "law without brackets": (
        lambda: replace(COIL, laws=SPRING),
        ["ForceElement 'spring'", "laws", "in brackets with a comma"],
    ),
    "force for a law": (lambda: replace(COIL, laws=(COIL,)), ["laws[0]", "a LinearSpring"]),
    "text for a law": (lambda: replace(COIL, laws=("spring",)), ["laws[0] is 'spring'"]),
    "path without its class": (
        lambda: replace(COIL, path=(("crank", A), ("rocker", B))),
        ["path", "an AlongTelescope, an AlongLine or a TwistOfHinges is needed"],
    ),
    "one body without brackets": (
        lambda: four_bar(bodies=FOUR_BAR.bodies[0]),
        ["bodies", "a tuple is needed", "with a comma"],
    ),
    "name of a joint for a joint": (
        lambda: four_bar(joints=("A", "B")),
        ["joints[0] is 'A'", "a Joint is needed"],
    ),
    "names of inputs without meaning": (
        lambda: four_bar(inputs=("crank_torque",)),
        ["inputs[0] is 'crank_torque'", "an Input is needed"],
    ),
    "input with a unit only": (
        lambda: four_bar(inputs=(Input("crank_torque", "N m"),)),
        ["Input 'crank_torque'", "meaning is missing"],
    ),
    "model for a mechanism": (
        lambda: model(mechanism=FOUR),
        ["Model 'four_bar'", "mechanism", "a Mechanism is needed"],
    ),
    "text for independent": (
        lambda: model(independent="A"),
        ["independent is 'A'", "write a tuple of names, ('A',)"],
    ),
    "text for massive": (lambda: model(massive="crank"), ["massive is 'crank'", "('crank',)"]),
    "joint for independent": (
        lambda: model(independent=(FOUR_BAR.joints[0],)),
        ["independent[0]", "a text is needed", "'A'"],
    ),
    "words for permission": (
        lambda: model(allow_iteration="no"),
        ["allow_iteration is 'no'", "True or False"],
    ),
    "list of prescribed joints": (
        lambda: model(prescribed=("A",)),
        ["prescribed", "a dictionary is needed"],
    ),
    "text for what is held": (
        lambda: replace(WISHBONE, held={"still": "rack_guide"}),
        ["held['still'] is 'rack_guide'", "('rack_guide',)"],
    ),
    "expression that is no expression": (
        lambda: four_bar(derived={"x": "-y"}),
        ["derived['x'] is '-y'", "Expr is needed"],
    ),
    # -- fields
    "misspelt field": (
        lambda: Revolute(name="A", frist="a", second="b", axis=AXIS),
        ["Revolute 'A'", "frist is none of its fields", "Did you mean first?"],
    ),
    "field left out": (
        lambda: Revolute(name="A", first="a", second="b"),
        ["Revolute 'A'", "axis is missing"],
    ),
    "argument too many": (
        lambda: Point("a", "x", "y"),
        ["Point 'a'", "'y' is one argument too many", "name, flat"],
    ),
    "unit and meaning left out": (
        lambda: Parameter("mass", 1.0),
        ["Parameter 'mass'", "unit is missing", "meaning is missing"],
    ),
    "path left out": (lambda: ForceElement(name="s", laws=()), ["'s'", "path is missing"]),
    "point without a name": (Point, ["Point", "name is missing"]),
    "end without a point": (
        lambda: AlongLine(("crank",), ("rocker", B)),
        ["AlongLine", "first is ('crank',), too few"],
    ),
    # -- words of a choice
    "stop with a capital": (
        lambda: Stop(side="Bump", length="l", rate="r", progression="p"),
        ["Stop", "side is 'Bump'", "'bump' or 'rebound' is needed"],
    ),
    "stop at the top": (
        lambda: Stop(side="top", length="l", rate="r", progression="p"),
        ["side is 'top'", "'bump' or 'rebound'"],
    ),
    "stop at no side": (
        lambda: Stop(side=None, length="l", rate="r", progression="p"),
        ["side is None", "'bump' or 'rebound'"],
    ),
    "flat along a number": (lambda: Point("a", flat=2), ["flat is 2", "'z'"]),
    "kind of a coordinate": (
        lambda: four_bar(coordinates=(replace(COORDINATE, kind="slide"),)),
        ["'crank_angle'", "kind 'slide' is not declared", "angle"],
    ),
    # -- numbers
    "not a number": (
        lambda: Parameter("a", float("nan"), "m", "a"),
        ["Parameter 'a'", "default nan", "no finite real number"],
    ),
    "infinite": (lambda: Parameter("a", np.inf, "m", "a"), ["default inf", "finite"]),
    "number in quotes": (lambda: Parameter("a", "1.0", "m", "a"), ["default '1.0'", "give one"]),
    "imaginary": (lambda: Parameter("a", 1j, "m", "a"), ["default 1j", "real"]),
    "an array": (lambda: Parameter("a", np.ones(3), "m", "a"), ["default array", "real"]),
    "a symbol": (lambda: Parameter("a", sp.Symbol("x"), "m", "a"), ["default x", "real"]),
    "beyond double precision": (lambda: Parameter("a", 10**400, "m", "a"), ["finite"]),
    "two coordinates of three": (
        lambda: point("a", (0.0, 1.0), "a"),
        ["point 'a'", "position", "too few"],
    ),
    "four coordinates of three": (
        lambda: point("a", (0.0, 1.0, 2.0, 3.0), "a"),
        ["point 'a'", "position", "shorter"],
    ),
    "a coordinate in quotes": (
        lambda: direction("a", (0.0, "1", 0.0), "a"),
        ["direction 'a'", "components[1] '1'", "real number"],
    ),
    "inertia as a matrix": (
        lambda: rigid_body("a", 1.0, (0, 0, 0), np.eye(3)),
        ["rigid_body 'a'", "inertia"],
    ),
    "fixed direction of zeros": (
        lambda: Direction("a", fixed=(0, 0, 0)),
        ["Direction 'a'", "fixed (0, 0, 0)", "not all of them zero"],
    ),
    "fixed direction of two": (lambda: Direction("a", fixed=(0, 1)), ["fixed", "three numbers"]),
    "no segments": (lambda: DamperTable(name="d", segments=0), ["segments is 0", "1 or more"]),
    "half a segment": (lambda: DamperTable(name="d", segments=1.5), ["segments is 1.5", "whole"]),
    "negative mass": (
        lambda: with_parameter("crank_mass", default=-1.0),
        ["'crank_mass' = -1 kg", "0 kg or more"],
    ),
    "negative inertia": (
        lambda: with_parameter("crank_inertia_zz", default=-1e-3),
        ["'crank_inertia_zz' = -0.001 kg m^2", "0 kg m^2 or more"],
    ),
    "negative rate": (
        lambda: with_parameter("spring_rate", default=-400.0),
        ["'spring_rate' = -400 N/m", "0 N/m or more"],
    ),
    "negative length": (
        lambda: with_parameter("spring_free_length", default=-0.3),
        ["'spring_free_length' = -0.3 m", "0 m or more"],
    ),
    "negative damping": (
        lambda: with_parameter("damper_rate", default=-1.0),
        ["'damper_rate' = -1 N s/m", "0 N s/m or more"],
    ),
    "beyond a bound of its own": (
        lambda: with_parameter("spring_ground_x", most=0.4),
        ["'spring_ground_x' = 0.45 m", "0.4 m or less"],
    ),
    "gravity upwards": (
        lambda: replace(
            DOUBLE_WISHBONE,
            parameters=tuple(
                replace(p, default=-9.81) if p.name == "gravity" else p
                for p in DOUBLE_WISHBONE.parameters
            ),
        ),
        ["'gravity' = -9.81 m/s^2", "0 m/s^2 or more"],
    ),
    "friction without a speed": (
        lambda: with_force(
            ForceElement(
                name="f",
                path=TwistOfHinges("A", "D"),
                laws=(Friction(level="damper_rate", speed="spring_free_length"),),
            ),
            parameters=tuple(
                replace(p, default=0.0) if p.name == "spring_free_length" else p
                for p in FOUR_BAR.parameters
            ),
        ),
        ["'spring_free_length' = 0 m", "more than 0 m"],
    ),
    # -- names
    "space in a name": (lambda: Point("ball joint"), ["'ball joint' cannot be written in C"]),
    "dash in a name": (lambda: Body("tie-rod", 1, center=A), ["'tie-rod' cannot be written in C"]),
    "digit first": (lambda: Direction("2nd"), ["'2nd' cannot be written in C", "a letter first"]),
    "empty name": (lambda: Parameter("", 1.0, "m", "a"), ["'' cannot be written in C"]),
    "accent": (lambda: with_joint(0, name="müde"), ["'müde' cannot be written in C"]),
    "tyre named after its wheel": (
        lambda: replace(TYRE, name="front-left"),
        ["LinearTyre 'front-left'", "cannot be written in C"],
    ),
    "dash in a model's name": (lambda: model(name="four-bar"), ["Model", "'four-bar' cannot"]),
    "macro of math.h": (
        lambda: with_parameter("spring_rate", name="NAN"),
        ["parameter 'NAN'", "choose another"],
    ),
    "another macro": (
        lambda: with_parameter("spring_rate", name="INFINITY"),
        ["parameter 'INFINITY'", "choose another"],
    ),
    "macro of the emitted code": (
        lambda: with_parameter("spring_rate", name="GUARD_FLOOR"),
        ["parameter 'GUARD_FLOOR'", "choose another"],
    ),
    "keyword of C": (
        lambda: with_parameter("spring_rate", name="double"),
        ["parameter 'double'", "choose another"],
    ),
    "keyword of Python": (
        lambda: with_parameter("spring_rate", name="lambda"),
        ["parameter 'lambda'", "choose another"],
    ),
    "coordinate named after a function": (
        lambda: four_bar(coordinates=(replace(COORDINATE, name="sin"),)),
        ["coordinate 'sin'", "choose another"],
    ),
    "body's number twice": (lambda: with_body(2, number=1), ["number of bodies: '1'", "2 times"]),
    "body twice": (lambda: with_body(2, name="crank"), ["body 'crank' is declared 2 times"]),
    "joint twice": (lambda: with_joint(1, name="A"), ["joint 'A' is declared 2 times"]),
    "element twice": (lambda: with_force(COIL), ["force 'spring' is declared 2 times"]),
    "other element of the name": (
        lambda: with_force(ForceElement(name="spring", path=BETWEEN, laws=(SPRING,))),
        ["force 'spring' is declared 2 times"],
    ),
    "torque twice": (
        lambda: with_force(TORQUE),
        ["JointForce along 'A by crank_torque' is declared 2"],
    ),
    "law twice": (
        lambda: four_bar(forces=(replace(COIL, laws=(SPRING, SPRING)),)),
        ["'spring'", "law", "is declared 2 times"],
    ),
    "weight twice": (
        lambda: with_force(Weight(gravity="damper_rate"), Weight(gravity="damper_rate")),
        ["weight 'Weight' is declared 2 times"],
    ),
    "parameter twice": (
        lambda: four_bar(parameters=(*FOUR_BAR.parameters, FOUR_BAR.parameters[0])),
        ["parameter 'crank_bearing_x' is declared 2 times"],
    ),
    "point and direction of one name": (
        lambda: with_joint(0, axis=Line(flat("crank_bearing"), Direction("rocker_pin"))),
        ["'rocker_pin' is a direction and a point", "a name of its own"],
    ),
    "point in a plane and in space": (
        lambda: with_joint(0, axis=Line(Point("crank_bearing"), UP)),
        ["'crank_bearing' is a point in a plane across z and a point with x, y and z"],
    ),
    "variant named after a function": (
        lambda: replace(WISHBONE, held={"jacobian": ("rack_guide",)}),
        ["variant 'jacobian'", "rhs_jacobian", "rename it"],
    ),
    # -- what belongs to what
    "misspelt body": (
        lambda: with_joint(1, second="cuopler"),
        ["joint 'B': body 'cuopler'", "did you mean 'coupler'?"],
    ),
    "joint of a body with itself": (
        lambda: with_joint(0, second="ground"),
        ["joint 'A' connects 'ground' with itself", "two bodies"],
    ),
    "misspelt joint of a torque": (
        lambda: with_force(JointForce(joint="Z", input="crank_torque")),
        ["JointForce: joint 'Z' is not declared", "A, B, C, D"],
    ),
    "misspelt input": (
        lambda: four_bar(forces=(JointForce(joint="A", input="crank_troque"),)),
        ["input 'crank_troque'", "did you mean 'crank_torque'?"],
    ),
    "misspelt body of a spring": (
        lambda: with_force(
            ForceElement(name="s", path=AlongLine(("crnk", A), ("rocker", B)), laws=(SPRING,))
        ),
        ["ForceElement 's': body 'crnk'", "did you mean 'crank'?"],
    ),
    "both ends on one body": (
        lambda: AlongLine(("crank", A), ("crank", B)),
        ["AlongLine", "both ends are on 'crank'", "two bodies"],
    ),
    "twist of one hinge": (
        lambda: TwistOfHinges("main", "main"),
        ["TwistOfHinges", "'main' less itself", "two hinges"],
    ),
    "telescope of a hinge": (
        telescope,
        ["'extra': joint 'lower_hinge' is revolute, not cylindrical", "AlongLine"],
    ),
    "telescope of a ball joint": (
        lambda: telescope(path=AlongTelescope("lower_ball")),
        ["joint 'lower_ball' is spherical, not cylindrical"],
    ),
    "twist of a guide": (
        lambda: telescope(path=TwistOfHinges("rack_guide", "bearing")),
        ["joint 'rack_guide' is prismatic, not revolute"],
    ),
    "spring without a free length": (
        lambda: with_force(replace(COIL, name="s", laws=(LinearSpring(rate="spring_rate"),))),
        ["'s'", "free_slide or a free_length"],
    ),
    "line to itself": (lambda: Line(A, A), ["Line", "from 'a' to itself"]),
    "direction between one point": (
        lambda: Direction("d", between=(A, A)),
        ["Direction 'd'", "between 'a' and itself"],
    ),
    "direction given twice": (
        lambda: Direction("d", fixed=(0, 0, 1), between=(A, B)),
        ["Direction 'd'", "fixed and between", "leave one"],
    ),
    "spring between coincident points": (
        lambda: four_bar(
            parameters=tuple(
                replace(p, default={"x": 0.12, "y": 0.18}[p.name[-1]])
                if p.name.startswith("spring_ground_")
                else p
                for p in FOUR_BAR.parameters
            )
        ),
        ["points 'spring_ground' and 'coupler_com'", "coincide", "check the defaults"],
    ),
    "no bodies": (lambda: four_bar(bodies=()), ["no bodies", "one of them is fixed"]),
    "misspelt independent joint": (
        lambda: model(independent=("a",)),
        ["independent joint 'a' is not declared", "A"],
    ),
    "ball joint as independent": (
        lambda: replace(WISHBONE, independent=("lower_ball",)),
        ["'lower_ball' is spherical", "three hinges"],
    ),
    "ground with mass": (
        lambda: model(massive=("ground", "crank")),
        ["'ground' is the ground", "leave it out"],
    ),
    "torque on what follows": (
        lambda: replace(model(), mechanism=with_force(JointForce(joint="D", input="crank_torque"))),
        ["'D' is neither independent nor prescribed", "Actuator"],
    ),
    "one motion for two joints": (
        lambda: model(independent=(), prescribed={"A": "drive", "D": "drive"}),
        ["input of prescribed joints 'drive' is declared 2 times"],
    ),
    "misspelt prescribed input": (
        lambda: replace(WISHBONE, prescribed={"rack_guide": "rak"}),
        ["input 'rak_position'", "did you mean 'rack_position'?"],
    ),
    "end of a comment": (lambda: four_bar(title="a */ b"), ["'a */ b'", "without */"]),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_told(mistake):
    make, words = MISTAKES[mistake]
    with pytest.raises(DeclarationError) as caught:
        make()
    assert isinstance(caught.value, kintrafo.KintrafoError)
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        (2, 2.0),
        (Decimal("0.1"), 0.1),
        (Fraction(1, 3), 1 / 3),
        (100 * sp.pi, 100 * np.pi),
        (np.float32(0.5), 0.5),
        (np.int64(-3), -3.0),
        (np.array(2.5), 2.5),
    ],
    ids=lambda value: type(value).__name__,
)
def test_every_real_number_is_one(given, expected):
    default = Parameter("a", given, "m", "a").default
    assert type(default) is float
    assert default == pytest.approx(expected, rel=1e-15)
    assert [p.default for p in point("a", (given, 0, 0), "a")] == [default, 0.0, 0.0]


def test_lists_do_for_tuples():
    listed = four_bar(bodies=list(FOUR_BAR.bodies), joints=list(FOUR_BAR.joints))
    assert listed == FOUR_BAR
    assert model(independent=["A"], massive=list(FOUR.massive)) == FOUR
    assert Direction("up", [0, 0, 1]) == Direction("up", (0, 0, 1))


def test_a_stop_between_hinges_has_an_angle_of_any_sign():
    """A length is not negative, but an angle may be."""
    stop = Stop(side="bump", length="angle", rate="spring_rate", progression="damper_rate")
    parameters = (*FOUR_BAR.parameters, Parameter("angle", -0.5, "rad", "angle of the stop"))
    bar = ForceElement(name="bar", path=TwistOfHinges("A", "D"), laws=(stop,))
    with_force(bar, parameters=parameters)
    line = ForceElement(name="bar", path=COIL.path, laws=(stop,))
    with pytest.raises(DeclarationError, match=r"'angle' = -0\.5 rad is out of its range"):
        with_force(line, parameters=parameters)


# -- parameters of compiled models ----------------------------------------------------------------


@pytest.mark.parametrize(
    ("equations", "changes", "words"),
    [
        (four_bar_equations, {"crank_mass": -1.0}, "'crank_mass' = -1 kg .* give 0 kg or more"),
        (four_bar_equations, {"coupler_inertia_zz": -1e-9}, "'coupler_inertia_zz' = -1e-09 kg m"),
        (four_bar_equations, {"spring_rate": -1.0}, "'spring_rate' = -1 N/m is out"),
        (four_bar_equations, {"spring_free_length": -0.1}, "'spring_free_length' = -0.1 m is out"),
        (macpherson_general, {"tyre_lifts_off": 2.0}, "'tyre_lifts_off' = 2 is out .* 1 or less"),
        (
            macpherson_general,
            {"strut_friction_speed": 0.0},
            "'strut_friction_speed' = 0 m/s .* more than 0 m/s",
        ),
        (double_wishbone, {"gravity": -9.81}, r"'gravity' = -9.81 m/s\^2 is out"),
        (double_wishbone, {"knuckle_inertia_xx": 9.0}, "inertia of 'knuckle': .* those of no body"),
        (double_wishbone, {"wheel_inertia_spin": 9.0}, "'wheel_inertia_spin' = 9 .* flat disc"),
        (front_axle, {"knuckle_mass": -1.0}, "'knuckle_mass' = -1 kg is out"),
    ],
)
def test_parameters_out_of_range_reach_no_model(equations, changes, words):
    """The way of every set of parameters is `prepare`, by name or in order."""
    values = {n: e["default"] for n, e in equations.PARAMETERS.items()} | changes
    for make in (
        lambda: kintrafo.System(equations, changes),
        lambda: equations.prepare(values),
        lambda: equations.prepare(list(values.values())),
    ):
        with pytest.raises(kintrafo.ParameterError, match=words):
            make()


def test_masses_and_rates_may_be_zero():
    kintrafo.System(four_bar_equations, {"crank_mass": 0.0, "spring_rate": 0.0})


# Names of C, of its library, of Python and of what is emitted, which nothing that is emitted needs.
WORDS = """
exp log pow fabsf isnan signbit fmin fma gamma j0 y1 yn I errno main printf stdin values x least
size_t len sum max min print range self math sp rhs margins results_ Array float_ sp_
"""


@needs_gcc
def test_words_of_c_and_python_can_be_parameters():
    """What is not reserved compiles, without a warning, and is what it says."""
    words = WORDS.split()
    dampers = tuple(LinearDamper(rate=word) for word in words)
    element = ForceElement(name="dampers", path=COIL.path, laws=dampers)
    rates = tuple(Parameter(word, 1.0, "N s/m", word) for word in words)
    mechanism = with_force(element, parameters=(*FOUR_BAR.parameters, *rates))
    declared = model(mechanism=mechanism, name="words")
    compiled, arrays = (kintrafo.System(own(declared, arrays=a)) for a in (False, True))
    state = compiled.state(crank_angle=0.3, crank_angle_rate=2.0)
    for system in (compiled, arrays):
        signals = system.signals(state)
        total = float(len(words) * signals["dampers_velocity"])
        # so many equal terms are added, each with its rounding
        assert signals["dampers_damper_force"] == pytest.approx(-total, rel=1e-14)


def test_macros_of_the_emitted_code_are_reserved():
    folder = Path(backends.__file__).parent
    printers, templates = (
        "".join(p.read_text(encoding="utf-8") for p in sorted(folder.rglob(f"*{suffix}")))
        for suffix in (".py", ".in")
    )
    defined = {*re.findall(r"#define ([A-Z][A-Z_]+)\b", printers + templates)}
    defined |= {*re.findall(r"(?m)^([A-Z][A-Z_]+) = ", templates)}
    assert {"ROUNDING", "CONVERGED"} <= defined
    for name in sorted(defined):
        with pytest.raises(DeclarationError, match=f"parameter '{name}' has a name that"):
            with_parameter("spring_rate", name=name)
