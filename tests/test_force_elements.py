"""Force elements that can stand in for one another give the same equations."""

import mpmath
import numpy as np
import pytest
from changes import changed
from kintrafo.generator import AlongLine, ForceElement, Length, LinearSpring
from kintrafo.generator.equations.dynamics import Dynamics
from kintrafo.generator.equations.parts import Parts
from kintrafo.generator.mechanisms import macpherson
from kintrafo.generator.planning.plan import Plan
from kintrafo.generator.program import ConstantStage, Program
from oracle.reference import perturbed_parameters
from symbolic import python
from sympy import Symbol

STATE = {"beta1": 1.5, "beta5": 0.3, "beta1_rate": 2.0, "beta5_rate": 90.0}
INPUTS = {
    "rack_position": 0.01,
    "rack_velocity": 0.2,
    "rack_acceleration": -1.0,
    "strut_force": 0.0,
    "road_height": 0.005,
}


def accelerations(model, parameters):
    """Derive a model and evaluate its accelerations with mpmath."""
    symbols = tuple(Symbol(p.name) for p in model.mechanism.parameters)
    constants = ConstantStage(symbols)
    program = Program(constants)
    dynamics = Dynamics(Parts(program, Plan.of(model)))
    function = program.function("rhs", "", dict(dynamics.accelerations))
    prepare = constants.function([function])
    given = {name: mpmath.mpf(value) for name, value in parameters.items()}
    values = dict(zip(prepare.labels, python(prepare)(given), strict=True))
    moving = {name: mpmath.mpf(value) for name, value in (STATE | INPUTS).items()}
    return [float(a) for a in python(function)(values | moving)]


@pytest.mark.parametrize("seed", [1, 2])
def test_line_spring_along_the_strut_is_the_telescope_spring(seed):
    model = macpherson.MODELS[0]
    parameters = perturbed_parameters(np.random.default_rng(seed))
    length = Length("coil_free_length", 0.8, "length at which the spring is free")
    line = ForceElement(
        "coil",
        AlongLine(
            (macpherson.CHASSIS, macpherson.STRUT_TOP), (macpherson.ARM, macpherson.BALL_JOINT)
        ),
        (LinearSpring(macpherson.SPRING_RATE, free_length=length), macpherson.DAMPER),
    )
    (strut,) = model.mechanism.elements
    free_length = parameters["strut_length_max"] - parameters["spring_free_slide"]
    by_line = accelerations(
        changed(model, (strut, line)),
        parameters | {"coil_free_length": free_length},
    )
    # both are evaluated with 15 digits of mpmath; the forces are large differences of lengths
    assert by_line == pytest.approx(accelerations(model, parameters), rel=1e-11)
