"""Bodies and points in the files of Project Chrono's templates."""

from abc import abstractmethod
from decimal import Decimal
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field

from ....core.named_types import Array
from ....core.physical import inertia_tensor
from ....core.vectors import cross
from ...input.bodies import impossible_inertia
from .keys import Part

# strict: neither a text nor true is a number
Finite = Annotated[float, Field(allow_inf_nan=False, strict=True)]
Point = tuple[Finite, Finite, Finite]

ON_THE_LINE = 1e-4
"""The distance within which points coincide, or a point is on a line [m]."""

DRAWING = frozenset({"Radius", "Width"})
"""Keys of bodies that are for drawing alone."""

POINTS_ONLY = "take the hardpoints alone: --points-only (points_only=True)"


class Ends(Part):
    """A rod between chassis and upright."""

    UNREAD: ClassVar[frozenset[str]] = frozenset({"Mass", "Inertia", "Radius", "Bushing Data"})

    chassis: Point = Field(alias="Location Chassis")
    upright: Point = Field(alias="Location Upright")


class Centre(Part):
    """The position of a body."""

    UNREAD: ClassVar[frozenset[str]] = DRAWING | {"Mass", "Inertia"}

    com: Point = Field(alias="COM")


class ArmPoints(Part):
    """The joints of an arm with two bearings on the chassis."""

    UNREAD: ClassVar[frozenset[str]] = DRAWING | {"Bushing Data"}

    front: Point = Field(alias="Location Chassis Front")
    back: Point = Field(alias="Location Chassis Back")
    upright: Point = Field(alias="Location Upright")


class ChronoBody(Centre):
    """A rigid body; its inertia has two forms, of older and of newer templates."""

    mass: Finite = Field(alias="Mass", ge=0.0)
    inertia: Point | None = Field(default=None, alias="Inertia")
    moments: Point | None = Field(default=None, alias="Moments of Inertia")
    products: Point | None = Field(default=None, alias="Products of Inertia")

    def problems(self, name: str) -> list[str]:
        """Return the problem of an inertia that no body can have, with the body's key."""
        if self.inertia is not None and (self.moments or self.products):
            other = "Moments of Inertia" if self.moments else "Products of Inertia"
            return [f'"{name} > Inertia" and "{other}" both give the inertia. Keep one of them.']
        if self.inertia is None and self.moments is None:
            return [f'"{name} > Inertia" or "Moments of Inertia" is missing. Add it, in kg m^2.']
        reason = impossible_inertia(elements(self._tensor()))
        if not reason:
            return []
        key = "Moments of Inertia" if self.inertia is None else "Inertia"
        given = f'"{name} > {key}" = {list(self.moments or self.inertia or ())}'
        if self.products is not None:
            given += f', "Products of Inertia" = {list(self.products)}'
        return [f"{given} kg m^2: {reason}. Correct it, or {POINTS_ONLY}."]

    def rigid(self, axes: Array) -> dict[str, Any]:
        """Return the section of a hardpoint file.

        `axes` are those of the inertia in the file, (3, 3), in columns.
        """
        named = elements(axes @ self._tensor() @ axes.T)
        return {
            "mass_kg": self.mass,
            "com_mm": list(map(millimetres, self.com)),
            **{f"inertia_{name}_kg_m2": value for name, value in named.items()},
        }

    def _tensor(self) -> Array:
        nothing = (0.0, 0.0, 0.0)
        moments = self.moments or self.inertia or nothing
        return inertia_tensor([*moments, *(self.products or nothing)])


class Spindle(Centre):
    """The spindle, which turns with the wheel."""

    mass: Finite = Field(alias="Mass", ge=0.0)
    inertia: Point = Field(alias="Inertia")


class ChronoArm(ChronoBody):
    """An arm as a body."""

    @abstractmethod
    def corners(self) -> tuple[Point, Point, Point]:
        """Return the bearing to which its x axis points, the other one, and its end."""

    def axes(self) -> Array:
        """Return Chrono's axes of the arm: x between its bearings, z normal to it."""
        to, off, end = map(np.array, self.corners())
        z = cross(off - end, to - end)
        x = to - off
        if not (np.linalg.norm(z) > 0.0 and np.linalg.norm(x) > 0.0):
            return np.eye(3)  # coinciding points are refused by name later
        x, z = x / np.linalg.norm(x), z / np.linalg.norm(z)
        return np.column_stack((x, cross(z, x), z))


class ControlArm(ArmPoints, ChronoArm):
    """An arm with two bearings and a joint on the upright."""

    UNREAD: ClassVar[frozenset[str]] = ArmPoints.UNREAD

    def corners(self) -> tuple[Point, Point, Point]:
        """Return the front bearing, the rear one, and the joint on the upright."""
        return self.front, self.back, self.upright


class ChronoAxle(Part):
    """The shaft that turns with the wheel."""

    inertia: Finite = Field(alias="Inertia", ge=0.0)


def millimetres(metres: float) -> float:
    """Return a length in millimetres, with its decimal digits in metres."""
    return float(Decimal(repr(metres)).scaleb(3))


def raised_moments(moments: Any) -> list[float]:
    """Return moments of inertia with the smaller ones raised to the sum that the largest needs.

    Empty for possible moments, and for other values than a list of three positive numbers, which
    are left to other checks.
    """
    if not (isinstance(moments, list) and len(moments) == len("xyz")):
        return []
    if not all(type(one) in (int, float) and 0.0 < one < np.inf for one in moments):
        return []
    largest = max(moments)
    others = sum(moments) - largest
    if largest <= others:
        return []
    return [one if one == largest else round(one * largest / others, 12) for one in moments]


def elements(tensor: Array) -> dict[str, float]:
    """Return the elements of a tensor by name."""
    at = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
    return {name: float(tensor[place]) for name, place in at.items()}
