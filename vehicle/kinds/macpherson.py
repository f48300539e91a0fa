"""The MacPherson suspension: a control arm, and a strut in which the knuckle turns."""

import math
from collections.abc import Mapping
from functools import cache
from types import ModuleType
from typing import Any, ClassVar, Literal, Self

import numpy as np
from pydantic import Field

from ...core.columns import number
from ...core.named_types import Array
from ...core.vectors import Vector, cross, unit_vector
from ...generated import macpherson, macpherson_free_rack, macpherson_general
from ...systems.allowed import LengthLimit
from ...systems.compile.build import compile_mechanism, require_generator
from ..corner.base import Extended, Names, Suspension
from ..corner.corner import CarrierMotion, Plane, SpringForce, Stroke, Strokes
from ..corner.drawing import Axis, Drawing
from ..corner.structure import (
    FORCES_OF_A_DAMPER,
    HingeJoint,
    LineForce,
    SphericalJoint,
    Structure,
    TelescopeJoint,
    UniversalJoint,
    steered,
)
from ..input.bodies import Bodies, Rack, RigidBody, TieRod
from ..input.damper import Damper
from ..input.hardpoints import SMALLEST_DISTANCE, Hardpoints, Pair
from ..input.section import Number, Triple
from ..input.spring import NO_CURVE, SpringSection
from ..input.strut import StrutSection
from ..input.units import in_metres

# Default height of the knuckle's centre of mass on the strut axis above the ball joint.
_DEFAULT_COM_ALONG_STRUT_MM = 120.0

# The points of each body; strut_top moves along the strut and is on a body of its own.
_POINTS_OF_BODIES = {
    "control arm": ("arm_front", "arm_rear", "ball_joint"),
    "knuckle": ("ball_joint", "tie_rod_outer", "wheel_center"),
    "strut": ("ball_joint", "strut_top"),
    "tie rod": ("tie_rod_outer", "tie_rod_inner"),
}

# The pairs of these points that define the directions of strut, tie rod and steering arm.
_DIRECTIONS_OF_STEERING = {
    ("ball_joint", "strut_top"),
    ("tie_rod_outer", "tie_rod_inner"),
    ("ball_joint", "tie_rod_outer"),
    ("strut_lower", "strut_top"),
}

# Bodies that the paper's equations leave without mass.
_MASSLESS_IN_THE_PAPER = ("tie_rod", "rack", "upper_strut")

# A spring seat nearer to the ball joint than this is drawn in line with the strut [m].
_OWN_SEAT = 0.05

_FORWARD, _UP = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])


class MacPhersonHardpoints(Hardpoints):
    """The points that define a MacPherson suspension, at the design position.

    All are in chassis axes (ISO 8855: x forward, y left, z up), in the unit that `unit` names.
    """

    STAND_INS: ClassVar[Mapping[str, str]] = {
        "strut_lower": "ball_joint",
        "spring_top": "strut_top",
        "spring_seat": "strut_lower",
    }
    CARRIERS: ClassVar[Mapping[str, str]] = {
        "ball_joint": "knuckle",
        "tie_rod_outer": "knuckle",
        "wheel_center": "knuckle",
        "tie_rod_inner": "rack",
        "strut_lower": "knuckle",
        "spring_seat": "knuckle",
    }
    ARMS: ClassVar[Mapping[str, Pair]] = {"ball_joint": ("arm_front", "arm_rear")}
    JOINTS: ClassVar[tuple[str, ...]] = ("ball_joint", "tie_rod_outer", "tie_rod_inner")
    STEERING_AXIS: ClassVar[Pair] = ("ball_joint", "strut_top")
    AXIS_NAME: ClassVar[str] = "strut axis"

    arm_front: Triple = Field(description="front bearing of the control arm")
    arm_rear: Triple = Field(description="rear bearing of the control arm")
    ball_joint: Triple = Field(description="ball joint of control arm and knuckle")
    strut_top: Triple = Field(description="upper mount of the strut")
    tie_rod_outer: Triple = Field(description="ball joint of tie rod and knuckle")
    tie_rod_inner: Triple = Field(description="joint of tie rod and rack or relay rod")
    wheel_center: Triple = Field(description="centre of the wheel")
    strut_lower: Triple | None = Field(
        default=None,
        description="a point of the knuckle on the strut's axis; by default the axis passes "
        "through ball_joint",
    )
    spring_top: Triple | None = Field(
        default=None, description="upper seat of the spring, on the chassis; by default strut_top"
    )
    spring_seat: Triple | None = Field(
        default=None, description="lower seat of the spring, on the knuckle; by default strut_lower"
    )

    def has_spring_seats(self) -> bool:
        """Return whether the spring has an axis of its own."""
        return self.spring_top is not None or self.spring_seat is not None

    def strut_axis(self) -> Vector:
        """Return the unit vector along the strut, upward from its lower end."""
        return unit_vector(self.metres("strut_top") - self.metres("strut_lower"))

    def steering_axis(self) -> Vector | None:
        if self.distance("strut_lower", "strut_top") < SMALLEST_DISTANCE:
            return None
        return self.strut_axis()

    def geometry_problems(self) -> list[str]:
        coinciding = self.coinciding(_POINTS_OF_BODIES)
        ends = {"strut": ("strut_lower", "strut_top"), "spring": ("spring_seat", "spring_top")}
        optional = set(self.given_optional())
        coinciding |= self.coinciding(
            {part: pair for part, pair in ends.items() if optional & {*pair}}
        )
        problems = self.coincidence_problems(coinciding)
        # The other checks need the directions that these pairs of points define.
        if "control arm" not in coinciding.values():
            problems += self.hinge_problems("arm_front", "arm_rear", "ball_joint")
        if not coinciding.keys() & _DIRECTIONS_OF_STEERING:
            problems += self.steering_problems(*self.STEERING_AXIS)
            strut, rod = ("strut_top", "strut_lower"), ("tie_rod_inner", "tie_rod_outer")
            problems += self.cross_problems(strut, "strut", _FORWARD, "the x axis")
            problems += self.cross_problems(rod, "tie rod", _UP, "the vertical")
            problems += self._offset()
        return problems

    def _offset(self) -> list[str]:
        """Return a problem if the ball joint is not below the strut top along the strut."""
        span = self.metres("strut_top") - self.metres("ball_joint")
        reach = number(span @ self.strut_axis())
        if reach >= SMALLEST_DISTANCE:
            return []
        problem = (
            f"{self.text('ball_joint', 'strut_lower', 'strut_top')}: along the strut, strut_top is "
            f"{1000 * reach:.3f} mm above ball_joint; at least {1000 * SMALLEST_DISTANCE:g} mm "
            "are needed. Swap the ends of the strut, or correct strut_lower."
        )
        return [problem]


class ControlArmBody(RigidBody):
    """The control arm."""

    POINTS: ClassVar[tuple[str, ...]] = ("arm_front", "arm_rear", "ball_joint")


class Knuckle(RigidBody):
    """The knuckle with the lower tube of the strut."""

    com_along_strut_mm: Number | None = Field(
        default=None,
        description="distance of the centre of mass from ball_joint, in the direction of strut_top",
    )

    def default_centre_of_mass(self, points: Hardpoints) -> Vector:
        """Return the point on the strut axis at a distance above the ball joint [m]."""
        given = self.com_along_strut_mm
        distance = in_metres(_DEFAULT_COM_ALONG_STRUT_MM if given is None else given, "mm")
        upward = unit_vector(points.metres("strut_top") - points.metres("strut_lower"))
        return points.metres("ball_joint") + distance * upward

    def problems(self) -> list[str]:
        problems = super().problems()
        if self.com_mm is not None and self.com_along_strut_mm is not None:
            problems.append(
                f"com_mm = {list(self.com_mm)} mm and com_along_strut_mm = "
                f"{self.com_along_strut_mm} mm both place the centre of mass; one is allowed. "
                "Remove the other."
            )
        return problems


class UpperStrut(RigidBody):
    """The upper strut: the piston rod with the parts that turn with it."""

    POINTS: ClassVar[tuple[str, ...]] = ("strut_top",)


class MacPhersonBodies(Bodies):
    """All bodies that may carry mass. Tie rod, rack and upper strut are massless if left out."""

    control_arm: ControlArmBody = Field(description="the control arm")
    knuckle: Knuckle = Field(description="the knuckle with the lower tube of the strut")
    tie_rod: TieRod = Field(default=TieRod(mass_kg=0.0), description="the tie rod")
    rack: Rack = Field(default=Rack(mass_kg=0.0), description="the rack")
    upper_strut: UpperStrut = Field(default=UpperStrut(mass_kg=0.0), description="the upper strut")


class MacPherson(Suspension):
    """A MacPherson suspension at its design position; see `Suspension`."""

    TITLE: ClassVar[str] = "MacPherson suspension"
    # all equations of this kind have the names of the paper's
    NAMES: ClassVar[Names] = Names("beta1", "beta5", "beta9", "strut_force")
    STARTER: ClassVar[str] = "reference_car"
    STOPPED: ClassVar[str] = "strut"
    PAGE: ClassVar[str] = """, which may be left out.

The *slide* of the strut is its compression from `length_max_mm`. The free length of the spring is
given in one of four ways: by the slide (`spring_free_slide_mm`), by the distance of the seats
(`spring_free_length_mm`), by the force with the strut extended (`spring_preload_N`), or by the
force at the design position (`spring_force_at_design_N`). The damper has a rate in `[strut]` or a
curve in `[damper]`, the spring a rate in `[strut]` or a curve in `[spring]`."""

    suspension: Literal["macpherson"] = Field(
        default="macpherson", description="the kind of suspension"
    )
    hardpoints: MacPhersonHardpoints = Field(description="the points that define the geometry")
    strut: StrutSection = Field(description="spring and damper")
    bodies: MacPhersonBodies = Field(description="masses and inertia")
    spring: SpringSection | None = Field(
        default=None,
        description="the spring; a MacPherson suspension can describe it in [strut] instead",
    )
    damper: Damper | None = Field(default=None, description="a damper curve instead of a rate")

    # -- its equations --------------------------------------------------------------------------

    def equations(self, *, free_rack: bool) -> ModuleType:
        """Return the paper's equations, or those with all additions."""
        if not self.beyond_the_paper():
            return macpherson_free_rack if free_rack else macpherson
        return _general_free_rack() if free_rack else macpherson_general

    def neglected_masses(self) -> dict[str, float]:
        rigid = self.bodies.rigid()
        masses = {name: rigid[name].mass_kg for name in _MASSLESS_IN_THE_PAPER}
        return {name: mass for name, mass in masses.items() if mass > 0.0}

    def without_friction(self) -> Self:
        return self.with_changes({"strut.friction_N": 0.0}) if self.strut.friction_N else self

    def parameters(self) -> dict[str, float]:
        """Return the parameters of the equations of motion, in SI units.

        They are `shared_parameters`, ``strut_length_max`` and ``spring_free_slide`` in m,
        ``spring_rate`` in N/m, ``damper_rate`` in N s/m; with anything of `beyond_the_paper`
        ``spring_free_length`` instead of the slide, and the further ones of
        ``generated.macpherson_general``.
        """
        general = bool(self.beyond_the_paper())
        values = self.shared_parameters(optional_points=general)
        values |= self.strut.parameters(self.damper)
        seats = self.hardpoints.distance("spring_seat", "spring_top")
        if general:
            return values | self._general_parameters() | self._spring_of(seats)
        if self.spring is None:
            slide = self.strut.free_slide(seats)
        else:
            slide = self.strut.length_max - self.spring.free_length(seats)
        rate = self._spring_of(seats)["spring_rate"]
        return values | {"spring_rate": rate, "spring_free_slide": slide}

    def _spring_of(self, seats: float) -> dict[str, Any]:
        """Return rate, free length and curve of the spring, in SI units."""
        if self.spring is not None:
            return self.spring.parameters(seats, general=True)
        own = {
            "spring_rate": self.strut.spring_rate_N_per_m,
            "spring_free_length": self.strut.free_length(seats),
        }
        return own | NO_CURVE

    def _general_parameters(self) -> dict[str, float]:
        """Return the further parameters of the general equations, in SI units."""
        length = self.hardpoints.distance("strut_lower", "strut_top")
        return self.parameters_of_extras(length, self.damper) | {
            "strut_friction": self.strut.friction_N,
            "strut_friction_speed": self.strut.friction_velocity_m_per_s,
        }

    # -- its geometry ---------------------------------------------------------------------------

    def lengths(self) -> dict[str, float]:
        return {
            "strut_length": self.hardpoints.distance("strut_lower", "strut_top"),
            "strut_length_max": self.strut.length_max,
        }

    def extended(self) -> Extended:
        return Extended("strut_length", self.strut.length_max, "strut", "[strut] length_max_mm")

    def allowed_lengths(self) -> tuple[LengthLimit, ...]:
        least = self.strut.length_min_mm
        if least is None:
            return ()
        end = f"least length, [strut] length_min_mm = {least:g} mm"
        return (LengthLimit("strut_length", in_metres(least, "mm"), "strut", end),)

    def rate_key(self, part: str) -> str:
        if part == "spring" and self.spring is not None:
            return super().rate_key(part)
        return super().rate_key(part).replace(f"[{part}] ", f"[strut] {part}_")

    def drawing(self) -> Drawing:
        """Return the drawing of arm, strut and tie rod.

        The drawn knuckle clamps the strut on its axis beside the wheel centre.
        """
        clamp = ("wheel_center", "strut_lower", "strut_top")
        in_line = self.hardpoints.distance("spring_seat", "ball_joint") <= _OWN_SEAT
        return Drawing(
            links={
                "control arm": ("arm_front", "ball_joint", "arm"),
                "strut": ("strut_top", "ball_joint", "strut"),
                "tie rod": ("tie_rod_inner", "tie_rod_outer", "rod"),
            },
            knuckle=("ball_joint", "tie_rod_outer", "wheel_center"),
            legend={"arm": "control arm", "strut": "strut"},
            damper=Axis(clamp, "strut_top", 0.585),
            spring=Axis(clamp, "strut_top", 0.46)
            if in_line
            else Axis("spring_seat", "spring_top", 0.0),
            upright=("ball_joint", clamp),
            brackets={},
        )

    # -- its structure --------------------------------------------------------------------------

    def structure(self) -> Structure:
        """Return the joints; the spring acts on the chassis, beside the mount of the strut."""
        joints = (
            HingeJoint("chassis", "control_arm", self.hardpoints.ARMS["ball_joint"]),
            SphericalJoint("control_arm", "knuckle", ("ball_joint",)),
            UniversalJoint(
                "chassis", "upper_strut", ("strut_top",), "strut_lower", (1.0, 0.0, 0.0)
            ),
            TelescopeJoint("upper_strut", "knuckle", ("strut_lower",), "strut_top"),
        )
        damper = (*FORCES_OF_A_DAMPER, self.NAMES.actuator)
        lines = (
            LineForce(
                "spring", ("spring_force",), "chassis", "knuckle", ("spring_top", "spring_seat")
            ),
            LineForce("damper", damper, "upper_strut", "knuckle", ("strut_top", "strut_lower")),
        )
        # strut and spring have one mount on the body
        held = steered(*joints, by=self.steering_gear.TIE_RODS_ON)
        return Structure(held, lines, {"spring_top": "strut_top"})

    # -- its characteristics --------------------------------------------------------------------

    def links_at(self, points: Mapping[str, Array], travel: CarrierMotion) -> tuple[Plane, Plane]:
        """Return the plane of the control arm, and the plane normal to the strut at its mount."""
        ball, front, rear = points["ball_joint"], points["arm_front"], points["arm_rear"]
        top, bottom = points["strut_top"], points["strut_lower"]
        return Plane(ball, cross(front - rear, ball - rear)), Plane(top, top - bottom)

    def spring_at(self, strokes: Strokes) -> SpringForce:
        return strokes.spring("spring_force", "spring" if "spring_length" in strokes else "strut")

    def damper_at(self, strokes: Strokes) -> Stroke:
        return strokes.stroke("strut")

    # -- its checks -----------------------------------------------------------------------------

    def beyond_the_paper(self) -> list[str]:
        """Return the sections and keys that the paper's equations do not have.

        Examples
        --------
        >>> from kintrafo import Suspension
        >>> car = Suspension.load("reference_car")
        >>> car.beyond_the_paper(), car.with_changes({"tyre.lifts_off": True}).beyond_the_paper()
        ([], ['[tyre] lifts_off'])
        """
        own = {
            **{f"[hardpoints] {name}": True for name in self.hardpoints.given_optional()},
            "[strut] friction_N": self.strut.friction_N > 0.0,
            "[damper]": self.damper is not None,
            "[spring] force_N": self.spring is not None and self.spring.by_curve,
        }
        return [name for name, is_present in own.items() if is_present] + self.extras()

    @classmethod
    def further_problems(cls, sections: Mapping[str, Any]) -> list[str]:
        strut, points = sections.get("strut"), sections["hardpoints"]
        if strut is None:
            return []
        without_curve = "damper" in sections and sections["damper"] is None
        described = "spring" not in sections or sections["spring"] is not None
        return [
            *_strut_too_long(strut, points),
            *_strut_too_short(strut, points),
            *strut.spring_problems(own_seats=points.has_spring_seats(), described=described),
            *_damper_problems(strut, with_curve=not without_curve),
        ]


@cache
def _general_free_rack() -> ModuleType:
    """Return the equations with all additions, which are not packaged, as they are rarely used."""
    require_generator()
    from ...generator.mechanisms.macpherson import GENERAL_FREE_RACK  # noqa: PLC0415 (an extra)

    return compile_mechanism(GENERAL_FREE_RACK)


def _strut_too_short(strut: StrutSection, hardpoints: MacPhersonHardpoints) -> list[str]:
    """Return the problem of a strut that is shorter at design than fully compressed."""
    length = 1000.0 * hardpoints.distance("strut_lower", "strut_top")
    if strut.length_min_mm is None or strut.length_min_mm <= length:
        return []
    limit = math.floor(10.0 * length) / 10.0  # rounded down, so that the printed value is accepted
    problem = (
        f"[strut] length_min_mm = {strut.length_min_mm} mm is more than the length at design; "
        f"allowed is {limit:.1f} mm or less, the distance of the strut's ends. Lower it, or "
        "correct these hardpoints."
    )
    return [problem]


def _damper_problems(strut: StrutSection, *, with_curve: bool) -> list[str]:
    """Return the problem of a damper that is described twice, or not."""
    if (strut.damper_rate_N_s_per_m is None) == with_curve:
        return []
    if with_curve:
        problem = (
            f"[strut] damper_rate_N_s_per_m = {strut.damper_rate_N_s_per_m} N s/m and [damper] "
            "both describe the damper; one is allowed. Remove the other."
        )
        return [problem]
    problem = (
        "[strut] damper_rate_N_s_per_m is missing: rate of the damper, unless a section [damper] "
        "has its curve. Add a line `damper_rate_N_s_per_m = ...`, in N s/m."
    )
    return [problem]


def _strut_too_long(strut: StrutSection, hardpoints: MacPhersonHardpoints) -> list[str]:
    """Return the problem of a strut that is longer at design than fully extended."""
    length = 1000.0 * hardpoints.distance("strut_lower", "strut_top")
    lower = "ball_joint" if hardpoints.strut_lower is None else "strut_lower"
    if strut.length_max_mm >= length:
        return []
    across = [
        name
        for name in (lower, "strut_top")
        if hardpoints.metres(name)[1] * hardpoints.metres("wheel_center")[1] < 0.0
    ]
    if across:
        problem = (
            f"{hardpoints.text(across[0], 'wheel_center')} are on different sides of the car. "
            f"That makes the strut {length:.1f} mm long at design, and [strut] length_max_mm is "
            f"{strut.length_max_mm} mm. y points left: correct the sign of y."
        )
        return [problem]
    limit = math.ceil(10.0 * length) / 10.0  # rounded up, so that the printed value is accepted
    problem = (
        f"[strut] length_max_mm = {strut.length_max_mm} mm is less than the length at design; "
        f"allowed is {limit:.1f} mm or more, the distance of {lower} and strut_top. Raise "
        "it, or correct these hardpoints."
    )
    return [problem]
