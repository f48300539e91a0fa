"""Force elements that can replace each other lead to the same equations."""

import dataclasses

import numpy as np
import pytest
from kintrafo import generator as g
from kintrafo.generator.declare.declared import declared
from kintrafo.generator.mechanisms import macpherson
from oracle.reference import perturbed_parameters
from support.changes import changed
from support.symbolic import accelerations

MOVING = {
    "beta1": 1.5, "beta5": 0.3, "beta1_rate": 2.0, "beta5_rate": 90.0, "rack_position": 0.01,
    "rack_velocity": 0.2, "rack_acceleration": -1.0, "strut_force": 0.0, "road_height": 0.005,
}  # fmt: skip
"""A state and inputs."""


@pytest.mark.parametrize("seed", [1, 2])
def test_line_spring_along_the_strut_is_the_telescope_spring(seed):
    model = macpherson.MODELS[0]
    parameters = perturbed_parameters(np.random.default_rng(seed))
    length = g.Length("coil_free_length", 0.8, "length at which the spring is free")
    line = g.ForceElement(
        "coil",
        g.AlongLine(
            (macpherson.CHASSIS, macpherson.STRUT_TOP), (macpherson.ARM, macpherson.BALL_JOINT)
        ),
        (g.LinearSpring(macpherson.SPRING_RATE, free_length=length), macpherson.DAMPER),
    )
    (strut,) = model.mechanism.elements
    free_length = parameters["strut_length_max"] - parameters["spring_free_slide"]
    by_line = accelerations(
        changed(model, (strut, line)), parameters | {"coil_free_length": free_length}, MOVING
    )
    # both are evaluated with 15 digits of mpmath; the forces are large differences of lengths
    assert by_line == pytest.approx(accelerations(model, parameters, MOVING), rel=1e-11)


@declared
@dataclasses.dataclass(frozen=True)
class Thrust(g.Force):
    """A constant force upward at a point of a body: a kind that this project does not have."""

    body: g.Body
    point: g.Point
    force: g.ForceLevel

    @property
    def identity(self):
        return "thrust", self.body.name

    def act(self, at):
        body = self.body.name
        local, up = at.local(body, self.point), at.up(body)
        forces = {
            k: self.force.symbol * up.dot(twist.linear + twist.angular.cross(local))
            for k, twist in at.twists(body).items()
        }
        return g.Action(forces)


def test_a_force_of_one_s_own_applies_itself():
    """Forces that lift every body by its weight have the effect of no gravity."""
    model = macpherson.MODELS[0]
    parameters = perturbed_parameters(np.random.default_rng(4))
    lifts = {f"{b.name}_lift": b for b in model.massive}
    forces = {n: parameters["gravity"] * parameters[f"{b.name}_mass"] for n, b in lifts.items()}
    thrusts = (Thrust(b, b.center, g.ForceLevel(n, 0.0, "lift")) for n, b in lifts.items())
    mechanism = dataclasses.replace(model.mechanism, forces=(*model.mechanism.forces, *thrusts))
    lifted = accelerations(
        dataclasses.replace(model, mechanism=mechanism), parameters | forces, MOVING
    )
    weightless = accelerations(model, parameters | {"gravity": 0.0}, MOVING)
    # both are evaluated with 15 digits of mpmath; the forces are large differences of lengths
    assert lifted == pytest.approx(weightless, rel=1e-11)
