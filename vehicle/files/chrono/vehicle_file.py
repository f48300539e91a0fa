"""The template WheeledVehicle: the parts of a whole vehicle, and their positions."""

from collections.abc import Iterator
from pathlib import Path, PureWindowsPath
from typing import Any, ClassVar, Literal

from pydantic import Field

from ....core.errors import InputError
from ....core.legible import legible, short
from ...input.commented_json import content
from .keys import Part
from .parts import Finite, Point

_AXLES = 2
_ABOVE = 6  # folders above a file in which others are searched
_SHOWN = 6


class _NamedFile(Part):
    file: str = Field(alias="Input File")


class SteeringPlace(_NamedFile):
    """A steering subsystem, and its position."""

    UNREAD: ClassVar[frozenset[str]] = frozenset({"Output"})

    location: Point = Field(alias="Location")
    orientation: tuple[Finite, Finite, Finite, Finite] = Field(alias="Orientation")
    chassis: int = Field(default=-1, strict=True, alias="Chassis Index")


class AxlePlace(Part):
    """The parts of an axle, and their positions."""

    UNREAD: ClassVar[frozenset[str]] = frozenset({"Output"})

    suspension: str = Field(alias="Suspension Input File")
    location: Point = Field(alias="Suspension Location")
    steering: int | None = Field(default=None, strict=True, alias="Steering Index")
    chassis: int = Field(default=-1, strict=True, alias="Chassis Index")
    subchassis: int | None = Field(default=None, strict=True, alias="Subchassis Index")
    bar: str | None = Field(default=None, alias="Antirollbar Input File")
    bar_location: Point = Field(default=(0.0, 0.0, 0.0), alias="Antirollbar Location")
    apart: Finite | None = Field(default=None, alias="Wheel Separation")
    left_wheel: str | None = Field(default=None, alias="Left Wheel Input File")
    right_wheel: str | None = Field(default=None, alias="Right Wheel Input File")
    left_brake: str | None = Field(default=None, alias="Left Brake Input File")
    right_brake: str | None = Field(default=None, alias="Right Brake Input File")
    tire: str | None = Field(default=None, alias="Tire Input File")


class DrivelinePlace(_NamedFile):
    """The driveline, and the axles that it drives."""

    UNREAD: ClassVar[frozenset[str]] = frozenset({"Output"})

    driven: tuple[int, ...] = Field(alias="Suspension Indexes")


class VehicleFile(Part):
    """The file of a wheeled vehicle."""

    UNREAD: ClassVar[frozenset[str]] = frozenset({"Name"})

    type: Literal["Vehicle"] = Field(alias="Type")
    template: Literal["WheeledVehicle"] = Field(alias="Template")
    chassis: _NamedFile = Field(alias="Chassis")
    rear_chassis: tuple[Any, ...] = Field(default=(), alias="Rear Chassis")
    subchassis: tuple[Any, ...] = Field(default=(), alias="Subchassis")
    axles: tuple[AxlePlace, ...] = Field(alias="Axles")
    steerings: tuple[SteeringPlace, ...] = Field(default=(), alias="Steering Subsystems")
    wheelbase: Finite | None = Field(default=None, alias="Wheelbase")
    driveline: DrivelinePlace | None = Field(default=None, alias="Driveline")

    def problems(self) -> list[str]:
        """Return the problems of vehicles other than one body on two axles."""
        lines = [
            f'"{key}": a vehicle of more than one body on its axles cannot be read.'
            for key, given in (("Rear Chassis", self.rear_chassis), ("Subchassis", self.subchassis))
            if given
        ]
        if len(self.axles) != _AXLES:
            lines.append(f'"Axles": {len(self.axles)} axles; {_AXLES} can be read.')
            return lines
        for end, axle in zip(("front", "rear"), self.axles, strict=True):
            lines += _problems_of_axle(end, axle)
        front, rear = self.axles
        if rear.steering is not None:
            lines.append('"Axles > Steering Index" of the rear axle: only the front one can steer.')
        if front.steering is not None and not 0 <= front.steering < len(self.steerings):
            lines.append(
                f'"Axles > Steering Index" = {front.steering} of {len(self.steerings)} "Steering '
                'Subsystems"; the first has the index 0.'
            )
        return lines


def _problems_of_axle(end: str, axle: AxlePlace) -> Iterator[str]:
    if axle.apart is not None:
        yield f'"Axles > Wheel Separation" of the {end} axle: double wheels cannot be read.'
    elif axle.left_wheel != axle.right_wheel:
        yield f'"Left Wheel Input File" and "Right ..." of the {end} axle are not the same.'
    elif axle.left_wheel is None:
        yield f'"Left Wheel Input File" of the {end} axle is missing.'
    if axle.left_brake != axle.right_brake:
        yield f'"Left Brake Input File" and "Right ..." of the {end} axle are not the same.'
    if axle.location[1] or axle.bar_location[1]:
        yield f'"... Location" of the {end} axle: y must be 0, the middle of the vehicle.'


class Folder:
    """The files that a vehicle's file names, with paths relative to a folder at or above its own.

    In Chrono they are relative to its folder of data, which a file does not name.
    """

    def __init__(self, path: str | Path) -> None:
        self._path = Path(path)
        here = self._path.resolve()
        self._roots = list(here.parents)[:_ABOVE]

    def find(self, name: str, key: str) -> Path:
        """Return the path of a named file, or raise an `InputError` with the key of the name."""
        parts = PureWindowsPath(name).parts
        if not parts or ".." in parts or PureWindowsPath(name).is_absolute():
            problem = f'"{key}" = "{legible(short(name))}" is not a path within a folder of data.'
            raise InputError([problem], str(self._path))
        for root in self._roots:
            file = root.joinpath(*parts)
            if file.is_file():
                return file
        problem = (
            f'"{key}" = "{legible(short(name))}": there is no such file, from the folder of this '
            f"file or from one of the {len(self._roots) - 1} above it. Chrono counts from its "
            "folder of data: keep the files in its folders."
        )
        raise InputError([problem], str(self._path))

    def tires(self) -> list[str]:
        """Return files of tires beside the vehicle's file or in the folder above."""
        found = []
        for root in self._roots[:2]:
            for file in sorted({*root.glob("*[tT]ire*.json"), *root.glob("[tT]ire*/*.json")}):
                try:
                    is_tire = content(file).get("Type") == "Tire"
                except InputError:
                    continue
                if is_tire:
                    found.append(str(file))
            if found:
                break
        return found[:_SHOWN]
