"""A rigid axle whose wheels are steered by a Pitman arm, a drag link and a track rod.

The beam is that of a rigid axle on four rods. At each of its ends a knuckle turns about a kingpin
and carries a wheel. The drag link leads from the Pitman arm, on the chassis, to one knuckle, the
left one here, and the track rod from this knuckle to the other. With the pose of the beam and the
angle of the Pitman arm, the drag link turns the one knuckle, and then the track rod the other: two
transformers in closed form, each an arm that a rod holds, behind the loops of the four rods.

The input is the displacement of the ball of the Pitman arm along its circle, as of a Pitman arm
with a relay rod (`pitman_arm`). Pitman arm, drag link and track rod have no mass. The default
values are this project's own, those of `rigid_axle` where both have them: ISO 8855 axes, ground at
z = 0.
"""

from __future__ import annotations

from dataclasses import replace

from .. import declare as d
from . import rigid_axle as beam
from .pitman_arm import MOTION, TURN, TURNED
from .rigid_axle import BEAM, CHASSIS
from .suspension import (
    RACK_FORCE,
    own_values,
    rod_joints,
    spring_and_damper,
    tyre,
    with_damping_and_liftoff,
)

# -- a side, the right one ------------------------------------------------------------------------

_LOWER = d.Point("kingpin_lower", (0.012, -0.695, 0.27), "lower point of the kingpin's axis")
_UPPER = d.Point("kingpin_upper", (-0.005, -0.675, 0.47), "upper point of the kingpin's axis")
KNUCKLE = d.Body("knuckle", 18.0, (0.0, -0.72, 0.36), (0.35, 0.3, 0.3))
WHEEL = beam.WHEEL
KINGPIN = d.Revolute("kingpin", BEAM, KNUCKLE, axis=d.Line(_LOWER, _UPPER))
BEARING = replace(beam.BEARING, first=KNUCKLE)
_OF_A_SIDE = (
    *spring_and_damper(
        ((CHASSIS, beam.SPRING_TOP), (BEAM, beam.SPRING_SEAT)),
        ((CHASSIS, beam.DAMPER_TOP), (BEAM, beam.DAMPER_SEAT)),
        (beam.SPRING, beam.ACTUATOR, beam.DAMPER),
    ),
    with_damping_and_liftoff(
        tyre("axle", d.Wheel(KNUCKLE, beam.WHEEL_CENTER, beam.SPIN_AXIS), 0.382, rate=230000.0)
    ),
)
_SIDE = d.Mechanism(
    name="side",
    title="Half of a steered rigid axle",
    joints=(*beam.GUIDES, *beam.RODS, KINGPIN, BEARING),
    forces=(beam.WEIGHT, *_OF_A_SIDE),
    coordinates=(
        *beam.OF_THE_BEAM,
        BEARING.angle(
            "spin_angle", "wheel spin angle relative to the knuckle, positive rolling forward"
        ),
        KINGPIN.angle("steer_angle", "turn of the knuckle about its kingpin, positive toe-in"),
    ),
)
_OWN = own_values((BEARING, KINGPIN, _OF_A_SIDE), BEAM)
_RIGHT = d.Copy(_SIDE, "right_", shared=beam.SHARED)
_LEFT = d.Copy(_SIDE, "left_", mirrored=True, shared=beam.SHARED, own=_OWN)

# -- the steering ---------------------------------------------------------------------------------

_PIVOT = d.Point("pitman_pivot", (0.66, 0.64, 0.46), "bearing of the Pitman arm")
_BALL = d.Point("pitman_ball", (0.66, 0.44, 0.46), "drag link at the Pitman arm")
_ARM_END = d.Point("drag_link_knuckle", (0.0, 0.50, 0.46), "drag link at the knuckle")
_ENDS = {
    side: d.Point(f"track_rod_{side}", (-0.16, y, 0.31), f"track rod at the {side} knuckle")
    for side, y in (("left", 0.66), ("right", -0.66))
}
_RACK_AXIS = d.Direction("rack_axis", (1.0, 0.0, 0.0), "direction of the ball of the Pitman arm")
# upright: equations of a hinge with such a default have no singular direction
_AXIS = d.Direction("pitman_axis", (0.0, 0.0, 1.0), "axis of the Pitman arm")

RACK = d.Body("rack", 0.0, (0.66, 0.44, 0.46))
PITMAN_ARM = d.Body("pitman_arm", 0.0, (0.66, 0.54, 0.46))
DRAG_LINK = d.Body("drag_link", 0.0, (0.33, 0.47, 0.46))
TRACK_ROD = d.Body("track_rod", 0.0, (-0.16, 0.0, 0.31))

RACK_GUIDE = d.Prismatic("rack_guide", CHASSIS, RACK, direction=_RACK_AXIS)
PITMAN_HINGE = d.Revolute(
    "pitman_hinge",
    CHASSIS,
    PITMAN_ARM,
    axis=d.Line(_PIVOT, _AXIS),
    follows=d.Gear(RACK_GUIDE, TURN),
)


def _steered(near: d.Body, far: d.Body, sides: tuple[str, str]) -> tuple[d.Joint, ...]:
    """Return the joints of the steering, with the drag link at the first of two knuckles."""
    first, last = (_ENDS[side] for side in sides)
    return (
        RACK_GUIDE,
        PITMAN_HINGE,
        *rod_joints(DRAG_LINK, (PITMAN_ARM, _BALL), (near, _ARM_END)),
        *rod_joints(TRACK_ROD, (near, first), (far, last)),
    )


_BOTH = d.combined(
    "steered_rigid_axle",
    "Rigid axle on four rods, steered by a drag link",
    (_RIGHT, _LEFT),
    forces=(beam.BAR,),
)
_INPUT = (
    PITMAN_HINGE.angle("pitman_angle", TURNED),
    RACK_GUIDE.slide("rack_displacement", MOTION.position),
)
_KNUCKLES = {"right": _RIGHT.of(KNUCKLE), "left": _LEFT.of(KNUCKLE)}


def _axle(near: str, far: str, name: str, title: str) -> d.Formulation:
    """Return the axle with the drag link at the knuckle of one side, `near`."""
    steered = _steered(_KNUCKLES[near], _KNUCKLES[far], (near, far))
    mechanism = replace(
        _BOTH,
        name=name,
        title=title,
        joints=(*_BOTH.joints, *steered),
        forces=(*_BOTH.forces, d.JointForce(RACK_GUIDE, RACK_FORCE)),
        coordinates=(*_BOTH.coordinates, *_INPUT),
    )
    massive = ("knuckle", "wheel")
    return d.Formulation(
        name=name,
        title=f"{title}; Pitman arm prescribed",
        mechanism=mechanism,
        independent=(
            beam.HEAVE,
            beam.ROLL,
            mechanism.joint("right_bearing"),
            mechanism.joint("left_bearing"),
        ),
        prescribed={RACK_GUIDE: MOTION},
        massive=(
            BEAM,
            *(mechanism.body(f"{side}_{body}") for body in massive for side in _KNUCKLES),
        ),
        allow_iteration=True,
    )


MODELS = (_axle("left", "right", _BOTH.name, _BOTH.title),)
SELDOM = (
    _axle(
        "right",
        "left",
        f"{_BOTH.name}_right",
        "Rigid axle on four rods, steered by a drag link at the right knuckle",
    ),
)
