"""The planar four-bar linkage: crank, coupler and rocker on two fixed hinges.

The loop is a dyad: the distance of the crank pin from the rocker's hinge gives the rocker's angle
(Freudenstein's equation). The default is a crank-rocker: by Grashof's rule the shortest link, the
crank of 0.1 m, turns all the way round. There is no gravity in its plane.
"""

from .. import declare as d
from ..declare import flat, hinge

# At the start the crank points along y: 0.1 m up from the origin.
CRANK_BEARING = flat("crank_bearing", (0.0, 0.0), "hinge of the crank on the ground")
CRANK_PIN = flat("crank_pin", (0.0, 0.1), "hinge of crank and coupler")
ROCKER_PIN = flat("rocker_pin", (0.24, 0.26), "hinge of coupler and rocker")
ROCKER_BEARING = flat("rocker_bearing", (0.3, 0.0), "hinge of the rocker on the ground")
CRANK_COM = flat("crank_com", (0.0, 0.05), "centre of mass of the crank")
COUPLER_COM = flat("coupler_com", (0.12, 0.18), "centre of mass of the coupler")
ROCKER_COM = flat("rocker_com", (0.27, 0.13), "centre of mass of the rocker")
SPRING_GROUND = flat("spring_ground", (0.45, 0.2), "end of the spring on the ground")

GROUND = d.Ground("ground")
CRANK = d.Body("crank", 0.5, CRANK_COM, 5e-4)
COUPLER = d.Body("coupler", 1.0, COUPLER_COM, 8e-3)
ROCKER = d.Body("rocker", 1.2, ROCKER_COM, 8e-3)

A = hinge("A", GROUND, CRANK, CRANK_BEARING)
B = hinge("B", CRANK, COUPLER, CRANK_PIN)
C = hinge("C", COUPLER, ROCKER, ROCKER_PIN)
D = hinge("D", GROUND, ROCKER, ROCKER_BEARING)

SPRING = d.LinearSpring(
    rate=d.SpringRate("spring_rate", 400.0, "rate of the spring"),
    free_length=d.Length("spring_free_length", 0.3, "free length of the spring"),
)
DAMPER = d.LinearDamper(
    rate=d.DamperRate("damper_rate", 0.0, "rate of the damper beside the spring")
)

FOUR_BAR = d.Mechanism(
    name="four_bar",
    title="Planar four-bar linkage",
    joints=(A, B, C, D),
    forces=(
        d.ForceElement(
            "spring", d.AlongLine((GROUND, SPRING_GROUND), (COUPLER, COUPLER_COM)), (SPRING, DAMPER)
        ),
        d.JointForce(A, d.Input("crank_torque", "N m", "torque on the crank")),
    ),
    coordinates=(
        A.angle("crank_angle", "angle of the crank from the start"),
        B.angle("coupler_angle", "angle of the coupler on the crank"),
        D.angle("rocker_angle", "angle of the rocker from the start"),
    ),
)

MODELS = (
    d.Formulation("four_bar", "Planar four-bar linkage, one degree of freedom", FOUR_BAR, (A,)),
)
