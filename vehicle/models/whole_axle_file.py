"""The sections of the files of all axles without sides."""

from collections.abc import Mapping
from typing import ClassVar

from pydantic import Field

from ..input.hardpoints import Hardpoints, Pair
from ..input.section import Positive, Section, Triple
from ..input.vehicle import Share
from .axle.file import Drive, TorqueReaction


class WholeAxleVehicle(Section):
    """Data of the whole vehicle for the characteristics of the axle."""

    wheelbase_mm: Positive | None = Field(
        default=None, description="distance of front and rear wheel centres along x"
    )
    center_of_gravity_height_mm: Positive | None = Field(
        default=None, description="height of the whole vehicle's centre of gravity above the ground"
    )
    front_brake_share: Share | None = Field(
        default=None, description="fraction of the braking force at the front wheels"
    )


class WholeAxleHardpoints(Hardpoints):
    """The points of the right side at the design position; the left one is its mirror image.

    All points are in chassis axes (ISO 8855: x forward, y left, z up), in the unit that `unit`
    names, which is that of all points of the file.
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
        return self.coincidence_problems(
            self.coinciding(
                {name: (f"{name}_seat", f"{name}_top") for name in ("spring", "damper")}
            )
        )


class AxleDrive(Drive):
    """The drive of the axle."""

    torque_on: TorqueReaction = Field(
        default="carrier",
        description='"carrier": the axle reacts the torque, with a final drive in it or motors at '
        'the wheels; "body": the final drive is on the chassis, and shafts lead to the wheels (de '
        "Dion)",
    )
