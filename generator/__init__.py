"""Derive the equations of motion of mechanisms with kinematic loops, and emit them as C.

The floors, the lowest first; a file imports only what stands on a lower one (`make lint`):

``program``
    the straight-line program: steps, constants, derivatives, what is shared, operation counts;
``declare``, and ``mechanisms`` that come with the project
    what a person declares, each part checked where it is written, and the whole;
``kinematics``
    bodies in motion: poses, twists, bias accelerations;
``loops``
    joint graph, minimal cycle basis, mobility, and the order in which the loops are solved;
``closed_forms``
    the catalogue, a file for each form with all that there is to say about it;
``planning``
    the planner with that catalogue in its hands, and proposals of coordinates;
``equations``
    dynamics, and the functions that are emitted;
``backends``
    printers, a folder for each: C, Cython, NumPy, Python, the derivation report.

What a declaration is made of can be imported from here.
"""

from . import memory  # noqa: F401 (before SymPy is imported)
from .declare.bodies import Body, Ground, Rotor
from .declare.composition import Copy, combined
from .declare.coordinates import RelativeCoordinate
from .declare.declared import DeclarationError
from .declare.forces import (
    AlongLine,
    AlongTelescope,
    ForceElement,
    JointForce,
    LinearTyre,
    TwistOfHinges,
    Weight,
)
from .declare.geometry import FORWARD, UP, Direction, Line, Point
from .declare.inputs import Input, Motion
from .declare.joints import Cylindrical, Prismatic, Revolute, Spherical, Universal
from .declare.laws import Actuator, DamperTable, Friction, LinearDamper, LinearSpring, Stop
from .declare.mechanism import Mechanism
from .declare.model import Model
from .declare.parameters import (
    Angle,
    AngularSpeed,
    DamperRate,
    Displacement,
    Distance,
    ForceLevel,
    Gravity,
    Length,
    MomentLevel,
    Parameter,
    Progression,
    Share,
    Speed,
    SpringRate,
    TorsionDamperRate,
    TorsionProgression,
    TorsionRate,
)

__all__ = [
    "FORWARD",
    "UP",
    "Actuator",
    "AlongLine",
    "AlongTelescope",
    "Angle",
    "AngularSpeed",
    "Body",
    "Copy",
    "Cylindrical",
    "DamperRate",
    "DamperTable",
    "DeclarationError",
    "Direction",
    "Displacement",
    "Distance",
    "ForceElement",
    "ForceLevel",
    "Friction",
    "Gravity",
    "Ground",
    "Input",
    "JointForce",
    "Length",
    "Line",
    "LinearDamper",
    "LinearSpring",
    "LinearTyre",
    "Mechanism",
    "Model",
    "MomentLevel",
    "Motion",
    "Parameter",
    "Point",
    "Prismatic",
    "Progression",
    "RelativeCoordinate",
    "Revolute",
    "Rotor",
    "Share",
    "Speed",
    "Spherical",
    "SpringRate",
    "Stop",
    "TorsionDamperRate",
    "TorsionProgression",
    "TorsionRate",
    "TwistOfHinges",
    "Universal",
    "Weight",
    "combined",
]
