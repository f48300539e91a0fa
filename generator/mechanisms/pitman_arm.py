"""Suspensions steered by a Pitman arm, a relay rod and an idler arm instead of a rack.

The relay rod joins both arms by a universal joint at the Pitman arm and a ball joint at the idler
arm; the tie rods of both sides are joined to it. With the chassis it is a spatial four-bar linkage,
closed like an arm that a rod holds, before the suspension's own loops, which stay as they are.

The input is that of a rack: the way of the ball of the Pitman arm along its circle. The guide of
the rack represents the worm nut of a steering gear, which turns the arm, so that the force on the
rack is the moment on the arm divided by the arm's length. The linkage has no mass.
"""

from __future__ import annotations

from dataclasses import replace

from .. import declare as d
from ..declare.composition import replaced
from . import double_wishbone, macpherson, multi_link, pull_rod, push_rod

_PIVOT = d.Point("pitman_pivot", (-0.39, 0.30, 0.265), "bearing of the Pitman arm")
_BALL = d.Point("pitman_ball", (-0.14, 0.30, 0.265), "relay rod at the Pitman arm")
_IDLER_PIVOT = d.Point("idler_pivot", (-0.39, -0.30, 0.265), "bearing of the idler arm")
_IDLER_BALL = d.Point("idler_ball", (-0.14, -0.30, 0.265), "relay rod at the idler arm")
_AXIS = d.Direction("pitman_axis", (0.0, 0.0, 1.0), "axis of the Pitman arm")
_IDLER_AXIS = d.Direction("idler_axis", (0.0, 0.0, 1.0), "axis of the idler arm")
TURN = d.TurnPerTravel(
    "pitman_turn", 4.0, "angle of the Pitman arm for the way of its ball: one over its length"
)
MOTION = d.Motion(
    "rack",
    "m",
    "way of the ball of the Pitman arm along its circle",
    "velocity of the ball of the Pitman arm along its circle",
    "acceleration of the ball of the Pitman arm along its circle",
)
TURNED = "angle of the Pitman arm from design, about its axis"

_ARM = d.Body("pitman_arm", 0.0, (-0.265, 0.30, 0.265))
_RELAY = d.Body("relay_rod", 0.0, (-0.14, 0.0, 0.265))
_IDLER = d.Body("idler_arm", 0.0, (-0.265, -0.30, 0.265))

LINKAGE = (_ARM, _RELAY, _IDLER)
"""Bodies that both sides of an axle share, besides the rack."""


def steered_by_pitman_arm(corner: d.Formulation) -> d.Formulation:
    """Return the equations of a suspension with its tie rod joined to a relay rod.

    Those of `corner` have a prescribed rack.
    """
    (guide,) = corner.prescribed
    source, rack = corner.mechanism, guide.second
    chassis = guide.first
    joints = tuple(
        joint if joint == guide else replaced(joint, {rack: _RELAY}) for joint in source.joints
    )
    hinge = d.Revolute(
        "pitman_hinge",
        chassis,
        _ARM,
        axis=d.Line(_PIVOT, _AXIS),
        follows=d.Gear(guide, TURN),
    )
    linkage = (
        hinge,
        d.Revolute("idler_hinge", chassis, _IDLER, axis=d.Line(_IDLER_PIVOT, _IDLER_AXIS)),
        d.Universal(
            "relay_cross", _ARM, _RELAY, at=_BALL, shaft=d.Line(_BALL, _IDLER_BALL), first_axis=d.UP
        ),
        d.Spherical("relay_ball", _IDLER, _RELAY, at=_IDLER_BALL),
    )
    angle = hinge.angle("pitman_angle", TURNED)
    return replace(
        corner,
        name=f"{corner.name}_pitman_arm",
        title=corner.title.replace("rack prescribed", "Pitman arm prescribed"),
        mechanism=replace(
            source,
            name=f"{source.name}_pitman_arm",
            joints=(*joints, *linkage),
            coordinates=(*source.coordinates, angle),
        ),
        prescribed={guide: MOTION},
        cites={},
    )


_EVERY = {
    model.name: steered_by_pitman_arm(model)
    for page in (macpherson, double_wishbone, multi_link, push_rod, pull_rod)
    for model in page.MODELS
    if model.prescribed
}
_OFTEN = "double_wishbone_general"  # of the light truck that comes with the project

MODELS = (_EVERY[_OFTEN],)
SELDOM = tuple(model for name, model in _EVERY.items() if name != _OFTEN)
