"""A front axle: two MacPherson suspensions that share the rack, with an anti-roll bar.

One side is declared, the right one: the paper's suspension and half a bar, which turns in its
bushes on the chassis and is pulled by a drop link from the control arm. The axle is this side and
its mirror image; both have the parameters of the right side. The halves of the bar are stiff, and
a torsion spring between them stands for its elasticity: equal travel on both sides leaves the bar
free, opposite travel twists it. The loop of each drop link closes in closed form, like that of an
arm held by a rod.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ..declare.assembly import Body, Parameter, RelativeCoordinate
from ..declare.composition import combined, copy
from ..declare.forces.force_element import ForceElement
from ..declare.geometry import FORWARD, Direction, Line, Point
from ..declare.joints import Revolute, Spherical, Universal
from ..declare.laws import LinearSpring
from ..declare.model import Model
from ..declare.parameters import direction, point, rigid_body
from ..declare.paths import TwistOfHinges
from . import macpherson

if TYPE_CHECKING:
    from ..declare.mechanism import Mechanism

BAR_BUSH = Point("bar_bush")
LINK_TOP, LINK_FOOT = Point("link_top"), Point("link_foot")
BAR_AXIS = Direction("bar_axis")

BAR_BODIES = (
    Body("bar", 8, center=Point("bar_com")),
    Body("drop_link", 9, center=Point("drop_link_com")),
)

BAR_JOINTS = (
    Revolute(name="bar_hinge", first="chassis", second="bar", axis=Line(BAR_BUSH, BAR_AXIS)),
    Spherical(name="link_ball", first="bar", second="drop_link", at=LINK_TOP),
    Universal(
        name="link_cross",
        first="control_arm",
        second="drop_link",
        at=LINK_FOOT,
        shaft=Line(LINK_FOOT, LINK_TOP),
        first_axis=FORWARD,
    ),
)

BAR_ANGLE = RelativeCoordinate(
    "bar_angle",
    "bar_hinge",
    "angle",
    "rad",
    "angle of the bar's half from design, right-handed about its axis to the left",
)

BAR_PARAMETERS = (
    *point("bar_bush", (0.24, -0.4, 0.32), "bush of the bar's half, on its axis"),
    *direction("bar_axis", (0.0, 1.0, 0.0), "axis of the bar in its bush, pointing left"),
    *point("link_top", (0.03, -0.58, 0.33), "drop link at the bar"),
    *point("link_foot", (0.03, -0.58, 0.2), "drop link at the control arm"),
    *rigid_body("bar", 0.0, (0.24, -0.3, 0.32)),
    *rigid_body("drop_link", 0.0, (0.03, -0.58, 0.265)),
)

BAR_RATES = (
    Parameter("bar_rate", 1000.0, "N m/rad", "rate of the anti-roll bar between its arms"),
    Parameter("bar_free_angle", 0.0, "rad", "twist at which the bar is free, left less right"),
)

ANTI_ROLL_BAR = ForceElement(
    name="bar",
    path=TwistOfHinges("right_bar_hinge", "left_bar_hinge"),
    laws=(LinearSpring(rate="bar_rate", free_length="bar_free_angle"),),
)

RACK = ("rack", "rack_position", "rack_velocity", "rack_acceleration", "rack_force")


def side() -> Mechanism:
    """Return the right side: the paper's suspension with half an anti-roll bar."""
    strut = macpherson.mechanism()
    return replace(
        strut,
        name="side",
        bodies=strut.bodies + BAR_BODIES,
        joints=strut.joints + BAR_JOINTS,
        parameters=strut.parameters + BAR_PARAMETERS,
        coordinates=(*strut.coordinates, BAR_ANGLE),
    )


def axle(declared: Mechanism, name: str, title: str) -> Mechanism:
    """Return a suspension of the right side with its mirror image, on one rack."""
    sides = [
        copy(declared, "right_", shared=RACK),
        copy(declared, "left_", mirrored=True, shared=RACK),
    ]
    return combined(name, title, sides)


def mechanism() -> Mechanism:
    """Return the axle with its anti-roll bar."""
    sides = axle(side(), "front_axle", "Front axle: two MacPherson suspensions, anti-roll bar")
    return replace(
        sides, forces=(*sides.forces, ANTI_ROLL_BAR), parameters=sides.parameters + BAR_RATES
    )


def without_bar() -> Mechanism:
    """Return the axle without an anti-roll bar."""
    return axle(macpherson.mechanism(), "front_axle", "Front axle: two MacPherson suspensions")


def model(
    declared: Mechanism, massive: tuple[str, ...] = ("control_arm", "knuckle", "wheel")
) -> Model:
    """Return the equations of an axle with prescribed rack.

    Parameters
    ----------
    declared
        With or without a bar.
    massive
        Bodies of a side that have mass; ``bar`` may be one of them.
    """
    both = ("right_", "left_")
    return Model(
        name=declared.name,
        title=declared.title + "; rack prescribed",
        mechanism=declared,
        independent=tuple(f"{prefix}{joint}" for prefix in both for joint in ("OA", "HG")),
        prescribed={"y": "rack"},
        massive=tuple(f"{prefix}{body}" for prefix in both for body in massive),
        held={"rack_held": ("y",)},
    )


MODELS = (model(mechanism()),)
