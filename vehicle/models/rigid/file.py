"""The sections of a rigid axle's file."""

from collections.abc import Mapping
from typing import Annotated, ClassVar

from pydantic import Field

from ....core.vectors import Vector
from ...corner.coil_sprung import CoilDamper
from ...input.bodies import Bodies, RigidBody
from ...input.hardpoints import Hardpoints, Pair
from ...input.section import Number, Positive, Range, Section, Triple
from ...input.vehicle import Share
from ..axle.file import Drive, TorqueReaction

_Rate = Annotated[
    Number,
    Field(gt=0.0, le=1e5),
    Range("more than 0 {unit}, at most 100,000 {unit}", "Check the unit of the value."),
]


class RigidAxleVehicle(Section):
    """What the whole vehicle adds to the characteristics of the axle."""

    wheelbase_mm: Positive | None = Field(
        default=None, description="distance of front and rear wheel centres along x"
    )
    center_of_gravity_height_mm: Positive | None = Field(
        default=None, description="height of the whole vehicle's centre of gravity above the ground"
    )
    front_brake_share: Share | None = Field(
        default=None, description="part of the braking force that acts at the front wheels"
    )


class RigidAxleHardpoints(Hardpoints):
    """The points of the right side at the design position; the left one is its mirror image.

    All points are in chassis axes (ISO 8855: x forward, y left, z up), in the unit that `unit`
    names, which is that of the rods, too.
    """

    CARRIERS: ClassVar[Mapping[str, str]] = {}
    ARMS: ClassVar[Mapping[str, Pair]] = {}
    STEERING_AXIS: ClassVar[Pair | None] = None
    JOINTS: ClassVar[tuple[str, ...]] = ()

    wheel_center: Triple = Field(description="centre of the right wheel")
    spring_top: Triple = Field(description="upper end of the spring, on the chassis")
    spring_seat: Triple = Field(description="lower end of the spring, on the axle")
    damper_top: Triple = Field(description="upper end of the damper, on the chassis")
    damper_seat: Triple = Field(description="lower end of the damper, on the axle")

    def geometry_problems(self) -> list[str]:
        """Say which points of a spring or a damper are one."""
        return self.coincidence_problems(
            self.coinciding(
                {name: (f"{name}_seat", f"{name}_top") for name in ("spring", "damper")}
            )
        )


class LeftHardpoints(Section):
    """What of the left side is not the mirror image of the right one, such as staggered dampers.

    In the unit of ``[hardpoints]``, with the y of the left side.
    """

    spring_top: Triple | None = Field(default=None, description="as of the right side")
    spring_seat: Triple | None = Field(default=None, description="as of the right side")
    damper_top: Triple | None = Field(default=None, description="as of the right side")
    damper_seat: Triple | None = Field(default=None, description="as of the right side")


class Rod(Section):
    """A rod of fixed length: a link, or a Panhard rod."""

    chassis: Triple = Field(description="its end on the chassis, in the unit of [hardpoints]")
    axle: Triple = Field(description="its end on the axle")


class AxleDamper(CoilDamper):
    """The damper, between the chassis and the axle.

    It has a rate, or a curve through measured points: velocities are positive in bump, forces where
    they resist bump (see `input.damper.Damper`). Its friction is ``friction v / sqrt(v^2 +
    friction_velocity^2)``.
    """

    ENDS: ClassVar[Pair] = ("damper_seat", "damper_top")

    length_min_mm: Positive | None = Field(
        default=None,
        description="distance of damper_seat and damper_top with the damper pressed in as far as "
        "it goes; no position beyond it is returned",
    )


class RollBar(Section):
    """An anti-roll bar, by what it does to the axle."""

    rate_Nm_per_deg: _Rate = Field(  # noqa: N815 (N is the newton)
        description="moment on the axle for a roll of it against the body"
    )


class AxleDrive(Drive):
    """What drives the axle."""

    torque_on: TorqueReaction = Field(
        default="carrier",
        description='"carrier": the final drive is in the axle, which holds the torque; "body": it '
        "is on the chassis, and shafts lead to the wheels (de Dion)",
    )


class Beam(RigidBody):
    """The axle without its wheels."""

    def default_centre_of_mass(self, points: Hardpoints) -> Vector:
        """Return the middle between the wheels, in m."""
        middle: Vector = points.metres("wheel_center") * [1.0, 0.0, 1.0]
        return middle


class RigidAxleBodies(Bodies):
    """The bodies; rods have no mass: add half of each to the axle."""

    beam: Beam = Field(description="the axle with hubs, brakes and, if it has one, its final drive")
