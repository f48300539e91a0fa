"""Derive the equations of motion of mechanisms with kinematic loops, and emit them as C.

The rooms, in the order in which a mechanism passes through them:

``mechanism``, ``joints``, ``geometry``, ``forces``, ``laws``, ``parameters``
    what a person declares (``declared`` checks each part, ``checks`` the whole);
``topology``
    mobility, joint graph, shortest paths, minimal cycle basis;
``transformer``
    which loop is cut at which pair of joints, and in which order the loops are solved;
``solutions``
    the catalogue of closed forms;
``kinematics``, ``dynamics``, ``outputs``
    the straight-line program from the coordinates to accelerations and everything else;
``program``
    named steps, stages, derivatives, common subexpressions, operation counts;
``emit``
    printers: C, Cython, the derivation report.

What a declaration is made of can be imported from here.
"""

from . import memory  # noqa: F401 (before SymPy is imported)
from .declare.assembly import Body, Parameter, RelativeCoordinate
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
from .declare.joints import Cylindrical, Prismatic, Revolute, Spherical, Universal
from .declare.laws import Actuator, DamperTable, Friction, LinearDamper, LinearSpring, Stop
from .declare.mechanism import Mechanism
from .declare.model import Model
from .declare.parameters import direction, point, rigid_body, rotor

__all__ = [
    "FORWARD",
    "UP",
    "Actuator",
    "AlongLine",
    "AlongTelescope",
    "Body",
    "Cylindrical",
    "DamperTable",
    "DeclarationError",
    "Direction",
    "ForceElement",
    "Friction",
    "JointForce",
    "Line",
    "LinearDamper",
    "LinearSpring",
    "LinearTyre",
    "Mechanism",
    "Model",
    "Parameter",
    "Point",
    "Prismatic",
    "RelativeCoordinate",
    "Revolute",
    "Spherical",
    "Stop",
    "TwistOfHinges",
    "Universal",
    "Weight",
    "direction",
    "point",
    "rigid_body",
    "rotor",
]
