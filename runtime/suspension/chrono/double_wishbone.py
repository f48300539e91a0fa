"""The template DoubleWishbone."""

from typing import Any, Literal

import numpy as np
from pydantic import Field

from .parts import (
    ON_THE_LINE,
    ControlArm,
    Ends,
    Finite,
    Point,
    Shock,
    Spring,
    SuspensionFile,
    bushes_of,
    curve_of,
    millimetres,
    rate_of,
    stops_of,
)


class _Spring(Spring):
    arm: Point = Field(alias="Location Arm")


class _Shock(Shock):
    arm: Point = Field(alias="Location Arm")


class _TieRod(Ends):
    mass: Finite = Field(default=0.0, alias="Mass", ge=0.0)


class DoubleWishbone(SuspensionFile):
    """Two arms; spring and damper stand on the lower one."""

    TEMPLATE = "DoubleWishbone"

    template: Literal["DoubleWishbone"] = Field(alias="Template")
    upper: ControlArm = Field(alias="Upper Control Arm")
    lower: ControlArm = Field(alias="Lower Control Arm")
    tie_rod: _TieRod = Field(alias="Tierod")
    spring: _Spring = Field(alias="Spring")
    shock: _Shock = Field(alias="Shock")

    def sections(self) -> dict[str, Any]:
        """Return the kind, hardpoints, spring, damper and the arms as bodies."""
        arms = {"lower": self.lower, "upper": self.upper}
        points = {}
        for name, arm in arms.items():
            points[f"{name}_arm_front"], points[f"{name}_arm_rear"] = arm.front, arm.back
            points[f"{name}_ball_joint"] = arm.upright
        points |= {"spring_top": self.spring.chassis, "spring_seat": self.spring.arm}
        spring = {
            "rate_N_per_m": rate_of(self.spring, self.name),
            "free_length_mm": millimetres(self.spring.free_length),
        }
        shock = self.shock
        straight = {"rate_N_s_per_m": shock.rate or 0.0}
        return {
            "suspension": "double_wishbone",
            "hardpoints": points,
            "spring": spring,
            "damper": straight if shock.curve is None else curve_of(shock.curve),
            "bodies": {f"{name}_arm": self.arm(arm) for name, arm in arms.items()},
        }

    def left_open(self) -> list[str]:
        """Tell where the damper stands, and what is left out."""
        told = []
        apart = (
            np.subtract(self.shock.chassis, self.spring.chassis),
            np.subtract(self.shock.arm, self.spring.arm),
        )
        if max(np.linalg.norm(offset) for offset in apart) > ON_THE_LINE:
            told.append("damper: stands where the spring does, not at points of its own")
        if self.tie_rod.mass > 0.0:
            told.append(f"tie rod: its mass of {self.tie_rod.mass:g} kg is left out")
        return told + bushes_of(self.lower, self.upper) + stops_of(self.spring)
