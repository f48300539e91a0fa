"""Mistakes in a declaration are found before anything is derived, all at once and by name."""

from dataclasses import replace

import pytest
from kintrafo.generator import (
    Actuator,
    AlongLine,
    AlongTelescope,
    Body,
    DeclarationError,
    ForceElement,
    Input,
    JointForce,
    LinearDamper,
    LinearSpring,
    LinearTyre,
    Parameter,
    RelativeCoordinate,
    Weight,
)
from kintrafo.generator.backends.counting import operations_of
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.mechanisms import four_bar, macpherson
from symbolic import constants_of, python

MODEL, FREE, GENERAL = macpherson.MODELS
MECHANISM = MODEL.mechanism


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"independent": ("OB", "HG")}, "independent joint 'OB' is not declared"),
        ({"independent": ("OA", "B")}, "joint 'B' is spherical, with 3 coordinates; only hinges"),
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


SPRING = LinearSpring(rate="spring_rate", free_slide="spring_free_slide")
STRUT = ForceElement(name="strut", path=AlongTelescope("BC"), laws=(SPRING,))
(TYRE,) = (force for force in MECHANISM.forces if isinstance(force, LinearTyre))


@pytest.mark.parametrize(
    ("force", "words"),
    [
        (replace(STRUT, path=AlongTelescope("CB")), "cylindrical joint 'CB' .*there are BC"),
        (
            replace(STRUT, path=AlongLine(("chassi", macpherson.C), ("knuckle", macpherson.B))),
            "body 'chassi' .*\n.*a free_slide needs a telescope",
        ),
        (replace(STRUT, laws=(Actuator(input="push"),)), "input 'push' is not declared"),
        (
            replace(STRUT, laws=(replace(SPRING, free_length="strut_length_max"),)),
            "a free_slide or a free_length",
        ),
        (replace(STRUT, laws=(replace(SPRING, free_slide=None),)), "a free_slide or a free_length"),
        (
            replace(TYRE, damper="tyre_damper", road="rack_force"),
            "'front': its damper needs the rate of 'rack_force'",
        ),
        (replace(TYRE, road="rod_height"), "did you mean 'road_height'"),
    ],
)
def test_force_elements(force, words):
    with pytest.raises(DeclarationError, match=words):
        replace(MECHANISM, forces=(force,))


def test_parameter_that_the_equations_need_is_missing():
    parameters = tuple(p for p in MECHANISM.parameters if p.name != "damper_rate")
    mechanism = replace(MECHANISM, parameters=parameters)
    with pytest.raises(DeclarationError, match="parameter 'damper_rate'"):
        generate(replace(MODEL, mechanism=mechanism), derivatives=False)


def test_all_problems_are_listed():
    with pytest.raises(DeclarationError) as caught:
        replace(MODEL, independent=("O", "H"), massive=("wheels",))
    assert len(caught.value.problems) == 3


def test_several_force_elements_of_a_kind_have_names_of_their_own():
    (spring,) = MECHANISM.elements
    second = replace(spring, name="helper", laws=spring.laws[:2])
    line = ForceElement(
        name="coil",
        path=AlongLine(("chassis", macpherson.C), ("control_arm", macpherson.B)),
        laws=(
            LinearSpring(rate="spring_rate", free_length="strut_length_max"),
            LinearDamper(rate="damper_rate"),
        ),
    )
    mechanism = replace(MECHANISM, forces=(*MECHANISM.forces, second, line))
    model = generate(replace(MODEL, mechanism=mechanism, held={}), derivatives=False)
    names = [entry.name for entry in model.signals]
    for name in ("strut_spring_force", "helper_spring_force", "coil_spring_force", "coil_length"):
        assert name in names
    assert len(set(names)) == len(names)


def test_body_that_nothing_holds():
    loose = Body("loose", 8, center=macpherson.G)
    with pytest.raises(ValueError, match="no joint path leads from the ground to loose"):
        generate(replace(MODEL, mechanism=replace(MECHANISM, bodies=(*MECHANISM.bodies, loose))))


# -- names ----------------------------------------------------------------------------------------


def renamed(old: str, new: str) -> tuple[Parameter, ...]:
    """Return the parameters, one of them under another name."""
    return tuple(replace(p, name=new) if p.name == old else p for p in MECHANISM.parameters)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"parameters": renamed("gravity", "double")}, "parameter 'double' has a name that"),
        ({"parameters": renamed("gravity", "given_g")}, "parameter 'given_g' has a name that"),
        ({"parameters": renamed("gravity", "Count")}, "parameter 'Count' has a name that"),
        (
            {"parameters": renamed("gravity", "Damper_Rate")},
            "parameter 'Damper_Rate' differs from 'damper_rate' in capital letters only",
        ),
        (
            {"parameters": renamed("gravity", "beta1_rate")},
            "'beta1_rate' is the name of a parameter and of the rate of a coordinate; rename",
        ),
        (
            {"parameters": renamed("gravity", "rack_force")},
            "'rack_force' is the name of a parameter and of an input; rename the parameter",
        ),
        ({"inputs": (*MECHANISM.inputs, Input("for", "N", ""))}, "input 'for' has a name that"),
    ],
)
def test_names_that_code_cannot_have(changes, words):
    with pytest.raises(DeclarationError, match=words):
        replace(MECHANISM, **changes)


@pytest.mark.parametrize("name", ["rocker_length", "shared_1", "constant_1", "coupler_reach_x"])
def test_parameter_with_the_name_of_an_internal_step(name):
    """The step gives way, and the numbers stay."""
    (model,) = four_bar.MODELS
    parameters = [
        replace(p, name=name) if p.name == "spring_rate" else p for p in model.mechanism.parameters
    ]
    (spring,) = model.mechanism.elements
    laws = (replace(spring.laws[0], rate=name), spring.laws[1])
    forces = (replace(spring, laws=laws), *model.mechanism.forces[1:])
    mechanism = replace(model.mechanism, parameters=tuple(parameters), forces=forces)
    derived = generate(replace(model, mechanism=mechanism))
    before = generate(model)
    assert {k: operations_of(f) for k, f in derived.functions.items()} == {
        k: operations_of(f) for k, f in before.functions.items()
    }
    given, state = (
        defaults(mechanism),
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


PULL = Input("pull", "N", "some force")


@pytest.mark.parametrize(
    ("inputs", "words"),
    [
        ((PULL, PULL), "input 'pull' is declared 2 times"),
        ((replace(PULL, derivative_of="push"),), "'pull': derivative_of='push' is not declared"),
        ((replace(PULL, derivative_of="pull"),), "'pull' is the derivative of itself"),
        (
            (replace(PULL, derivative_of="rate"), Input("rate", "N/s", "", derivative_of="pull")),
            "'rate' is the derivative of itself",
        ),
        (
            (PULL, *(Input(f"rate_{i}", "N/s", "", derivative_of="pull") for i in (1, 2))),
            "'rate_1' and 'rate_2' are both the derivative of 'pull'",
        ),
    ],
)
def test_an_input_is_the_derivative_of_another_one_once(inputs, words):
    with pytest.raises(DeclarationError, match=words):
        replace(MECHANISM, inputs=(*MECHANISM.inputs, *inputs))


@pytest.mark.parametrize(
    ("left_out", "of"), [("velocity", "position"), ("acceleration", "velocity")]
)
def test_a_prescribed_motion_has_its_rates(left_out, of):
    model = macpherson.MODELS[0]
    inputs = tuple(
        replace(i, derivative_of=None) if i.name == f"rack_{left_out}" else i
        for i in MECHANISM.inputs
    )
    mechanism = replace(MECHANISM, inputs=inputs)
    with pytest.raises(DeclarationError, match=f"no input is the rate of 'rack_{of}'; declare"):
        replace(model, mechanism=mechanism)
