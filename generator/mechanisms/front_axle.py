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

from .. import declare as d
from . import macpherson
from .macpherson import ARM, CHASSIS, HG, KNUCKLE, OA, WHEEL, Y
from .suspension import RACK_FORCE, RACK_MOTION

BAR_BUSH = d.Point("bar_bush", (0.24, -0.4, 0.32), "bush of the bar's half, on its axis")
BAR_AXIS = d.Direction("bar_axis", (0.0, 1.0, 0.0), "axis of the bar in its bush, pointing left")
LINK_TOP = d.Point("link_top", (0.03, -0.58, 0.33), "drop link at the bar")
LINK_FOOT = d.Point("link_foot", (0.03, -0.58, 0.2), "drop link at the control arm")

BAR = d.Body("bar", 0.0, (0.24, -0.3, 0.32))
DROP_LINK = d.Body("drop_link", 0.0, (0.03, -0.58, 0.265))

BAR_HINGE = d.Revolute("bar_hinge", CHASSIS, BAR, axis=d.Line(BAR_BUSH, BAR_AXIS))
LINK_BALL = d.Spherical("link_ball", BAR, DROP_LINK, at=LINK_TOP)
LINK_CROSS = d.Universal(
    "link_cross",
    ARM,
    DROP_LINK,
    at=LINK_FOOT,
    shaft=d.Line(LINK_FOOT, LINK_TOP),
    first_axis=d.FORWARD,
)
BAR_ANGLE = BAR_HINGE.angle(
    "bar_angle", "angle of the bar's half from design, right-handed about its axis to the left"
)
BAR_SPRING = d.LinearSpring(
    rate=d.TorsionRate("bar_rate", 1000.0, "rate of the anti-roll bar between its arms"),
    free_length=d.Angle("bar_free_angle", 0.0, "twist at which the bar is free, left less right"),
)


def side() -> d.Mechanism:
    """Return the right side: the paper's suspension with half an anti-roll bar."""
    strut = macpherson.mechanism()
    return replace(
        strut,
        name="side",
        joints=(*strut.joints, BAR_HINGE, LINK_BALL, LINK_CROSS),
        coordinates=(*strut.coordinates, BAR_ANGLE),
    )


def sides(declared: d.Mechanism) -> tuple[d.Copy, d.Copy]:
    """Return a suspension of the right side and its mirror image, on one rack."""
    shared = (macpherson.RACK, RACK_FORCE)
    return (
        d.Copy(declared, "right_", shared=shared),
        d.Copy(declared, "left_", mirrored=True, shared=shared),
    )


def mechanism() -> d.Mechanism:
    """Return the axle with its anti-roll bar."""
    right, left = sides(side())
    bar = d.ForceElement(
        "bar", d.TwistOfHinges(right.of(BAR_HINGE), left.of(BAR_HINGE)), (BAR_SPRING,)
    )
    title = "Front axle: two MacPherson suspensions, anti-roll bar"
    return d.combined("front_axle", title, (right, left), forces=(bar,))


def without_bar() -> d.Mechanism:
    """Return the axle without an anti-roll bar."""
    title = "Front axle: two MacPherson suspensions"
    return d.combined("front_axle", title, sides(macpherson.mechanism()))


def model(
    declared: d.Mechanism, massive: tuple[d.Body, ...] = (ARM, KNUCKLE, WHEEL)
) -> d.Formulation:
    """Return the equations of an axle with prescribed rack.

    Parameters
    ----------
    declared
        With or without a bar.
    massive
        Bodies of a side that have mass; the bar may be one of them.
    """
    both = ("right_", "left_")
    return d.Formulation(
        name=declared.name,
        title=declared.title + "; rack prescribed",
        mechanism=declared,
        independent=tuple(declared.joint(f"{s}{joint.name}") for s in both for joint in (OA, HG)),
        prescribed={Y: RACK_MOTION},
        massive=tuple(declared.body(f"{s}{body.name}") for s in both for body in massive),
        held={"rack_held": (Y,)},
    )


MODELS = (model(mechanism()),)
