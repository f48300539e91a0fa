"""Quantities: name, unit, definition and sign of a number."""

from dataclasses import dataclass, replace
from typing import Any

from ...core.quantities import Display, display_of
from ...core.units import KM_PER_H


@dataclass(frozen=True)
class Quantity:
    """Name, unit, definition and sign of a characteristic."""

    name: str
    units: str  # SI unit; "1" for a pure number
    long_name: str
    definition: str
    sign: str
    display: Display | None = None  # display unit, if it is not the usual one

    def attributes(self) -> dict[str, Any]:
        """Return the attributes of the variable in a dataset."""
        per_length = Display.of("deg/mm") if self.units == "rad/m" else None
        shown = self.display or per_length or display_of({"units": self.units})
        return {
            "units": self.units,
            "long_name": self.long_name,
            "definition": self.definition,
            "sign": self.sign,
            "display_units": shown.units,
            "display_factor": shown.factor,
        }

    def of_wheel(self, wheel: str) -> "Quantity":
        """Return the quantity of one wheel, as a column of a flat table; itself for no wheel."""
        if not wheel:
            return self
        name, words = f"{self.name}_{wheel}", f"{self.long_name}, {wheel.replace('_', ' ')}"
        return replace(self, name=name, long_name=words)


TRAVEL = Quantity("wheel_travel", "m", "wheel travel",
    "height of the wheel centre above its design height",
    "positive in bump")  # fmt: skip
RACK = Quantity("rack_position", "m", "rack displacement",
    "displacement of the rack along its axis from its middle position",
    "positive along the rack's axis")  # fmt: skip
PITMAN_BALL = Quantity(RACK.name, "m", "displacement of the Pitman arm's ball",
    "length of the arc on which the ball of the Pitman arm moves, from its middle position",
    "positive right-handed about the axis of the arm")  # fmt: skip
ROLL = Quantity("roll_angle", "rad", "roll angle",
    "inclination of the line through the wheel centres, which move oppositely, to the plane of the "
    "body's x and y axes, from that at design",
    "positive with the right side down")  # fmt: skip
STEERING_WHEEL = Quantity("steering_wheel_angle", "rad", "steering-wheel angle",
    "angle of the steering wheel from its middle position",
    "positive to the left")  # fmt: skip
HEAVE = Quantity("body_heave", "m", "heave of the body",
    "height of the body above that at design, over wheels that stay",
    "positive up")  # fmt: skip
PITCH = Quantity("body_pitch", "rad", "pitch of the body",
    "turn of the body about the axis to the left, by the travels of its axles over their distance",
    "positive nose down")  # fmt: skip
LATERAL_ACCELERATION = Quantity("lateral_acceleration", "m/s^2", "lateral acceleration",
    "acceleration of the centre of gravity across the heading, in a steady turn on a level road",
    "positive to the left")  # fmt: skip
SPEED = Quantity("speed", "m/s", "speed",
    "of the car along the road",
    "positive forward", Display("km/h", KM_PER_H))  # fmt: skip


def displaced_by(key: str) -> Quantity:
    """Return the displacement that steers, given the key of the section of the steering."""
    return PITMAN_BALL if key == "pitman_arm" else RACK


LEAST_SPEED, GREATEST_SPEED = 1.0, 500.0
"""The range of the speed of a simulation [km/h]: others are mistakes, such as of units."""
