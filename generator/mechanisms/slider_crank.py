"""The slider-crank: crank, connecting rod, and a piston on a guide along x.

The loop leaves one quadratic in the slide. By default the guide passes through the crank's
bearing; the points may be moved for an offset one.
"""

from __future__ import annotations

import math

from ..declare.assembly import Body, Parameter, RelativeCoordinate
from ..declare.forces.joint_force import JointForce
from ..declare.geometry import FORWARD
from ..declare.inputs import Input
from ..declare.joints import Prismatic
from ..declare.mechanism import Mechanism
from ..declare.model import Model
from .planar import flat, hinge, inertia, places

# A crank of 40 mm and a rod of 0.15 m, at the start with the crank along y.
_ROD = 0.15
_PISTON = math.sqrt(_ROD**2 - 0.04**2)
_PLACES = {
    "crank_bearing": ((0.0, 0.0), "hinge of the crank on the ground"),
    "crank_pin": ((0.0, 0.04), "hinge of crank and rod"),
    "piston_pin": ((_PISTON, 0.0), "hinge of rod and piston"),
    "crank_com": ((0.0, 0.01), "centre of mass of the crank"),
    "rod_com": ((0.3 * _PISTON, 0.028), "centre of mass of the rod"),
    "piston_com": ((_PISTON, 0.0), "centre of mass of the piston"),
}

SLIDER_CRANK = Mechanism(
    name="slider_crank",
    fixed="ground",
    title="Slider-crank",
    bodies=(
        Body("ground", 0, center=flat("crank_bearing")),
        Body("crank", 1, center=flat("crank_com")),
        Body("rod", 2, center=flat("rod_com")),
        Body("piston", 3, center=flat("piston_com")),
    ),
    joints=(
        hinge("A", "ground", "crank", "crank_bearing"),
        hinge("B", "crank", "rod", "crank_pin"),
        hinge("C", "rod", "piston", "piston_pin"),
        Prismatic(name="guide", first="ground", second="piston", direction=FORWARD),
    ),
    forces=(JointForce(joint="A", input="crank_torque"),),
    parameters=(
        *places(_PLACES),
        *inertia("crank", 2.0, 3e-3),
        *inertia("rod", 0.6, 2e-3),
        Parameter("piston_mass", 0.4, "kg", "mass of piston"),
    ),
    coordinates=(
        RelativeCoordinate("crank_angle", "A", "angle", "rad", "angle of the crank from the start"),
        RelativeCoordinate("rod_angle", "B", "angle", "rad", "angle of the rod on the crank"),
        RelativeCoordinate("piston_slide", "guide", "slide", "m", "slide of the piston along x"),
    ),
    inputs=(Input("crank_torque", "N m", "torque on the crank"),),
)

MODELS = (
    Model(
        name="slider_crank",
        title="Slider-crank, one degree of freedom",
        mechanism=SLIDER_CRANK,
        independent=("A",),
        massive=("crank", "rod", "piston"),
    ),
)
