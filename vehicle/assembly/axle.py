"""An axle as an assembly: two corners, with a rack and an anti-roll bar between them."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...core.named_types import Array
from ...core.validator import Validator
from ..corner.bushes import described_bushings, mirrored_bushings, softness_of_rack
from ..models.axle import Axle
from ..models.axle.bar import unlikely_bar
from ..models.axle.equations import AxleModel
from ..models.car.car import AnyAxle
from ..models.model import Model
from ..models.plausibility import Plausibility
from ..models.reach import PositionError
from ..models.sides import LEFT, RIGHT, SENSE, SIDES
from ..models.whole_axle import WholeAxle
from . import motions
from .anti_roll_bar import Bar, on_the_bar, pull_of_bar, rules_of, turn_of_half
from .assembly import Bushings, HeldAssembly, WheelNames
from .axle_kinematics import AxleKinematics, refuse_loose_link
from .corner import CornerAssembly, lines_of, poses_of
from .coupling import BodyPose
from .load import Load
from .measures.axle import OVER_RACK, OVER_STEERING, OVER_TRAVEL
from .part_poses import CornerParts, PartPoses, states_with
from .rest import settled
from .rig import RestConditions, RigPosition, SweepRange, WheelReach
from .soft_lines import SoftLines
from .steered import SteerableAssembly, motions_of_two
from .steering_linkage import on_the_steering, steering_of
from .whole_axle import whole_axle_assembly

if TYPE_CHECKING:
    import xarray as xr

_NO_REST = (
    "the axle has no stable equilibrium near that of its sides. Check the anti-roll bar's "
    "free_twist_deg and rate, or the heights of the road."
)


class AxleAssembly(SteerableAssembly):
    """An axle of two corners; `model` has its equations, if they exist already."""

    MEASURES, OVER_STEERING, OVER_RACK = OVER_TRAVEL, OVER_STEERING, OVER_RACK
    ENDS = "the linkage or a drop link reaches no farther"
    BAR_SIGN = "positive with the left half turned farther about the axis to the left"

    def __init__(self, axle: Axle, model: AxleModel | None = None) -> None:
        self.subject = self.axle = axle
        self._model = model
        self.wheeled = [*axle.sides.values()]
        self.symmetric = axle.symmetric
        names = {"anti_roll_bar": "bar", "drive": "drive", "brakes": "brakes"}
        found = {name: getattr(axle, own) for name, own in names.items()}
        found["steering"] = axle.steering
        self.own_sections = {name: each for name, each in found.items() if each is not None}
        self.motions = motions_of_two() | self.of_steering()

    @property
    def design_sections(self) -> dict[str, dict[str, Any]]:
        """The sections of its own file, of both sides together if they are images, and of each."""
        whole = self.axle.to_dict()
        found = {f"{side}.": each.to_dict() for side, each in self.axle.sides.items()}
        if "side" in whole:
            found = {"side.": whole.pop("side")} | found
        own = {name: values for name, values in whole.items() if name not in SIDES}
        return found | {"": own}

    @property
    def words(self) -> str:
        by = f", {self.axle.steering_gear.WORDS}" if self.steered else ""
        words = [
            f"Both wheels of the {self.axle.heading()}{by}.",
            "One side is the mirror image of the other." if self.symmetric else "The sides differ.",
            *(f"Anti-roll bar: {bar}." for bar in self.described().values()),
        ]
        return " ".join(words)

    def usual_travel(self, motion: str, far: SweepRange) -> Array:
        if motion == "roll":
            return motions.rolls(self.axle, far)
        return motions.travels(self.axle, far, (motion,) if motion in SIDES else SIDES)

    def usual_racks(self, far: SweepRange) -> Array:
        return motions.racks(self.axle, far)

    def travels_in(self, motion: str, along: Array, rack: float) -> tuple[Array, Array]:
        if motion == "roll":
            return motions.opposite(self.axle, along, rack)
        left, right = (
            along if motion in ("bump", side) else np.zeros_like(along) for side in SIDES
        )
        return left, right

    @cached_property
    def model(self) -> AxleModel:
        """Its equations, derived and compiled when they are first needed."""
        return AxleModel(self.axle) if self._model is None else self._model

    @property
    def coordinates(self) -> tuple[str, ...]:
        return tuple(f"{side}_{model.names.arm}" for side, model in self.axle.models.items())

    def names_of(self, wheel: str) -> WheelNames:
        names, prefix = self.axle.models[wheel].names, f"{wheel}_"
        signals = f"{prefix}{self.axle.end}_"
        return WheelNames(prefix, signals, f"{prefix}{names.spin}", f"{prefix}{names.actuator}")

    def wheel_equations(self, wheel: str) -> tuple[Model, str, Mapping[str, str]]:
        model = self.axle.models[wheel]
        return model, "", {model.names.arm: f"{wheel}_{model.names.arm}"}

    def coordinates_at_rest(self, held: RestConditions) -> Array:
        """Return the arm angles of the state of rest nearest to that of the sides without a bar."""
        # further inputs have other names in the equations of a side
        alone = replace(held, inputs={})
        sides = self._corners.values()
        near = np.concatenate([side.coordinates_at_rest(alone) for side in sides])
        return settled(self, held, near, _NO_REST)

    def coordinates_of(self, suffix: str) -> dict[str, str]:
        return {self.axle.models[suffix.removeprefix("_")].names.arm: "arm_angle"}

    def joints(self, suffix: str) -> tuple[str, ...]:
        return self.axle.sides[suffix.removeprefix("_")].hardpoints.JOINTS

    def kinematics(self, position: RigPosition) -> AxleKinematics:
        left, right = (position.travels[side] for side in SIDES)
        return AxleKinematics.at(self.axle, left, right, position.rack, position.per_turn)

    def poses(self, position: RigPosition) -> dict[str, PartPoses]:
        found: dict[str, PartPoses] = {}
        for side, model in self.axle.models.items():
            poses = poses_of(model, position.travels[side], position.rack)
            if self.axle.halves:
                _, turn = turn_of_half(self.axle, side, poses)
                travel = np.asarray(position.travels[side])
                refuse_loose_link(side, turn, travel, np.asarray(position.rack))
            found[f"_{side}"] = poses
        return found

    def soft_lines(self, poses: Mapping[str, PartPoses]) -> dict[str, SoftLines]:
        return {suffix: lines_of(each) for suffix, each in poses.items()}

    @cached_property
    def _corners(self) -> dict[str, CornerAssembly]:
        return {side: CornerAssembly(model) for side, model in self.axle.models.items()}

    @property
    def independent(self) -> Sequence[HeldAssembly]:
        """The sides, if no anti-roll bar joins them."""
        return (self,) if self.axle.halves else tuple(self._corners.values())

    @property
    def design_wheel_coordinates(self) -> Array:
        return np.concatenate([one.design_wheel_coordinates for one in self._corners.values()])

    def wheel_coordinates(self, travels: Sequence[float | None], rack: float) -> Array:
        found = []
        for (side, one), travel in zip(self._corners.items(), travels, strict=True):
            try:
                found.append(one.wheel_coordinates([travel], rack))
            except PositionError as error:
                raise PositionError(f"{side}: {error}") from None
        return np.concatenate(found)

    def wheel_reach(self, rack: float) -> list[WheelReach]:
        return [reach for one in self._corners.values() for reach in one.wheel_reach(rack)]

    def at_wheel_coordinates(self, coordinates: Array, racks: Array) -> dict[str, PartPoses]:
        sides = enumerate(self._corners.items())
        return {f"_{side}": one.at_angles(coordinates[:, i], racks) for i, (side, one) in sides}

    def reached(self, coordinates: Array, racks: Array) -> NDArray[np.bool_]:
        """Return where the drop links reach."""
        found = super().reached(coordinates, racks)
        for i, side in enumerate(self.axle.halves):
            poses = self._corners[side].at_angles(coordinates[:, i], racks)
            found &= np.isfinite(turn_of_half(self.axle, side, poses)[1])
        return found

    @property
    def rules(self) -> tuple[str, ...]:
        own = [rule for side in self.axle.sides.values() for rule in side.structure().rules]
        return tuple(dict.fromkeys([*own, *rules_of(self.axle)]))

    def acting(self, poses: Mapping[str, Any]) -> dict[str, list[Load]]:
        found = super().acting(poses)
        if self.axle.halves:
            torque = self.bar_torque(poses)
            for side in SIDES:
                pull = pull_of_bar(self.axle, side, poses[f"_{side}"], torque)
                found[f"_{side}"].append(pull)
        return found

    def between(
        self, poses: Mapping[str, PartPoses], loads: Sequence[Load]
    ) -> tuple[list[Load], dict[str, BodyPose]]:
        bar, places = on_the_bar(self.axle, poses, loads) if self.axle.halves else ([], {})
        steering, of_steering = on_the_steering(poses[f"_{LEFT}"], loads, "rack_middle")
        return [*bar, *steering], places | of_steering

    def further(
        self, over: str, poses: Mapping[str, PartPoses], found: "xr.Dataset"
    ) -> "dict[str, xr.Variable]":
        of_bar = super().further(over, poses, found)
        if not self.steered:
            return of_bar
        return steering_of(self.axle.steering_gear, over, found) | of_bar

    def in_motion(
        self, states: Array, inputs: Array
    ) -> tuple[dict[str, PartPoses], dict[str, Array]]:
        model = self.model
        by_time = model.evaluate("rhs", states, inputs)
        poses: dict[str, PartPoses] = {}
        rates = {}
        for side, corner in model.corners.items():
            columns = [model.state_names.index(f"{side}_{name}") for name in corner.state_names]
            own = [f"{side}_{name}" for name in corner.input_names]
            given = [
                model.input_names.index(name if name in model.input_names else shared)
                for name, shared in zip(own, corner.input_names, strict=True)
            ]
            poses[f"_{side}"] = CornerParts.of(corner, states[:, columns], inputs[:, given])
            rates[f"_{side}"] = by_time[:, columns]
        return poses, rates

    def parts_with(self, values: Mapping[str, Array], count: int) -> dict[str, PartPoses]:
        return {
            f"_{side}": CornerParts.of(corner, *states_with(corner, values, count, f"{side}_"))
            for side, corner in self.axle.models.items()
        }

    def described_bushings(
        self, given: Validator, bushings: Mapping[str, Any] | None
    ) -> dict[str, dict[str, Any]]:
        """Return the descriptions of bushes by side: those of the files, or given ones, mirrored.

        A problem of the given ones names the side that they describe.
        """
        if bushings is None:
            return {
                side: described_bushings(given, None, suspension.bushings)
                for side, suspension in self.axle.sides.items()
            }
        one = self.axle.bar_side
        other = LEFT if one == RIGHT else RIGHT
        described = described_bushings(given, bushings, None)
        with_one = Validator("compliance")
        self.axle.sides[one].bushes(with_one, described)
        return {one: described, other: {} if with_one.failed else mirrored_bushings(described)}

    def with_bushings(self, bushings: Mapping[str, Any]) -> Axle:
        with Validator("compliance") as given:
            described = self.described_bushings(given, bushings)
        changes = {f"{side}.bushings": described[side] for side in SIDES}
        return self.axle.with_changes(changes)

    def bushes(self, given: Validator, bushings: Mapping[str, Any] | None) -> Bushings:
        described = self.described_bushings(given, bushings)
        found = {f"_{side}": self.axle.sides[side].bushes(given, described[side]) for side in SIDES}
        return Bushings(found, softness_of_rack(given, described[self.axle.bar_side]))

    @property
    def corners(self) -> Mapping[str, Model]:
        if self.axle.symmetric:
            return {self.axle.bar_side: self.axle.models[self.axle.bar_side]}
        return {side: self.axle.models[side] for side in SIDES}

    def plausibility(self) -> Plausibility:
        bar = self.axle.bar
        if bar is None:
            return Plausibility((), ())
        note = "the anti-roll bar is bent at design: the sides' equilibrium is without it"
        return Plausibility(tuple(unlikely_bar(bar)), (note,) if bar.free_twist_deg else ())

    def described(self) -> dict[str, str]:
        bar = self.axle.bar
        if bar is None:
            return {}
        soft = ", its bushes or drop links included" if bar.gives_way() else ""
        part = bar.link_on.replace("_", " ")
        rate = np.deg2rad(bar.rate())
        return {"anti-roll bar": f"{rate:.4g} N m/deg{soft}, drop links on the {part}"}

    def without_friction(self) -> "AxleAssembly":
        left, right = (one.without_friction() for one in self.axle.sides.values())
        return AxleAssembly(replace(self.axle, left=left, right=right))

    @property
    def bar(self) -> Bar | None:
        if self.axle.bar is None:
            return None
        halves = self.axle.halves[LEFT], self.axle.halves[RIGHT]
        return Bar(self.axle.bar.rate(), halves, self.axle.bar.free_twist())

    def bar_loads(self, poses: Mapping[str, Any]) -> dict[str, list[Load]]:
        if not self.axle.halves:
            return {}
        return {f"_{side}": [pull_of_bar(self.axle, side, poses[f"_{side}"])] for side in SIDES}

    def bar_twist(self, poses: Mapping[str, Any]) -> dict[str, Array]:
        return {
            f"_{side}": SENSE[side] * turn_of_half(self.axle, side, poses[f"_{side}"])[1]
            for side in self.axle.halves
        }


def axle_assembly(axle: AnyAxle) -> SteerableAssembly:
    """Return an axle of two sides, or one without sides, as an assembly."""
    if isinstance(axle, WholeAxle):
        return whole_axle_assembly(axle.KEY)(axle)
    return AxleAssembly(axle)
