"""The base of the files of suspensions, with their points alone and with all data."""

import math
from abc import abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar, Literal

import numpy as np
from pydantic import Field

from .forces import Shock, Spring, problems_of
from .keys import Part, Unread
from .parts import (
    Centre,
    ChronoArm,
    ChronoAxle,
    ChronoBody,
    Ends,
    Finite,
    Point,
    Spindle,
    millimetres,
)
from .tires import TYRE_RATE, USUAL, Tire

_ALIKE = 0.01  # relative difference of diametral moments of a wheel that is not reported


class PointsFile(Part):
    """The geometry of a file: its points, camber and toe."""

    UNREAD: ClassVar[frozenset[str]] = frozenset({"Name", "Output", "Vehicle-Frame Inertia"})

    TEMPLATE: ClassVar[str]
    KIND: ClassVar[str]  # kind of suspension
    # keys of the file by those of a hardpoint file, for messages
    SOURCES: ClassVar[Mapping[str, str]] = {
        "wheel_center": "Spindle > COM",
        "camber_deg": "Camber Angle (deg)",
        "toe_deg": "Toe Angle (deg)",
    }

    type: Literal["Suspension"] = Field(alias="Type")
    template: str = Field(alias="Template")
    camber: Finite = Field(default=0.0, alias="Camber Angle (deg)")
    toe: Finite = Field(default=0.0, alias="Toe Angle (deg)")
    spindle: Centre = Field(alias="Spindle")

    @abstractmethod
    def own_points(self) -> dict[str, Point]:
        """Return the hardpoints of the kind, without the wheel centre [m]."""

    def points(self) -> dict[str, Point]:
        """Return all hardpoints [m]."""
        return self.own_points() | {"wheel_center": self.spindle.com}

    def alignment(self) -> dict[str, float]:
        """Return camber and toe in front and top view [deg].

        Chrono rotates the spindle by toe about the vertical and then by camber about its own axis.
        """
        camber, toe = math.radians(self.camber), math.radians(self.toe)
        projected = math.degrees(math.atan2(math.tan(camber), math.cos(toe)))
        return {"camber_deg": projected, "toe_deg": self.toe}


class SteeredPoints(PointsFile):
    """The points of a suspension with a tie rod."""

    SOURCES: ClassVar[Mapping[str, str]] = {
        **PointsFile.SOURCES,
        "tie_rod_outer": "Tierod > Location Upright",
        "tie_rod_inner": "Tierod > Location Chassis",
    }

    tie_rod: Ends = Field(alias="Tierod")

    def points(self) -> dict[str, Point]:
        rod = {"tie_rod_outer": self.tie_rod.upright, "tie_rod_inner": self.tie_rod.chassis}
        return super().points() | rod


class SuspensionFile(PointsFile):
    """All data of a file."""

    UNREAD: ClassVar[frozenset[str]] = frozenset({"Name", "Output"})
    SOURCES: ClassVar[Mapping[str, str]] = {
        **PointsFile.SOURCES,
        "free_height_mm": "Spindle > COM",
        "[bodies.wheel]": 'Spindle" with "Axle',
    }

    LINKED: ClassVar[str]  # part of the kind to which the drop link of an anti-roll bar is joined

    vehicle_axes: bool = Field(default=False, strict=True, alias="Vehicle-Frame Inertia")
    spindle: Spindle = Field(alias="Spindle")
    axle: ChronoAxle = Field(alias="Axle")
    spring: Spring = Field(alias="Spring")
    shock: Shock = Field(alias="Shock")

    @abstractmethod
    def arms(self) -> Mapping[str, tuple[str, ChronoArm]]:
        """Return the arms with their keys in the file, by body."""

    def carriers(self) -> dict[str, tuple[str, ChronoBody]]:
        """Return the bodies with an inertia in vehicle axes and their keys, by body."""
        return {}

    @abstractmethod
    def forces(self) -> dict[str, Any]:
        """Return the sections of spring and damper of a file without `problems`."""

    @abstractmethod
    def left_open(self) -> list[str]:
        """Return the assumptions of the template."""

    def without_effect(self) -> list[Unread]:
        """Return the keys that Chrono does not use, with their values."""
        return [*self.spring.without_effect(), *self.shock.without_effect()]

    def problems(self) -> list[str]:
        """Return the problems of data that cannot be read."""
        bodies = [*self.arms().values(), *self.carriers().values()]
        of_bodies = [text for name, body in bodies for text in body.problems(name)]
        return of_bodies + problems_of(self.spring, self.shock)

    def data(self, tire: Tire) -> dict[str, Any]:
        """Return the hardpoint file of the left suspension."""
        touching = {
            "rate_N_per_m": TYRE_RATE if tire.rate is None else tire.rate,
            "free_height_mm": millimetres(self.spindle.com[2]),
        }
        radius = {} if tire.radius is None else {"radius_mm": millimetres(tire.radius)}
        arms = {name: arm.rigid(self._axes(arm)) for name, (_, arm) in self.arms().items()}
        others = {name: body.rigid(np.eye(3)) for name, (_, body) in self.carriers().items()}
        return {
            "suspension": self.KIND,
            "vehicle": {"side": "left"},
            "hardpoints": {"unit": "m"} | {name: list(p) for name, p in self.points().items()},
            "wheel": self.alignment(),
            **self.forces(),
            "tyre": touching | radius,
            "gravity": {"acceleration_m_per_s2": 9.81},
            "bodies": arms | others | {"wheel": self._wheel(tire)},
        }

    def assumed_alone(self, tire: Tire) -> list[str]:
        """Return the assumptions for a suspension without its vehicle, a sentence each."""
        given = "" if tire.rate is not None else f"{TYRE_RATE / 1e3:g} N/mm, "
        lines = [f"tyre: {given}just touching at design"]
        if tire.is_usual:
            lines.append(
                f"wheel: {USUAL.mass:g} kg, {USUAL.inertia[1]:g} kg m^2 about its axis and "
                f"{USUAL.inertia[0]:g} kg m^2 across it; give a tire for its own"
            )
        else:
            lines.append(
                f"tire: of the template {tire.template}, on a rim without mass, as the file of "
                "Chrono's wheel is not read"
            )
        return lines

    def assumptions(self, tire: Tire) -> list[str]:
        """Return the other assumptions, a sentence each."""
        lines = []
        across, _, other = np.array(self.spindle.inertia) + tire.inertia
        if abs(across - other) > _ALIKE * max(across, other):
            lines.append(
                f"wheel: {(across + other) / 2.0:g} kg m^2 across its axis, the mean of {across:g} "
                f"and {other:g}"
            )
        return lines + self.left_open()

    def _axes(self, arm: ChronoArm) -> Any:
        return np.eye(3) if self.vehicle_axes else arm.axes()

    def _wheel(self, tire: Tire) -> dict[str, float]:
        """Return the section of the wheel, which includes spindle, tire and the axle's shaft."""
        across, along, other = np.array(self.spindle.inertia) + tire.inertia
        return {
            "mass_kg": self.spindle.mass + tire.mass,
            "inertia_spin_kg_m2": float(along) + self.axle.inertia,
            "inertia_diametral_kg_m2": float(across + other) / 2.0,
            "inertia_shaft_kg_m2": self.axle.inertia,
        }


class KnuckleFile(SuspensionFile, SteeredPoints):
    """All data of a suspension with an upright and a tie rod."""

    SOURCES: ClassVar[Mapping[str, str]] = {
        **SuspensionFile.SOURCES,
        **SteeredPoints.SOURCES,
        "[bodies.knuckle]": "Upright",
    }

    upright: ChronoBody = Field(alias="Upright")

    def carriers(self) -> dict[str, tuple[str, ChronoBody]]:
        return {"knuckle": ("Upright", self.upright)}

    def data(self, tire: Tire) -> dict[str, Any]:
        found = super().data(tire)
        bodies = found.pop("bodies")
        return found | {"rack": {"axis": [0.0, 1.0, 0.0]}, "bodies": bodies}

    def assumed_alone(self, tire: Tire) -> list[str]:
        return [RACK, *super().assumed_alone(tire)]


RACK = "rack: moves along y; the file of the steering is not read"
"""The assumption on the steering."""


def arm_sources(hardpoint: str, arm: str) -> dict[str, str]:
    """Return the keys of an arm's bearings in the file, by our names with a prefix."""
    return {
        f"{hardpoint}_front": f"{arm} > Location Chassis Front",
        f"{hardpoint}_rear": f"{arm} > Location Chassis Back",
    }
