"""The MacPherson suspension of Góis & Sarzeto (IME, Rio de Janeiro, 2000): their Figure 1, Table 1.

Bodies and joints carry the paper's numbers and names. The paper gives no dimensions: the default
values are this project's reference car (front right, ISO 8855 axes, ground at z = 0).
"""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING

from .. import declare as d
from .suspension import (
    RACK_FORCE,
    RACK_MOTION,
    ROAD_HEIGHT,
    further_laws,
    spring_table,
    with_damping_and_liftoff,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

# -- points, directions and numbers ---------------------------------------------------------------

ARM_FRONT = d.Point("arm_front", (0.17, -0.35, 0.205), "front bush of the control arm")
ARM_REAR = d.Point("arm_rear", (-0.15, -0.35, 0.205), "rear bush of the control arm")
BALL_JOINT = d.Point("ball_joint", (0.005, -0.71, 0.18), "lower ball joint")
STRUT_TOP = d.Point("strut_top", (-0.028, -0.585, 0.82), "top mount of the strut")
ROD_OUTER = d.Point("tie_rod_outer", (-0.13, -0.69, 0.26), "tie rod at the knuckle")
ROD_INNER = d.Point("tie_rod_inner", (-0.14, -0.31, 0.28), "tie rod at the rack")
WHEEL_CENTER = d.Point("wheel_center", (0.0, -0.76, 0.3), "wheel centre")
RACK_AXIS = d.Direction("rack_axis", (0.0, 1.0, 0.0), "direction of the rack")
SPIN_AXIS = d.Direction("spin_axis", (0.0, 1.0, 0.0), "spin axis of the wheel, pointing left")

STRUT_LENGTH = d.Distance("strut_length_max", 0.85, "strut length |BC| at zero slide (p of Eq. 6)")
SPRING_RATE = d.SpringRate("spring_rate", 25000.0, "rate of the strut spring (k1)")
DAMPER = d.LinearDamper(d.DamperRate("damper_rate", 1500.0, "rate of the strut damper (c)"))
TYRE_RATE = d.SpringRate("tyre_rate", 200000.0, "radial rate of the tyre (k2)")
TYRE_HEIGHT = d.Displacement(
    "tyre_free_height", 0.319, "height of the wheel centre at which the tyre is free of force (l20)"
)
WEIGHT = d.Weight()
_FREE_SLIDE = 0.05255401719941255  # [m]

# -- bodies and joints (Table 1) ------------------------------------------------------------------

CHASSIS = d.Ground("chassis", 1)
_ARM_COM = ((0.17 - 0.15 + 0.005) / 3, (-0.35 - 0.35 - 0.71) / 3, 0.59 / 3)
ARM = d.Body("control_arm", 5.0, _ARM_COM, (0.06, 0.04, 0.09))
_BC = 0.6529272547535444  # [m]; the knuckle's centre is 0.12 m from B on the way to C
_KNUCKLE_COM = (0.005 - 0.033 * 0.12 / _BC, -0.71 + 0.125 * 0.12 / _BC, 0.18 + 0.64 * 0.12 / _BC)
KNUCKLE = d.Body("knuckle", 15.0, _KNUCKLE_COM, (0.2, 0.18, 0.08))
TIE_ROD = d.Body("tie_rod", 0.0, (-0.135, -0.5, 0.27))
RACK = d.Body("rack", 0.0, (-0.14, -0.31, 0.28))
STRUT = d.Body("upper_strut", 0.0, (-0.028, -0.585, 0.82))
WHEEL = d.Rotor("wheel", 22.0, WHEEL_CENTER, axis=SPIN_AXIS, spin=1.1, diametral=0.6)

OA = d.Revolute("OA", CHASSIS, ARM, axis=d.Line(ARM_REAR, ARM_FRONT), angle_to=BALL_JOINT)
B = d.Spherical("B", ARM, KNUCKLE, at=BALL_JOINT)
D = d.Spherical("D", KNUCKLE, TIE_ROD, at=ROD_OUTER)
E = d.Universal(
    "E", RACK, TIE_ROD, at=ROD_INNER, shaft=d.Line(ROD_INNER, ROD_OUTER), first_axis=d.UP
)
Y = d.Prismatic("y", CHASSIS, RACK, direction=RACK_AXIS)
HG = d.Revolute("HG", KNUCKLE, WHEEL, axis=d.Line(WHEEL_CENTER, SPIN_AXIS))

STRUT_FORCE = d.Input(
    "strut_force", "N", "actuator force in the strut, positive when it pushes its ends apart"
)


def strut(lower: d.Point) -> tuple[d.Cylindrical, d.Universal]:
    """Return telescope and top mount of a strut whose axis leads from a point to the top."""
    axis, shaft = d.Line(lower, STRUT_TOP), d.Line(STRUT_TOP, lower)
    telescope = d.Cylindrical("BC", STRUT, KNUCKLE, axis, STRUT_LENGTH, angle_to=WHEEL_CENTER)
    return telescope, d.Universal("C", CHASSIS, STRUT, at=STRUT_TOP, shaft=shaft)


def coordinates(bc: d.Cylindrical, c: d.Universal) -> tuple[d.RelativeCoordinate, ...]:
    """Return the coordinates of Figure 3.

    beta6 to beta9 are the second transformer's copies of coordinates from the first one.
    """
    return (
        OA.angle("beta1", "arm angle from the chassis vertical (Eq. 6); falls as the wheel rises"),
        bc.slide("beta2", "strut slide, positive in compression"),
        c.elevation("beta3", "sin(beta3) = n_z, n from C to B (Eq. 7)"),
        c.azimuth("beta4", "sin(beta4) cos(beta3) = -n_x, cos(beta4) cos(beta3) = n_y (Eq. 8)"),
        HG.angle("beta5", "wheel spin angle relative to the knuckle, positive rolling forward"),
        bc.slide("beta6", "beta2 in the second transformer (Eq. 9)"),
        c.elevation("beta7", "beta3 in the second transformer (Eq. 10)"),
        c.azimuth("beta8", "beta4 in the second transformer (Eq. 11)"),
        Y.slide("beta9", "rack displacement along its axis (Eq. 12)"),
        bc.angle("beta10", "rotation of the knuckle about BC, from the strut's z-x frame (Eq. 16)"),
    )


TIE_ROD_COORDINATES = (
    E.elevation("beta11", "elevation of the tie rod E to D, as beta3; not in the paper"),
    E.azimuth("beta12", "azimuth of the tie rod, as beta4; not in the paper"),
)


# -- the paper's suspension -----------------------------------------------------------------------

BC, C = strut(BALL_JOINT)
SPRING = d.LinearSpring(
    rate=SPRING_RATE,
    free_slide=d.Displacement(
        "spring_free_slide", _FREE_SLIDE, "strut slide at which the spring is free of force (l10)"
    ),
)
TYRE = d.LinearTyre(
    name="front",
    wheel=d.Wheel(KNUCKLE, WHEEL_CENTER, SPIN_AXIS),
    rate=TYRE_RATE,
    free_height=TYRE_HEIGHT,
    road=ROAD_HEIGHT,
)
FORCES = (
    WEIGHT,
    d.ForceElement(
        "strut", d.AlongTelescope(BC, STRUT_LENGTH), (SPRING, DAMPER, d.Actuator(STRUT_FORCE))
    ),
    TYRE,
    d.JointForce(Y, RACK_FORCE),
)

# -- further elements of cars: see `general` ------------------------------------------------------

STRUT_LOWER = d.Point("strut_lower", (0.005, -0.71, 0.18), "lower end of the strut, on its axis")
SPRING_TOP = d.Point(
    "spring_top", (-0.028, -0.585, 0.82), "upper seat of the spring, on the chassis"
)
SPRING_SEAT = d.Point(
    "spring_seat", (0.005, -0.71, 0.18), "lower seat of the spring, on the knuckle"
)
OFFSET_BC, OFFSET_C = strut(STRUT_LOWER)
SEATED_SPRING = d.LinearSpring(
    rate=SPRING_RATE,
    free_length=d.Length(
        "spring_free_length",
        0.85 - _FREE_SLIDE,
        "distance of the spring's seats at which it is free of force",
    ),
)
GENERAL_FORCES = (
    WEIGHT,
    d.ForceElement(
        "spring",
        d.AlongLine((CHASSIS, SPRING_TOP), (KNUCKLE, SPRING_SEAT)),
        (SEATED_SPRING, spring_table()),
    ),
    d.ForceElement(
        "strut",
        d.AlongTelescope(OFFSET_BC, STRUT_LENGTH),
        (DAMPER, *further_laws("strut", 0.85), d.Actuator(STRUT_FORCE)),
    ),
    with_damping_and_liftoff(TYRE),
    d.JointForce(Y, RACK_FORCE),
)


def mechanism(*, free_rack: bool = False) -> d.Mechanism:
    """Return the suspension; with a free rack, the tie rod's angles are reported, too."""
    return d.Mechanism(
        name="macpherson",
        title="MacPherson suspension (Góis & Sarzeto, 2000)",
        joints=(OA, B, BC, C, D, E, Y, HG),
        forces=FORCES,
        coordinates=coordinates(BC, C) + (TIE_ROD_COORDINATES if free_rack else ()),
    )


def general(*, free_rack: bool = False) -> d.Mechanism:
    """Return the suspension with further elements of cars.

    The strut's axis may miss the ball joint, the spring has seats of its own, the damper a curve,
    the strut friction and stops, and the tyre damps and lifts off. With the defaults of all these
    it is the paper's suspension, at a higher price.
    """
    own = coordinates(OFFSET_BC, OFFSET_C)
    return d.Mechanism(
        name="macpherson_general",
        title="MacPherson suspension with an offset strut",
        joints=(OA, B, OFFSET_BC, OFFSET_C, D, E, Y, HG),
        forces=GENERAL_FORCES,
        coordinates=own + (TIE_ROD_COORDINATES if free_rack else ()),
    )


# places in the paper of the results of functions, the motion of bodies, and forces
EQUATIONS_OF_THE_PAPER = {
    "relative_coordinates": "Figure 3",
    "residuals": "Eqs. 4 to 13",
    "dynamics": "Eq. 3",
    "mass_matrix": "Eq. 3",
    "bias": "Eq. 3",
    "forces": "Eq. 3",
    "position of knuckle": "Eq. 17",
    "position of wheel": "Eq. 18",
    "position of control_arm": "Eq. 19",
    "omega of knuckle": "Eq. 20",
    "omega of wheel": "Eq. 21",
    "omega of control_arm": "Eq. 22",
    "strut": "Eq. 23",
    "front": "Eq. 24",
}


def _steered(
    name: str, title: str, declared: d.Mechanism, cites: Mapping[str, str] = MappingProxyType({})
) -> d.Formulation:
    """Return the equations with a prescribed rack: arm, knuckle and wheel carry mass."""
    massive, held = (ARM, KNUCKLE, WHEEL), {"rack_held": (Y,)}
    return d.Formulation(
        name, title, declared, (OA, HG), massive, {Y: RACK_MOTION}, held, cites=dict(cites)
    )


MODELS = (
    _steered(
        "macpherson",
        "MacPherson suspension, rack prescribed: arm, knuckle and wheel carry mass",
        mechanism(),
        EQUATIONS_OF_THE_PAPER,
    ),
    d.Formulation(
        "macpherson_free_rack",
        "MacPherson suspension, rack free: every moving body carries mass",
        mechanism(free_rack=True),
        independent=(OA, HG, Y),
    ),
    _steered(
        "macpherson_general",
        "MacPherson suspension with an offset strut, spring seats, stops; rack prescribed",
        general(),
    ),
)

# Seldom needed, and as long as all others together: `kintrafo.Model` compiles it on demand.
GENERAL_FREE_RACK = d.Formulation(
    "macpherson_general_free_rack",
    "MacPherson suspension with an offset strut, spring seats, stops; rack free",
    general(free_rack=True),
    independent=(OA, HG, Y),
)
SELDOM = (GENERAL_FREE_RACK,)
