"""The MacPherson suspension of Góis & Sarzeto (IME, Rio de Janeiro, 2000): their Figure 1, Table 1.

Bodies and joints carry the paper's numbers and names. The paper gives no dimensions: the default
values are this project's reference car (front right, ISO 8855 axes, ground at z = 0).
"""

from __future__ import annotations

from ..declare.bodies import Body, Ground, Rotor
from ..declare.coordinates import RelativeCoordinate
from ..declare.forces import AlongLine, AlongTelescope, ForceElement, JointForce, LinearTyre, Weight
from ..declare.geometry import FORWARD, UP, Direction, Line, Point
from ..declare.inputs import Input
from ..declare.joints import Cylindrical, Prismatic, Revolute, Spherical, Universal
from ..declare.laws import Actuator, DamperTable, Friction, LinearDamper, LinearSpring, Stop
from ..declare.mechanism import Mechanism
from ..declare.model import Model
from ..declare.parameters import (
    DamperRate,
    Displacement,
    Distance,
    ForceLevel,
    Length,
    Progression,
    Share,
    Speed,
    SpringRate,
)
from .suspension import RACK_FORCE, RACK_MOTION, ROAD_HEIGHT, ROAD_VELOCITY

# -- points, directions and numbers ---------------------------------------------------------------

ARM_FRONT = Point("arm_front", (0.17, -0.35, 0.205), "front bush of the control arm")
ARM_REAR = Point("arm_rear", (-0.15, -0.35, 0.205), "rear bush of the control arm")
BALL_JOINT = Point("ball_joint", (0.005, -0.71, 0.18), "lower ball joint")
STRUT_TOP = Point("strut_top", (-0.028, -0.585, 0.82), "top mount of the strut")
ROD_OUTER = Point("tie_rod_outer", (-0.13, -0.69, 0.26), "tie rod at the knuckle")
ROD_INNER = Point("tie_rod_inner", (-0.14, -0.31, 0.28), "tie rod at the rack")
WHEEL_CENTER = Point("wheel_center", (0.0, -0.76, 0.3), "wheel centre")
RACK_AXIS = Direction("rack_axis", (0.0, 1.0, 0.0), "direction of the rack")
SPIN_AXIS = Direction("spin_axis", (0.0, 1.0, 0.0), "spin axis of the wheel, pointing left")

STRUT_LENGTH = Distance("strut_length_max", 0.85, "strut length |BC| at zero slide (p of Eq. 6)")
SPRING_RATE = SpringRate("spring_rate", 25000.0, "rate of the strut spring (k1)")
DAMPER = LinearDamper(rate=DamperRate("damper_rate", 1500.0, "rate of the strut damper (c)"))
TYRE_RATE = SpringRate("tyre_rate", 200000.0, "radial rate of the tyre (k2)")
TYRE_HEIGHT = Displacement(
    "tyre_free_height", 0.319, "height of the wheel centre at which the tyre is free of force (l20)"
)
WEIGHT = Weight()

# -- bodies and joints (Table 1) ------------------------------------------------------------------

CHASSIS = Ground("chassis", 1)
ARM = Body(
    "control_arm",
    5.0,
    ((0.17 - 0.15 + 0.005) / 3, (-0.35 - 0.35 - 0.71) / 3, 0.59 / 3),
    (0.06, 0.04, 0.09),
)
KNUCKLE = Body(
    "knuckle",
    15.0,
    (
        0.005 - 0.033 * 0.12 / 0.6529272547535444,
        -0.71 + 0.125 * 0.12 / 0.6529272547535444,
        0.18 + 0.64 * 0.12 / 0.6529272547535444,
    ),
    (0.2, 0.18, 0.08),
)
TIE_ROD = Body("tie_rod", 0.0, (-0.135, -0.5, 0.27))
RACK = Body("rack", 0.0, (-0.14, -0.31, 0.28))
STRUT = Body("upper_strut", 0.0, (-0.028, -0.585, 0.82))
WHEEL = Rotor("wheel", 22.0, WHEEL_CENTER, axis=SPIN_AXIS, spin=1.1, diametral=0.6)

OA = Revolute("OA", CHASSIS, ARM, axis=Line(ARM_REAR, ARM_FRONT), angle_to=BALL_JOINT)
B = Spherical("B", ARM, KNUCKLE, at=BALL_JOINT)
D = Spherical("D", KNUCKLE, TIE_ROD, at=ROD_OUTER)
E = Universal("E", RACK, TIE_ROD, at=ROD_INNER, shaft=Line(ROD_INNER, ROD_OUTER), first_axis=UP)
Y = Prismatic("y", CHASSIS, RACK, direction=RACK_AXIS)
HG = Revolute("HG", KNUCKLE, WHEEL, axis=Line(WHEEL_CENTER, SPIN_AXIS))

STRUT_FORCE = Input(
    "strut_force", "N", "actuator force in the strut, positive when it pushes its ends apart"
)


def strut(lower: Point) -> tuple[Cylindrical, Universal]:
    """Return telescope and top mount of a strut whose axis leads from a point to the top."""
    telescope = Cylindrical(
        "BC",
        STRUT,
        KNUCKLE,
        axis=Line(lower, STRUT_TOP),
        length_at_zero_slide=STRUT_LENGTH,
        angle_to=WHEEL_CENTER,
    )
    shaft = Line(STRUT_TOP, lower)
    return telescope, Universal("C", CHASSIS, STRUT, at=STRUT_TOP, shaft=shaft, first_axis=FORWARD)


def coordinates(bc: Cylindrical, c: Universal) -> tuple[RelativeCoordinate, ...]:
    """Return those of Figure 3.

    beta6 to beta9 are the second transformer's copies of what the first one gives it.
    """
    return (
        RelativeCoordinate(
            "beta1", OA, "arm angle from the chassis vertical (Eq. 6); falls as the wheel rises"
        ),
        RelativeCoordinate("beta2", bc, "strut slide, positive in compression", "slide"),
        RelativeCoordinate("beta3", c, "sin(beta3) = n_z, n from C to B (Eq. 7)", "elevation"),
        RelativeCoordinate(
            "beta4",
            c,
            "sin(beta4) cos(beta3) = -n_x, cos(beta4) cos(beta3) = n_y (Eq. 8)",
            "azimuth",
        ),
        RelativeCoordinate(
            "beta5", HG, "wheel spin angle relative to the knuckle, positive rolling forward"
        ),
        RelativeCoordinate("beta6", bc, "beta2 in the second transformer (Eq. 9)", "slide"),
        RelativeCoordinate("beta7", c, "beta3 in the second transformer (Eq. 10)", "elevation"),
        RelativeCoordinate("beta8", c, "beta4 in the second transformer (Eq. 11)", "azimuth"),
        RelativeCoordinate("beta9", Y, "rack displacement along its axis (Eq. 12)"),
        RelativeCoordinate(
            "beta10",
            bc,
            "rotation of the knuckle about BC, from the strut's z-x frame (Eq. 16)",
            "angle",
        ),
    )


TIE_ROD_COORDINATES = (
    RelativeCoordinate(
        "beta11", E, "elevation of the tie rod E to D, as beta3; not in the paper", "elevation"
    ),
    RelativeCoordinate(
        "beta12", E, "azimuth of the tie rod, as beta4; not in the paper", "azimuth"
    ),
)


def _tyre(**more: object) -> LinearTyre:
    return LinearTyre(
        name="front",
        carrier=KNUCKLE,
        center=WHEEL_CENTER,
        spin=SPIN_AXIS,
        rate=TYRE_RATE,
        free_height=TYRE_HEIGHT,
        road=ROAD_HEIGHT,
        **more,
    )


# -- the paper's suspension -----------------------------------------------------------------------

BC, C = strut(BALL_JOINT)
JOINTS = (OA, B, BC, C, D, E, Y, HG)
COORDINATES = coordinates(BC, C)
SPRING = LinearSpring(
    rate=SPRING_RATE,
    free_slide=Displacement(
        "spring_free_slide",
        0.05255401719941255,
        "strut slide at which the spring is free of force (l10)",
    ),
)
TYRE = _tyre()
FORCES = (
    WEIGHT,
    ForceElement("strut", AlongTelescope(BC), (SPRING, DAMPER, Actuator(input=STRUT_FORCE))),
    TYRE,
    JointForce(Y, RACK_FORCE),
)

# -- what cars have beyond it: see `general` ------------------------------------------------------

STRUT_LOWER = Point("strut_lower", (0.005, -0.71, 0.18), "lower end of the strut, on its axis")
SPRING_TOP = Point(
    "spring_top", (-0.028, -0.585, 0.82), "upper seat of the spring, on the chassis"
)
SPRING_SEAT = Point("spring_seat", (0.005, -0.71, 0.18), "lower seat of the spring, on the knuckle")
OFFSET_BC, OFFSET_C = strut(STRUT_LOWER)
SEATED_SPRING = LinearSpring(
    rate=SPRING_RATE,
    free_length=Length(
        "spring_free_length",
        0.85 - 0.05255401719941255,
        "distance of the spring's seats at which it is free of force",
    ),
)
DAMPER_TABLE = DamperTable(name="damper_table", segments=10)
FRICTION = Friction(
    level=ForceLevel("strut_friction", 0.0, "friction of the strut in full sliding"),
    speed=Speed("strut_friction_speed", 0.01, "velocity at which 71 % of the friction is reached"),
)
BUMP_STOP, REBOUND_STOP = (
    Stop(
        side=side,
        length=Length(
            f"{side}_stop_length", touched, f"strut length at which the {side} stop is touched"
        ),
        rate=SpringRate(f"{side}_stop_rate", 0.0, f"rate of the {side} stop at first touch"),
        progression=Progression(
            f"{side}_stop_progression", 0.0, f"cubic term of the {side} stop"
        ),
    )
    for side, touched in (("bump", 0.0), ("rebound", 0.85))
)
GENERAL_FORCES = (
    WEIGHT,
    ForceElement(
        "spring", AlongLine((CHASSIS, SPRING_TOP), (KNUCKLE, SPRING_SEAT)), (SEATED_SPRING,)
    ),
    ForceElement(
        "strut",
        AlongTelescope(OFFSET_BC),
        (DAMPER, DAMPER_TABLE, FRICTION, BUMP_STOP, REBOUND_STOP, Actuator(input=STRUT_FORCE)),
    ),
    _tyre(
        damper=DamperRate("tyre_damper_rate", 0.0, "radial damping of the tyre"),
        road_velocity=ROAD_VELOCITY,
        lifts_off=Share(
            "tyre_lifts_off", 0.0, "1: the tyre can leave the road; 0: it holds on to it"
        ),
    ),
    JointForce(Y, RACK_FORCE),
)


def mechanism(*, free_rack: bool = False) -> Mechanism:
    """Return the suspension; with a free rack, the tie rod's angles are reported as well."""
    return Mechanism(
        name="macpherson",
        title="MacPherson suspension (Góis & Sarzeto, 2000)",
        joints=JOINTS,
        forces=FORCES,
        coordinates=COORDINATES + (TIE_ROD_COORDINATES if free_rack else ()),
    )


def general(*, free_rack: bool = False) -> Mechanism:
    """Return the suspension as it is on cars.

    The strut's axis may miss the ball joint, the spring has seats of its own, the damper a curve,
    the strut friction and stops, and the tyre damps and lifts off. With the defaults of all these
    it is the paper's suspension, at a higher price.
    """
    own = coordinates(OFFSET_BC, OFFSET_C)
    return Mechanism(
        name="macpherson_general",
        title="MacPherson suspension with an offset strut",
        joints=(OA, B, OFFSET_BC, OFFSET_C, D, E, Y, HG),
        forces=GENERAL_FORCES,
        coordinates=own + (TIE_ROD_COORDINATES if free_rack else ()),
    )


MOVED = (ARM, KNUCKLE, WHEEL)
EVERY = (ARM, KNUCKLE, TIE_ROD, RACK, STRUT, WHEEL)

MODELS = (
    Model(
        name="macpherson",
        title="MacPherson suspension, rack prescribed: arm, knuckle and wheel carry mass",
        mechanism=mechanism(),
        independent=(OA, HG),
        prescribed={Y: RACK_MOTION},
        massive=MOVED,
        held={"rack_held": (Y,)},
    ),
    Model(
        name="macpherson_free_rack",
        title="MacPherson suspension, rack free: every moving body carries mass",
        mechanism=mechanism(free_rack=True),
        independent=(OA, HG, Y),
        massive=EVERY,
    ),
    Model(
        name="macpherson_general",
        title="MacPherson suspension with an offset strut, spring seats, stops; rack prescribed",
        mechanism=general(),
        independent=(OA, HG),
        prescribed={Y: RACK_MOTION},
        massive=MOVED,
        held={"rack_held": (Y,)},
    ),
)

# Seldom wanted, and as long as all others together: `kintrafo.Model` compiles it when it is needed.
GENERAL_FREE_RACK = Model(
    name="macpherson_general_free_rack",
    title="MacPherson suspension with an offset strut, spring seats, stops; rack free",
    mechanism=general(free_rack=True),
    independent=(OA, HG, Y),
    massive=EVERY,
)
