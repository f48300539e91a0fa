"""The sections of vehicle, wheel, tyre, steering rack and gravity."""

from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field

from ...core.columns import radians, tan
from ...core.vectors import Vector, components, unit_vector
from .places import reverse
from .section import (
    Flag,
    NonNegative,
    Number,
    Positive,
    Remedy,
    Section,
    Triple,
    without_direction,
)
from .units import in_metres

Angle = Annotated[
    Number,
    Field(ge=-45.0, le=45.0),
    Remedy("Enter the angle at design in degrees, with the sign that the file states."),
]


Share = Annotated[
    Number, Field(ge=0.0, le=1.0), Remedy("Enter the part of the whole: 0.7 for 70 %.")
]


class VehicleSection(Section):
    """The side of the suspension, and data of the whole vehicle for its characteristics.

    Only the side enters the equations of motion.
    """

    side: Literal["left", "right"] = Field(description="the vehicle's side, left or right")
    end: Literal["front", "rear"] | None = Field(
        default=None, description="the vehicle's end, front or rear; front by default"
    )
    wheelbase_mm: Positive | None = Field(
        default=None, description="distance of front and rear wheel centres along x"
    )
    center_of_gravity_height_mm: Positive | None = Field(
        default=None, description="height of the whole vehicle's centre of gravity above the ground"
    )
    front_brake_share: Share | None = Field(
        default=None, description="fraction of the braking force at the front wheels"
    )

    @property
    def sign(self) -> float:
        """The sign of y at the wheel: +1 left, -1 right."""
        return 1.0 if self.side == "left" else -1.0


class WheelSection(Section):
    """Alignment of the wheel at the design position.

    Camber is positive with the wheel's top outboard, toe is positive with its front inboard.
    """

    camber_deg: Angle = Field(description="camber at design, positive with the top outboard")
    toe_deg: Angle = Field(description="toe at design, positive toe-in")

    def spin_axis(self, side_sign: float) -> Vector:
        """Return the unit vector of the spin axis that points left at zero camber and toe.

        `side_sign` is +1 for a left, -1 for a right suspension.
        """
        # The unit vector n that points outboard has camber = atan2(-n_z, s n_y) and
        # toe = atan2(n_x, s n_y), hence n ~ (tan toe, s, -tan camber); the spin axis is s n.
        toe, camber = radians(self.toe_deg), radians(self.camber_deg)
        return unit_vector([side_sign * tan(toe), 1.0, -side_sign * tan(camber)]) + 0.0


class TyreSection(Section):
    """The tyre as a radial spring and damper in the wheel plane, which may leave the road."""

    rate_N_per_m: NonNegative = Field(  # noqa: N815 (N is the newton)
        description="rate of the tyre"
    )
    free_height_mm: Number = Field(description="z of wheel_center at which the tyre force is zero")
    radius_mm: Positive | None = Field(
        default=None,
        description="radius of the wheel as a thin disc that touches the ground; for "
        "characteristics, loads and compliance; by default the height of wheel_center above z = 0",
    )
    lateral_rate_N_per_m: Positive | None = Field(  # noqa: N815 (N is the newton)
        default=None, description="lateral rate of the stationary tyre; only for compliance"
    )
    longitudinal_rate_N_per_m: Positive | None = Field(  # noqa: N815 (N is the newton)
        default=None, description="longitudinal rate of the stationary tyre; only for compliance"
    )
    damper_rate_N_s_per_m: NonNegative = Field(  # noqa: N815 (N is the newton)
        default=0.0, description="radial damping of the tyre"
    )
    lifts_off: Flag = Field(
        default=False,
        description="true: the tyre can leave the road; false, as in the paper: it can pull at the "
        "road",
    )

    def parameters(self) -> dict[str, float]:
        """Return the rate [N/m] and the free height [m] by the names in the equations."""
        return {
            "tyre_rate": self.rate_N_per_m,
            "tyre_free_height": in_metres(self.free_height_mm, "mm"),
        }


class Steering(Section):
    """The steering rack."""

    WORDS: ClassVar[str] = "on one rack"
    """How both wheels of an axle are steered."""
    TURN_KEY: ClassVar[str] = "[rack] travel_per_turn_mm"
    """The key of its travel for one turn of the steering wheel."""
    TIE_RODS_ON: ClassVar[str] = "rack"
    """The part that the tie rods are joined to."""
    MOVED: ClassVar[tuple[str, ...]] = ()
    """Points of the steering that this part carries."""

    axis: Triple = Field(description="direction in which the rack moves for positive displacement")
    travel_per_turn_mm: Positive | None = Field(
        default=None, description="rack travel for one turn of the steering wheel"
    )

    def problems(self) -> list[str]:
        remedy = "Enter [0.0, 1.0, 0.0] for a rack that moves to the left."
        return without_direction({"axis": self.axis}, remedy)

    def direction(self) -> Vector:
        """Return the direction of positive displacement, a unit vector."""
        return unit_vector(self.axis)

    def travel_per_turn(self) -> float | None:
        """Return the travel for one turn of the steering wheel [m]; None if it is not given."""
        given = self.travel_per_turn_mm
        return None if given is None else in_metres(given, "mm")

    @staticmethod
    def points() -> dict[str, Vector]:
        """Return no points besides the hardpoints."""
        return {}

    @staticmethod
    def centers_of_mass() -> dict[str, Vector]:
        """Return no bodies besides those of the file."""
        return {}

    def parameters(self) -> dict[str, float]:
        """Return the direction by its names in the equations."""
        return components("rack_axis", self.direction())

    @staticmethod
    def mirror(data: dict[str, Any]) -> None:
        """Turn the section over for the other side of the vehicle, the sense kept.

        The mirror image of (x, y, z) is (x, -y, z), which with the sense kept is (-x, y, -z).
        """
        reverse(data["axis"], 0)
        reverse(data["axis"], 2)


class GravitySection(Section):
    """Gravity, which acts downward (-z)."""

    acceleration_m_per_s2: NonNegative = Field(description="acceleration of free fall")
