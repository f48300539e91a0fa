"""The MacPherson suspension of Góis & Sarzeto (IME, Rio de Janeiro, 2000): their Figure 1, Table 1.

Bodies and joints carry the paper's numbers and names. The paper gives no dimensions: the default
values are this project's reference car (front right, ISO 8855 axes, ground at z = 0).
"""

from __future__ import annotations

from ..declare.assembly import Body, Parameter, RelativeCoordinate
from ..declare.forces.force_element import ForceElement
from ..declare.forces.joint_force import JointForce
from ..declare.forces.linear_tyre import LinearTyre
from ..declare.forces.weight import Weight
from ..declare.geometry import FORWARD, UP, Direction, Line, Point
from ..declare.inputs import Input
from ..declare.joints import Cylindrical, Joint, Prismatic, Revolute, Spherical, Universal
from ..declare.laws import Actuator, LinearDamper, LinearSpring
from ..declare.mechanism import Mechanism
from ..declare.model import Model
from ..declare.parameters import direction, point, rigid_body, rotor
from ..declare.paths import AlongLine, AlongTelescope
from ..declare.wheel import Wheel
from .suspension import INPUTS as SUSPENSION_INPUTS
from .suspension import further_laws, further_parameters

A = Point("arm_front")
O = Point("arm_rear")
B = Point("ball_joint")
C = Point("strut_top")
D = Point("tie_rod_outer")
E = Point("tie_rod_inner")
G = Point("wheel_center")
STRUT_LOWER = Point("strut_lower")
SPRING_TOP = Point("spring_top")
SPRING_SEAT = Point("spring_seat")
RACK = Direction("rack_axis")
SPIN = Direction("spin_axis")

BODIES = (
    Body("chassis", 1, center=C),
    Body("control_arm", 2, center=Point("control_arm_com")),
    Body("knuckle", 3, center=Point("knuckle_com")),
    Body("tie_rod", 4, center=Point("tie_rod_com")),
    Body("rack", 5, center=Point("rack_com")),
    Body("upper_strut", 6, center=Point("upper_strut_com")),
    Body("wheel", 7, center=G, rotor_axis=SPIN),
)


def _joints(axis: Line) -> tuple[Joint, ...]:
    """Return the joints of Table 1 for an axis of the strut, from its lower to its upper end."""
    return (
        Revolute(name="OA", first="chassis", second="control_arm", axis=Line(O, A), angle_to=B),
        Spherical(name="B", first="control_arm", second="knuckle", at=B),
        Cylindrical(
            name="BC",
            first="upper_strut",
            second="knuckle",
            axis=axis,
            length_at_zero_slide="strut_length_max",
            angle_to=G,
        ),
        Universal(
            name="C",
            first="chassis",
            second="upper_strut",
            at=C,
            shaft=Line(C, axis.through),
            first_axis=FORWARD,
        ),
        Spherical(name="D", first="knuckle", second="tie_rod", at=D),
        Universal(name="E", first="rack", second="tie_rod", at=E, shaft=Line(E, D), first_axis=UP),
        Prismatic(name="y", first="chassis", second="rack", direction=RACK),
        Revolute(name="HG", first="knuckle", second="wheel", axis=Line(G, SPIN)),
    )


# Figure 3; beta6 to beta9 are the second transformer's copies of what the first one gives it
COORDINATES = (
    RelativeCoordinate(
        "beta1",
        "OA",
        "angle",
        "rad",
        "arm angle from the chassis vertical (Eq. 6); falls as the wheel rises",
    ),
    RelativeCoordinate("beta2", "BC", "slide", "m", "strut slide, positive in compression"),
    RelativeCoordinate("beta3", "C", "elevation", "rad", "sin(beta3) = n_z, n from C to B (Eq. 7)"),
    RelativeCoordinate(
        "beta4",
        "C",
        "azimuth",
        "rad",
        "sin(beta4) cos(beta3) = -n_x, cos(beta4) cos(beta3) = n_y (Eq. 8)",
    ),
    RelativeCoordinate(
        "beta5",
        "HG",
        "angle",
        "rad",
        "wheel spin angle relative to the knuckle, positive rolling forward",
    ),
    RelativeCoordinate("beta6", "BC", "slide", "m", "beta2 in the second transformer (Eq. 9)"),
    RelativeCoordinate(
        "beta7", "C", "elevation", "rad", "beta3 in the second transformer (Eq. 10)"
    ),
    RelativeCoordinate("beta8", "C", "azimuth", "rad", "beta4 in the second transformer (Eq. 11)"),
    RelativeCoordinate("beta9", "y", "slide", "m", "rack displacement along its axis (Eq. 12)"),
    RelativeCoordinate(
        "beta10",
        "BC",
        "angle",
        "rad",
        "rotation of the knuckle about BC, from the strut's z-x frame (Eq. 16)",
    ),
)
TIE_ROD_COORDINATES = (
    RelativeCoordinate(
        "beta11",
        "E",
        "elevation",
        "rad",
        "elevation of the tie rod E to D, as beta3; not in the paper",
    ),
    RelativeCoordinate(
        "beta12", "E", "azimuth", "rad", "azimuth of the tie rod, as beta4; not in the paper"
    ),
)

FORCES = (
    Weight(gravity="gravity"),
    ForceElement(
        name="strut",
        path=AlongTelescope("BC"),
        laws=(
            LinearSpring(rate="spring_rate", free_slide="spring_free_slide"),
            LinearDamper(rate="damper_rate"),
            Actuator(input="strut_force"),
        ),
    ),
    LinearTyre(
        name="front",
        wheel=Wheel("knuckle", G, SPIN),
        rate="tyre_rate",
        free_height="tyre_free_height",
        road="road_height",
    ),
    JointForce(joint="y", input="rack_force"),
)

# What cars have beyond the paper: see `general`.
GENERAL_FORCES = (
    Weight(gravity="gravity"),
    ForceElement(
        name="spring",
        path=AlongLine(("chassis", SPRING_TOP), ("knuckle", SPRING_SEAT)),
        laws=(LinearSpring(rate="spring_rate", free_length="spring_free_length"),),
    ),
    ForceElement(
        name="strut",
        path=AlongTelescope("BC"),
        laws=(
            LinearDamper(rate="damper_rate"),
            *further_laws("strut"),
            Actuator(input="strut_force"),
        ),
    ),
    LinearTyre(
        name="front",
        wheel=Wheel("knuckle", G, SPIN),
        rate="tyre_rate",
        free_height="tyre_free_height",
        road="road_height",
        damper="tyre_damper_rate",
        lifts_off="tyre_lifts_off",
    ),
    JointForce(joint="y", input="rack_force"),
)

INPUTS = (
    *SUSPENSION_INPUTS,
    Input(
        "strut_force", "N", "actuator force in the strut, positive when it pushes its ends apart"
    ),
)


_COMMON_PARAMETERS = (
    *point("arm_front", (0.17, -0.35, 0.205), "front bush of the control arm"),
    *point("arm_rear", (-0.15, -0.35, 0.205), "rear bush of the control arm"),
    *point("ball_joint", (0.005, -0.71, 0.18), "lower ball joint"),
    *point("strut_top", (-0.028, -0.585, 0.82), "top mount of the strut"),
    *point("tie_rod_outer", (-0.13, -0.69, 0.26), "tie rod at the knuckle"),
    *point("tie_rod_inner", (-0.14, -0.31, 0.28), "tie rod at the rack"),
    *point("wheel_center", (0.0, -0.76, 0.3), "wheel centre"),
    *direction("rack_axis", (0.0, 1.0, 0.0), "direction of the rack"),
    *direction("spin_axis", (0.0, 1.0, 0.0), "spin axis of the wheel, pointing left"),
    Parameter("strut_length_max", 0.85, "m", "strut length |BC| at zero slide (p of Eq. 6)"),
    Parameter("spring_rate", 25000.0, "N/m", "rate of the strut spring (k1)"),
    Parameter("damper_rate", 1500.0, "N s/m", "rate of the strut damper (c)"),
    Parameter("tyre_rate", 200000.0, "N/m", "radial rate of the tyre (k2)"),
    Parameter(
        "tyre_free_height",
        0.319,
        "m",
        "height of the wheel centre at which the tyre is free of force (l20)",
    ),
    Parameter("gravity", 9.81, "m/s^2", "acceleration of gravity"),
    *rigid_body(
        "control_arm",
        5.0,
        ((0.17 - 0.15 + 0.005) / 3, (-0.35 - 0.35 - 0.71) / 3, 0.59 / 3),
        (0.06, 0.04, 0.09),
    ),
    *rigid_body(
        "knuckle",
        15.0,
        (
            0.005 - 0.033 * 0.12 / 0.6529272547535444,
            -0.71 + 0.125 * 0.12 / 0.6529272547535444,
            0.18 + 0.64 * 0.12 / 0.6529272547535444,
        ),
        (0.2, 0.18, 0.08),
    ),
    *rigid_body("tie_rod", 0.0, (-0.135, -0.5, 0.27)),
    *rigid_body("rack", 0.0, (-0.14, -0.31, 0.28)),
    *rigid_body("upper_strut", 0.0, (-0.028, -0.585, 0.82)),
    *rotor("wheel", 22.0, 1.1, 0.6),
)
PARAMETERS = (
    *_COMMON_PARAMETERS,
    Parameter(
        "spring_free_slide",
        0.05255401719941255,
        "m",
        "strut slide at which the spring is free of force (l10)",
    ),
)
GENERAL_PARAMETERS = (
    *_COMMON_PARAMETERS,
    *point("strut_lower", (0.005, -0.71, 0.18), "lower end of the strut, on its axis"),
    *point("spring_top", (-0.028, -0.585, 0.82), "upper seat of the spring, on the chassis"),
    *point("spring_seat", (0.005, -0.71, 0.18), "lower seat of the spring, on the knuckle"),
    Parameter(
        "spring_free_length",
        0.85 - 0.05255401719941255,
        "m",
        "distance of the spring's seats at which it is free of force",
    ),
    *further_parameters("strut", 0.85),
)


def mechanism(*, free_rack: bool = False) -> Mechanism:
    """Return the suspension; with a free rack, the tie rod's angles are reported as well."""
    return Mechanism(
        name="macpherson",
        fixed="chassis",
        title="MacPherson suspension (Góis & Sarzeto, 2000)",
        bodies=BODIES,
        joints=_joints(Line(B, C)),
        forces=FORCES,
        parameters=PARAMETERS,
        coordinates=COORDINATES + (TIE_ROD_COORDINATES if free_rack else ()),
        inputs=INPUTS,
    )


def general(*, free_rack: bool = False) -> Mechanism:
    """Return the suspension as it is on cars.

    The strut's axis may miss the ball joint, the spring has seats of its own, the damper a curve,
    the strut friction and stops, and the tyre damps and lifts off. With the defaults of all these
    it is the paper's suspension, at a higher price.
    """
    return Mechanism(
        name="macpherson_general",
        fixed="chassis",
        title="MacPherson suspension with an offset strut",
        bodies=BODIES,
        joints=_joints(Line(STRUT_LOWER, C)),
        forces=GENERAL_FORCES,
        parameters=GENERAL_PARAMETERS,
        coordinates=COORDINATES + (TIE_ROD_COORDINATES if free_rack else ()),
        inputs=INPUTS,
    )


MODELS = (
    Model(
        name="macpherson",
        title="MacPherson suspension, rack prescribed: arm, knuckle and wheel carry mass",
        mechanism=mechanism(),
        independent=("OA", "HG"),
        prescribed={"y": "rack"},
        massive=("control_arm", "knuckle", "wheel"),
        held={"rack_held": ("y",)},
    ),
    Model(
        name="macpherson_free_rack",
        title="MacPherson suspension, rack free: every moving body carries mass",
        mechanism=mechanism(free_rack=True),
        independent=("OA", "HG", "y"),
        massive=("control_arm", "knuckle", "tie_rod", "rack", "upper_strut", "wheel"),
    ),
    Model(
        name="macpherson_general",
        title="MacPherson suspension with an offset strut, spring seats, stops; rack prescribed",
        mechanism=general(),
        independent=("OA", "HG"),
        prescribed={"y": "rack"},
        massive=("control_arm", "knuckle", "wheel"),
        held={"rack_held": ("y",)},
    ),
)

# Seldom wanted, and as long as all others together: `kintrafo.Model` compiles it when it is needed.
GENERAL_FREE_RACK = Model(
    name="macpherson_general_free_rack",
    title="MacPherson suspension with an offset strut, spring seats, stops; rack free",
    mechanism=general(free_rack=True),
    independent=("OA", "HG", "y"),
    massive=("control_arm", "knuckle", "tie_rod", "rack", "upper_strut", "wheel"),
)
