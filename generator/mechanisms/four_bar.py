"""The planar four-bar linkage: crank, coupler and rocker on two fixed hinges.

The loop is a dyad: the distance of the crank pin from the rocker's hinge gives the rocker's angle
(Freudenstein's equation). The default is a crank-rocker: by Grashof's rule the shortest link, the
crank of 0.1 m, turns all the way round. There is no gravity in its plane.
"""

from __future__ import annotations

from ..declare.bodies import Body, Ground
from ..declare.coordinates import RelativeCoordinate
from ..declare.forces import AlongLine, ForceElement, JointForce
from ..declare.inputs import Input
from ..declare.laws import LinearDamper, LinearSpring
from ..declare.mechanism import Mechanism
from ..declare.model import Model
from ..declare.parameters import DamperRate, Length, SpringRate
from .planar import flat, hinge

# At the start the crank points along y: 0.1 m up from the origin.
CRANK_BEARING = flat("crank_bearing", (0.0, 0.0), "hinge of the crank on the ground")
CRANK_PIN = flat("crank_pin", (0.0, 0.1), "hinge of crank and coupler")
ROCKER_PIN = flat("rocker_pin", (0.24, 0.26), "hinge of coupler and rocker")
ROCKER_BEARING = flat("rocker_bearing", (0.3, 0.0), "hinge of the rocker on the ground")
CRANK_COM = flat("crank_com", (0.0, 0.05), "centre of mass of the crank")
COUPLER_COM = flat("coupler_com", (0.12, 0.18), "centre of mass of the coupler")
ROCKER_COM = flat("rocker_com", (0.27, 0.13), "centre of mass of the rocker")
SPRING_GROUND = flat("spring_ground", (0.45, 0.2), "end of the spring on the ground")

GROUND = Ground("ground")
CRANK = Body("crank", 0.5, CRANK_COM, 5e-4)
COUPLER = Body("coupler", 1.0, COUPLER_COM, 8e-3)
ROCKER = Body("rocker", 1.2, ROCKER_COM, 8e-3)

A = hinge("A", GROUND, CRANK, CRANK_BEARING)
B = hinge("B", CRANK, COUPLER, CRANK_PIN)
C = hinge("C", COUPLER, ROCKER, ROCKER_PIN)
D = hinge("D", GROUND, ROCKER, ROCKER_BEARING)

SPRING = LinearSpring(
    rate=SpringRate("spring_rate", 400.0, "rate of the spring"),
    free_length=Length("spring_free_length", 0.3, "free length of the spring"),
)
DAMPER = LinearDamper(rate=DamperRate("damper_rate", 0.0, "rate of the damper beside the spring"))

FOUR_BAR = Mechanism(
    name="four_bar",
    title="Planar four-bar linkage",
    joints=(A, B, C, D),
    forces=(
        ForceElement(
            "spring", AlongLine((GROUND, SPRING_GROUND), (COUPLER, COUPLER_COM)), (SPRING, DAMPER)
        ),
        JointForce(A, Input("crank_torque", "N m", "torque on the crank")),
    ),
    coordinates=(
        RelativeCoordinate("crank_angle", A, "angle of the crank from the start"),
        RelativeCoordinate("coupler_angle", B, "angle of the coupler on the crank"),
        RelativeCoordinate("rocker_angle", D, "angle of the rocker from the start"),
    ),
)

MODELS = (
    Model(
        name="four_bar",
        title="Planar four-bar linkage, one degree of freedom",
        mechanism=FOUR_BAR,
        independent=(A,),
        massive=(CRANK, COUPLER, ROCKER),
    ),
)
