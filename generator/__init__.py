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
from .declare.assembly import Body, Parameter, RelativeCoordinate
from .declare.declared import DeclarationError
from .declare.forces.force_element import ForceElement
from .declare.forces.joint_force import JointForce
from .declare.forces.linear_tyre import LinearTyre
from .declare.forces.weight import Weight
from .declare.geometry import FORWARD, UP, Direction, Line, Point
from .declare.inputs import Input, motion
from .declare.joints import Cylindrical, Free, Prismatic, Revolute, Spherical, Universal
from .declare.laws import Actuator, DamperTable, Friction, LinearDamper, LinearSpring, Stop
from .declare.mechanism import Mechanism
from .declare.model import Model
from .declare.parameters import direction, point, rigid_body, rotor
from .declare.paths import AlongLine, AlongTelescope, TwistOfHinges
from .declare.wheel import Wheel

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
    "Free",
    "Friction",
    "Input",
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
    "Wheel",
    "direction",
    "motion",
    "point",
    "rigid_body",
    "rotor",
]
