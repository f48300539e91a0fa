"""The planar four-bar linkage: crank, coupler and rocker on two fixed hinges.

The loop is a dyad: the distance of the crank pin from the rocker's hinge gives the rocker's angle
(Freudenstein's equation). The default is a crank-rocker: by Grashof's rule the shortest link, the
crank of 0.1 m, turns all the way round. There is no gravity in its plane.
"""

from __future__ import annotations

from ..declare.assembly import Body, Parameter, RelativeCoordinate
from ..declare.forces.force_element import ForceElement
from ..declare.forces.joint_force import JointForce
from ..declare.inputs import Input
from ..declare.laws import LinearDamper, LinearSpring
from ..declare.mechanism import Mechanism
from ..declare.model import Model
from ..declare.paths import AlongLine
from .planar import flat, hinge, inertia, places

# At the start the crank points along y: 0.1 m up from the origin.
_PLACES = {
    "crank_bearing": ((0.0, 0.0), "hinge of the crank on the ground"),
    "crank_pin": ((0.0, 0.1), "hinge of crank and coupler"),
    "rocker_pin": ((0.24, 0.26), "hinge of coupler and rocker"),
    "rocker_bearing": ((0.3, 0.0), "hinge of the rocker on the ground"),
    "crank_com": ((0.0, 0.05), "centre of mass of the crank"),
    "coupler_com": ((0.12, 0.18), "centre of mass of the coupler"),
    "rocker_com": ((0.27, 0.13), "centre of mass of the rocker"),
    "spring_ground": ((0.45, 0.2), "end of the spring on the ground"),
}

FOUR_BAR = Mechanism(
    name="four_bar",
    fixed="ground",
    title="Planar four-bar linkage",
    bodies=(
        Body("ground", 0, center=flat("crank_bearing")),
        Body("crank", 1, center=flat("crank_com")),
        Body("coupler", 2, center=flat("coupler_com")),
        Body("rocker", 3, center=flat("rocker_com")),
    ),
    joints=(
        hinge("A", "ground", "crank", "crank_bearing"),
        hinge("B", "crank", "coupler", "crank_pin"),
        hinge("C", "coupler", "rocker", "rocker_pin"),
        hinge("D", "ground", "rocker", "rocker_bearing"),
    ),
    forces=(
        ForceElement(
            name="spring",
            path=AlongLine(("ground", flat("spring_ground")), ("coupler", flat("coupler_com"))),
            laws=(
                LinearSpring(rate="spring_rate", free_length="spring_free_length"),
                LinearDamper(rate="damper_rate"),
            ),
        ),
        JointForce(joint="A", input="crank_torque"),
    ),
    parameters=(
        *places(_PLACES),
        *inertia("crank", 0.5, 5e-4),
        *inertia("coupler", 1.0, 8e-3),
        *inertia("rocker", 1.2, 8e-3),
        Parameter("spring_rate", 400.0, "N/m", "rate of the spring"),
        Parameter("spring_free_length", 0.3, "m", "free length of the spring"),
        Parameter("damper_rate", 0.0, "N s/m", "rate of the damper beside the spring"),
    ),
    coordinates=(
        RelativeCoordinate("crank_angle", "A", "angle", "rad", "angle of the crank from the start"),
        RelativeCoordinate(
            "coupler_angle", "B", "angle", "rad", "angle of the coupler on the crank"
        ),
        RelativeCoordinate(
            "rocker_angle", "D", "angle", "rad", "angle of the rocker from the start"
        ),
    ),
    inputs=(Input("crank_torque", "N m", "torque on the crank"),),
)

MODELS = (
    Model(
        name="four_bar",
        title="Planar four-bar linkage, one degree of freedom",
        mechanism=FOUR_BAR,
        independent=("A",),
        massive=("crank", "coupler", "rocker"),
    ),
)
