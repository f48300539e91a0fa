"""An axle of two suspensions: one of the right side and its mirror image, on one rack if any.

Any suspension of one side makes an axle, with an anti-roll bar or without. Half a bar turns in its
bushes on the chassis and is pulled by a drop link from a body of the suspension; the loop of each
drop link closes in closed form, like that of an arm held by a rod. The halves are stiff, and a
torsion spring between them represents the bar's elasticity: equal travel on both sides leaves the
bar free, opposite travel twists it.

Both sides have the parameters of the right one, or each has its own.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from .. import declare as d
from ..declare.parameters import Owner
from .pitman_arm import LINKAGE
from .suspension import RACK_FORCE, with_tyres_named

SIDES = ("right_", "left_")


def mechanism(
    name: str,
    title: str,
    corner: d.Formulation,
    *,
    pulls: str = "",
    own: bool = False,
    end: str = "front",
) -> d.Mechanism:
    """Return an axle.

    `corner` has the equations of the suspension of the right side, whose rack, if any, is
    prescribed. The drop link joins an anti-roll bar to its body `pulls`; without that, there is no
    bar. `own` is whether the left side has parameters of its own, whose names begin with ``left_``;
    `end` is the name of the tyres: the end of the car.
    """
    side = with_tyres_named(corner.mechanism, lambda _: end)
    if not pulls:
        return d.combined(name, title, _copies(corner, side, own=own))
    bar = _half_bar(side, pulls)
    right, left = copies = _copies(corner, _with_half_a_bar(side, bar), own=own)
    path = d.TwistOfHinges(right.of(bar.hinge), left.of(bar.hinge))
    return d.combined(name, title, copies, forces=(d.ForceElement("bar", path, (bar.spring,)),))


def model(
    corner: d.Formulation, declared: d.Mechanism, *, with_mass: tuple[str, ...] = ()
) -> d.Formulation:
    """Return the equations of an axle from those of one side; its rack, if any, is prescribed.

    Bodies of a side in `with_mass`, such as ``bar``, have mass besides those of the corner.
    """
    heavy = (*(body.name for body in corner.massive), *with_mass)
    return d.Formulation(
        name=declared.name,
        title=declared.title + ("; rack prescribed" if corner.prescribed else ""),
        mechanism=declared,
        independent=tuple(
            declared.joint(f"{s}{joint.name}") for s in SIDES for joint in corner.independent
        ),
        prescribed=corner.prescribed,
        massive=tuple(declared.body(f"{s}{name}") for s in SIDES for name in heavy),
        held=corner.held,
        allow_iteration=corner.allow_iteration,
    )


@dataclass(frozen=True)
class _HalfBar:
    """Half an anti-roll bar with its drop link."""

    hinge: d.Revolute
    ball: d.Spherical
    cross: d.Universal
    spring: d.LinearSpring


def _half_bar(suspension: d.Mechanism, pulls: str) -> _HalfBar:
    """Declare half a bar after the suspension, so that its bodies are behind it in all lists."""
    chassis, pulled = map(suspension.body, (suspension.ground, pulls))
    bush = d.Point("bar_bush", (0.24, -0.4, 0.32), "bush of the bar's half, on its axis")
    along = d.Direction("bar_axis", (0.0, 1.0, 0.0), "axis of the bar in its bush, pointing left")
    top = d.Point("link_top", (0.03, -0.58, 0.33), "drop link at the bar")
    foot = d.Point("link_foot", (0.03, -0.58, 0.2), f"drop link at the {pulls.replace('_', ' ')}")
    bar = d.Body("bar", 0.0, (0.24, -0.3, 0.32))
    link = d.Body("drop_link", 0.0, (0.03, -0.58, 0.265))
    shaft = d.Line(foot, top)
    return _HalfBar(
        d.Revolute("bar_hinge", chassis, bar, axis=d.Line(bush, along)),
        d.Spherical("link_ball", bar, link, at=top),
        d.Universal("link_cross", pulled, link, at=foot, shaft=shaft, first_axis=d.FORWARD),
        d.LinearSpring(
            rate=d.TorsionRate("bar_rate", 1000.0, "rate of the anti-roll bar between its arms"),
            free_length=d.Angle(
                "bar_free_angle", 0.0, "twist at which the bar is free, left less right"
            ),
        ),
    )


def _with_half_a_bar(suspension: d.Mechanism, bar: _HalfBar) -> d.Mechanism:
    angle = bar.hinge.angle(
        "bar_angle", "angle of the bar's half from design, right-handed about its axis to the left"
    )
    return replace(
        suspension,
        name="side",
        joints=(*suspension.joints, bar.hinge, bar.ball, bar.cross),
        coordinates=(*suspension.coordinates, angle),
    )


def _copies(corner: d.Formulation, side: d.Mechanism, *, own: bool) -> tuple[d.Copy, d.Copy]:
    """Return a suspension of the right side and its mirror image, on one rack if any."""
    shared: tuple[d.Body | d.Input, ...] = (
        *(guide.second for guide in corner.prescribed),
        *(body for body in LINKAGE if body in side.bodies),
        *((RACK_FORCE,) if corner.prescribed else ()),
    )
    theirs = tuple(side.every(Owner)) if own else ()
    return (
        d.Copy(side, "right_", shared=shared),
        d.Copy(side, "left_", mirrored=True, shared=shared, own=theirs),
    )
