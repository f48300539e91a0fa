"""A compliant steering column between the steering wheel and the rack of an axle.

The rack of the axle is a degree of freedom. The pinion turns with it, and the steering wheel with a
second rack that has no mass and whose motion is prescribed: the rack of a rigid column. Spring and
damper of the column act on the twist between both. Friction acts along the guide of the rack.

The pinion turns about the upward axis of the body, to the left for a positive displacement of the
rack. Its inertia reaches the rack by the gear; its reaction on the body is that of this axis. The
real axis is not known, nor is its sense: both change the torque of the steering wheel by twice the
inertia times the yaw acceleration, some 0.01 N m.
"""

from __future__ import annotations

from dataclasses import replace

from .. import declare as d

_CENTER = d.Point("pinion_center", (0.0, 0.0, 0.0), "centre of the pinion")
_TURN = d.TurnPerTravel("pinion_turn", 125.0, "angle of the pinion for a displacement of the rack")
_LAWS = (
    d.LinearSpring(
        rate=d.TorsionRate("column_rate", 1000.0, "torsional rate of the steering column"),
        free_length=d.Angle("column_free_twist", 0.0, "twist of the steering column without load"),
    ),
    d.LinearDamper(
        d.TorsionDamperRate("column_damper_rate", 0.0, "damping of the twist of the column")
    ),
)
_FRICTION = d.Friction(
    level=d.ForceLevel("rack_friction", 0.0, "friction of the rack in full sliding"),
    speed=d.Speed(
        "rack_friction_speed", 0.005, "velocity of the rack at which 71 % of the friction acts"
    ),
)
_PINION = d.Rotor("pinion", 0.0, _CENTER, axis=d.UP, spin=0.0, diametral=0.0)


def on_a_column(axle: d.Formulation) -> d.Formulation:
    """Return an axle whose prescribed rack, or Pitman arm, is moved by a compliant column."""
    ((guide, motion),) = axle.prescribed.items()
    assert isinstance(guide, d.Prismatic)
    mechanism, chassis = axle.mechanism, guide.first
    column = d.Body("column", 0.0, (0.0, 0.0, 0.0))
    rigid = d.Body("rack_of_rigid_column", 0.0, (0.0, 0.0, 0.0))
    moved = d.Prismatic("wheel_guide", chassis, rigid, direction=guide.direction)
    line = d.Line(_CENTER, d.UP)
    wheel, pinion = (
        d.Revolute(f"{body.name}_hinge", chassis, body, axis=line, follows=d.Gear(of, _TURN))
        for body, of in ((column, moved), (_PINION, guide))
    )
    return replace(
        axle,
        mechanism=replace(
            mechanism,
            joints=(*mechanism.joints, moved, wheel, pinion),
            forces=(
                *mechanism.forces,
                d.ForceElement("column", d.TwistOfHinges(wheel, pinion), _LAWS),
                d.ForceElement("rack", d.AlongGuide(guide), (_FRICTION,)),
            ),
            coordinates=(
                *mechanism.coordinates,
                moved.slide("rigid_rack_displacement", "displacement of a rack on a rigid column"),
            ),
        ),
        independent=(*axle.independent, guide),
        prescribed={moved: motion},
        massive=(*axle.massive, _PINION),
        held={},
    )
