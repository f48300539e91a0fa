"""The sections of a rigid axle's file."""

from typing import Annotated

from pydantic import Field

from ....core.vectors import Vector
from ...input.bodies import Bodies, RigidBody
from ...input.hardpoints import Hardpoints
from ...input.section import CHECK_UNIT, Number, Section, Triple

_Rate = Annotated[Number, Field(gt=0.0, le=1e5), CHECK_UNIT]


class LeftHardpoints(Section):
    """Points of the left side without a mirror image on the right, such as staggered dampers.

    In the unit of ``[hardpoints]``, with the y of the left side.
    """

    spring_top: Triple | None = Field(
        default=None, description="as for the right side, by default its mirror image"
    )
    spring_seat: Triple | None = Field(
        default=None, description="as for the right side, by default its mirror image"
    )
    damper_top: Triple | None = Field(
        default=None, description="as for the right side, by default its mirror image"
    )
    damper_seat: Triple | None = Field(
        default=None, description="as for the right side, by default its mirror image"
    )


class RodSection(Section):
    """A rod of fixed length: a link, or a Panhard rod."""

    chassis: Triple = Field(description="its end on the chassis, in the unit of [hardpoints]")
    axle: Triple = Field(description="its end on the axle")


class RollBarSection(Section):
    """An anti-roll bar, by its rate at the axle."""

    rate_Nm_per_deg: _Rate = Field(  # noqa: N815 (N is the newton)
        description="moment on the axle per roll relative to the body"
    )


class Beam(RigidBody):
    """The axle without its wheels."""

    def default_centre_of_mass(self, points: Hardpoints) -> Vector:
        """Return the middle between the wheels, in m."""
        return points.metres("wheel_center") * [1.0, 0.0, 1.0]


class RigidAxleBodies(Bodies):
    """The bodies; rods have no mass: add half of each to the axle."""

    beam: Beam = Field(description="the axle with hubs, brakes and, if it has one, its final drive")
