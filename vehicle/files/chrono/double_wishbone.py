"""The template DoubleWishbone."""

import math
from collections.abc import Mapping
from typing import Any, ClassVar, Literal

import numpy as np
from pydantic import Field

from ....core.vectors import cross
from .forces import (
    DamperLaw,
    LineToArm,
    ShockOnArm,
    SpringOnArm,
    damper_law,
    spring_law,
    words_of_curves,
)
from .parts import ON_THE_LINE, POINTS_ONLY, ArmPoints, ControlArm, Point
from .suspension_file import KnuckleFile, SteeredPoints, arm_sources

# Least speed of the damper between its own points, over that of the spring.
_LEAST_RATIO = 0.1

_SOURCES = {
    **arm_sources("lower_arm", "Lower Control Arm"),
    **arm_sources("upper_arm", "Upper Control Arm"),
    "lower_ball_joint": "Lower Control Arm > Location Upright",
    "upper_ball_joint": "Upper Control Arm > Location Upright",
    "spring_top": "Spring > Location Chassis",
    "spring_seat": "Spring > Location Arm",
}


class WishbonePoints(SteeredPoints):
    """The points of two arms; the spring acts on the lower one."""

    TEMPLATE: ClassVar[str] = "DoubleWishbone"
    KIND: ClassVar[str] = "double_wishbone"
    SOURCES: ClassVar[Mapping[str, str]] = {**SteeredPoints.SOURCES, **_SOURCES}

    template: Literal["DoubleWishbone"] = Field(alias="Template")
    upper: ArmPoints = Field(alias="Upper Control Arm")
    lower: ArmPoints = Field(alias="Lower Control Arm")
    spring: LineToArm = Field(alias="Spring")

    def own_points(self) -> dict[str, Point]:
        points = {}
        for name, arm in (("lower", self.lower), ("upper", self.upper)):
            points[f"{name}_arm_front"], points[f"{name}_arm_rear"] = arm.front, arm.back
            points[f"{name}_ball_joint"] = arm.upright
        return points | {"spring_top": self.spring.chassis, "spring_seat": self.spring.arm}


class DoubleWishboneFile(KnuckleFile, WishbonePoints):
    """Two arms; spring and damper act on the lower one."""

    LINKED: ClassVar[str] = "lower_arm"
    SOURCES: ClassVar[Mapping[str, str]] = {
        **KnuckleFile.SOURCES,
        **_SOURCES,
        "[bodies.lower_arm]": "Lower Control Arm",
        "[bodies.upper_arm]": "Upper Control Arm",
        "[spring]": "Spring",
        "[bump_stop]": "Spring > Minimum Length",
        "[rebound_stop]": "Spring > Maximum Length",
        "[damper]": "Shock",
    }

    upper: ControlArm = Field(alias="Upper Control Arm")
    lower: ControlArm = Field(alias="Lower Control Arm")
    spring: SpringOnArm = Field(alias="Spring")
    shock: ShockOnArm = Field(alias="Shock")

    def arms(self) -> dict[str, tuple[str, ControlArm]]:
        return {
            "lower_arm": ("Lower Control Arm", self.lower),
            "upper_arm": ("Upper Control Arm", self.upper),
        }

    def problems(self) -> list[str]:
        lines = super().problems()
        if self._is_apart() and not self._ratio() >= _LEAST_RATIO:
            lines.append(
                f'"Shock > Location Chassis" = {list(self.shock.chassis)} m and "Location Arm" = '
                f"{list(self.shock.arm)} m: between them the damper moves {self._ratio():.3g} "
                "times as fast as the spring at design. Here both have the same points, "
                f"and at least {_LEAST_RATIO:g} is needed. Correct them, or {POINTS_ONLY}."
            )
        return lines

    def forces(self) -> dict[str, Any]:
        stops, at_design = self.spring.stops(), math.dist(self.spring.chassis, self.spring.arm)
        own = {"spring": spring_law(self.spring).section(), "damper": self._damper().section()}
        return own | (stops.sections(at_design) if stops else {})

    def left_open(self) -> list[str]:
        laws = spring_law(self.spring), self._damper()
        of_curves = words_of_curves(self.spring.stops(), *laws)
        if not self._is_apart():
            return of_curves
        ratio = self._ratio()
        lines = (
            f"damper: between the points of the spring, with {ratio:.4g} times its force at "
            f"{1.0 / ratio:.4g} times its speed, which does the same at design as between its own, "
            f'"Shock > Location Chassis" = {list(self.shock.chassis)} and "Location Arm" = '
            f"{list(self.shock.arm)} m"
        )
        return [lines, *of_curves]

    def _damper(self) -> DamperLaw:
        """Return the damper between the points of the spring."""
        damper = damper_law(self.spring, self.shock)
        return damper.scaled(self._ratio()) if self._is_apart() else damper

    def _is_apart(self) -> bool:
        """Return whether the damper has points of its own."""
        ends = ((self.shock.chassis, self.spring.chassis), (self.shock.arm, self.spring.arm))
        away = max(np.linalg.norm(np.subtract(own, other)) for own, other in ends)
        return bool(away > ON_THE_LINE) and bool(self.shock.dampers())

    def _ratio(self) -> float:
        """Return the speed of the damper between its own points over that of the spring."""
        front, back = np.array(self.lower.front), np.array(self.lower.back)

        def speed(element: SpringOnArm | ShockOnArm) -> float:
            end = np.array(element.arm)
            line = end - element.chassis
            return float(cross(front - back, end - front) @ line / np.linalg.norm(line))

        with np.errstate(all="ignore"):  # coinciding points are refused by name later
            return speed(self.shock) / speed(self.spring) if speed(self.spring) else np.nan
