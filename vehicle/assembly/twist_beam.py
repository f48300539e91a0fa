"""A twist-beam axle as an assembly: two trailing arms, and between them a beam that twists."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import ClassVar

import numpy as np

from ...core.named_types import Array
from ..models.sides import LEFT, RIGHT, SENSE, SIDES
from ..models.twist_beam import (
    ACROSS,
    LIFT,
    PIVOT,
    SHEAR_CENTER,
    TWIST,
    TwistBeamAxle,
    TwistBeamModel,
)
from .anti_roll_bar import TwistBar
from .load import Load
from .measures.twist_beam import MEASURES
from .part_poses import CENTER, PartMass
from .whole_axle import WholeAxleAssembly
from .whole_axle_parts import BAR, WholeAxleParts

_MIRROR = np.diag([1.0, -1.0, 1.0])
_ARMS = {f"arm_{side}": f"{side}_arm" for side in SIDES}
_WHEELS = {f"wheel_{side}": f"{side}_wheel" for side in SIDES}
_ENDS_OF_ROLL, _CLOSE = 20, 1e-15


@dataclass(frozen=True)
class TwistBeamParts(WholeAxleParts):
    """A twist-beam axle in n positions: both arms, each with half the beam, and both wheels."""

    model: TwistBeamModel

    PARAMETERS: ClassVar[Mapping[str, str]] = {
        **dict.fromkeys(_ARMS, "arm"),
        f"wheel_{LEFT}": "left_wheel",
        f"wheel_{RIGHT}": "wheel",
    }
    MASSIVE: ClassVar[Mapping[str, str]] = _ARMS | _WHEELS
    RATE = "beam_rate"

    @classmethod
    def placed(
        cls, axle: TwistBeamAxle, centers: Mapping[str, Array], turned: Mapping[str, Array]
    ) -> dict[str, Array]:
        found, begin = {}, cls.design_centers(axle)
        for side in SIDES:
            arm = f"arm_{side}"
            for name, point in axle.points(side).items():
                still = name.endswith("_top") or name == PIVOT
                moved = centers[arm] + turned[arm] @ (point - begin[arm])
                at = np.broadcast_to(point, centers[arm].shape) if still else moved
                found[f"{name}_{side}"] = at
        of_wheels = {side: found[f"{CENTER}_{side}"] for side in SIDES}
        found |= cls.contacts(axle, of_wheels, {side: turned[f"arm_{side}"] for side in SIDES})
        arm = f"arm_{RIGHT}"
        at_beam = axle.shear_center - begin[arm]
        return found | {SHEAR_CENTER: centers[arm] + turned[arm] @ at_beam}

    @classmethod
    def design_centers(cls, axle: TwistBeamAxle) -> dict[str, Array]:
        right = np.asarray(axle.bodies.arm.centre_of_mass(axle.hardpoints))
        return {f"arm_{LEFT}": _MIRROR @ right, f"arm_{RIGHT}": right}

    @property
    def axle(self) -> TwistBeamAxle:
        return self.model.axle

    def carrier(self, side: str) -> str:
        return f"arm_{side}"

    def masses(self) -> dict[str, PartMass]:
        """Return mass and inertia of the parts; the left arm is the image of the right one."""
        found = super().masses()
        arm = found[f"arm_{LEFT}"]
        return found | {f"arm_{LEFT}": replace(arm, tensor=_MIRROR @ arm.tensor @ _MIRROR)}

    @property
    def twist(self) -> Array:
        angle: Array = self.states[:, self.model.state_names.index(TWIST)]
        return self.axle.twist_ratio * angle

    @property
    def rate_of_twist(self) -> float:
        return self.axle.beam.rate

    def by_torque(self) -> list[Load]:
        at = self.points[SHEAR_CENTER]
        return [
            Load(f"arm_{side}", SHEAR_CENTER, BAR, np.zeros(3), -SENSE[side] * ACROSS, at)
            for side in SIDES
        ]


class TwistBeamAssembly(WholeAxleAssembly):
    """A twist-beam axle; `model` has its equations, if they exist already."""

    AXLE, MODEL, PARTS = TwistBeamAxle, TwistBeamModel, TwistBeamParts
    MEASURES = MEASURES
    ENDS = "a damper reaches no farther, or a spring or a damper has turned by a right angle"
    MODES: ClassVar[Mapping[str, str]] = {LIFT: "axle hop", TWIST: "axle tramp"}

    axle: TwistBeamAxle

    @property
    def words(self) -> str:
        return (
            f"A {self.axle.heading()}: two arms and a beam of {self.axle.beam.rate_Nm_per_deg:.4g} "
            "N m/deg between them."
        )

    def _travels(self, motion: str, along: Array) -> tuple[Array, Array]:
        """Return the travels of the left and the right wheel along a motion [m].

        In roll they are opposite, so that the line through the wheel centres has the angle.
        """
        left, right = super()._travels(motion, along)
        if motion != "roll":
            return left, right
        half = np.atleast_1d(right)
        wanted = np.atleast_1d(np.tan(along))
        for _ in range(_ENDS_OF_ROLL):
            states = np.nan_to_num(self.model.placed(-half, half))
            left, right = (self.PARTS.of(self.model, states).points[f"{CENTER}_{s}"] for s in SIDES)
            line = left - right
            before, half = half, 0.5 * np.hypot(line[:, 0], line[:, 1]) * wanted
            if not (np.abs(half - before) > _CLOSE).any():
                break
        half = half.reshape(np.shape(along))
        return -half, half

    def described(self) -> dict[str, str]:
        far = 1e3 * float(self.axle.pivot[0] - self.axle.shear_center[0])
        return {
            "track": f"{2e3 * self.axle.half_track:.4g} mm",
            "beam": f"{self.axle.beam.rate_Nm_per_deg:.4g} N m/deg, its shear centre {far:.1f} mm "
            "behind the pivots",
        }

    @property
    def bar(self) -> TwistBar | None:
        rate = self.axle.beam.rate
        if not rate:
            return None
        return TwistBar(rate, f"arm_{RIGHT}", f"arm_{LEFT}", ACROSS, attrgetter("twist"))
