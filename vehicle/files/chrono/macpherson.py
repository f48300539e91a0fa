"""The template MacPhersonStrut."""

import math
from collections.abc import Mapping
from typing import Any, ClassVar, Literal

import numpy as np
from pydantic import Field

from ....core.vectors import cross
from .forces import Shock, Spring, damper_law, spring_law, words_of_curves
from .keys import Part
from .parts import DRAWING, ON_THE_LINE, POINTS_ONLY, ArmPoints, ControlArm, Point, millimetres
from .suspension_file import KnuckleFile, SteeredPoints, arm_sources

_STROKE = 0.1
"""The assumed travel of the strut from design to full extension [m]."""

_SOURCES = {
    **arm_sources("arm", "Control Arm"),
    "ball_joint": "Control Arm > Location Upright",
    "strut_top": "Spring > Location Chassis",
    "strut_lower": "Spring > Location Upright",
}


class _SpringPoints(Part):
    chassis: Point = Field(alias="Location Chassis")
    upright: Point = Field(alias="Location Upright")


class _Spring(Spring, _SpringPoints):
    pass


class _Shock(Shock):
    upright: Point = Field(alias="Location Upright")


class _Strut(Part):
    UNREAD: ClassVar[frozenset[str]] = DRAWING | {"Mass", "Inertia"}


class StrutPoints(SteeredPoints):
    """The points of a strut; its axis is that of the spring, as in Chrono's joint."""

    TEMPLATE: ClassVar[str] = "MacPhersonStrut"
    KIND: ClassVar[str] = "macpherson"
    SOURCES: ClassVar[Mapping[str, str]] = {**SteeredPoints.SOURCES, **_SOURCES}

    template: Literal["MacPhersonStrut"] = Field(alias="Template")
    control_arm: ArmPoints = Field(alias="Control Arm")
    spring: _SpringPoints = Field(alias="Spring")

    def own_points(self) -> dict[str, Point]:
        return {
            "arm_front": self.control_arm.front,
            "arm_rear": self.control_arm.back,
            "ball_joint": self.control_arm.upright,
            "strut_top": self.spring.chassis,
            "strut_lower": self.spring.upright,
        }


class MacPhersonStrut(KnuckleFile, StrutPoints):
    """A strut that guides the upright."""

    LINKED: ClassVar[str] = "control_arm"
    SOURCES: ClassVar[Mapping[str, str]] = {
        **KnuckleFile.SOURCES,
        **_SOURCES,
        "[bodies.control_arm]": "Control Arm",
        "[strut] spring_": "Spring",
        "[spring]": "Spring",
        "[bump_stop]": "Spring > Minimum Length",
        "[rebound_stop]": "Spring > Maximum Length",
        "[strut] damper_": "Shock",
        "[damper]": "Shock",
    }

    control_arm: ControlArm = Field(alias="Control Arm")
    strut: _Strut = Field(default=_Strut(), alias="Strut")
    spring: _Spring = Field(alias="Spring")
    shock: _Shock = Field(alias="Shock")

    def arms(self) -> dict[str, tuple[str, ControlArm]]:
        return {"control_arm": ("Control Arm", self.control_arm)}

    def problems(self) -> list[str]:
        lines, off = super().problems(), self._off_the_axis()
        if self.shock.dampers() and off > ON_THE_LINE:
            lines.append(
                f'"Shock > Location Chassis" = {list(self.shock.chassis)} m and "Location Upright" '
                f"= {list(self.shock.upright)} m are {1e3 * off:.3g} mm off the axis of the strut, "
                f"which leads through those of the spring; allowed is {1e3 * ON_THE_LINE:g} mm. "
                f"Correct them, or {POINTS_ONLY}."
            )
        return lines

    def forces(self) -> dict[str, Any]:
        spring, damper = spring_law(self.spring), damper_law(self.spring, self.shock)
        length = math.dist(self.spring.chassis, self.spring.upright)
        stops = self.spring.stops()
        strut = {"length_max_mm": round(millimetres(length + _STROKE), 3)}
        if spring.curve:
            own = {"spring": spring.section()}
        else:
            own, of_strut = {}, spring.section()
            strut |= {f"spring_{key}": value for key, value in of_strut.items()}
        own |= stops.sections(length) if stops else {}
        if damper.curve:
            return {"strut": strut, "damper": damper.section()} | own
        return {"strut": strut | {"damper_rate_N_s_per_m": damper.rate}} | own

    def left_open(self) -> list[str]:
        lines = [f"strut: {1e3 * _STROKE:g} mm longer when fully extended than at design"]
        laws = spring_law(self.spring), damper_law(self.spring, self.shock)
        lines += words_of_curves(self.spring.stops(), *laws)
        ends = np.subtract(self.shock.chassis, self.spring.chassis)
        if self.shock.dampers() and np.linalg.norm(ends) > ON_THE_LINE:
            lines.append(
                "damper: along the strut's axis in every position, as at design between its own "
                f'points, "Shock > Location Chassis" = {list(self.shock.chassis)} m'
            )
        return lines

    def _off_the_axis(self) -> float:
        """Return the distance of the ends of the damper from the strut's axis [m]."""
        start, end = np.array(self.spring.upright), np.array(self.spring.chassis)
        length = np.linalg.norm(end - start)
        if not length > 0.0:
            return 0.0  # coinciding points are refused by name later
        ends = (self.shock.chassis, self.shock.upright)
        offsets = [cross(np.array(point) - start, (end - start) / length) for point in ends]
        return float(max(np.linalg.norm(offset) for offset in offsets))
