"""The template SemiTrailingArm."""

from collections.abc import Mapping
from typing import Any, ClassVar, Literal

from pydantic import Field

from .forces import LineToArm, ShockOnArm, SpringOnArm, damper_law, spring_law, words_of_curves
from .keys import Part
from .parts import DRAWING, POINTS_ONLY, ChronoArm, Point
from .suspension_file import PointsFile, SuspensionFile

_SOURCES = {
    "arm_outer": "Trailing Arm > Location Chassis Outer",
    "arm_inner": "Trailing Arm > Location Chassis Inner",
    "spring_top": "Spring > Location Chassis",
    "spring_seat": "Spring > Location Arm",
    "damper_top": "Shock > Location Chassis",
    "damper_seat": "Shock > Location Arm",
}


class _Bearings(Part):
    UNREAD: ClassVar[frozenset[str]] = DRAWING | {"Bushing Data"}

    outer: Point = Field(alias="Location Chassis Outer")
    inner: Point = Field(alias="Location Chassis Inner")


class _TrailingArm(_Bearings, ChronoArm):
    UNREAD: ClassVar[frozenset[str]] = _Bearings.UNREAD

    end: Point = Field(alias="Location Spindle")

    def corners(self) -> tuple[Point, Point, Point]:
        """Return the outer bearing, the inner one, and the end at the spindle.

        Chrono's y and z point the other way, without effect on an inertia without products.
        """
        return self.outer, self.inner, self.end


class TrailingPoints(PointsFile):
    """The points of an arm that swings about two bearings, of its spring and of its damper."""

    TEMPLATE: ClassVar[str] = "SemiTrailingArm"
    KIND: ClassVar[str] = "trailing_arm"
    SOURCES: ClassVar[Mapping[str, str]] = {**PointsFile.SOURCES, **_SOURCES}

    template: Literal["SemiTrailingArm"] = Field(alias="Template")
    arm: _Bearings = Field(alias="Trailing Arm")
    spring: LineToArm = Field(alias="Spring")
    shock: LineToArm = Field(alias="Shock")

    def own_points(self) -> dict[str, Point]:
        return {
            "arm_inner": self.arm.inner,
            "arm_outer": self.arm.outer,
            "spring_top": self.spring.chassis,
            "spring_seat": self.spring.arm,
            "damper_top": self.shock.chassis,
            "damper_seat": self.shock.arm,
        }


class SemiTrailingArm(SuspensionFile, TrailingPoints):
    """One arm, which carries the wheel; spring and damper act on it."""

    LINKED: ClassVar[str] = "trailing_arm"
    SOURCES: ClassVar[Mapping[str, str]] = {
        **SuspensionFile.SOURCES,
        **_SOURCES,
        "[bodies.trailing_arm]": "Trailing Arm",
        "[spring]": "Spring",
        "[damper]": "Shock",
    }

    arm: _TrailingArm = Field(alias="Trailing Arm")
    spring: SpringOnArm = Field(alias="Spring")
    shock: ShockOnArm = Field(alias="Shock")

    def arms(self) -> dict[str, tuple[str, ChronoArm]]:
        return {"trailing_arm": ("Trailing Arm", self.arm)}

    def problems(self) -> list[str]:
        lines = super().problems()
        if self.spring.stops():
            lines.append(
                '"Spring > Minimum Length" and "Maximum Length" are stops along the spring; those '
                f"of a trailing arm are along its damper here. Remove them, or {POINTS_ONLY}."
            )
        return lines

    def forces(self) -> dict[str, Any]:
        damper = damper_law(self.spring, self.shock)
        return {"spring": spring_law(self.spring).section(), "damper": damper.section()}

    def left_open(self) -> list[str]:
        return words_of_curves(None, spring_law(self.spring), damper_law(self.spring, self.shock))
