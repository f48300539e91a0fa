"""Mistakes in a declaration are found before anything is derived, all at once and by name."""

import re
from dataclasses import replace

import pytest
from kintrafo import generator as g
from kintrafo.generator.backends.casadi.dialect import CASADI
from kintrafo.generator.backends.counting import operations_of
from kintrafo.generator.backends.jax.dialect import JAX
from kintrafo.generator.backends.numpy.dialect import NUMPY
from kintrafo.generator.backends.words import FORMULA
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.mechanisms import four_bar, macpherson
from kintrafo.generator.mechanisms.macpherson import HG, OA
from kintrafo.generator.mechanisms.suspension import RACK_FORCE, RACK_MOTION, ROAD_VELOCITY
from support.changes import changed
from support.models import derive
from support.symbolic import constants_of, python

MODEL, FREE, GENERAL = macpherson.MODELS
MECHANISM = MODEL.mechanism
STRANGE = four_bar.A
TORQUE = g.Input("torque", "N m", "torque")


@pytest.mark.parametrize(
    "changes",
    [
        {"independent": (STRANGE, HG)},
        {"independent": (OA, macpherson.B)},
        {"massive": (four_bar.CRANK,)},
        {"prescribed": {STRANGE: RACK_MOTION}},
        {"prescribed": {OA: RACK_MOTION}},
        {"held": {"still": (OA,)}},
    ],
)
def test_models(changes, refused):
    refused(g.DeclarationError, lambda: replace(MODEL, **changes))


@pytest.mark.parametrize(
    "changes",
    [
        {"forces": (*MECHANISM.forces, g.Weight())},
        {"forces": (g.JointForce(STRANGE, TORQUE),)},
        {"coordinates": (STRANGE.angle("q", "q"),)},
    ],
)
def test_mechanisms(changes, refused):
    refused(g.DeclarationError, lambda: replace(MECHANISM, **changes))


(TYRE,) = (force for force in MECHANISM.forces if isinstance(force, g.LinearTyre))


def test_a_free_slide_needs_a_telescope(refused):
    ends = g.AlongLine(
        (macpherson.CHASSIS, macpherson.STRUT_TOP), (macpherson.KNUCKLE, macpherson.BALL_JOINT)
    )
    refused(
        g.DeclarationError,
        lambda: g.ForceElement("strut", ends, (macpherson.SPRING,)),
        lambda: replace(macpherson.SPRING, free_slide=None),
    )


def test_a_tyre_damps_against_the_rate_of_the_road(refused):
    damper = g.DamperRate("tyre_damper", 1.0, "damper")
    refused(
        g.DeclarationError,
        lambda: replace(TYRE, damper=damper),
        lambda: replace(
            TYRE, road=RACK_MOTION.inputs[0], damper=damper, road_velocity=ROAD_VELOCITY
        ),
    )


def test_all_problems_are_listed():
    with pytest.raises(g.DeclarationError) as caught:
        replace(MODEL, independent=(STRANGE, four_bar.D), massive=(four_bar.CRANK,))
    # two strangers, neither of them reported, and a body
    assert len(caught.value.problems) == 5


def test_what_is_referred_to_is_there_and_nothing_else():
    """Bodies, inputs and parameters are collected, in the order in which they were written."""
    names = [body.name for body in MECHANISM.bodies]
    assert names == ["chassis", "control_arm", "knuckle", "tie_rod", "rack", "upper_strut", "wheel"]
    assert list(MECHANISM.numbers.values()) == list(range(1, 8))
    assert MECHANISM.input_names == ["strut_force", "road_height", "rack_force"]
    parameters = [p.name for p in MECHANISM.parameters]
    assert parameters[:3] == ["arm_front_x", "arm_front_y", "arm_front_z"]
    assert "spring_free_slide" in parameters
    free = replace(MECHANISM, forces=())
    lost = set(parameters) - {p.name for p in free.parameters}
    assert lost == {
        "spring_rate",
        "spring_free_slide",
        "damper_rate",
        "tyre_rate",
        "tyre_free_height",
        "gravity",
    }
    assert free.inputs == ()


def test_a_replaced_body_keeps_its_place():
    heavy = replace(macpherson.RACK, mass=3.0)
    other = changed(MECHANISM, (macpherson.RACK, heavy))
    assert [b.name for b in other.bodies] == [b.name for b in MECHANISM.bodies]
    assert other.body("rack").mass.default == 3.0


def test_several_force_elements_of_a_kind_have_names_of_their_own():
    (strut,) = MECHANISM.elements
    second = replace(strut, name="helper", laws=strut.laws[:2])
    line = g.ForceElement(
        "coil",
        g.AlongLine(
            (macpherson.CHASSIS, macpherson.STRUT_TOP), (macpherson.ARM, macpherson.BALL_JOINT)
        ),
        (
            g.LinearSpring(
                macpherson.SPRING_RATE, free_length=macpherson.SEATED_SPRING.free_length
            ),
            macpherson.DAMPER,
        ),
    )
    mechanism = replace(MECHANISM, forces=(*MECHANISM.forces, second, line))
    model = generate(replace(MODEL, mechanism=mechanism, held={}), derivatives=False)
    names = [entry.name for entry in model.signals]
    for name in ("strut_spring_force", "helper_spring_force", "coil_spring_force", "coil_length"):
        assert name in names
    assert len(set(names)) == len(names)


# -- names ----------------------------------------------------------------------------------------

(WEIGHT, *_) = MECHANISM.forces


@pytest.mark.parametrize(
    ("old", "name"),
    [
        (WEIGHT.gravity, "double"),
        (WEIGHT.gravity, "given_g"),
        (WEIGHT.gravity, "Count"),
        (WEIGHT.gravity, "Damper_Rate"),
        (WEIGHT.gravity, "beta1_rate"),
        (WEIGHT.gravity, "rack_force"),
        (RACK_FORCE, "for"),
    ],
)
def test_names_that_code_cannot_have(old, name, refused):
    refused(g.DeclarationError, lambda: changed(MECHANISM, (old, replace(old, name=name))))


@pytest.mark.parametrize("dialect", [FORMULA, NUMPY, CASADI, JAX])
def test_names_in_the_syntax_of_a_language_are_reserved(dialect, refused):
    """A parameter of that name would hide a function or a package in the emitted code."""
    spellings = [*dialect.functions.values(), dialect.root, dialect.negation]
    used = {n for text in spellings for n in re.findall(r"(?<![\w.])[A-Za-z_]\w*", text)}
    assert used
    for name in sorted(used):
        other = replace(WEIGHT.gravity, name=name)
        with refused(g.DeclarationError):
            changed(MECHANISM, (WEIGHT.gravity, other))


@pytest.mark.parametrize("name", ["rocker_length", "shared_1", "constant_1", "coupler_reach_x"])
def test_parameter_with_the_name_of_an_internal_step(name):
    """The step gets another name, and the results are the same."""
    (model,) = four_bar.MODELS
    rate = four_bar.SPRING.rate
    renamed = changed(model, (rate, replace(rate, name=name)))
    derived = generate(renamed)
    before = derive(model)
    assert {k: operations_of(f) for k, f in derived.functions.items()} == {
        k: operations_of(f) for k, f in before.functions.items()
    }
    given, state = (
        defaults(renamed.mechanism),
        {"crank_torque": 1.5} | {"crank_angle": 0.3, "crank_angle_rate": 2.0},
    )
    found = python(derived.functions["rhs"])(constants_of(derived, given) | state)
    given = defaults(model.mechanism)
    expected = python(before.functions["rhs"])(constants_of(before, given) | state)
    for one, other in zip(found, expected, strict=True):
        assert float(one) == pytest.approx(float(other), rel=1e-14)  # sums in another order


def defaults(mechanism):
    """Return the values of all parameters."""
    return {p.name: p.default for p in mechanism.parameters}


PULL = g.Input("pull", "N", "some force")
IMPULSE = g.Input("impulse", "N s", "what a force adds up to")


def pulled_by(*inputs):
    """Return the suspension with actuators in its strut, of inputs that all are forces there."""
    (strut,) = MECHANISM.elements
    pulled = replace(strut, laws=(*strut.laws, *map(g.Actuator, inputs)))
    return changed(MECHANISM, (strut, pulled))


@pytest.mark.parametrize(
    "inputs",
    [
        (PULL, replace(PULL, meaning="another force")),
        tuple(g.Input(f"rate_{i}", "N", "", derivative_of=IMPULSE) for i in (1, 2)),
    ],
)
def test_an_input_is_the_derivative_of_another_one_once(inputs, refused):
    refused(g.DeclarationError, lambda: pulled_by(*inputs))


def test_what_an_input_is_the_derivative_of_is_an_input():
    pulled = pulled_by(g.Input("pull", "N", "how it changes", derivative_of=IMPULSE))
    assert {"impulse", "pull"} <= {*pulled.input_names}


def test_a_prescribed_motion_has_its_rates(refused):
    position, velocity, acceleration = RACK_MOTION.inputs
    assert position.derivative_of is None
    assert velocity.derivative_of == position
    assert acceleration.derivative_of == velocity
    other = g.Input("rack_speed", "m/s", "", derivative_of=position)
    damper = g.DamperRate("tyre_damper", 1.0, "damper")
    tyre = replace(TYRE, road=position, damper=damper, road_velocity=other)
    refused(g.DeclarationError, lambda: replace(MODEL, mechanism=changed(MECHANISM, (TYRE, tyre))))
