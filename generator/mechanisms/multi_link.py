"""Multi-link suspensions: a wheel carrier on links, for which there is no closed form.

Three of them, all rear right, ISO 8855 axes, ground at z = 0; the numbers are this project's own.
In `CONTROL_ARM` the carrier hangs at the ball joint of a lower control arm, and an upper link, a
camber link and a toe link hold it: three equations. In `FIVE_LINK` five links hold it and a push
rod that leads to a rocker, in `STRUT` five links and a strut, whose slide is the coordinate: six
equations. A rack steers the rear wheel at the inner end of the toe link.

Their models are declared with ``allow_iteration=True``. They are not among those that come with the
project, whose code is all free of iteration.
"""

from __future__ import annotations

from ..declare.assembly import Body, Parameter, RelativeCoordinate
from ..declare.forces.force_element import ForceElement
from ..declare.forces.joint_force import JointForce
from ..declare.forces.linear_tyre import LinearTyre
from ..declare.forces.weight import Weight
from ..declare.geometry import UP, Direction, Line, Point
from ..declare.joints import Joint, Prismatic, Revolute, Spherical, Universal
from ..declare.laws import LinearDamper, LinearSpring
from ..declare.mechanism import Mechanism
from ..declare.model import Model
from ..declare.parameters import direction, point, rigid_body, rotor
from ..declare.paths import AlongLine
from ..declare.wheel import Wheel
from .suspension import INPUTS

Place = tuple[float, float, float]

WHEEL_CENTER = Point("wheel_center")
SPRING_TOP, SPRING_SEAT = Point("spring_top"), Point("spring_seat")
RACK, SPIN = Direction("rack_axis"), Direction("spin_axis")

PLACES: dict[str, tuple[Place, Place]] = {
    "upper_link": ((0.03, -0.38, 0.47), (0.05, -0.66, 0.49)),
    "camber_link": ((-0.16, -0.38, 0.45), (-0.07, -0.67, 0.47)),
    "toe_link": ((-0.17, -0.36, 0.27), (-0.15, -0.69, 0.26)),
    "front_link": ((0.21, -0.41, 0.20), (0.02, -0.71, 0.17)),
    "lower_link": ((-0.12, -0.30, 0.18), (-0.04, -0.70, 0.16)),
    "push_rod": ((-0.04, -0.44, 0.56), (-0.03, -0.65, 0.22)),
}
"""Inner and outer end of every rod [m]."""


def _ends(rod: str) -> tuple[Point, Point]:
    return Point(f"{rod}_inner"), Point(f"{rod}_outer")


def _link(rod: str, inner_body: str) -> tuple[Joint, Joint]:
    """Return the joints of a rod: a cross inside, a ball joint at the carrier."""
    inner, outer = _ends(rod)
    return (
        Universal(
            name=f"{rod}_cross",
            first=inner_body,
            second=rod,
            at=inner,
            shaft=Line(inner, outer),
            first_axis=UP,
        ),
        Spherical(name=f"{rod}_ball", first="carrier", second=rod, at=outer),
    )


def _rod_parameters(rod: str) -> list[Parameter]:
    inner, outer = PLACES[rod]
    x, y, z = ((a + b) / 2 for a, b in zip(inner, outer, strict=True))
    return [
        *point(f"{rod}_inner", inner, f"inner end of the {rod}"),
        *point(f"{rod}_outer", outer, f"end of the {rod} at the carrier"),
        *rigid_body(rod, 1.2, (x, y, z), (0.008, 0.003, 0.007)),
    ]


def _bodies(*names: str) -> tuple[Body, ...]:
    """Return the ground, some bodies in their order, and the wheel."""
    moving = (Body(name, i, center=Point(f"{name}_com")) for i, name in enumerate(names, 2))
    wheel = Body("wheel", len(names) + 2, center=WHEEL_CENTER, rotor_axis=SPIN)
    return (Body("chassis", 1, center=SPRING_TOP), *moving, wheel)


_RACK_GUIDE = Prismatic(name="rack_guide", first="chassis", second="rack", direction=RACK)
_BEARING = Revolute(name="bearing", first="carrier", second="wheel", axis=Line(WHEEL_CENTER, SPIN))
_SPIN_ANGLE = RelativeCoordinate(
    "spin_angle", "bearing", "angle", "rad", "wheel spin angle relative to the carrier"
)
_RACK_DISPLACEMENT = RelativeCoordinate(
    "rack_displacement", "rack_guide", "slide", "m", "rack displacement along its axis"
)


def _forces(seat_body: str) -> tuple[Weight, ForceElement, LinearTyre, JointForce]:
    return (
        Weight(gravity="gravity"),
        ForceElement(
            name="spring",
            path=AlongLine(("chassis", SPRING_TOP), (seat_body, SPRING_SEAT)),
            laws=(
                LinearSpring(rate="spring_rate", free_length="spring_free_length"),
                LinearDamper(rate="damper_rate"),
            ),
        ),
        LinearTyre(
            name="rear",
            wheel=Wheel("carrier", WHEEL_CENTER, SPIN),
            rate="tyre_rate",
            free_height="tyre_free_height",
            road="road_height",
        ),
        JointForce(joint="rack_guide", input="rack_force"),
    )


def _parameters(
    rods: tuple[str, ...], spring_top: Place, spring_seat: Place, free_length: float
) -> list[Parameter]:
    return [
        *(entry for rod in rods for entry in _rod_parameters(rod)),
        *point("wheel_center", (0.0, -0.76, 0.31), "wheel centre"),
        *point("spring_top", spring_top, "seat of the spring on the chassis"),
        *point("spring_seat", spring_seat, "seat of the spring on what moves it"),
        *direction("rack_axis", (0.0, 1.0, 0.0), "direction of the rack"),
        *direction("spin_axis", (0.0, 1.0, -0.02), "spin axis of the wheel, pointing left"),
        *rigid_body("carrier", 11.0, (-0.01, -0.69, 0.31), (0.14, 0.12, 0.06)),
        *rigid_body("rack", 0.0, (-0.17, -0.36, 0.27)),
        *rotor("wheel", 21.0, 1.0, 0.55),
        Parameter("spring_rate", 55000.0, "N/m", "rate of the spring"),
        Parameter("spring_free_length", free_length, "m", "length of the spring without force"),
        Parameter("damper_rate", 3500.0, "N s/m", "rate of the damper along the spring"),
        Parameter("tyre_rate", 200000.0, "N/m", "radial rate of the tyre"),
        Parameter(
            "tyre_free_height",
            0.329,
            "m",
            "height of the wheel centre at which the tyre is free of force",
        ),
        Parameter("gravity", 9.81, "m/s^2", "acceleration of gravity"),
    ]


# -- a control arm and three links ----------------------------------------------------------------

_ARM_FRONT, _ARM_REAR = Point("lower_arm_front"), Point("lower_arm_rear")
_ARM_BALL = Point("lower_ball_joint")
_THREE = ("upper_link", "camber_link", "toe_link")

CONTROL_ARM = Mechanism(
    name="control_arm_multi_link",
    fixed="chassis",
    title="Multi-link suspension with a lower control arm and three links",
    bodies=_bodies("lower_arm", "carrier", *_THREE, "rack"),
    joints=(
        Revolute(
            name="lower_hinge",
            first="chassis",
            second="lower_arm",
            axis=Line(_ARM_REAR, _ARM_FRONT),
            angle_to=_ARM_BALL,
        ),
        Spherical(name="lower_ball", first="lower_arm", second="carrier", at=_ARM_BALL),
        *_link("upper_link", "chassis"),
        *_link("camber_link", "chassis"),
        *_link("toe_link", "rack"),
        _RACK_GUIDE,
        _BEARING,
    ),
    forces=_forces("lower_arm"),
    parameters=(
        *_parameters(_THREE, (-0.03, -0.50, 0.60), (-0.01, -0.60, 0.19), 0.52),
        *point("lower_arm_front", (0.15, -0.34, 0.20), "front bush of the lower arm"),
        *point("lower_arm_rear", (-0.19, -0.36, 0.18), "rear bush of the lower arm"),
        *point("lower_ball_joint", (0.0, -0.70, 0.17), "ball joint of the lower arm"),
        *rigid_body("lower_arm", 5.0, (-0.01, -0.50, 0.18), (0.06, 0.04, 0.09)),
    ),
    coordinates=(
        RelativeCoordinate(
            "arm_angle",
            "lower_hinge",
            "angle",
            "rad",
            "angle of the lower arm from the chassis vertical; falls as the wheel rises",
        ),
        _SPIN_ANGLE,
        _RACK_DISPLACEMENT,
    ),
    inputs=INPUTS,
)

# -- five links, and a push rod to a rocker -------------------------------------------------------

_ROCKER_PIVOT, _ROCKER_AXIS = Point("rocker_pivot"), Direction("rocker_axis")
_SIX = ("upper_link", "camber_link", "toe_link", "front_link", "lower_link", "push_rod")

FIVE_LINK = Mechanism(
    name="five_link",
    fixed="chassis",
    title="Five-link suspension with a push rod and a rocker",
    bodies=_bodies("rocker", "carrier", *_SIX, "rack"),
    joints=(
        Revolute(
            name="rocker_hinge",
            first="chassis",
            second="rocker",
            axis=Line(_ROCKER_PIVOT, _ROCKER_AXIS),
        ),
        *_link("upper_link", "chassis"),
        *_link("camber_link", "chassis"),
        *_link("toe_link", "rack"),
        *_link("front_link", "chassis"),
        *_link("lower_link", "chassis"),
        *_link("push_rod", "rocker"),
        _RACK_GUIDE,
        _BEARING,
    ),
    forces=_forces("rocker"),
    parameters=(
        *_parameters(_SIX, (-0.04, -0.12, 0.62), (-0.04, -0.34, 0.62), 0.27),
        *point("rocker_pivot", (-0.04, -0.35, 0.52), "bearing of the rocker"),
        *direction("rocker_axis", (1.0, 0.1, 0.0), "axis of the rocker"),
        *rigid_body("rocker", 1.5, (-0.04, -0.38, 0.56), (0.006, 0.004, 0.005)),
    ),
    coordinates=(
        RelativeCoordinate(
            "rocker_angle",
            "rocker_hinge",
            "angle",
            "rad",
            "angle of the rocker from design, right-handed about its axis to the front",
        ),
        _SPIN_ANGLE,
        _RACK_DISPLACEMENT,
    ),
    inputs=INPUTS,
)


# -- five links and a strut -----------------------------------------------------------------------

_FIVE = _SIX[:-1]
_STRUT_LINE = Direction("strut_line", between=(SPRING_SEAT, SPRING_TOP))

STRUT = Mechanism(
    name="five_link_strut",
    fixed="chassis",
    title="Five-link suspension with a strut",
    bodies=_bodies("strut_tube", "strut_rod", "carrier", *_FIVE, "rack"),
    joints=(
        Universal(
            name="strut_cross",
            first="chassis",
            second="strut_tube",
            at=SPRING_TOP,
            shaft=Line(SPRING_TOP, SPRING_SEAT),
            first_axis=RACK,
        ),
        Prismatic(
            name="strut_guide", first="strut_tube", second="strut_rod", direction=_STRUT_LINE
        ),
        Spherical(name="strut_ball", first="strut_rod", second="carrier", at=SPRING_SEAT),
        *_link("upper_link", "chassis"),
        *_link("camber_link", "chassis"),
        *_link("toe_link", "rack"),
        *_link("front_link", "chassis"),
        *_link("lower_link", "chassis"),
        _RACK_GUIDE,
        _BEARING,
    ),
    forces=_forces("carrier"),
    parameters=(
        *_parameters(_FIVE, (-0.04, -0.50, 0.72), (-0.03, -0.66, 0.20), 0.60),
        *rigid_body("strut_tube", 2.0, (-0.04, -0.52, 0.60), (0.010, 0.010, 0.003)),
        *rigid_body("strut_rod", 1.5, (-0.03, -0.62, 0.33), (0.008, 0.008, 0.002)),
    ),
    coordinates=(
        RelativeCoordinate(
            "compression", "strut_guide", "slide", "m", "by how much the strut is compressed"
        ),
        _SPIN_ANGLE,
        _RACK_DISPLACEMENT,
    ),
    inputs=INPUTS,
)


def _model(mechanism: Mechanism, driving: str) -> Model:
    """Return the model with a prescribed rack; everything but the rack has mass."""
    return Model(
        name=mechanism.name,
        title=f"{mechanism.title}, rack prescribed",
        mechanism=mechanism,
        independent=(driving, "bearing"),
        prescribed={"rack_guide": "rack"},
        massive=tuple(b.name for b in mechanism.bodies[1:] if b.name != "rack"),
        held={"rack_held": ("rack_guide",)},
        allow_iteration=True,
    )


MODELS = (
    _model(CONTROL_ARM, "lower_hinge"),
    _model(FIVE_LINK, "rocker_hinge"),
    _model(STRUT, "strut_guide"),
)
