"""A double wishbone suspension whose spring lies on the chassis: a rod and a rocker move it.

The rod leads from an arm to the rocker, which turns about a hinge of any direction; its loop closes
in closed form, like that of an arm held by a rod. Spring and damper act between rocker and chassis.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from .. import declare as d
from . import double_wishbone as wishbones
from .double_wishbone import ACTUATOR, CHASSIS, DAMPER, DOUBLE_WISHBONE, RACK_GUIDE, TYRE, WEIGHT
from .suspension import (
    RACK_FORCE,
    RACK_MOTION,
    further_laws,
    spring_table,
    with_damping_and_liftoff,
)


@dataclass(frozen=True)
class Rocker:
    """A rocker and its rod, with their points."""

    # ends of the rod: at the arm, and at the rocker
    outer: d.Point
    inner: d.Point
    # bearings of the rocker
    front: d.Point
    rear: d.Point
    # ends of the spring: on the chassis, and on the rocker
    top: d.Point
    seat: d.Point
    # bodies
    rocker: d.Body
    rod: d.Body


def model(arm: d.Body, at: Rocker, spring: d.LinearSpring) -> d.Formulation:
    """Return the equations of the suspension, with its rack prescribed.

    `arm` is the body that moves the rod.
    """
    name, rod, rocker = at.rod.name, at.rod, at.rocker
    hinge = d.Revolute("rocker_hinge", CHASSIS, rocker, axis=d.Line(at.rear, at.front))
    ball = d.Spherical(f"{name}_ball", arm, rod, at=at.outer)
    cross = d.Universal(
        f"{name}_cross",
        rocker,
        rod,
        at=at.inner,
        shaft=d.Line(at.inner, at.outer),
        first_axis=d.Direction("rocker_axis", between=(at.rear, at.front)),
    )
    coil = d.ForceElement(
        "spring",
        d.AlongLine((CHASSIS, at.top), (rocker, at.seat)),
        (spring, spring_table(), DAMPER, *further_laws("damper", 1.0), ACTUATOR),
    )
    title = f"Double wishbone suspension with {name.replace('_', ' ')} and rocker"
    angle = hinge.angle(
        "rocker_angle", "angle of the rocker from design, right-handed about its axis forward"
    )
    mechanism = replace(
        DOUBLE_WISHBONE,
        name=name,
        title=title,
        joints=(*DOUBLE_WISHBONE.joints, hinge, ball, cross),
        forces=(WEIGHT, coil, with_damping_and_liftoff(TYRE), d.JointForce(RACK_GUIDE, RACK_FORCE)),
        coordinates=(*DOUBLE_WISHBONE.coordinates, angle),
    )
    arms = wishbones.LOWER_ARM, wishbones.KNUCKLE, wishbones.UPPER_ARM
    return d.Formulation(
        name=name,
        title=f"{title}, rack prescribed",
        mechanism=mechanism,
        independent=(wishbones.LOWER_HINGE, wishbones.BEARING),
        prescribed={RACK_GUIDE: RACK_MOTION},
        massive=(*arms, wishbones.WHEEL, rocker),
        held={"rack_held": (RACK_GUIDE,)},
    )
