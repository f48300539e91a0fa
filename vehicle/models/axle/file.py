"""The sections of an axle's file."""

from typing import Annotated, Any, Literal

from pydantic import Field, WithJsonSchema

from ...input.section import Section
from ...input.vehicle import Share
from .bar import AntiRollBar
from .steering import SteeringCurve

End = Literal["front", "rear"]
TorqueReaction = Literal["body", "carrier"]

SECTIONS_OF_SIDES = ("side", "right", "left")

# The type in a file; from Python a side may also be a suspension, or the sections of its file.
_BY_NAME = WithJsonSchema({"type": "string"})
_SIDE = "hardpoint file beside this one, or the name of a packaged data set: "


class Torque(Section):
    """The part that reacts the torque of brakes or drive."""

    torque_on: TorqueReaction = Field(
        description='"carrier": the wheel carrier reacts the torque, as with brakes or a motor at '
        'the wheel; "body": the chassis reacts it, behind a shaft'
    )


class Brakes(Torque):
    """The brakes of the axle; ``front_brake_share`` in the side's file is their share."""

    torque_on: TorqueReaction = Field(
        default="carrier",
        description='"carrier": brakes at the wheel; "body": inboard brakes, behind a shaft',
    )


class Drive(Torque):
    """The drive of the axle."""

    torque_on: TorqueReaction = Field(
        default="body",
        description='"body": the final drive is on the chassis, a shaft leads to the wheel; '
        '"carrier": a motor at the wheel',
    )
    share: Share = Field(description="fraction of the driving force at the wheels of this axle")


class AxleFile(Section):
    """The sections of an axle's file; `Axle` has the suspensions that are named here."""

    axle: End = Field(description='where the axle is: "front" or "rear"')
    side: Annotated[
        Any,
        Field(description=_SIDE + "one side; the other is its mirror image"),
        _BY_NAME,
    ] = None
    right: Annotated[Any, Field(description=_SIDE + "the right side"), _BY_NAME] = None
    left: Annotated[Any, Field(description=_SIDE + "the left side"), _BY_NAME] = None
    anti_roll_bar: AntiRollBar | None = Field(default=None, description="the anti-roll bar")
    steering: SteeringCurve | None = Field(
        default=None,
        description="the rack over the angle of the steering wheel, instead of travel_per_turn_mm",
    )
    brakes: Brakes = Field(default=Brakes(), description="reaction of the brake torque")
    drive: Drive | None = Field(default=None, description="the drive of the axle")

    def problems(self) -> list[str]:
        given = [name for name in SECTIONS_OF_SIDES if getattr(self, name) is not None]
        if given in (["side"], ["right", "left"]):
            return []
        problem = (
            f"{' and '.join(given) or 'no side is'} given: an axle needs `side`, a hardpoint file "
            "of one side whose mirror image is the other, or both `right` and `left`."
        )
        return [problem]
