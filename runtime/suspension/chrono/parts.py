"""What the files of Project Chrono's templates have in common, and what becomes of it."""

import math
from abc import abstractmethod
from collections.abc import Sequence
from decimal import Decimal
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field

from ...core.errors import InputError
from ...core.vectors import cross

Array = NDArray[np.float64]
# strict: neither a text nor true is a number
Finite = Annotated[float, Field(allow_inf_nan=False, strict=True)]
Point = tuple[Finite, Finite, Finite]

TYRE_RATE = 200e3
"""Radial rate of a tyre that no file describes [N/m]."""

# A point nearer than this to another one, or to a line, lies on it [m].
ON_THE_LINE = 1e-4


class Part(BaseModel):
    """A part of the file; keys that are not used are let pass, as Chrono itself does."""

    model_config = ConfigDict(extra="ignore", populate_by_name=True)


class Body(Part):
    """A rigid body."""

    mass: Finite = Field(alias="Mass", ge=0.0)
    com: Point = Field(alias="COM")
    inertia: Point | None = Field(default=None, alias="Inertia")
    moments: Point | None = Field(default=None, alias="Moments of Inertia")
    products: Point = Field(default=(0.0, 0.0, 0.0), alias="Products of Inertia")

    def rigid(self, axes: Array) -> dict[str, Any]:
        """Return its section of a hardpoint file.

        Parameters
        ----------
        axes : ndarray, shape (3, 3)
            Axes of the body in which the file gives its inertia, in columns.
        """
        xx, yy, zz = self.moments or self.inertia or (0.0, 0.0, 0.0)
        xy, xz, yz = self.products
        local = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        tensor: Array = axes @ local @ axes.T
        at = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
        return {
            "mass_kg": self.mass,
            "com_mm": list(map(millimetres, self.com)),
            **{f"inertia_{name}_kg_m2": float(tensor[place]) for name, place in at.items()},
        }


class Spindle(Body):
    """What turns with the wheel."""

    inertia: Point = Field(alias="Inertia")


class ControlArm(Body):
    """An arm with two bearings on the chassis."""

    front: Point = Field(alias="Location Chassis Front")
    back: Point = Field(alias="Location Chassis Back")
    upright: Point = Field(alias="Location Upright")
    bushing: Any = Field(default=None, alias="Bushing Data")

    def axes(self) -> Array:
        """Return Chrono's axes of the arm: x from its rear to its front bearing, z across it."""
        front, back, upright = map(np.array, (self.front, self.back, self.upright))
        z = cross(back - upright, front - upright)
        x = front - back
        if not (np.linalg.norm(z) > 0.0 and np.linalg.norm(x) > 0.0):
            return np.eye(3)  # no triangle: the hardpoints are refused later, by name
        x, z = x / np.linalg.norm(x), z / np.linalg.norm(z)
        return np.column_stack((x, cross(z, x), z))


class Ends(Part):
    """What reaches from the chassis to the upright."""

    chassis: Point = Field(alias="Location Chassis")
    upright: Point = Field(alias="Location Upright")


class Spring(Part):
    """A spring; where it ends, its template says."""

    chassis: Point = Field(alias="Location Chassis")
    rate: Finite | None = Field(default=None, alias="Spring Coefficient")
    free_length: Finite = Field(alias="Free Length")
    shortest: Finite | None = Field(default=None, alias="Minimum Length")
    longest: Finite | None = Field(default=None, alias="Maximum Length")


class Shock(Part):
    """A damper; where it ends, its template says."""

    chassis: Point = Field(alias="Location Chassis")
    rate: Finite | None = Field(default=None, alias="Damping Coefficient")
    curve: tuple[tuple[Finite, Finite], ...] | None = Field(default=None, alias="Curve Data")


class Axle(Part):
    """The shaft that turns with the wheel."""

    inertia: Finite = Field(alias="Inertia", ge=0.0)


class Tire(Part):
    """A tire with its rim."""

    type: Literal["Tire"] = Field(default="Tire", alias="Type")
    radius: Finite | None = Field(alias="Radius", gt=0.0)
    mass: Finite = Field(alias="Mass", ge=0.0)
    inertia: Point = Field(alias="Inertia")


USUAL = Tire(Radius=None, Mass=20.0, Inertia=(0.8, 1.0, 0.8))
"""Of a passenger car, with its rim; where no file of a tire is given."""


class SuspensionFile(Part):
    """A file of a suspension: what all templates have."""

    TEMPLATE: ClassVar[str]
    """What the file calls its template."""

    name: str = Field(default="suspension", alias="Name")
    type: Literal["Suspension"] = Field(alias="Type")
    camber: Finite = Field(default=0.0, alias="Camber Angle (deg)")
    toe: Finite = Field(default=0.0, alias="Toe Angle (deg)")
    vehicle_axes: bool = Field(default=False, strict=True, alias="Vehicle-Frame Inertia")
    spindle: Spindle = Field(alias="Spindle")
    upright: Body = Field(alias="Upright")
    tie_rod: Ends = Field(alias="Tierod")
    axle: Axle = Field(alias="Axle")

    @abstractmethod
    def sections(self) -> dict[str, Any]:
        """Return the sections of the hardpoint file that are those of the kind."""

    @abstractmethod
    def left_open(self) -> list[str]:
        """Return what the template leaves open, and what has no place here."""

    def data(self, tire: Tire) -> dict[str, Any]:
        """Return the hardpoint file of the left suspension."""
        own = self.sections()
        touching = {"rate_N_per_m": TYRE_RATE, "free_height_mm": millimetres(self.spindle.com[2])}
        radius = {} if tire.radius is None else {"radius_mm": millimetres(tire.radius)}
        bodies = {"knuckle": self.upright.rigid(np.eye(3)), "wheel": self._wheel(tire)}
        return own | {
            "vehicle": {"side": "left"},
            "hardpoints": self._hardpoints(own["hardpoints"]),
            "wheel": self._alignment(),
            "tyre": touching | radius,
            "rack": {"axis": [0.0, 1.0, 0.0]},
            "gravity": {"acceleration_m_per_s2": 9.81},
            "bodies": own["bodies"] | bodies,
        }

    def assumptions(self, tire: Tire) -> tuple[str, ...]:
        """Return what the file leaves open, and what has no place here, a sentence each."""
        told = [
            "rack: moves along y; the file of the steering is not read",
            f"tyre: {TYRE_RATE / 1e3:g} N/mm, just touching at design",
        ]
        of_wheel = (
            f"wheel: {USUAL.mass:g} kg, {USUAL.inertia[1]:g} kg m^2 about its axis and "
            f"{USUAL.inertia[0]:g} kg m^2 across it; give a tire for its own"
        )
        return (*told, *([of_wheel] if tire is USUAL else []), *self.left_open())

    def arm(self, arm: ControlArm) -> dict[str, Any]:
        """Return the section of an arm as a body."""
        return arm.rigid(np.eye(3) if self.vehicle_axes else arm.axes())

    def _hardpoints(self, own: dict[str, Point]) -> dict[str, Any]:
        points = own | {
            "tie_rod_outer": self.tie_rod.upright,
            "tie_rod_inner": self.tie_rod.chassis,
            "wheel_center": self.spindle.com,
        }
        return {"unit": "m"} | {name: list(point) for name, point in points.items()}

    def _alignment(self) -> dict[str, float]:
        """Return camber and toe as seen from the front and from above.

        Chrono turns the spindle by toe about the vertical and then by camber about its own axis.
        """
        camber, toe = math.radians(self.camber), math.radians(self.toe)
        projected = math.degrees(math.atan2(math.tan(camber), math.cos(toe)))
        return {"camber_deg": projected, "toe_deg": self.toe}

    def _wheel(self, tire: Tire) -> dict[str, float]:
        """Return the body that turns with the wheel: spindle, axle shaft and tire."""
        across, along, other = np.array(self.spindle.inertia) + tire.inertia
        return {
            "mass_kg": self.spindle.mass + tire.mass,
            "inertia_spin_kg_m2": float(along) + self.axle.inertia,
            "inertia_diametral_kg_m2": float(across + other) / 2.0,
        }


def rate_of(spring: Spring, name: str) -> float:
    """Return the rate of a spring [N/m]; refuse one by a curve."""
    if spring.rate is None:
        problem = (
            '"Spring > Spring Coefficient" is missing: a spring by a curve cannot be read. Enter a '
            "rate in N/m."
        )
        raise InputError([problem], name)
    return spring.rate


def curve_of(points: Sequence[tuple[float, float]]) -> dict[str, list[float]]:
    """Return a damper curve; in Chrono it is over the rate of the length, positive in rebound."""
    ordered = sorted((-velocity, -force) for velocity, force in points)
    return {
        "velocity_m_per_s": [velocity + 0.0 for velocity, _ in ordered],
        "force_N": [force + 0.0 for _, force in ordered],
    }


def bushes_of(*arms: ControlArm) -> list[str]:
    """Tell that the bushes of arms are left out."""
    if all(arm.bushing is None for arm in arms):
        return []
    return ["bushes: those of the arms are left out; enter them as [bushings]"]


def stops_of(spring: Spring) -> list[str]:
    """Tell that the lengths of a spring are left out."""
    if spring.shortest is None and spring.longest is None:
        return []
    return ["stops: the shortest and longest length of the spring are left out"]


def millimetres(metres: float) -> float:
    """Return a length in millimetres, with the digits that it has in metres."""
    return float(Decimal(repr(metres)).scaleb(3))
