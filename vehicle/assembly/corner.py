"""A corner as an assembly: one wheel."""

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from typing import Any, Literal

import numpy as np

from ...core.named_types import Array, ArrayLike
from ...core.validator import Validator
from ..corner.bushes import described_bushings, softness_of_rack
from ..corner.corner import Corner
from ..models.axle.file import TorqueReaction
from ..models.model import Model
from ..models.positions import PositionError, arm_angles, design_height
from ..models.reach import at_rest, height_and_slope, travel_range
from .assembly import Bushings, HeldAssembly, WheelNames
from .corner_kinematics import corner
from .coupling import BodyPose, rules_of
from .load import Load
from .measures.corner import OF_STEERING, OVER_RACK, OVER_TRAVEL
from .measures.measure import Measure
from .mirrored_corner import MirroredCorner
from .part_poses import CornerParts, PartPoses
from .quantity import TRAVEL
from .rest import forces_of, nearest
from .rig import RestConditions, RigMotion, RigPosition, SweepRange, WheelReach
from .soft_lines import SoftLines, soft_lines
from .steering_linkage import on_the_steering
from .usual import usual_rack, usual_travel

_TRAVEL = {"travel": RigMotion(TRAVEL, "the wheel rises and falls", "wheel travel")}


class CornerAssembly(HeldAssembly):
    """A corner."""

    PARTS = CornerParts

    def __init__(self, model: Model) -> None:
        self.model: Model = model
        self.subject = model.suspension
        self.wheeled = (model.suspension,)
        self.wheels = (model.suspension.vehicle.side,)
        self.motions = dict(_TRAVEL)
        if self.steered:
            self.motions["rack"] = self.motion_of_steering("the wheel")

    @property
    def words(self) -> str:
        return f"A {self.subject.heading()}, {self.wheels[0]} side."

    def usual(
        self, motion: str, ends: SweepRange | None = None, *, travel: float = 0.0, rack: float = 0.0
    ) -> Array:
        far = ends or SweepRange()
        if motion == "rack":
            return usual_rack(self.model, extent=far.rack, step=far.step, travel=travel)
        return usual_travel(
            self.model, rebound=far.rebound, bump=far.bump, step=far.step, rack=rack
        )

    def position(
        self, motion: str, along: Array, *, travel: float = 0.0, rack: float = 0.0
    ) -> RigPosition:
        if motion == "rack":
            return RigPosition({self.wheels[0]: np.full_like(along, travel)}, along)
        return self.at_travel(along, rack)

    @property
    def coordinates(self) -> tuple[str, ...]:
        return (self.model.names.arm,)

    def names_of(self, wheel: str) -> WheelNames:
        return WheelNames("", "", self.model.names.spin, self.model.names.actuator)

    def wheel_equations(self, wheel: str) -> tuple[Model, str, Mapping[str, str]]:
        arm = self.model.names.arm
        return self.model, "", {arm: arm}

    def at_rest(self, coordinates: Array, rack: Array | float) -> tuple[Array, Array]:
        """Return states and inputs with zero rates; a free rack is a state."""
        return at_rest(self.model, coordinates[..., 0], rack)

    def coordinates_at_rest(self, held: RestConditions) -> Array:
        """Return the arm angle of the stable state of rest that is nearest to design."""
        forces, reach = forces_of(self, held), travel_range(self.model, held.rack)

        def moment(angle: ArrayLike) -> Array:
            return forces(np.asarray(angle)[..., None])[..., 0]

        return np.array([nearest(moment, reach, self.model.design_state[0])])

    @property
    def steering_motion(self) -> str | None:
        return "rack" if self.steered else None

    def refuse_of_steering(self, names: Iterable[str]) -> None:
        with Validator(self.heading) as given:
            for name in names:
                if name in OF_STEERING:
                    self.refuse_unsteered(given, name)

    def coordinates_of(self, suffix: str) -> dict[str, str]:
        return {self.model.names.arm: "arm_angle"}

    def joints(self, suffix: str) -> tuple[str, ...]:
        return self.subject.hardpoints.JOINTS

    def measures(self, motion: str) -> tuple[Measure, ...]:
        return OVER_RACK if motion == "rack" else OVER_TRAVEL

    def kinematics(self, position: RigPosition) -> MirroredCorner:
        travel, rack = position.travels[self.wheels[0]], position.rack

        def straight() -> Corner | None:
            try:
                return corner_at(self.model, travel[:1], np.zeros(1))
            except PositionError:
                return None

        return MirroredCorner(
            corner_at(self.model, travel, rack),
            lambda: corner_at(self.model.mirror_image, travel, rack),
            straight,
        )

    def poses(self, position: RigPosition) -> dict[str, PartPoses]:
        return {"": poses_of(self.model, position.travels[self.wheels[0]], position.rack)}

    def soft_lines(self, poses: Mapping[str, PartPoses]) -> dict[str, SoftLines]:
        return {suffix: lines_of(each) for suffix, each in poses.items()}

    @cached_property
    def _sense(self) -> float:
        """The sign of the arm angle's derivative with respect to wheel height."""
        _, slope = height_and_slope(self.model, self.model.design_state[0])
        return float(np.sign(slope))

    @property
    def design_wheel_coordinates(self) -> Array:
        """The arm angle at design, with the sign that rises with the wheel [rad]."""
        return self._sense * self.model.design_state[:1]

    def wheel_coordinates(self, travels: Sequence[float | None], rack: float) -> Array:
        (travel,) = travels
        if travel is None:
            return self.design_wheel_coordinates
        return self._sense * arm_angles(self.model, [design_height(self.model) + travel], rack)

    def wheel_reach(self, rack: float) -> list[WheelReach]:
        found = travel_range(self.model, rack)
        low, high = (self._sense * angle for angle in found.arm_angle)
        return [WheelReach((low, high), found.height)]

    def at_wheel_coordinates(self, coordinates: Array, racks: Array) -> dict[str, PartPoses]:
        """Return the parts at rest; the coordinate is the arm angle, of either sign [rad]."""
        return {"": self.at_angles(coordinates[:, 0], racks)}

    def at_angles(self, coordinates: Array, racks: Array) -> CornerParts:
        """Return the parts at rest, (n,)."""
        return CornerParts.of(self.model, *at_rest(self.model, self._sense * coordinates, racks))

    def torque_on(self, what: Literal["brakes", "drive"]) -> TorqueReaction:
        return "carrier" if what == "brakes" else "body"

    @property
    def rules(self) -> tuple[str, ...]:
        return rules_of(self.subject)

    def between(
        self, poses: Mapping[str, PartPoses], loads: Sequence[Load]
    ) -> tuple[list[Load], dict[str, BodyPose]]:
        return on_the_steering(poses[""], loads, "rack_guide")

    def bushes(self, given: Validator, bushings: Mapping[str, Any] | None) -> Bushings:
        described = described_bushings(given, bushings, self.subject.bushings)
        found = self.subject.bushes(given, described)
        return Bushings({"": found}, softness_of_rack(given, described))

    @property
    def heading(self) -> str:
        return self.subject.TITLE

    @property
    def corners(self) -> Mapping[str, Model]:
        return {self.wheels[0]: self.model}

    def without_friction(self) -> "CornerAssembly":
        return CornerAssembly(self.model.of_another(self.subject.without_friction()))


def corner_at(model: Model, travels: Array, rack: Array) -> Corner:
    """Return the corner at wheel travels and displacements of the rack [m].

    Raises `PositionError` if the wheel cannot be there.
    """
    return corner(model, arm_angles(model, design_height(model) + travels, rack), rack)


def poses_of(model: Model, travels: Array, rack: Array) -> CornerParts:
    """Return the parts of a corner with rigid joints, from wheel travels and rack positions [m].

    Raises `PositionError` if the wheel cannot be there.
    """
    angles = arm_angles(model, design_height(model) + travels, rack)
    return CornerParts.of(model, *at_rest(model, angles, rack))


def lines_of(poses: PartPoses) -> SoftLines:
    """Return the flexibilities of spring and stops of a corner."""
    model: Model = poses.model
    angles = poses.states[..., model.state_names.index(model.names.arm)]
    if model.free_rack:
        racks = poses.states[..., model.state_names.index(model.names.rack)]
    elif model.suspension.steered():
        racks = poses.inputs[..., model.input_names.index("rack_position")]
    else:
        racks = np.zeros_like(angles)
    return soft_lines(corner(model, angles, racks))
