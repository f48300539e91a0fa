"""The slider-crank: crank, connecting rod, and a piston on a guide along x.

The loop leaves one quadratic in the slide. By default the guide passes through the crank's
bearing; the points may be moved for an offset one.
"""

import math

from .. import declare as d
from ..declare import flat, hinge

# A crank of 40 mm and a rod of 0.15 m, at the start with the crank along y.
_ROD = 0.15
_PISTON = math.sqrt(_ROD**2 - 0.04**2)

CRANK_BEARING = flat("crank_bearing", (0.0, 0.0), "hinge of the crank on the ground")
CRANK_PIN = flat("crank_pin", (0.0, 0.04), "hinge of crank and rod")
PISTON_PIN = flat("piston_pin", (_PISTON, 0.0), "hinge of rod and piston")
CRANK_COM = flat("crank_com", (0.0, 0.01), "centre of mass of the crank")
ROD_COM = flat("rod_com", (0.3 * _PISTON, 0.028), "centre of mass of the rod")
PISTON_COM = flat("piston_com", (_PISTON, 0.0), "centre of mass of the piston")

GROUND = d.Ground("ground")
CRANK = d.Body("crank", 2.0, CRANK_COM, 3e-3)
ROD = d.Body("rod", 0.6, ROD_COM, 2e-3)
PISTON = d.Body("piston", 0.4, PISTON_COM)

A = hinge("A", GROUND, CRANK, CRANK_BEARING)
B = hinge("B", CRANK, ROD, CRANK_PIN)
C = hinge("C", ROD, PISTON, PISTON_PIN)
GUIDE = d.Prismatic("guide", GROUND, PISTON, direction=d.FORWARD)

SLIDER_CRANK = d.Mechanism(
    name="slider_crank",
    title="Slider-crank",
    joints=(A, B, C, GUIDE),
    forces=(d.JointForce(A, d.Input("crank_torque", "N m", "torque on the crank")),),
    coordinates=(
        A.angle("crank_angle", "angle of the crank from the start"),
        B.angle("rod_angle", "angle of the rod on the crank"),
        GUIDE.slide("piston_slide", "slide of the piston along x"),
    ),
)

MODELS = (d.Formulation("slider_crank", "Slider-crank, one degree of freedom", SLIDER_CRANK, (A,)),)
