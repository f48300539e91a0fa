"""The double wishbone suspension: two arms, of which the lower one carries spring and damper."""

from collections.abc import Mapping
from types import ModuleType
from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from ...core.columns import number
from ...core.named_types import Array
from ...core.vectors import Vector, cross, distance_from_line, unit_vector
from ...generated import double_wishbone, double_wishbone_general
from ..corner.base import Names
from ..corner.coil_sprung import CoilDamper, CoilSprung
from ..corner.corner import CarrierMotion, Plane
from ..corner.drawing import Axis, Drawing
from ..corner.structure import (
    FORCES_OF_A_DAMPER,
    HingeJoint,
    LineForce,
    SphericalJoint,
    Structure,
    steered,
)
from ..input.bodies import Bodies, Rack, RigidBody, TieRod
from ..input.hardpoints import SMALLEST_DISTANCE, Hardpoints, Pair
from ..input.section import Triple
from ..input.spring import SpringSection

_UP = np.array([0.0, 0.0, 1.0])

# The points of each body, and of the spring.
_LOWER_ARM = ("lower_arm_front", "lower_arm_rear", "lower_ball_joint")
_UPPER_ARM = ("upper_arm_front", "upper_arm_rear", "upper_ball_joint")
_KNUCKLE = ("lower_ball_joint", "upper_ball_joint", "tie_rod_outer", "wheel_center")
_TIE_ROD = ("tie_rod_inner", "tie_rod_outer")
_SPRING = ("spring_seat", "spring_top")
_POINTS_OF_BODIES = {
    "lower arm": _LOWER_ARM,
    "upper arm": _UPPER_ARM,
    "knuckle": _KNUCKLE,
    "tie rod": _TIE_ROD,
    "spring": _SPRING,
}


class DoubleWishboneHardpoints(Hardpoints):
    """The points that define a double wishbone suspension, at the design position.

    All are in chassis axes (ISO 8855: x forward, y left, z up), in the unit that `unit` names.
    """

    CARRIERS: ClassVar[Mapping[str, str]] = {
        "lower_ball_joint": "knuckle",
        "upper_ball_joint": "knuckle",
        "tie_rod_outer": "knuckle",
        "wheel_center": "knuckle",
        "tie_rod_inner": "rack",
        "spring_seat": "lower_arm",
    }
    ARMS: ClassVar[Mapping[str, Pair]] = {
        "lower_ball_joint": ("lower_arm_front", "lower_arm_rear"),
        "upper_ball_joint": ("upper_arm_front", "upper_arm_rear"),
    }
    JOINTS: ClassVar[tuple[str, ...]] = (
        "lower_ball_joint",
        "upper_ball_joint",
        "tie_rod_outer",
        "tie_rod_inner",
    )
    STEERING_AXIS: ClassVar[Pair] = ("lower_ball_joint", "upper_ball_joint")

    lower_arm_front: Triple = Field(description="front bearing of the lower arm")
    lower_arm_rear: Triple = Field(description="rear bearing of the lower arm")
    upper_arm_front: Triple = Field(description="front bearing of the upper arm")
    upper_arm_rear: Triple = Field(description="rear bearing of the upper arm")
    lower_ball_joint: Triple = Field(description="ball joint of lower arm and knuckle")
    upper_ball_joint: Triple = Field(description="ball joint of upper arm and knuckle")
    tie_rod_outer: Triple = Field(description="ball joint of tie rod and knuckle")
    tie_rod_inner: Triple = Field(description="joint of tie rod and rack or relay rod")
    spring_top: Triple = Field(description="upper end of spring and damper, on the chassis")
    spring_seat: Triple = Field(description="lower end of spring and damper, on the lower arm")
    wheel_center: Triple = Field(description="centre of the wheel")

    def geometry_problems(self) -> list[str]:
        coinciding = self.coinciding(_POINTS_OF_BODIES)
        problems = self.coincidence_problems(coinciding)
        # The other checks need the directions that these pairs of points define.
        bad = set(coinciding.values())
        axis = self.steering_axis()
        for body, points in (("lower arm", _LOWER_ARM), ("upper arm", _UPPER_ARM)):
            if body not in bad:
                problems += self.hinge_problems(*points)
        if "tie rod" not in bad:
            problems += self.cross_problems(_TIE_ROD, "tie rod", _UP, "the vertical")
        if axis is not None:
            problems += self._upside_down()
            if "upper arm" not in bad:
                problems += self._dead_centre(axis)
            if not bad & {"knuckle", "tie rod"}:
                problems += self.steering_problems(*self.STEERING_AXIS)
        return problems

    def _upside_down(self) -> list[str]:
        """Return a problem if the upper ball joint is not above the lower one."""
        low, high = map(self.metres, self.STEERING_AXIS)
        rise = number(high[2] - low[2])
        if rise >= SMALLEST_DISTANCE:
            return []
        problem = (
            f"{self.text(*self.STEERING_AXIS)}: the upper ball joint is {1000 * rise:.3f} mm above "
            f"the lower one; at least {1000 * SMALLEST_DISTANCE:g} mm are needed. Swap the arms, "
            "or correct z."
        )
        return [problem]

    def _dead_centre(self, axis: Vector) -> list[str]:
        """Return a problem if the knuckle cannot turn the upper arm."""
        hinge = self.metres("upper_arm_front") - self.metres("upper_arm_rear")
        arm = self.metres("upper_ball_joint") - self.metres("upper_arm_rear")
        lever = abs(number(cross(arm, axis) @ unit_vector(hinge)))
        if lever >= SMALLEST_DISTANCE:
            return []
        problem = (
            f"{self.text(*self.STEERING_AXIS)}: the knuckle pulls the upper arm with a lever of "
            f"{1000 * lever:.3f} mm about its hinge; at least {1000 * SMALLEST_DISTANCE:g} mm are "
            "needed, or the linkage is at its dead centre. Move lower_ball_joint out of the plane "
            "of the upper arm."
        )
        return [problem]


class LowerArm(RigidBody):
    """The lower arm."""

    POINTS: ClassVar[tuple[str, ...]] = _LOWER_ARM


class UpperArm(RigidBody):
    """The upper arm."""

    POINTS: ClassVar[tuple[str, ...]] = _UPPER_ARM


class UprightBody(RigidBody):
    """The knuckle between the ball joints."""

    POINTS: ClassVar[tuple[str, ...]] = DoubleWishboneHardpoints.STEERING_AXIS


class DoubleWishboneBodies(Bodies):
    """All bodies. Tie rod and rack have no mass in the equations of this suspension."""

    MASSLESS: ClassVar[tuple[str, ...]] = ("tie_rod", "rack")

    lower_arm: LowerArm = Field(description="the lower arm")
    upper_arm: UpperArm = Field(description="the upper arm")
    knuckle: UprightBody = Field(description="the knuckle")
    tie_rod: TieRod = Field(
        default=TieRod(mass_kg=0.0), description="the tie rod, whose mass must be 0"
    )
    rack: Rack = Field(default=Rack(mass_kg=0.0), description="the rack, whose mass must be 0")


class DoubleWishbone(CoilSprung):
    """A double wishbone suspension with a tie rod at its design position; see `Suspension`.

    Spring and damper act between the chassis and the lower arm.
    """

    TITLE: ClassVar[str] = "double wishbone suspension"
    NAMES: ClassVar[Names] = Names(
        "arm_angle", "spin_angle", "rack_displacement", "spring_actuator"
    )
    STARTER: ClassVar[str] = "double_wishbone_car"
    STOPPED: ClassVar[str] = "spring"
    PLAIN: ClassVar[ModuleType] = double_wishbone
    GENERAL: ClassVar[ModuleType] = double_wishbone_general
    PAGE: ClassVar[str] = """.

The free length of the spring is given directly (`free_length_mm`) or by the force at the design
position (`force_at_design_N`). Spring and damper are on the lower arm. The damper has a rate or a
curve; the stops depend on its length."""

    suspension: Literal["double_wishbone"] = Field(description="the kind of suspension")
    hardpoints: DoubleWishboneHardpoints = Field(description="the points that define the geometry")
    spring: SpringSection = Field(description="the spring, between chassis and lower arm")
    damper: CoilDamper = Field(description="the damper, on the spring's axis")
    bodies: DoubleWishboneBodies = Field(description="masses and inertia")

    # -- its geometry ---------------------------------------------------------------------------

    def lengths(self) -> dict[str, float]:
        points = self.hardpoints
        arms = {
            f"{ball.removesuffix('_ball_joint')}_arm_length": distance_from_line(
                *(points.metres(name) for name in (ball, *bearings))
            )
            for ball, bearings in points.ARMS.items()
        }
        return arms | {"spring_length": points.distance(*_SPRING)}

    def drawing(self) -> Drawing:
        held = {
            f"{end}_bracket": ("spring_seat", "lower_ball_joint", f"lower_arm_{end}")
            for end in ("front", "rear")
        }
        return Drawing(
            links={
                "lower arm": ("lower_arm_front", "lower_ball_joint", "arm"),
                "upper arm": ("upper_arm_front", "upper_ball_joint", "upper arm"),
                "spring and damper": ("spring_top", "spring_seat", "strut"),
                "tie rod": ("tie_rod_inner", "tie_rod_outer", "rod"),
            },
            knuckle=(
                "tie_rod_outer",
                "lower_ball_joint",
                "upper_ball_joint",
                "wheel_center",
                "lower_ball_joint",
            ),
            legend={"arm": "control arms", "strut": "damper"},
            damper=Axis("spring_seat", "spring_top", 0.5),
            spring=Axis("spring_seat", "spring_top", 0.32),
            upright=self.hardpoints.STEERING_AXIS,
            brackets={name: (place, "spring_seat") for name, place in held.items()},
        )

    # -- its structure --------------------------------------------------------------------------

    def structure(self) -> Structure:
        """Return the joints; spring, damper and stops act between chassis and lower arm."""
        arms = [
            joint
            for ball, bearings in self.hardpoints.ARMS.items()
            for arm in [ball.replace("ball_joint", "arm")]
            for joint in (
                HingeJoint("chassis", arm, bearings),
                SphericalJoint(arm, "knuckle", (ball,)),
            )
        ]
        held = steered(*arms, by=self.steering_gear.TIE_RODS_ON)
        return Structure(held, self._lines("lower_arm"))

    def _lines(self, carrier: str) -> tuple[LineForce, LineForce]:
        """Return spring and damper on one line, between the chassis and a body."""
        ends = ("chassis", carrier, ("spring_top", "spring_seat"))
        damper = (*FORCES_OF_A_DAMPER, self.NAMES.actuator)
        return LineForce("spring", ("spring_force",), *ends), LineForce("damper", damper, *ends)

    # -- its characteristics --------------------------------------------------------------------

    def links_at(self, points: Mapping[str, Array], travel: CarrierMotion) -> tuple[Plane, Plane]:
        """Return the planes of the lower and of the upper arm."""
        lower, upper = (
            Plane(points[ball], cross(points[front] - points[rear], points[ball] - points[rear]))
            for ball, (front, rear) in self.hardpoints.ARMS.items()
        )
        return lower, upper
