"""The parts of a rigid axle in n positions: the beam, both wheels and the rods."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from ...core.named_types import Array
from ...core.vectors import cross, directions
from ..corner.corner import UP
from ..models.rigid_axle.axle import BeamAxle
from ..models.rigid_axle.model import ROLL, RigidAxleModel
from ..models.rigid_axle.structure import BEAM, MIDDLE
from ..models.sides import SENSE, SIDES
from ..models.whole_axle import CHASSIS
from .load import Load
from .part_poses import CENTER, road_axes
from .whole_axle_parts import BAR, WholeAxleParts

_LEFTWARD = np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True)
class RigidAxleParts(WholeAxleParts):
    """The parts of a rigid axle in n positions; the centre of a rod is its middle."""

    model: RigidAxleModel

    PARAMETERS: ClassVar[Mapping[str, str]] = {
        BEAM: "beam",
        "wheel_left": "left_wheel",
        "wheel_right": "wheel",
    }
    MASSIVE: ClassVar[Mapping[str, str]] = {
        BEAM: "beam",
        "wheel_left": "left_wheel",
        "wheel_right": "right_wheel",
    }
    RATE = "bar_rate"

    @classmethod
    def of(cls, model: RigidAxleModel, states: Array, inputs: Array | None = None) -> Self:
        found = super().of(model, states, inputs)
        # the equations have no centre of mass of a rod, which has no mass
        for name, (inner, outer) in model.axle.ends().items():
            chassis, beam = (found.points[f"{name}_{end}"] for end in (CHASSIS, "axle"))
            if name not in found.turned:
                turned = _upright_frames(beam - chassis) @ _upright_frames(outer - inner).T
                found.turned[name] = turned
            found.centers[name] = 0.5 * (chassis + beam)
        return found

    @classmethod
    def bodies(cls, axle: BeamAxle) -> Mapping[str, str]:
        return {**{name: f"rod_{i}" for i, name in enumerate(axle.guides, 1)}, **cls.MASSIVE}

    @classmethod
    def placed(
        cls, axle: BeamAxle, centers: Mapping[str, Array], turned: Mapping[str, Array]
    ) -> dict[str, Array]:
        still, moved = {}, {MIDDLE: axle.center}
        for name, (inner, outer) in axle.ends().items():
            still[f"{name}_{CHASSIS}"], moved[f"{name}_axle"] = inner, outer
        for side in SIDES:
            for name, point in axle.points(side).items():
                (still if name.endswith("_top") else moved)[f"{name}_{side}"] = point
            moved[f"{CENTER}_{side}"] = axle.center + SENSE[side] * axle.half_track * _LEFTWARD
        begin, center, turn = cls.design_centers(axle)[BEAM], centers[BEAM], turned[BEAM]
        points = {name: np.broadcast_to(point, center.shape) for name, point in still.items()}
        points |= {name: center + turn @ (point - begin) for name, point in moved.items()}
        of_wheels = {side: points[f"{CENTER}_{side}"] for side in SIDES}
        return points | cls.contacts(axle, of_wheels, dict.fromkeys(SIDES, turn))

    @property
    def axle(self) -> BeamAxle:
        return self.model.axle

    @classmethod
    def design_centers(cls, axle: BeamAxle) -> dict[str, Array]:
        return {BEAM: axle.bodies.beam.centre_of_mass(axle.hardpoints)}

    def carrier(self, side: str) -> str:
        return BEAM

    def carried_by(self, part: str, point: str) -> Array:
        """Return the position of a point on a part, (n, 3) [m].

        A fifth rod keeps its design length, centred between its ends on axle and chassis.
        """
        if part not in self.axle.rods or part in self.axle.guides:
            return self.points[point]
        inner, outer = self.axle.ends()[part]
        arm = self.turned[part] @ (self.design[point] - 0.5 * (inner + outer))
        return self.centers[part] + arm

    def rod(self, name: str) -> Array:
        """Return the unit vector along a rod from the axle to the chassis, (n, 3)."""
        return self.along(f"{name}_{CHASSIS}", f"{name}_axle")

    def along(self, first: str, last: str) -> Array:
        """Return the unit vector from the last to the first point of a link, (n, 3)."""
        return directions(self.points[first] - self.points[last])

    # -- its loads ------------------------------------------------------------------------------

    @property
    def twist(self) -> Array:
        """The inclination of the axle, positive with the left wheel up, (n,) [rad]."""
        return self.states[:, self.model.state_names.index(ROLL)]

    @property
    def rate_of_twist(self) -> float:
        """The moment of the anti-roll bar per inclination [N m/rad]; zero without one."""
        return self.model.parameters[self.RATE]

    def by_torque(self) -> list[Load]:
        """Return the loads of a unit torque of the anti-roll bar, against the roll of the axle.

        The moment on the axle is about its forward axis.
        """
        # the line through the wheels points left, and the forward axis is level
        forward = road_axes(self.turned[BEAM][:, :, 1])[:, 0]
        on_beam = Load(BEAM, MIDDLE, BAR, np.zeros(3), -forward, self.points[MIDDLE])
        return [on_beam, replace(on_beam, part=CHASSIS, moment=forward)]


def _upright_frames(way: Array) -> Array:
    """Return the axes of rods as columns, (..., 3, 3): along, level across it, and across both.

    A cross whose first axis is upright turns a rod so that its second axis stays level.
    """
    along = directions(way)
    level = directions(cross(along, np.broadcast_to(UP, along.shape)))
    return np.stack([along, level, cross(along, level)], axis=-1)
