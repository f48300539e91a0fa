"""Declarations: bodies, joints, forces, laws, and models made of them."""

from .bodies import Body, Ground, Rotor
from .composition import Copy, combined
from .constraints import NoSlip, Rolling
from .contact_laws import LinearContact, MagicFormulaContact, TMeasyContact
from .declared import DeclarationError
from .forces.air_forces import AirForces
from .forces.applied_force import AppliedForce
from .forces.applied_moment import AppliedMoment
from .forces.force import Action, Force
from .forces.force_element import ForceElement
from .forces.joint_force import JointForce
from .forces.linear_tyre import LinearTyre
from .forces.rolling_tyre import RollingTyre
from .forces.shaft_torque import ShaftTorque
from .forces.weight import Weight
from .forces.wheel_loads import WheelLoads
from .formulation import Formulation
from .geometry import FORWARD, UP, Direction, Line, Point
from .inputs import Input, Motion
from .internal_states import InternalState
from .joints import (
    Cylindrical,
    Free,
    Gear,
    Joint,
    Prismatic,
    RelativeCoordinate,
    Revolute,
    Spherical,
    Universal,
    Weld,
)
from .laws import (
    Actuator,
    DamperTable,
    Friction,
    LaggingDamper,
    LinearDamper,
    LinearSpring,
    SpringTable,
    Stop,
)
from .mechanism import Mechanism
from .outputs import AccelerationOf, AngleBetween, DistanceBetween, ForceOf, PositionOf, VelocityOf
from .parameters import (
    Angle,
    AngularSpeed,
    DamperRate,
    Displacement,
    Distance,
    ForceLevel,
    Gravity,
    Lead,
    Length,
    MomentLevel,
    Parameter,
    Progression,
    Ratio,
    Share,
    Speed,
    SpringRate,
    TimeConstant,
    TorsionDamperRate,
    TorsionProgression,
    TorsionRate,
    TurnPerTravel,
)
from .paths import AlongGuide, AlongHinge, AlongLine, AlongTelescope, TwistOfHinges
from .planar import flat, hinge
from .shown import Shown
from .surroundings import Surroundings
from .wheel import Wheel
from .world import WORLD

__all__ = [
    "FORWARD", "UP", "WORLD", "AccelerationOf", "Action", "Actuator", "AirForces", "AlongGuide",
    "AlongHinge", "AlongLine", "AlongTelescope", "Angle", "AngleBetween", "AngularSpeed",
    "AppliedForce", "AppliedMoment", "Body", "Copy", "Cylindrical", "DamperRate", "DamperTable",
    "DeclarationError", "Direction", "Displacement", "Distance", "DistanceBetween", "Force",
    "ForceElement", "ForceLevel", "ForceOf", "Formulation", "Free", "Friction", "Gear", "Gravity",
    "Ground", "Input", "InternalState", "Joint", "JointForce", "LaggingDamper", "Lead", "Length",
    "Line", "LinearContact", "LinearDamper", "LinearSpring", "LinearTyre", "MagicFormulaContact",
    "Mechanism", "MomentLevel", "Motion", "NoSlip", "Parameter", "Point", "PositionOf", "Prismatic",
    "Progression", "Ratio", "RelativeCoordinate", "Revolute", "Rolling", "RollingTyre", "Rotor",
    "ShaftTorque", "Share", "Shown", "Speed", "Spherical", "SpringRate", "SpringTable", "Stop",
    "Surroundings", "TMeasyContact", "TimeConstant", "TorsionDamperRate", "TorsionProgression",
    "TorsionRate", "TurnPerTravel", "TwistOfHinges", "Universal", "VelocityOf", "Weight", "Weld",
    "Wheel", "WheelLoads", "combined", "flat", "hinge",
]  # fmt: skip
