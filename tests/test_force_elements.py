"""Force elements that can stand in for one another give the same equations."""

import dataclasses

import mpmath
import numpy as np
import pytest
from kintrafo.generator import (
    AlongLine,
    ForceElement,
    LinearDamper,
    LinearSpring,
    Parameter,
    Point,
)
from kintrafo.generator.declare.declared import Name, declared
from kintrafo.generator.declare.forces.force import Action, Force
from kintrafo.generator.equations.dynamics import Dynamics
from kintrafo.generator.equations.in_motion import InMotion
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
    dynamics = Dynamics(InMotion.of(program, Plan.of(model)))
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
    line = ForceElement(
        name="coil",
        path=AlongLine(("chassis", macpherson.C), ("control_arm", macpherson.B)),
        laws=(
            LinearSpring(rate="spring_rate", free_length="coil_free_length"),
            LinearDamper(rate="damper_rate"),
        ),
    )
    forces = tuple(
        line if isinstance(force, ForceElement) else force for force in model.mechanism.forces
    )
    mechanism = dataclasses.replace(
        model.mechanism,
        forces=forces,
        parameters=(
            *model.mechanism.parameters,
            Parameter("coil_free_length", 0.8, "m", "length at which the spring is free"),
        ),
    )
    free_length = parameters["strut_length_max"] - parameters["spring_free_slide"]
    by_line = accelerations(
        dataclasses.replace(model, mechanism=mechanism),
        parameters | {"coil_free_length": free_length},
    )
    # both are evaluated with 15 digits of mpmath; the forces are large differences of lengths
    assert by_line == pytest.approx(accelerations(model, parameters), rel=1e-11)


@declared
@dataclasses.dataclass(frozen=True, kw_only=True)
class Thrust(Force):
    """A constant force upward at a point of a body: a kind that this project does not have."""

    body: Name
    point: Point
    force: Name

    @property
    def identity(self):
        return "thrust", self.body

    def act(self, at):
        local, up = at.local(self.body, self.point), at.up(self.body)
        forces = {
            k: Symbol(self.force) * up.dot(twist.linear + twist.angular.cross(local))
            for k, twist in at.twists(self.body).items()
        }
        return Action(forces)

    def copied(self, copy):
        return Thrust(
            body=copy.body(self.body), point=copy.point(self.point), force=copy.named(self.force)
        )


def test_a_force_of_one_s_own_applies_itself():
    """What lifts every body by its weight is worth as much as no gravity."""
    model = macpherson.MODELS[0]
    parameters = perturbed_parameters(np.random.default_rng(4))
    bodies = [model.mechanism.body(name) for name in model.massive]
    lifts = {f"{b.name}_lift": parameters["gravity"] * parameters[f"{b.name}_mass"] for b in bodies}
    mechanism = dataclasses.replace(
        model.mechanism,
        forces=(
            *model.mechanism.forces,
            *(Thrust(body=b.name, point=b.center, force=f"{b.name}_lift") for b in bodies),
        ),
        parameters=(
            *model.mechanism.parameters,
            *(Parameter(name, 0.0, "N", "lift") for name in lifts),
        ),
    )
    lifted = accelerations(dataclasses.replace(model, mechanism=mechanism), parameters | lifts)
    weightless = accelerations(model, parameters | {"gravity": 0.0})
    # both are evaluated with 15 digits of mpmath; the forces are large differences of lengths
    assert lifted == pytest.approx(weightless, rel=1e-11)
