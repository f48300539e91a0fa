"""The sections of a car's file."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal, get_args

import numpy as np
from pydantic import Field, WithJsonSchema

from ....core.legible import legible
from ....core.vectors import Vector
from ...input.bodies import RigidBody
from ...input.hardpoints import Hardpoints
from ...input.section import Number, Positive, Section, Triple
from ...input.units import point_in_metres
from .driving import Air, CarBrakes, CarTyres, SteeringColumn

Freedoms = Literal["heave", "ride", "roll", "full"]

COORDINATES: Mapping[str, tuple[str, ...]] = {
    "heave": ("heave",),
    "ride": ("heave", "pitch"),
    "roll": ("heave", "pitch", "roll"),
    "full": ("heave", "pitch", "roll", "yaw", "forward", "sideways"),
}
"""The coordinates of the body by their name in a file; those of "full" only describe its motion."""

ENDS = ("front", "rear")

OF_DRIVING = ("tyres", "steering_column", "brakes", "air")
"""Sections that only a driving car uses."""

# The type in a file; from Python it may also be an object, or the sections of its file.
_BY_NAME = WithJsonSchema({"type": "string"})
_FILE = "file beside this one, or the name of a packaged data set: "
_OF_A_SEAT = (
    'the name of a seat may have letters, digits and _, and must not be "body", which is the name '
    "of the acceleration of the centre of mass. Rename it."
)
# The moment of inertia about the axis of each rotation of the body.
_INERTIA = {"pitch": "yy", "roll": "xx", "yaw": "zz"}


class CarBody(RigidBody):
    """The body of a car with all that is fixed to it: the sprung mass."""

    mass_kg: Positive = Field(description="mass of the body, without axles and wheels")
    com_mm: Triple | None = Field(
        default=None, description="centre of mass at design; required, except for a quarter car"
    )

    def default_centre_of_mass(self, points: Hardpoints) -> Vector:
        """Return the origin: a quarter car, which only heaves, has no use for the point."""
        return np.zeros(3)

    def problems_with(self, coordinates: tuple[str, ...]) -> list[str]:
        """Return the missing data for coordinates of the body."""
        turning = [f"inertia_{_INERTIA[name]}_kg_m2" for name in coordinates if name in _INERTIA]
        missing = [
            f"{key} = {getattr(self, key):g} kg m^2: more than 0 kg m^2 is needed for a body that "
            "turns. Enter its moment of inertia about the centre of mass."
            for key in turning
            if getattr(self, key) <= 0.0
        ]
        if turning and self.com_mm is None:
            missing.append("com_mm is missing: the centre of mass. Add a line `com_mm = ...`.")
        return missing


class Seat(Section):
    """A point of the body at which the ride acceleration is evaluated."""

    place_mm: Triple = Field(description="position at design, axes of the car")


class CarFile(Section):
    """The sections of a car's file; `Car` has the axles that are named here."""

    car: Freedoms = Field(
        description='how its body moves: "heave" (a quarter car), "ride" (heave and pitch), "roll" '
        '(heave, pitch and roll), "full" (freely: the car drives)'
    )
    corner: Annotated[
        Any, Field(description=_FILE + "the suspension of a quarter car"), _BY_NAME
    ] = None
    front: Annotated[Any, Field(description=_FILE + "the front axle"), _BY_NAME] = None
    rear: Annotated[Any, Field(description=_FILE + "the rear axle"), _BY_NAME] = None
    wheelbase_mm: Positive | None = Field(
        default=None, description="distance of front and rear wheel centres along x"
    )
    rear_origin_mm: Number = Field(
        default=0.0,
        description="x of the origin of the rear axle's axes, in the axes of the car, which are "
        "those of the front axle",
    )
    body: CarBody = Field(description="the body")
    tyres: CarTyres | None = Field(default=None, description="the tyres of a car that drives")
    steering_column: SteeringColumn | None = Field(
        default=None,
        description="compliance and friction of the steering of a car that drives; by default the "
        "rack follows the steering wheel",
    )
    brakes: CarBrakes | None = Field(default=None, description="the brakes of a car that drives")
    air: Air | None = Field(default=None, description="drag and lift of a car that drives")
    seats: dict[str, Seat] = Field(
        default_factory=dict,
        description="points of the body at which the ride acceleration is evaluated, by name",
    )

    @property
    def coordinates(self) -> tuple[str, ...]:
        """The coordinates of the body."""
        return COORDINATES[self.car]

    @property
    def drives(self) -> bool:
        """Whether its body moves freely, on rolling tyres."""
        return self.car == "full"

    def problems(self) -> list[str]:
        """Return missing keys, and keys that a quarter car does not have."""
        of_axles = ("front", "rear", "wheelbase_mm")
        given = [key for key in (*of_axles, "corner") if getattr(self, key) is not None]
        needed = of_axles if len(self.coordinates) > 1 else ("corner",)
        problems = [
            f'{key} is missing: car = "{self.car}" needs {" and ".join(needed)}. Add a line '
            f"`{key} = ...`."
            for key in needed
            if key not in given
        ]
        others = " or ".join(f'"{word}"' for word in get_args(Freedoms)[1:])
        belongs = {"corner": 'a quarter car, car = "heave"'} | dict.fromkeys(
            of_axles, f"a car with two axles, car = {others}"
        )
        problems += [
            f"{key} is given, which is a key of {belongs[key]}. Remove that line, or change `car`."
            for key in given
            if key not in needed
        ]
        if "rear" not in needed and self.rear_origin_mm:
            problems.append("rear_origin_mm is given, and a quarter car has no rear. Remove it.")
        if self.drives and self.tyres is None:
            problems.append(
                "[tyres] is missing: a car that drives rolls on them. Add that section with "
                '`front = "passenger_205_55"` and `rear = ...`.'
            )
        problems += [
            f"[seats.{legible(name)}]: {_OF_A_SEAT}"
            for name in self.seats
            if not name.isidentifier() or name == "body"
        ]
        return problems + [
            f"[body] {problem}" for problem in self.body.problems_with(self.coordinates)
        ]

    def seat_places(self) -> dict[str, Vector]:
        """Return the positions of the seats [m]."""
        return {name: point_in_metres(seat.place_mm, "mm") for name, seat in self.seats.items()}
