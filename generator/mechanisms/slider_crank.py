"""The slider-crank: crank, connecting rod, and a piston on a guide along x.

The loop leaves one quadratic in the slide. By default the guide passes through the crank's
bearing; the points may be moved for an offset one.
"""

from __future__ import annotations

import math

from ..forces import JointForce
from ..geometry import FORWARD, UP, Line, Point
from ..joints import Prismatic, Revolute
from ..mechanism import Body, Mechanism, Model, Parameter, RelativeCoordinate


def _point(name: str) -> Point:
    return Point(name, flat="z")


def _hinge(name: str, first: str, second: str, at: str) -> Revolute:
    axis = Line(_point(at), UP)
    return Revolute(name=name, first=first, second=second, axis=axis, angle_from=FORWARD)


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
    title="Slider-crank",
    bodies=(
        Body("ground", 0, center=_point("crank_bearing")),
        Body("crank", 1, center=_point("crank_com")),
        Body("rod", 2, center=_point("rod_com")),
        Body("piston", 3, center=_point("piston_com")),
    ),
    joints=(
        _hinge("A", "ground", "crank", "crank_bearing"),
        _hinge("B", "crank", "rod", "crank_pin"),
        _hinge("C", "rod", "piston", "piston_pin"),
        Prismatic(name="guide", first="ground", second="piston", direction=FORWARD),
    ),
    forces=(JointForce(joint="A", input="crank_torque"),),
    parameters=(
        *(
            Parameter(f"{name}_{axis}", value, "m", f"{meaning} at the start, {axis}")
            for name, (place, meaning) in _PLACES.items()
            for axis, value in zip("xy", place, strict=True)
        ),
        Parameter("crank_mass", 2.0, "kg", "mass of the crank"),
        Parameter("crank_inertia_zz", 3e-3, "kg m^2", "inertia of the crank across the plane"),
        Parameter("rod_mass", 0.6, "kg", "mass of the rod"),
        Parameter("rod_inertia_zz", 2e-3, "kg m^2", "inertia of the rod across the plane"),
        Parameter("piston_mass", 0.4, "kg", "mass of the piston"),
    ),
    coordinates=(
        RelativeCoordinate("crank_angle", "A", "angle", "rad", "angle of the crank from the start"),
        RelativeCoordinate("rod_angle", "B", "angle", "rad", "angle of the rod on the crank"),
        RelativeCoordinate("piston_slide", "guide", "slide", "m", "slide of the piston along x"),
    ),
    inputs={"crank_torque": ("N m", "torque on the crank")},
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
