"""Two trailing arms with a beam between them that twists: a twist-beam axle.

The beam is stiff in bending and soft in torsion, and its section is open, so that it twists about
the line through its shear centre. In parallel travel both arms turn about the line of their pivots
(*lift*). As they move oppositely, the shear centre in the middle of the beam stays where it is by
symmetry, and each arm turns about the line from its pivot to that point (*twist*): like a
semi-trailing arm, whose hinge points there (J. Reimpell, H. Stoll, J. W. Betzler, The Automotive
Chassis, 2nd ed., 2001, on the compound crank suspension; D. Lee, C. Yang, Finite Elements in
Analysis and Design 63 (2013) 98-106). Both together are the two coordinates, without a loop to
close: a frame turns on the pivots and carries both pivots and the shear centre, and in it the arms
turn by opposite angles. So the halves of the beam have one point in common, and at every instant
turn against each other about the direction of the pivots, which twists the beam; its resistance is
a torsion spring.

The bending of beam and arms is left out, and so is the lengthening of a beam that is twisted by
large angles. A half of the beam belongs to each arm. The default values are this project's own: the
rear axle of a compact car, ISO 8855 axes, ground at z = 0.
"""

from __future__ import annotations

from dataclasses import replace

from .. import declare as d
from ..program.vectors import UNIT_Y
from .suspension import (
    actuator,
    damper,
    own_values,
    spring,
    spring_and_damper,
    tyre,
    with_damping_and_liftoff,
)

PIVOT = d.Point("pivot", (0.42, -0.56, 0.315), "pivot of the arm on the chassis")
SHEAR_CENTER = d.Point("shear_center", (0.22, 0.0, 0.345), "shear centre of the beam, its middle")
WHEEL_CENTER = d.Point("wheel_center", (0.0, -0.75, 0.30), "wheel centre")
SPIN_AXIS = d.Direction("spin_axis", (0.0, 1.0, 0.0), "spin axis of the wheel, pointing left")
SPRING_TOP = d.Point("spring_top", (0.10, -0.50, 0.50), "upper seat of the spring, on the chassis")
SPRING_SEAT = d.Point("spring_seat", (0.08, -0.50, 0.26), "lower seat of the spring, on the arm")
DAMPER_TOP = d.Point("damper_top", (-0.02, -0.57, 0.66), "upper end of the damper, on the chassis")
DAMPER_SEAT = d.Point("damper_seat", (-0.06, -0.60, 0.24), "lower end of the damper, on the arm")
LEFTWARD = d.Direction("leftward", fixed=UNIT_Y)

CHASSIS = d.Ground("chassis", 1)
FRAME = d.Body("lift_frame", 0.0, SHEAR_CENTER)
ARM = d.Body("arm", 15.0, (0.14, -0.46, 0.30), (0.9, 0.35, 1.2))
WHEEL = d.Rotor("wheel", 19.0, WHEEL_CENTER, axis=SPIN_AXIS, spin=0.85, diametral=0.46)

LIFT = d.Revolute("lift_hinge", CHASSIS, FRAME, axis=d.Line(PIVOT, LEFTWARD))
TURN = d.Revolute("arm_hinge", FRAME, ARM, axis=d.Line(SHEAR_CENTER, PIVOT))
BEARING = d.Revolute("bearing", ARM, WHEEL, axis=d.Line(WHEEL_CENTER, SPIN_AXIS))

SPRING = spring(42000.0, 0.33)
DAMPER = damper(1500.0)
ACTUATOR = actuator()
TYRE = tyre("axle", d.Wheel(ARM, WHEEL_CENTER, SPIN_AXIS), 0.315, rate=210000.0)
OF_A_SIDE = (
    *spring_and_damper(
        ((CHASSIS, SPRING_TOP), (ARM, SPRING_SEAT)),
        ((CHASSIS, DAMPER_TOP), (ARM, DAMPER_SEAT)),
        (SPRING, ACTUATOR, DAMPER),
    ),
    with_damping_and_liftoff(TYRE),
)

_SIDE = d.Mechanism(
    name="side",
    title="Half of a twist-beam axle",
    joints=(LIFT, TURN, BEARING),
    forces=(d.Weight(), *OF_A_SIDE),
    coordinates=(
        LIFT.angle("lift", "angle of both arms about the line of the pivots, positive wheels up"),
        BEARING.angle(
            "spin_angle", "wheel spin angle relative to the arm, positive rolling forward"
        ),
    ),
)
_OWN = own_values((BEARING, OF_A_SIDE), ARM)
_RIGHT = d.Copy(_SIDE, "right_", shared=(FRAME,))
_LEFT = d.Copy(_SIDE, "left_", mirrored=True, shared=(FRAME,), own=_OWN)
_DRIVING, _LED = _RIGHT.of(TURN), _LEFT.of(TURN)
_OPPOSITE = d.Ratio("opposite", -1.0, "turn of the left arm by that of the right one")
_GEARED = replace(_LED, follows=d.Gear(_DRIVING, _OPPOSITE))
BEAM = d.ForceElement(
    "beam",
    d.AlongHinge(_DRIVING),
    (
        d.LinearSpring(
            rate=d.TorsionRate("beam_rate", 0.0, "rate of the beam, by the turn of an arm"),
            free_length=d.Angle("beam_free_angle", 0.0, "turn at which the beam is free"),
        ),
    ),
)
_BOTH = d.combined(
    "twist_beam",
    "Twist-beam axle",
    (_RIGHT, _LEFT),
    forces=(BEAM,),
    coordinates=(
        _DRIVING.angle(
            "twist",
            "angle of the arms about their lines to the shear centre, positive left wheel up",
        ),
    ),
)
TWIST_BEAM = replace(
    _BOTH, joints=tuple(_GEARED if joint == _LED else joint for joint in _BOTH.joints)
)

MODELS = (
    d.Formulation(
        name="twist_beam",
        title="Twist-beam axle",
        mechanism=TWIST_BEAM,
        independent=(
            LIFT,
            _DRIVING,
            TWIST_BEAM.joint("right_bearing"),
            TWIST_BEAM.joint("left_bearing"),
        ),
        massive=tuple(
            TWIST_BEAM.body(f"{side}_{name}")
            for name in ("arm", "wheel")
            for side in ("right", "left")
        ),
    ),
)
