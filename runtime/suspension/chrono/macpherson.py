"""The template MacPhersonStrut."""

from typing import Any, Literal

import numpy as np
from pydantic import Field

from ...core.vectors import cross
from .parts import (
    ON_THE_LINE,
    ControlArm,
    Finite,
    Part,
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

_STROKE = 0.1
"""How much longer than at design the extended strut is assumed to be [m]."""


class _Strut(Part):
    mass: Finite = Field(alias="Mass", ge=0.0)


class _Spring(Spring):
    upright: Point = Field(alias="Location Upright")


class _Shock(Shock):
    upright: Point = Field(alias="Location Upright")


class MacPhersonStrut(SuspensionFile):
    """A strut that guides the upright; its axis is that of the spring, as in Chrono's joint."""

    TEMPLATE = "MacPhersonStrut"

    template: Literal["MacPhersonStrut"] = Field(alias="Template")
    control_arm: ControlArm = Field(alias="Control Arm")
    strut: _Strut = Field(alias="Strut")
    spring: _Spring = Field(alias="Spring")
    shock: _Shock = Field(alias="Shock")

    def sections(self) -> dict[str, Any]:
        """Return hardpoints, strut, damper curve and the arm as a body."""
        spring, shock = self.spring, self.shock
        length = float(np.linalg.norm(np.subtract(spring.chassis, spring.upright)))
        strut = {
            "length_max_mm": round(millimetres(length + _STROKE), 3),
            "spring_rate_N_per_m": rate_of(spring, self.name),
            "spring_free_length_mm": millimetres(spring.free_length),
        }
        damper = {}
        if shock.curve is None:
            strut["damper_rate_N_s_per_m"] = shock.rate or 0.0
        else:
            damper["damper"] = curve_of(shock.curve)
        points = {
            "arm_front": self.control_arm.front,
            "arm_rear": self.control_arm.back,
            "ball_joint": self.control_arm.upright,
            "strut_top": spring.chassis,
            "strut_lower": spring.upright,
        }
        bodies = {"control_arm": self.arm(self.control_arm)}
        return {"hardpoints": points, "strut": strut, "bodies": bodies} | damper

    def left_open(self) -> list[str]:
        """Tell the stroke of the strut, and what of it is left out."""
        told = [f"strut: {1e3 * _STROKE:g} mm longer when fully extended than at design"]
        if self.strut.mass > 0.0:
            told.append(f"upper strut: its mass of {self.strut.mass:g} kg is left out")
        if not self._damps_along_the_strut():
            told.append("damper: acts along the strut's axis, not between points of its own")
        return told + bushes_of(self.control_arm) + stops_of(self.spring)

    def _damps_along_the_strut(self) -> bool:
        start, end = np.array(self.spring.upright), np.array(self.spring.chassis)
        line = (end - start) / np.linalg.norm(end - start)
        ends = (self.shock.chassis, self.shock.upright)
        offsets = [cross(np.array(point) - start, line) for point in ends]
        return bool(max(np.linalg.norm(offset) for offset in offsets) < ON_THE_LINE)
