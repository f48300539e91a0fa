"""Wheel carriers held by several rods together, without a closed form.

Three of them, all rear right, ISO 8855 axes, ground at z = 0; the numbers are this project's own.
In `CONTROL_ARM` the carrier hangs at the ball joint of a lower control arm, and an upper link, a
camber link and a toe link hold it: three equations. In `FIVE_LINK` five links hold it and a push
rod that leads to a rocker, in `STRUT` five links and a strut, whose slide is the coordinate: six
equations. A rack steers the rear wheel at the inner end of the toe link.

Their models are declared with ``allow_iteration=True``, as examples of such loops; the multi-link
suspension that comes with the project is another one.
"""

from __future__ import annotations

from dataclasses import dataclass

from .. import declare as d
from .suspension import RACK_FORCE, RACK_MOTION, damper, rod_joints, tyre

Place = tuple[float, float, float]


@dataclass(frozen=True)
class Rod:
    """A rod with its ends: a cross inside, a ball joint at the carrier."""

    body: d.Body
    inner: d.Point
    outer: d.Point

    def joints(self, base: d.Body) -> tuple[d.Joint, d.Joint]:
        """Return its joints, the inner one at a base."""
        return rod_joints(self.body, (base, self.inner), (CARRIER, self.outer))


def _rod(name: str, inner: Place, outer: Place) -> Rod:
    x, y, z = ((a + b) / 2 for a, b in zip(inner, outer, strict=True))
    return Rod(
        d.Body(name, 1.2, (x, y, z), (0.008, 0.003, 0.007)),
        d.Point(f"{name}_inner", inner, f"inner end of the {name}"),
        d.Point(f"{name}_outer", outer, f"end of the {name} at the carrier"),
    )


WHEEL_CENTER = d.Point("wheel_center", (0.0, -0.76, 0.31), "wheel centre")
RACK_AXIS = d.Direction("rack_axis", (0.0, 1.0, 0.0), "direction of the rack")
SPIN_AXIS = d.Direction("spin_axis", (0.0, 1.0, -0.02), "spin axis of the wheel, pointing left")

CHASSIS = d.Ground("chassis", 1)
LOWER_ARM = d.Body("lower_arm", 5.0, (-0.01, -0.50, 0.18), (0.06, 0.04, 0.09))
ROCKER = d.Body("rocker", 1.5, (-0.04, -0.38, 0.56), (0.006, 0.004, 0.005))
STRUT_TUBE = d.Body("strut_tube", 2.0, (-0.04, -0.52, 0.60), (0.010, 0.010, 0.003))
STRUT_ROD = d.Body("strut_rod", 1.5, (-0.03, -0.62, 0.33), (0.008, 0.008, 0.002))
CARRIER = d.Body("carrier", 11.0, (-0.01, -0.69, 0.31), (0.14, 0.12, 0.06))
UPPER_LINK = _rod("upper_link", (0.03, -0.38, 0.47), (0.05, -0.66, 0.49))
CAMBER_LINK = _rod("camber_link", (-0.16, -0.38, 0.45), (-0.07, -0.67, 0.47))
TOE_LINK = _rod("toe_link", (-0.17, -0.36, 0.27), (-0.15, -0.69, 0.26))
FRONT_LINK = _rod("front_link", (0.21, -0.41, 0.20), (0.02, -0.71, 0.17))
LOWER_LINK = _rod("lower_link", (-0.12, -0.30, 0.18), (-0.04, -0.70, 0.16))
PUSH_ROD = _rod("push_rod", (-0.04, -0.44, 0.56), (-0.03, -0.65, 0.22))
RACK = d.Body("rack", 0.0, (-0.17, -0.36, 0.27))
WHEEL = d.Rotor("wheel", 21.0, WHEEL_CENTER, axis=SPIN_AXIS, spin=1.0, diametral=0.55)

RACK_GUIDE = d.Prismatic("rack_guide", CHASSIS, RACK, direction=RACK_AXIS)
BEARING = d.Revolute("bearing", CARRIER, WHEEL, axis=d.Line(WHEEL_CENTER, SPIN_AXIS))
_STEERED_LINKS = (*UPPER_LINK.joints(CHASSIS), *CAMBER_LINK.joints(CHASSIS), *TOE_LINK.joints(RACK))
_FIVE_LINKS = (*_STEERED_LINKS, *FRONT_LINK.joints(CHASSIS), *LOWER_LINK.joints(CHASSIS))
_REPORTED = (
    BEARING.angle("spin_angle", "wheel spin angle relative to the carrier"),
    RACK_GUIDE.slide("rack_displacement", "rack displacement along its axis"),
)

_SPRING_RATE = d.SpringRate("spring_rate", 55000.0, "rate of the spring")
_DAMPER = damper(3500.0, along="the spring")
_WEIGHT = d.Weight()
_TYRE = tyre("rear", d.Wheel(CARRIER, WHEEL_CENTER, SPIN_AXIS), 0.329)


def _suspension(
    name: str,
    title: str,
    joints: tuple[d.Joint, ...],
    driving: d.RelativeCoordinate,
    spring: tuple[d.Point, d.Point],
    seat_body: d.Body,
    free_length: float,
) -> d.Mechanism:
    """Return a suspension with a spring from a point of the chassis to one of another body."""
    top, seat = spring
    length = d.Length("spring_free_length", free_length, "length of the spring without force")
    coil = d.LinearSpring(rate=_SPRING_RATE, free_length=length)
    return d.Mechanism(
        name=name,
        title=title,
        joints=(*joints, RACK_GUIDE, BEARING),
        forces=(
            _WEIGHT,
            d.ForceElement(
                "spring", d.AlongLine((CHASSIS, top), (seat_body, seat)), (coil, _DAMPER)
            ),
            _TYRE,
            d.JointForce(RACK_GUIDE, RACK_FORCE),
        ),
        coordinates=(driving, *_REPORTED),
    )


def _seats(top: Place, seat: Place) -> tuple[d.Point, d.Point]:
    return (
        d.Point("spring_top", top, "seat of the spring on the chassis"),
        d.Point("spring_seat", seat, "seat of the spring on what moves it"),
    )


# -- a control arm and three links ----------------------------------------------------------------

ARM_FRONT = d.Point("lower_arm_front", (0.15, -0.34, 0.20), "front bush of the lower arm")
ARM_REAR = d.Point("lower_arm_rear", (-0.19, -0.36, 0.18), "rear bush of the lower arm")
ARM_BALL = d.Point("lower_ball_joint", (0.0, -0.70, 0.17), "ball joint of the lower arm")
LOWER_HINGE = d.Revolute(
    "lower_hinge", CHASSIS, LOWER_ARM, axis=d.Line(ARM_REAR, ARM_FRONT), angle_to=ARM_BALL
)
LOWER_BALL = d.Spherical("lower_ball", LOWER_ARM, CARRIER, at=ARM_BALL)

CONTROL_ARM = _suspension(
    "control_arm_multi_link",
    "Multi-link suspension with a lower control arm and three links",
    (LOWER_HINGE, LOWER_BALL, *_STEERED_LINKS),
    LOWER_HINGE.angle(
        "arm_angle", "angle of the lower arm from the chassis vertical; falls as the wheel rises"
    ),
    _seats((-0.03, -0.50, 0.60), (-0.01, -0.60, 0.19)),
    LOWER_ARM,
    0.52,
)

# -- five links, and a push rod to a rocker -------------------------------------------------------

ROCKER_PIVOT = d.Point("rocker_pivot", (-0.04, -0.35, 0.52), "bearing of the rocker")
ROCKER_AXIS = d.Direction("rocker_axis", (1.0, 0.1, 0.0), "axis of the rocker")
ROCKER_HINGE = d.Revolute("rocker_hinge", CHASSIS, ROCKER, axis=d.Line(ROCKER_PIVOT, ROCKER_AXIS))

FIVE_LINK = _suspension(
    "five_link",
    "Five-link suspension with a push rod and a rocker",
    (ROCKER_HINGE, *_FIVE_LINKS, *PUSH_ROD.joints(ROCKER)),
    ROCKER_HINGE.angle(
        "rocker_angle", "angle of the rocker from design, right-handed about its axis to the front"
    ),
    _seats((-0.04, -0.12, 0.62), (-0.04, -0.34, 0.62)),
    ROCKER,
    0.27,
)

# -- five links and a strut -----------------------------------------------------------------------

STRUT_SEATS = STRUT_TOP, STRUT_SEAT = _seats((-0.04, -0.50, 0.72), (-0.03, -0.66, 0.20))
STRUT_LINE = d.Direction("strut_line", between=(STRUT_SEAT, STRUT_TOP))
STRUT_CROSS = d.Universal(
    "strut_cross",
    CHASSIS,
    STRUT_TUBE,
    at=STRUT_TOP,
    shaft=d.Line(STRUT_TOP, STRUT_SEAT),
    first_axis=RACK_AXIS,
)
STRUT_GUIDE = d.Prismatic("strut_guide", STRUT_TUBE, STRUT_ROD, direction=STRUT_LINE)
STRUT_BALL = d.Spherical("strut_ball", STRUT_ROD, CARRIER, at=STRUT_SEAT)

STRUT = _suspension(
    "five_link_strut",
    "Five-link suspension with a strut",
    (STRUT_CROSS, STRUT_GUIDE, STRUT_BALL, *_FIVE_LINKS),
    STRUT_GUIDE.slide("compression", "by how much the strut is compressed"),
    STRUT_SEATS,
    CARRIER,
    0.60,
)


def _model(mechanism: d.Mechanism, driving: d.Joint) -> d.Formulation:
    """Return the model with a prescribed rack; everything but the rack has mass."""
    return d.Formulation(
        name=mechanism.name,
        title=f"{mechanism.title}, rack prescribed",
        mechanism=mechanism,
        independent=(driving, BEARING),
        prescribed={RACK_GUIDE: RACK_MOTION},
        massive=tuple(body for body in mechanism.bodies[1:] if body != RACK),
        held={"rack_held": (RACK_GUIDE,)},
        allow_iteration=True,
    )


EMITTED = False  # they are in tests and examples
MODELS = (
    _model(CONTROL_ARM, LOWER_HINGE),
    _model(FIVE_LINK, ROCKER_HINGE),
    _model(STRUT, STRUT_GUIDE),
)
