"""A declared number is in the unit that the equations read it in, or it is refused."""

import re
from dataclasses import replace

import kintrafo
import pytest
from kintrafo import generator as g
from kintrafo.core.si_units import powers_of, rate_of
from kintrafo.generator.declare.declared import parts
from kintrafo.generator.declare.inputs import Input
from kintrafo.generator.declare.parameters import Parameter
from kintrafo.generator.declare.shown import Shown
from kintrafo.generator.mechanisms import MODELS
from mechanisms.own_force import GUIDE, A, Own, Showing, model

WRONG = ("deg", "furlong", "mm", "km/h", "N*m", "Nm", "kN", "g", "", "m/", "m^", "°", "N/mm",
         "rad/")  # fmt: skip


@pytest.mark.parametrize("unit", WRONG)
def test_what_is_no_unit_of_si_is_refused(unit, refused):
    for make in (
        lambda: g.Input("push", unit, "push"),
        lambda: Parameter("number", 1.0, unit, "number"),
        lambda: g.Motion("turn", unit, "turn"),
    ):
        with pytest.raises(g.DeclarationError, match=re.escape(repr(unit))):
            make()
    shows = Showing(lambda _: g.Action({"q_A": 1}), lambda *_: [Shown("s", 1, unit, "s")])
    refused(kintrafo.MechanismError, lambda: kintrafo.compile(model(shows), backend="numpy"))


@pytest.mark.parametrize("unit", ["N", "N m", "m/s^2", "N s/m", "1", "1/s", "V", "kg m^2", "N/m^3"])
def test_units_of_si_are_taken(unit):
    assert powers_of(unit) is not None
    g.Input("given", unit, "given")
    Parameter("number", 1.0, unit, "number")


@pytest.mark.parametrize(
    ("joint", "unit", "right"), [(A, "m", "rad"), (GUIDE, "rad", "m"), (A, "N", "rad")]
)
def test_a_motion_is_in_the_unit_of_its_joint(joint, unit, right):
    whole = model(Own(lambda _: None), A).mechanism
    whole = replace(whole, joints=(joint,), forces=(), coordinates=())
    with pytest.raises(g.DeclarationError, match=right):
        g.Formulation("m", "t", whole, (), prescribed={joint: g.Motion("mo", unit, "motion")})
    g.Formulation("m", "t", whole, (), prescribed={joint: g.Motion("mo", right, "motion")})


@pytest.mark.parametrize(("joint", "right"), [(A, "N m"), (GUIDE, "N")], ids=["hinge", "guide"])
@pytest.mark.parametrize("unit", ["N", "N m", "m", "1", "rad"])
def test_a_force_along_a_joint_is_in_its_unit(joint, right, unit, refused):
    given = g.Input("push", unit, "push")
    if unit == right:
        g.JointForce(joint, given)
        return
    refused(g.DeclarationError, lambda: g.JointForce(joint, given))


@pytest.mark.parametrize(
    ("unit", "rate"), [("m", "m/s"), ("m/s", "m/s^2"), ("N m", "N m/s"), ("rad", "rad/s")]
)
def test_a_rate_is_in_the_unit_of_a_rate(unit, rate, refused):
    assert rate_of(unit) == rate
    source = g.Input("source", unit, "source")
    g.Input("rate", rate, "rate", source)
    for other in (unit, "1/s", f"kg {rate}"):
        with refused(g.DeclarationError):
            g.Input("rate", other, "rate", source)


def test_a_road_is_a_height(refused):
    wheel = g.Wheel(g.Body("arm", 1.0, (0, 0, 0), (1, 1, 1)), g.Point("c", (0, 0, 0)), g.FORWARD)
    refused(
        g.DeclarationError,
        lambda: g.LinearTyre(
            name="tyre",
            wheel=wheel,
            rate=g.SpringRate("rate", 1.0, "rate"),
            free_height=g.Displacement("free", 0.3, "free"),
            road=g.Input("road", "rad", "road"),
        ),
    )


def test_all_units_that_ship_are_of_si():
    for model_ in MODELS:
        for part in parts(model_.mechanism):
            if isinstance(part, Input | Parameter | g.RelativeCoordinate):
                assert powers_of(part.unit) is not None, part
