"""A steered rigid axle as an assembly: a beam with two knuckles, a drag link and a track rod."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from ...core.named_types import Array
from ...core.quantities import variable
from ...core.vectors import MIRROR, cross
from ..corner.corner import CarrierMotion, SteeringAxis
from ..models.rigid_axle.structure import BEAM
from ..models.sides import LEFT, RIGHT, SIDES
from ..models.steered_rigid_axle.axle import SteeredRigidAxle
from ..models.steered_rigid_axle.file import LOWER, TRACK_ROD, UPPER
from ..models.steered_rigid_axle.model import SteeredRigidAxleModel
from ..models.steered_rigid_axle.structure import (
    BALL,
    DRAG_LINK,
    KNUCKLE_END,
    PITMAN_ARM,
    knuckle,
)
from . import wheel
from .coupling import BodyPose
from .load import Load
from .measures.steered_rigid_axle import MEASURES, OVER_RACK, OVER_STEERING
from .part_poses import CENTER, PartPoses
from .rigid_axle import RigidAxleAssembly, lengths_of, pull
from .rigid_axle_parts import RigidAxleParts
from .steering_axis import AxisOfPoints
from .steering_linkage import on_the_steering, steering_of
from .whole_axle_kinematics import RigidAxleKinematics, TravellingWheel

if TYPE_CHECKING:
    import xarray as xr

_KNUCKLES = {knuckle(side): f"{side}_knuckle" for side in SIDES}


@dataclass(frozen=True)
class SteeredRigidAxleParts(RigidAxleParts):
    """A steered rigid axle in n positions; the centre of a link without mass is its middle."""

    model: SteeredRigidAxleModel

    PARAMETERS: ClassVar[Mapping[str, str]] = {
        **RigidAxleParts.PARAMETERS,
        knuckle(LEFT): "left_knuckle",
        knuckle(RIGHT): "knuckle",
    }
    MASSIVE: ClassVar[Mapping[str, str]] = {**RigidAxleParts.MASSIVE, **_KNUCKLES}

    @classmethod
    def of(cls, model: Any, states: Array, inputs: Array | None = None) -> Self:
        found = super().of(model, states, inputs)
        # the equations have no centre of mass of these links, which have no mass
        for name, (first, last) in _LINKS.items():
            found.centers[name] = 0.5 * (found.points[first] + found.points[last])
        return found

    @classmethod
    def bodies(cls, axle: Any) -> Mapping[str, str]:
        return {**super().bodies(axle), **{name: name for name in (*_LINKS, PITMAN_ARM)}}

    @classmethod
    def placed(
        cls, axle: Any, centers: Mapping[str, Array], turned: Mapping[str, Array]
    ) -> dict[str, Array]:
        found: dict[str, Array] = super().placed(axle, centers, turned)
        begin = cls.design_centers(axle)
        steering = axle.steering_points()
        on = {PITMAN_ARM: {BALL: steering[BALL]}, knuckle(axle.near): {}}
        for side in SIDES:
            points = axle.points(side)
            own = {f"{name}_{side}": points[name] for name in (CENTER, TRACK_ROD)}
            on[knuckle(side)] = on.get(knuckle(side), {}) | own
        on[knuckle(axle.near)][KNUCKLE_END] = steering[KNUCKLE_END]
        for part, points in on.items():
            for name, point in points.items():
                found[name] = centers[part] + turned[part] @ (point - begin[part])
        of_wheels = {side: found[f"{CENTER}_{side}"] for side in SIDES}
        turns = {side: turned[knuckle(side)] for side in SIDES}
        return {**found, **cls.contacts(axle, of_wheels, turns)}

    @classmethod
    def design_centers(cls, axle: Any) -> dict[str, Array]:
        """Return centres of mass at design, (3,) [m].

        They are those of beam and knuckles; the Pitman arm has no mass, and its middle is used.
        """
        right = np.asarray(axle.bodies.knuckle.centre_of_mass(axle.hardpoints))
        knuckles = {knuckle(LEFT): right * MIRROR, knuckle(RIGHT): right}
        return {**super().design_centers(axle), **knuckles, **axle.pitman_arm.centers_of_mass()}

    @property
    def axle(self) -> SteeredRigidAxle:
        return self.model.axle

    def carrier(self, side: str) -> str:
        return knuckle(side)

    def steering_twists(self) -> dict[str, Array]:
        """Return angular velocities and velocities per unit velocity of the steering, (n, 6)."""
        inputs = self.inputs.copy()
        inputs[:, self.model.input_names.index("rack_velocity")] = 1.0
        return self._by_part(self.model.evaluate("velocities", self.states, inputs))


_LINKS = {
    DRAG_LINK: (BALL, KNUCKLE_END),
    TRACK_ROD: (f"{TRACK_ROD}_{LEFT}", f"{TRACK_ROD}_{RIGHT}"),
}


@dataclass(frozen=True)
class SteeredWheel(TravellingWheel):
    """A wheel on a kingpin."""

    steering_axis: SteeringAxis
    # per unit of the steering's displacement, with both wheel centres at constant height [per m]
    steering: CarrierMotion


@dataclass(frozen=True)
class SteeredRigidAxleKinematics(RigidAxleKinematics):
    """A steered rigid axle at rest in n positions."""

    parts: SteeredRigidAxleParts

    @cached_property
    def corners(self) -> dict[str, Any]:
        """Both wheels, each with its kingpin, and its motions in parallel travel and steering."""
        return {
            side: SteeredWheel(
                **vars(one), steering_axis=self._kingpin(side), steering=self._steering(side)
            )
            for side, one in super().corners.items()
        }

    def _kingpin(self, side: str) -> AxisOfPoints:
        lower, upper = (self.parts.points[f"{name}_{side}"] for name in (LOWER, UPPER))
        rates = [cross(self.turning_of(BEAM, by), upper - lower) for by in self.model.COORDINATES]
        return AxisOfPoints(lower, upper, self.in_motion("bump", rates))

    @cached_property
    def _steered(self) -> dict[str, CarrierMotion]:
        """Motions of both carriers per displacement of the steering, with the beam at rest."""
        twists, found = self.parts.steering_twists(), {}
        for side in SIDES:
            part = self.parts.carrier(side)
            velocity = self.parts.velocity_at(part, self.wheel_center(side), twists[part])
            found[side] = CarrierMotion(velocity, twists[part][:, :3])
        return found

    def _steering(self, side: str) -> CarrierMotion:
        """Return the motion of a carrier per displacement, with the wheel centres held."""
        moved = self._steered[side]
        for other in SIDES:
            rise = self._steered[other].velocity[:, 2]
            moved = moved.minus(self.motion(side, other), rise)
        return moved

    @property
    def rack(self) -> Array:
        """The displacement of the Pitman arm's ball along its circle, (n,) [m]."""
        return self.parts.inputs[:, self.model.input_names.index("rack_position")]

    @cached_property
    def design_track(self) -> float:
        """The distance of the wheel centres at design [m]."""
        return 2.0 * float(self.axle.half_track)

    @cached_property
    def turned(self) -> tuple[Array, Array]:
        """Steer angles without those of the middle position at these heights, left first [rad].

        NaN where the middle position is out of reach.
        """
        heights = [self.wheel_center(side)[:, 2] - self.axle.center[2] for side in SIDES]
        states = self.model.placed(*heights)
        fine = np.isfinite(states).all(axis=-1)
        middle = SteeredRigidAxleKinematics(type(self.parts).of(self.model, states[fine]))
        found = []
        for side, corner in self.corners.items():
            angle = np.full(len(states), np.nan)
            angle[fine] = wheel.steer(corner)[fine] - wheel.steer(middle.corners[side])
            found.append(angle)
        return found[0], found[1]


class SteeredRigidAxleAssembly(RigidAxleAssembly):
    """A steered rigid axle; `model` has its equations, if they exist already."""

    AXLE, MODEL, PARTS = SteeredRigidAxle, SteeredRigidAxleModel, SteeredRigidAxleParts
    KINEMATICS = SteeredRigidAxleKinematics
    MEASURES, OVER_STEERING, OVER_RACK = MEASURES, OVER_STEERING, OVER_RACK
    ENDS = (
        "a rod, the drag link, the track rod or a damper reaches no farther, or a spring or a "
        "damper has turned by a right angle"
    )

    axle: SteeredRigidAxle
    on_a_beam = False  # each wheel has a knuckle with a steer angle of its own

    @property
    def words(self) -> str:
        return (
            f"{super().words} A Pitman arm moves the drag link to the {self.axle.near} knuckle, "
            "and a track rod turns the other one."
        )

    def between(
        self, poses: Mapping[str, PartPoses], loads: Sequence[Load]
    ) -> tuple[list[Load], dict[str, BodyPose]]:
        return on_the_steering(poses[""], loads, "")

    def further(
        self, over: str, poses: Mapping[str, Any], found: "xr.Dataset"
    ) -> "dict[str, xr.Variable]":
        steering = steering_of(self.axle.steering_gear, over, found)
        knuckles = {DRAG_LINK: knuckle(self.axle.near), TRACK_ROD: knuckle(RIGHT)}
        for name, (first, last) in _LINKS.items():
            end = f"{knuckles[name]} at {last} by {name}"
            force = pull(found, end, poses[""].along(first, last))
            words = f"force along the {name.replace('_', ' ')}, positive in tension"
            steering[f"{name}_force"] = variable(over, force, words, "N")
        return super().further(over, poses, found) | steering

    def described(self) -> dict[str, str]:
        links = lengths_of(self.axle.links())
        return super().described() | {"steering": f"{links}, drag link at the {self.axle.near}"}
