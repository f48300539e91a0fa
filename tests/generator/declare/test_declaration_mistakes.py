"""The most natural mistakes in a declaration: each message has the name, the value and a remedy.

Every row is what somebody may write. Nothing is derived.
"""

import re
import subprocess
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import kintrafo
import numpy as np
import pytest
import sympy as sp
from kintrafo import generator as g
from kintrafo.generated import double_wishbone, front_axle, macpherson_general
from kintrafo.generated import four_bar as four_bar_equations
from kintrafo.generator.backends.words import ELEMENTARY
from kintrafo.generator.mechanisms import double_wishbone as wishbone
from kintrafo.generator.mechanisms import four_bar as bar
from kintrafo.generator.mechanisms.double_wishbone import DOUBLE_WISHBONE
from kintrafo.generator.mechanisms.double_wishbone import MODELS as WISHBONES
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
from kintrafo.generator.mechanisms.four_bar import MODELS as FOUR_BARS
from kintrafo.simulation.lanes import own as own_lanes
from support import lanes
from support.changes import changed, with_default
from support.models import needs_gcc, own

(FOUR, WISHBONE) = (FOUR_BARS[0], WISHBONES[0])
A, B = g.Point("a", (0.0, 0.0, 0.0)), g.Point("b", (1.0, 0.0, 0.0))
AXIS = g.Line(A, g.UP)
ONE, TWO = bar.CRANK, bar.ROCKER
BETWEEN = g.AlongLine((ONE, A), (TWO, B))
(COIL, TORQUE) = FOUR_BAR.forces
(TYRE,) = (f for f in DOUBLE_WISHBONE.forces if isinstance(f, g.LinearTyre))
RATE, FREE = bar.SPRING.rate, bar.SPRING.free_length


def four_bar(**changes):
    """Return the four-bar with changes."""
    return replace(FOUR_BAR, **changes)


def with_force(*forces, **changes):
    """Return the four-bar with more forces."""
    return four_bar(forces=(*FOUR_BAR.forces, *forces), **changes)


def instead(old, **changes):
    """Return the four-bar with an object changed wherever it is."""
    return changed(FOUR_BAR, (old, replace(old, **changes)))


def model(**changes):
    """Return the model of the four-bar with changes."""
    return replace(FOUR, **changes)


def stop(**changes):
    """Return a stop with changes."""
    rate, progression = g.SpringRate("r", 1.0, "rate"), g.Progression("p", 1.0, "progression")
    given = {"side": "bump", "length": FREE, "rate": rate, "progression": progression}
    return g.Stop(**given | changes)


MISTAKES = {
    # -- types: one thing in the place of another
    "direction for an axis": lambda: g.Revolute("A", ONE, TWO, axis=g.UP),
    "point for an axis": lambda: g.Revolute("A", ONE, TWO, axis=A),
    "text for a point": lambda: g.Spherical("B", ONE, TWO, at="ball"),
    "line for a direction": lambda: g.Prismatic("P", ONE, TWO, direction=AXIS),
    "text for a direction": lambda: g.Rotor("wheel", 1.0, A, axis="spin", spin=1.0, diametral=1.0),
    "text for a centre": lambda: g.Body("wheel", 1.0, com="wheel_com"),
    "text for a mass": lambda: g.Body("wheel", "1.0", A),
    "name of a body for the body": lambda: g.Revolute("A", "crank", TWO, axis=AXIS),
    "end the wrong way round": lambda: g.AlongLine((A, ONE), (TWO, B)),
    "number for a parameter": lambda: g.LinearSpring(400.0, free_length=FREE),
    "name for a parameter": lambda: g.Weight("gravity"),
    "rate of a damper for that of a spring": lambda: g.LinearSpring(
        bar.DAMPER.rate, free_length=FREE
    ),
    "torsion along a line": lambda: replace(
        COIL, laws=(g.LinearSpring(g.TorsionRate("k", 1.0, "k"), free_length=FREE),)
    ),
    "class for an object": lambda: g.Line(A, g.Direction),
    "name of a joint for the telescope": lambda: g.AlongTelescope("BC"),
    "law for a force": lambda: with_force(bar.SPRING),
    "none for a force": lambda: with_force(None),
    "text for a force": lambda: with_force("spring"),
    "law without brackets": lambda: replace(COIL, laws=bar.SPRING),
    "force for a law": lambda: replace(COIL, laws=(COIL,)),
    "text for a law": lambda: replace(COIL, laws=("spring",)),
    "path without its class": lambda: replace(COIL, path=((ONE, A), (TWO, B))),
    "one joint without brackets": lambda: four_bar(joints=bar.A),
    "name of a joint for a joint": lambda: four_bar(joints=("A", "B")),
    "name of an input for an input": lambda: g.JointForce(bar.A, "crank_torque"),
    "input with a unit only": lambda: g.Input("crank_torque", "N m"),
    "derivative of a name": lambda: g.Input("v", "m/s", "velocity", "x"),
    "model for a mechanism": lambda: model(mechanism=FOUR),
    "one independent joint without brackets": lambda: model(independent=bar.A),
    "name for an independent joint": lambda: model(independent=("A",)),
    "name for a body with mass": lambda: model(massive=("crank",)),
    "words for permission": lambda: model(allow_iteration="no"),
    "list of prescribed joints": lambda: model(prescribed=(bar.A,)),
    "joint for what is held": lambda: replace(WISHBONE, held={"still": wishbone.RACK_GUIDE}),
    # -- fields
    "misspelt field": lambda: g.Revolute(name="A", frist=ONE, second=TWO, axis=AXIS),
    "field left out": lambda: g.Revolute("A", ONE, TWO),
    "argument too many": lambda: g.Point("a", (0, 0, 0), "a", "x", "y"),
    "fields that are named, in a row": lambda: g.Stop("bump", 0.1),
    "unit and meaning left out": lambda: g.Parameter("mass", 1.0),
    "path left out": lambda: g.ForceElement("s", laws=()),
    "point without a name": g.Point,
    "end without a point": lambda: g.AlongLine((ONE,), (TWO, B)),
    # -- words of a choice
    "stop with a capital": lambda: stop(side="Bump"),
    "stop at the top": lambda: stop(side="top"),
    "stop at no side": lambda: stop(side=None),
    "flat along a number": lambda: g.Point("a", (0, 0), flat=2),
    # -- numbers
    "not a number": lambda: g.Parameter("a", float("nan"), "m", "a"),
    "infinite": lambda: g.Parameter("a", np.inf, "m", "a"),
    "number in quotes": lambda: g.Parameter("a", "1.0", "m", "a"),
    "imaginary": lambda: g.Parameter("a", 1j, "m", "a"),
    "an array": lambda: g.Parameter("a", np.ones(3), "m", "a"),
    "a symbol": lambda: g.Parameter("a", sp.Symbol("x"), "m", "a"),
    "beyond double precision": lambda: g.Parameter("a", 10**400, "m", "a"),
    "two coordinates of three": lambda: g.Point("a", (0.0, 1.0)),
    "three coordinates in a plane": lambda: g.Point("a", (0.0, 1.0, 2.0), flat="z"),
    "a coordinate in quotes": lambda: g.Direction("a", (0.0, "1", 0.0), "a"),
    "inertia as a matrix": lambda: g.Body("a", 1.0, (0, 0, 0), np.eye(3)),
    "two moments of inertia": lambda: g.Body("a", 1.0, (0, 0, 0), (1.0, 2.0)),
    "a tensor in a plane": lambda: g.Body("a", 1.0, bar.CRANK_COM, (1.0, 2.0, 3.0)),
    "fixed direction of zeros": lambda: g.Direction("a", fixed=(0, 0, 0)),
    "fixed direction of two": lambda: g.Direction("a", fixed=(0, 1)),
    "no segments": lambda: g.DamperTable(name="d", segments=0),
    "half a segment": lambda: g.DamperTable(name="d", segments=1.5),
    "negative mass": lambda: with_default(FOUR_BAR, crank_mass=-1.0),
    "negative inertia": lambda: with_default(FOUR_BAR, crank_inertia_zz=-1e-3),
    "negative rate": lambda: with_default(FOUR_BAR, spring_rate=-400.0),
    "negative length": lambda: with_default(FOUR_BAR, spring_free_length=-0.3),
    "negative damping": lambda: with_default(FOUR_BAR, damper_rate=-1.0),
    "beyond a bound of its own": lambda: instead(RATE, most=300.0),
    "gravity upwards": lambda: with_default(DOUBLE_WISHBONE, gravity=-9.81),
    "friction without a speed": lambda: with_force(
        g.ForceElement(
            "f",
            g.TwistOfHinges(bar.A, bar.D),
            (g.Friction(g.MomentLevel("m", 1.0, "m"), g.AngularSpeed("w", 0.0, "speed")),),
        )
    ),
    # -- names
    "space in a name": lambda: g.Point("ball joint", (0, 0, 0)),
    "dash in a name": lambda: g.Body("tie-rod", 1.0, A),
    "digit first": lambda: g.Direction("2nd", (1, 0, 0)),
    "empty name": lambda: g.Parameter("", 1.0, "m", "a"),
    "accent": lambda: instead(bar.A, name="müde"),
    "tyre named after its wheel": lambda: replace(TYRE, name="front-left"),
    "dash in a model's name": lambda: model(name="four-bar"),
    **{
        f"parameter {name}": lambda name=name: instead(RATE, name=name)
        for name in ("NAN", "INFINITY", "GUARD_FLOOR", "double", "lambda")
    },
    "coordinate named after a function": lambda: four_bar(
        coordinates=(bar.A.angle("sin", "angle"),)
    ),
    "coordinate named as the time": lambda: four_bar(coordinates=(bar.A.angle("time", "angle"),)),
    "input named as the time": lambda: with_force(
        g.JointForce(bar.A, g.Input("time", "N m", "torque"))
    ),
    "two bodies of a name": lambda: instead(bar.COUPLER, name="crank"),
    "a body declared twice, differently": lambda: four_bar(
        joints=(replace(bar.A, second=replace(bar.CRANK, mass=1.0)), bar.B)
    ),
    "two joints of a name": lambda: instead(bar.B, name="A"),
    "joint twice": lambda: four_bar(joints=(*FOUR_BAR.joints, bar.A)),
    "element twice": lambda: with_force(COIL),
    "other element of the name": lambda: with_force(
        g.ForceElement("spring", BETWEEN, (bar.DAMPER,))
    ),
    "torque twice": lambda: with_force(TORQUE),
    "law twice": lambda: four_bar(forces=(replace(COIL, laws=(bar.SPRING, bar.SPRING)),)),
    "weight twice": lambda: with_force(g.Weight(), g.Weight()),
    "two parameters of a name": lambda: instead(bar.DAMPER.rate, name="crank_mass"),
    "point and direction of one name": lambda: instead(
        bar.A, axis=g.Line(bar.CRANK_BEARING, g.Direction("rocker_pin", (0, 0, 1)))
    ),
    "point in a plane and in space": lambda: instead(
        bar.A, axis=g.Line(g.Point("crank_pin", (0.0, 0.1, 0.1)), g.UP)
    ),
    "variant named after a function": lambda: replace(
        WISHBONE, held={"jacobian": (wishbone.RACK_GUIDE,)}
    ),
    # -- what belongs to what
    "joint of a body with itself": lambda: replace(bar.A, second=bar.GROUND),
    "torque along a joint of another mechanism": lambda: with_force(
        g.JointForce(wishbone.BEARING, TORQUE.input)
    ),
    "spring at a body of another mechanism": lambda: with_force(
        g.ForceElement("s", g.AlongLine((wishbone.KNUCKLE, A), (TWO, B)), (bar.DAMPER,))
    ),
    "coordinate of another mechanism": lambda: four_bar(
        coordinates=(wishbone.BEARING.angle("q", "angle"),)
    ),
    "both ends on one body": lambda: g.AlongLine((ONE, A), (ONE, B)),
    "twist of one hinge": lambda: g.TwistOfHinges(bar.A, bar.A),
    "telescope of a hinge": lambda: g.AlongTelescope(wishbone.LOWER_HINGE),
    "twist of a guide": lambda: g.TwistOfHinges(wishbone.RACK_GUIDE, wishbone.BEARING),
    "spring without a free length": lambda: g.LinearSpring(RATE),
    "line to itself": lambda: g.Line(A, A),
    "direction between one point": lambda: g.Direction("d", between=(A, A)),
    "direction given twice": lambda: g.Direction("d", fixed=(0, 0, 1), between=(A, B)),
    "direction without components": lambda: g.Direction("d"),
    "spring between coincident points": lambda: with_default(
        FOUR_BAR, spring_ground_x=0.12, spring_ground_y=0.18
    ),
    "no joints": lambda: four_bar(joints=(), forces=(), coordinates=()),
    "no ground": lambda: changed(FOUR_BAR, (bar.GROUND, g.Body("ground", 1.0, (0.0, 0.0, 0.0)))),
    "two grounds": lambda: instead(bar.D, first=g.Ground("floor")),
    "independent joint of another mechanism": lambda: model(independent=(wishbone.BEARING,)),
    "ball joint as independent": lambda: replace(WISHBONE, independent=(wishbone.LOWER_BALL,)),
    "ground with mass": lambda: model(massive=(bar.GROUND, bar.CRANK)),
    "torque on what follows": lambda: model(
        mechanism=with_force(g.JointForce(bar.D, TORQUE.input))
    ),
    "one motion for two joints": lambda: g.Formulation(
        "m", "m", four_bar(forces=()), (), prescribed=dict.fromkeys((bar.A, bar.D), DRIVE)
    ),
    "motion named as a parameter": lambda: g.Formulation(
        "m", "m", instead(RATE, name="drive_velocity"), (), prescribed={bar.A: DRIVE}
    ),
    "end of a comment": lambda: four_bar(title="a */ b"),
}
DRIVE = g.Motion("drive", "rad", "angle of the crank")


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_reported(mistake, refused):
    error = refused(g.DeclarationError, MISTAKES[mistake])
    assert isinstance(error, kintrafo.KintrafoError)


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
    default = g.Parameter("a", given, "m", "a").default
    assert type(default) is float
    assert default == pytest.approx(expected, rel=1e-15)
    point = g.Point("a", (given, 0, 0))
    assert [p.default for p in point.numbers] == [default, 0.0, 0.0]


def test_lists_do_for_tuples():
    listed = four_bar(joints=list(FOUR_BAR.joints), forces=list(FOUR_BAR.forces))
    assert listed == FOUR_BAR
    assert model(independent=[bar.A], massive=list(FOUR.massive)) == FOUR
    assert g.Direction("up", fixed=[0, 0, 1]) == g.Direction("up", fixed=(0, 0, 1))
    assert g.Point("a", [0, 0, 1]) == g.Point("a", (0, 0, 1))


def test_a_stop_between_hinges_has_an_angle_of_any_sign(refused):
    """A length is not negative, but an angle may be."""
    turning = g.Stop(
        side="bump",
        length=g.Angle("angle", -0.5, "angle of the stop"),
        rate=g.TorsionRate("rate", 1.0, "rate"),
        progression=g.TorsionProgression("progression", 0.0, "progression"),
    )
    with_force(g.ForceElement("bar", g.TwistOfHinges(bar.A, bar.D), (turning,)))
    line = g.ForceElement("bar", COIL.path, (stop(length=g.Length("touch", -0.5, "length")),))
    refused(g.DeclarationError, lambda: with_force(line))


# -- parameters of compiled models ----------------------------------------------------------------


@pytest.mark.parametrize(
    ("equations", "changes"),
    [
        (four_bar_equations, {"crank_mass": -1.0}),
        (four_bar_equations, {"coupler_inertia_zz": -1e-9}),
        (four_bar_equations, {"spring_rate": -1.0}),
        (four_bar_equations, {"spring_free_length": -0.1}),
        (macpherson_general, {"tyre_lifts_off": 2.0}),
        (macpherson_general, {"strut_friction_speed": 0.0}),
        (double_wishbone, {"gravity": -9.81}),
        (double_wishbone, {"knuckle_inertia_xx": 9.0}),
        (front_axle, {"knuckle_mass": -1.0}),
    ],
    ids=lambda of: next(iter(of)) if isinstance(of, dict) else of.NAME,
)
def test_parameters_out_of_range_reach_no_model(equations, changes, refused):
    """The way of every set of parameters is `prepare`, by name or in order."""
    values = {n: e["default"] for n, e in equations.PARAMETERS.items()} | changes
    refused(
        kintrafo.ParameterError,
        lambda: kintrafo.System(equations, changes),
        lambda: equations.prepare(values),
        lambda: equations.prepare(list(values.values())),
    )


def test_a_shaft_may_turn_with_a_rotor(refused):
    """It adds to the moment about the axis alone; a body that is declared is without one."""
    kintrafo.System(double_wishbone, {"wheel_inertia_spin": 9.0})
    refused(g.DeclarationError, lambda: with_default(DOUBLE_WISHBONE, wheel_inertia_spin=9.0))


def test_masses_and_rates_may_be_zero():
    kintrafo.System(four_bar_equations, {"crank_mass": 0.0, "spring_rate": 0.0})


# Names of C, of its library, of Python and of what is emitted, which nothing that is emitted needs.
WORDS = """
pow fabsf isnan signbit fmin fma gamma j0 y1 yn I errno main printf stdin values x least
size_t len sum max min print range self math sp rhs margins results_ Array float_ sp_
real bits digits turned reduced lost choose root magnitude with_sign_of of_quarters memcpy
kt_front kt
"""


@needs_gcc
def test_words_of_c_and_python_can_be_parameters():
    """Names that are not reserved compile without a warning, and have their own values."""
    words = WORDS.split()
    dampers = tuple(g.LinearDamper(g.DamperRate(word, 1.0, word)) for word in words)
    mechanism = with_force(g.ForceElement("dampers", COIL.path, dampers))
    declared = model(mechanism=mechanism, name="words")
    compiled, arrays = (kintrafo.System(own(declared, arrays=a)) for a in (False, True))
    state = compiled.state(crank_angle=0.3, crank_angle_rate=2.0)
    for system in (compiled, arrays):
        signals = system.signals(state)
        total = float(len(words) * signals["dampers_velocity"])
        # so many equal terms are added, each with its rounding
        assert signals["dampers_damper_force"] == pytest.approx(-total, rel=1e-14)


def reserved(name):
    with pytest.raises(g.DeclarationError, match=f"'{name}'"):
        instead(RATE, name=name)


def test_macros_of_the_emitted_code_are_reserved():
    folder = Path(g.backends.__file__).parent
    printers, templates = (
        "".join(p.read_text(encoding="utf-8") for p in sorted(folder.rglob(f"*{suffix}")))
        for suffix in (".py", ".in")
    )
    defined = {*re.findall(r"#define ([A-Z][A-Z_]+)\b", printers + templates)}
    defined |= {*re.findall(r"(?m)^([A-Z][A-Z_]+) = ", templates)}
    assert {"ROUNDING", "CONVERGED", "ROUNDER"} <= defined
    for name in sorted(defined):
        reserved(name)


@needs_gcc
@pytest.mark.parametrize("in_lanes", [False, True])
def test_macros_around_the_emitted_code_are_reserved(in_lanes):
    """So are macros of the C library and of lanes, and functions that macros call."""
    emitted = [str(lanes.EMITTED / "multi_link.c")]
    macros = ['-DMODEL="multi_link.c"', "-DWIDTH=2"]
    read = [*macros, str(lanes.HEADERS / "model.c")] if in_lanes else emitted
    folders = [f"-I{folder}" for folder in (lanes.EMITTED, lanes.HEADERS)]
    command = ["gcc", "-std=c99", *folders, "-dM", "-E", *read]
    text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    alone = {*re.findall(r"(?m)^#define ([A-Za-z]\w*) ", text)}
    called = {*re.findall(r"(?m)^#define [a-z]\w*(?:\(.*?\))? .*?\b(kt_\w+)", text)}
    assert {"ROUNDER", "NAN"} <= alone
    assert {"kt_arc_sine", "kt_real" if in_lanes else "kt_any_sine"} <= called
    for name in sorted(alone | called):
        reserved(name)


def test_files_of_the_generated_code_are_no_names_of_models(refused):
    """Generated files share a folder, also where file names do not distinguish capitals."""
    headers = {Path(name).stem for name in (ELEMENTARY, *own_lanes.HEADERS)}
    for name in (*sorted(headers), "Vectors"):
        with refused(g.DeclarationError):
            replace(FOUR_BARS[0], name=name)
