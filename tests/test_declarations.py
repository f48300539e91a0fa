"""Mistakes in a declaration are found before anything is derived, all at once and by name."""

from dataclasses import replace

import pytest
from kintrafo.generator.checks import DeclarationError
from kintrafo.generator.forces import JointForce, LineSpring, TelescopeSpring, Weight
from kintrafo.generator.mechanism import Body, RelativeCoordinate
from kintrafo.generator.mechanisms import macpherson
from kintrafo.generator.outputs import generate

MODEL, FREE = macpherson.MODELS
MECHANISM = MODEL.mechanism


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"independent": ("OB", "HG")}, "independent joint 'OB' is not declared"),
        ({"independent": ("OA", "B")}, "without a coordinate: 'B'"),
        ({"massive": ("knuckel",)}, "did you mean 'knuckle'"),
        ({"prescribed": {"z": "rack"}}, "prescribed joint 'z'"),
        ({"prescribed": {"y": "rak"}}, "input 'rak_position' .* did you mean 'rack_position'"),
        ({"prescribed": {"OA": "rack"}}, "'OA' is both independent and prescribed"),
        ({"held": {"still": ("OA",)}}, "held joint of 'still' 'OA'"),
    ],
)
def test_models(changes, words):
    with pytest.raises(DeclarationError, match=words):
        replace(MODEL, **changes)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"bodies": (*MECHANISM.bodies, MECHANISM.bodies[-1])}, "body 'wheel' is declared 2 times"),
        ({"forces": (*MECHANISM.forces, Weight(gravity="g"))}, "weight .* declared 2 times"),
        ({"forces": (JointForce(joint="x", input="rack_force"),)}, "JointForce: joint 'x'"),
        ({"forces": (JointForce(joint="y", input="force"),)}, "input 'force' .*rack_force"),
        (
            {"coordinates": (RelativeCoordinate("beta1", "OA", "slide", "m", ""),)},
            "kind 'slide' is not declared; there are angle",
        ),
        ({"parameters": (*MECHANISM.parameters, MECHANISM.parameters[0])}, "declared 2 times"),
    ],
)
def test_mechanisms(changes, words):
    with pytest.raises(DeclarationError, match=words):
        replace(MECHANISM, **changes)


def test_parameter_that_the_equations_need_is_missing():
    parameters = tuple(p for p in MECHANISM.parameters if p.name != "damper_rate")
    mechanism = replace(MECHANISM, parameters=parameters)
    with pytest.raises(DeclarationError, match="parameter 'damper_rate'"):
        generate(replace(MODEL, mechanism=mechanism))


def test_all_problems_are_listed():
    with pytest.raises(DeclarationError) as caught:
        replace(MODEL, independent=("O", "H"), massive=("wheels",))
    assert len(caught.value.problems) == 5


def test_several_force_elements_of_a_kind_have_names_of_their_own():
    (spring,) = (f for f in MECHANISM.forces if isinstance(f, TelescopeSpring))
    second = replace(spring, name="helper", actuator=None)
    line = LineSpring(
        name="coil",
        first=("chassis", macpherson.C),
        second=("control_arm", macpherson.B),
        rate="spring_rate",
        damper="damper_rate",
        free_length="strut_length_max",
    )
    mechanism = replace(MECHANISM, forces=(*MECHANISM.forces, second, line))
    model = generate(replace(MODEL, mechanism=mechanism, held={}))
    names = [entry.name for entry in model.signals]
    for name in ("strut_spring_force", "helper_spring_force", "coil_spring_force", "coil_length"):
        assert name in names
    assert len(set(names)) == len(names)


def test_body_that_nothing_holds():
    loose = Body("loose", 8, center=macpherson.G)
    with pytest.raises(ValueError, match="no joint path leads from the ground to loose"):
        generate(replace(MODEL, mechanism=replace(MECHANISM, bodies=(*MECHANISM.bodies, loose))))
