"""The sections of a steered rigid axle's file."""

from typing import ClassVar, Literal

from pydantic import Field

from ...input.bodies import RigidBody
from ...input.section import Section, Triple
from ..rigid_axle.file import RigidAxleBodies
from ..whole_axle_file import WholeAxleHardpoints

LOWER, UPPER, TRACK_ROD = "kingpin_lower", "kingpin_upper", "track_rod"


class SteeredHardpoints(WholeAxleHardpoints):
    """The points of the right side at the design position; the left one is its mirror image.

    All points are in chassis axes (ISO 8855: x forward, y left, z up), in the unit that `unit`
    names, which is that of all points of the file.
    """

    AXIS_NAME: ClassVar[str] = "kingpin"

    kingpin_lower: Triple = Field(description="lower point of the kingpin's axis, on the axle")
    kingpin_upper: Triple = Field(description="upper point of the kingpin's axis, on the axle")
    track_rod: Triple = Field(description="end of the track rod at the right knuckle")

    def geometry_problems(self) -> list[str]:
        problems = super().geometry_problems() + self.coincidence_problems(
            self.coinciding({"kingpin": (LOWER, UPPER)})
        )
        if not problems and self.metres(UPPER)[2] <= self.metres(LOWER)[2]:
            problems.append(f"{self.text(LOWER, UPPER)}: the upper point is not above the lower "
                            "one. Swap the two, or correct z.")  # fmt: skip
        return problems


class DragLinkSection(Section):
    """The drag link: a rod from the ball of the Pitman arm to one knuckle."""

    side: Literal["left", "right"] = Field(
        description='the knuckle to which it is joined, "left" or "right"'
    )
    knuckle: Triple = Field(description="its end on this knuckle, in the unit of [hardpoints]")


class KnuckleBody(RigidBody):
    """The right knuckle with hub carrier, brake and arms; the left one is its mirror image."""

    POINTS: ClassVar[tuple[str, ...]] = (LOWER, UPPER)


class SteeredRigidAxleBodies(RigidAxleBodies):
    """The bodies; rods, drag link, track rod and Pitman arm have no mass."""

    knuckle: KnuckleBody = Field(description="the right knuckle with hub carrier and brake")
