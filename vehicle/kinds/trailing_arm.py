"""The trailing arm: the wheel carrier has one hinge on the chassis, and is not steered."""

from collections.abc import Mapping
from types import ModuleType
from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from ...core.columns import length, number
from ...core.named_types import Array
from ...core.vectors import angle_between_lines, cross, distance_from_line
from ...generated import trailing_arm
from ..corner.base import Names
from ..corner.coil_sprung import ApartDamper, CoilSprung
from ..corner.corner import CarrierMotion, Plane
from ..corner.drawing import Axis, Drawing
from ..corner.structure import (
    FORCES_OF_A_DAMPER,
    FixedJoint,
    HingeJoint,
    LineForce,
    Structure,
    frame,
)
from ..input.bodies import Bodies, RigidBody
from ..input.hardpoints import SMALLEST_DISTANCE, Hardpoints, Pair
from ..input.section import Triple
from ..input.spring import SpringSection

_BEARINGS = ("arm_inner", "arm_outer")
_ARM = (*_BEARINGS, "wheel_center")

# Least angle of the hinge to the vertical [deg].
_SMALLEST_HINGE_ANGLE = 1.0


class TrailingArmHardpoints(Hardpoints):
    """The points that define a trailing arm, at the design position.

    The wheel swings about the line through the two bearings: a lateral line makes a trailing arm,
    an oblique one a semi-trailing arm. All points are in chassis axes (ISO 8855: x forward, y left,
    z up), in the unit that `unit` names.
    """

    CARRIERS: ClassVar[Mapping[str, str]] = {
        "wheel_center": "trailing_arm",
        "spring_seat": "trailing_arm",
        "damper_seat": "trailing_arm",
    }
    ARMS: ClassVar[Mapping[str, Pair]] = {"wheel_center": _BEARINGS}
    STEERING_AXIS: ClassVar[Pair | None] = None
    JOINTS: ClassVar[tuple[str, ...]] = ("spring_seat", "damper_seat")

    arm_inner: Triple = Field(description="inner bearing of the arm on the chassis")
    arm_outer: Triple = Field(description="outer bearing of the arm on the chassis")
    spring_top: Triple = Field(description="upper end of the spring, on the chassis")
    spring_seat: Triple = Field(description="lower end of the spring, on the arm")
    damper_top: Triple = Field(description="upper end of the damper, on the chassis")
    damper_seat: Triple = Field(description="lower end of the damper, on the arm")
    wheel_center: Triple = Field(description="centre of the wheel")

    def geometry_problems(self) -> list[str]:
        bodies: dict[str, tuple[str, ...]] = {
            "arm": _ARM,
            "spring": ("spring_seat", "spring_top"),
            "damper": ("damper_seat", "damper_top"),
        }
        problems = self.coincidence_problems(self.coinciding(bodies))
        return problems or self._of_hinge()

    def _of_hinge(self) -> list[str]:
        """Return a problem if the arm cannot move the wheel up and down."""
        inner, outer, center = map(self.metres, _ARM)
        lever = distance_from_line(center, inner, outer)
        if lever < SMALLEST_DISTANCE:
            problem = (
                f"{self.text('wheel_center')} lies {1000 * lever:.3f} mm from the hinge axis "
                f"through {' and '.join(_BEARINGS)}; at least {1000 * SMALLEST_DISTANCE:g} mm are "
                "needed for the arm to move the wheel. Correct one of the three."
            )
            return [problem]
        tilt = angle_between_lines(outer - inner, np.array([0.0, 0.0, 1.0]))
        if tilt < _SMALLEST_HINGE_ANGLE:
            problem = (
                f"{self.text(*_BEARINGS)}: the hinge axis is {tilt:.3f} deg from the vertical; at "
                f"least {_SMALLEST_HINGE_ANGLE:g} deg are needed for the arm to swing up and down. "
                "Move one of the bearings."
            )
            return [problem]
        # the vertical velocity of the wheel centre per rotation about the axis
        rise = number(cross(outer - inner, center - inner)[2]) / length(outer - inner)
        if abs(rise) >= SMALLEST_DISTANCE:
            return []
        problem = (
            f"{self.text(*_ARM)}: the arm lifts the wheel with a lever of {1000 * abs(rise):.3f} "
            f"mm; at least {1000 * SMALLEST_DISTANCE:g} mm are needed, or the arm is at its dead "
            "centre. Move wheel_center away from above or below the hinge axis."
        )
        return [problem]


class TrailingArmBody(RigidBody):
    """The arm, which carries the wheel."""

    POINTS: ClassVar[tuple[str, ...]] = _ARM


class TrailingArmBodies(Bodies):
    """All bodies: the arm and the wheel."""

    trailing_arm: TrailingArmBody = Field(description="the arm, which carries the wheel")


class TrailingArm(CoilSprung):
    """A trailing or semi-trailing arm at its design position; see `Suspension`.

    One hinge on the chassis; spring and damper act between the chassis and the arm, each with its
    own ends. Nothing steers the wheel.
    """

    TITLE: ClassVar[str] = "trailing-arm suspension"
    NAMES: ClassVar[Names] = Names("arm_angle", "spin_angle", "", "spring_actuator")
    GENERAL: ClassVar[ModuleType] = trailing_arm
    ADDITION: ClassVar[str] = "trailing arm"
    STARTER: ClassVar[str] = "trailing_arm_car"
    STOPPED: ClassVar[str] = "damper"
    PAGE: ClassVar[str] = """: an arm on one hinge, which carries the wheel.

The wheel swings about the line through `arm_inner` and `arm_outer`. A line across the car makes a
trailing arm, an oblique line a semi-trailing arm. The file has no tie rod and no `[rack]`;
characteristics of steered wheels are left out or an error. Spring and damper act on the arm, each
with its own ends. The free length of the spring is given directly (`free_length_mm`) or by the
force at the design position (`force_at_design_N`). The stops depend on the length of the damper."""

    suspension: Literal["trailing_arm"] = Field(description="the kind of suspension")
    hardpoints: TrailingArmHardpoints = Field(description="the points that define the geometry")
    # not sections of the file; code that needs them asks `steered` first
    rack: ClassVar[None] = None  # type: ignore[misc] # a field of the base
    pitman_arm: ClassVar[None] = None  # type: ignore[misc] # a field of the base
    spring: SpringSection = Field(description="the spring, between chassis and arm")
    damper: ApartDamper = Field(description="the damper, between chassis and arm")
    bodies: TrailingArmBodies = Field(description="masses and inertia")

    # -- its geometry ---------------------------------------------------------------------------

    def lengths(self) -> dict[str, float]:
        points = self.hardpoints
        inner, outer, center = map(points.metres, _ARM)
        return {
            "arm_length": distance_from_line(center, inner, outer),
            "spring_length": points.distance("spring_seat", "spring_top"),
            "damper_length": points.distance("damper_seat", "damper_top"),
        }

    def drawing(self) -> Drawing:
        return Drawing(
            links={
                "arm": ("arm_inner", "wheel_center", "arm"),
                "spring": ("spring_top", "spring_seat", "strut"),
                "damper": ("damper_top", "damper_seat", "strut"),
            },
            knuckle=("arm_inner", "arm_outer", "wheel_center"),
            legend={"arm": "arm", "strut": "damper", "knuckle": "hub carrier"},
            damper=Axis("damper_seat", "damper_top", 0.5),
            spring=Axis("spring_seat", "spring_top", 0.0),
            upright=(("wheel_center", *_BEARINGS), "arm_outer"),
            brackets={
                f"{name}_bracket": ((f"{name}_seat", "wheel_center", "arm_inner"), f"{name}_seat")
                for name in ("spring", "damper")
            },
        )

    # -- its structure --------------------------------------------------------------------------

    def structure(self) -> Structure:
        ends = ("chassis", "trailing_arm")
        signals = ("spring_force", self.NAMES.actuator)
        joints = (
            HingeJoint(*ends, _BEARINGS),
            FixedJoint("trailing_arm", "wheel", ("wheel_center",)),
        )
        lines = (
            LineForce("spring", signals, *ends, ("spring_top", "spring_seat")),
            LineForce("damper", FORCES_OF_A_DAMPER, *ends, ("damper_top", "damper_seat")),
        )
        return Structure(joints, lines)

    # -- its characteristics --------------------------------------------------------------------

    def links_at(self, points: Mapping[str, Array], travel: CarrierMotion) -> tuple[Plane, Plane]:
        """Return two planes through the hinge, about which the arm turns."""
        inner, outer = (points[name] for name in _BEARINGS)
        _, across, other = frame(outer - inner)
        return Plane(inner, across), Plane(inner, other)
