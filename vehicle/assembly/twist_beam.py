"""A twist-beam axle as an assembly: two trailing arms, and between them a beam that twists."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from ..corner.corner import Array
from ..models.sides import LEFT, RIGHT, SIDES
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
from .mass import PartMass
from .measures.measure import Measure
from .measures.twist_beam import MEASURES
from .part_poses import CENTER, CONTACT, PartPoses
from .rig import RigPosition
from .soft_lines import SoftLines, lines_of_beam
from .twist_beam_kinematics import TwistBeamKinematics
from .wheel import lowest_point
from .whole_axle import WholeAxleAssembly
from .whole_axle_kinematics import SENSE
from .whole_axle_parts import BAR, WholeAxleParts

_MIRROR = np.diag([1.0, -1.0, 1.0])
_ARMS = {f"arm_{side}": f"{side}_arm" for side in SIDES}
_WHEELS = {f"wheel_{side}": f"{side}_wheel" for side in SIDES}
_ENDS_OF_ROLL, _CLOSE = 20, 1e-15


@dataclass(frozen=True)
class TwistBeamParts(WholeAxleParts):
    """A twist-beam axle in n positions: both arms, each with half the beam, and both wheels.

    Attributes
    ----------
    model : TwistBeamModel
    states, inputs, centers, turned, points
        As of `WholeAxleParts`.
    """

    model: TwistBeamModel

    PARAMETERS: ClassVar[Mapping[str, str]] = {
        **dict.fromkeys(_ARMS, "arm"),
        f"wheel_{LEFT}": "left_wheel",
        f"wheel_{RIGHT}": "wheel",
    }
    MASSIVE: ClassVar[Mapping[str, str]] = _ARMS | _WHEELS

    @classmethod
    def of(
        cls, model: TwistBeamModel, states: Array, inputs: Array | None = None
    ) -> "TwistBeamParts":
        """Return the parts in some states, by default without any input."""
        if inputs is None:
            inputs = np.zeros((len(states), len(model.input_names)))
        rows = [model.equations.BODIES.index(body) for body in cls.MASSIVE.values()]
        places = np.moveaxis(model.evaluate("positions", states, inputs)[:, rows], 1, 0)
        turns = np.moveaxis(model.evaluate("orientations", states, inputs)[:, rows], 1, 0)
        centers, turned = (dict(zip(cls.MASSIVE, part, strict=True)) for part in (places, turns))
        return cls(model, states, inputs, centers, turned, _points(model.axle, centers, turned))

    @property
    def axle(self) -> TwistBeamAxle:
        """The axle."""
        return self.model.axle

    @cached_property
    def design(self) -> dict[str, Array]:
        """The points at design, (3,) [m]."""
        centers = {f"arm_{side}": _com(self.axle, side)[None] for side in SIDES}
        turned = dict.fromkeys(centers, np.eye(3)[None])
        return {name: at[0] for name, at in _points(self.axle, centers, turned).items()}

    def carrier(self, side: str) -> str:
        """Return the arm of a wheel."""
        return f"arm_{side}"

    def masses(self) -> dict[str, PartMass]:
        """Return what the acceleration of parts moves; the left arm is the right one's image."""
        found = super().masses()
        arm = found[f"arm_{LEFT}"]
        return found | {f"arm_{LEFT}": replace(arm, tensor=_MIRROR @ arm.tensor @ _MIRROR)}

    def beam_twist(self) -> Array:
        """Return the twist of the beam, positive with the left wheel up, (n,) [rad]."""
        angle: Array = self.states[:, self.model.state_names.index(TWIST)]
        return self.axle.twist_ratio * angle

    def beam_by_torque(self) -> list[Load]:
        """Return what a unit torque of the beam does on both arms: against its twist."""
        at = self.points[SHEAR_CENTER]
        return [
            Load(f"arm_{side}", SHEAR_CENTER, BAR, np.zeros(3), -SENSE[side] * ACROSS, at)
            for side in SIDES
        ]

    def _of_bar(self) -> list[Load]:
        torque = float(np.degrees(self.axle.beam.rate_Nm_per_deg)) * self.beam_twist()
        if not self.axle.beam.rate_Nm_per_deg:
            return []
        return [replace(o, moment=torque[:, None] * o.moment) for o in self.beam_by_torque()]


class TwistBeamAssembly(WholeAxleAssembly):
    """A twist-beam axle.

    Parameters
    ----------
    axle : TwistBeamAxle
    model : TwistBeamModel, optional
        Its equations, where there are some already.
    """

    AXLE, MODEL = TwistBeamAxle, TwistBeamModel
    ENDS = "a damper reaches no farther, or a spring or a damper has turned by a right angle"
    MODES: ClassVar[Mapping[str, str]] = {LIFT: "axle hop", TWIST: "axle tramp"}

    axle: TwistBeamAxle

    @property
    def words(self) -> str:
        """What it is, in sentences."""
        return (
            f"A {self.axle.heading()}: two arms and a beam of {self.axle.beam.rate_Nm_per_deg:.4g} "
            "N m/deg between them."
        )

    def _travels(self, motion: str, along: Array) -> tuple[Array, Array]:
        """Return the travels of the left and the right wheel along a motion [m].

        In roll they are opposite, by as much as turns the line through the wheel centres.
        """
        left, right = super()._travels(motion, along)
        if motion != "roll":
            return left, right
        half = np.atleast_1d(right)
        wanted = np.atleast_1d(np.tan(along))
        for _ in range(_ENDS_OF_ROLL):
            states = self.model.placed(-half, half)
            apart = TwistBeamKinematics(self.model, np.nan_to_num(states))
            line = apart.wheel_center(LEFT) - apart.wheel_center(RIGHT)
            before, half = half, 0.5 * np.hypot(line[:, 0], line[:, 1]) * wanted
            if not (np.abs(half - before) > _CLOSE).any():
                break
        half = half.reshape(np.shape(along))
        return -half, half

    def parts(self, states: Array, inputs: Array | None = None) -> TwistBeamParts:
        """Return its parts in states of its equations."""
        return TwistBeamParts.of(self.model, states, inputs)

    def measures(self, motion: str) -> tuple[Measure, ...]:
        """Return its characteristics, the same over all motions."""
        del motion
        return MEASURES

    def kinematics(self, position: RigPosition) -> TwistBeamKinematics:
        """Return how the axle is and how it moves first."""
        left, right = (position.travels[side] for side in SIDES)
        return TwistBeamKinematics(self.model, self.model.states_at(left, right))

    def soft_lines(self, poses: Mapping[str, PartPoses]) -> dict[str, SoftLines]:
        """Return how springs and stops deflect."""
        return {"": lines_of_beam(TwistBeamKinematics(self.model, poses[""].states))}

    def described(self) -> dict[str, str]:
        """Return its track and its beam in words."""
        far = 1e3 * float(self.axle.pivot[0] - self.axle.shear_center[0])
        return {
            "track": f"{2e3 * self.axle.half_track:.4g} mm",
            "beam": f"{self.axle.beam.rate_Nm_per_deg:.4g} N m/deg, its shear centre {far:.1f} mm "
            "behind the pivots",
        }

    @property
    def bar(self) -> TwistBar | None:
        """The beam, where it has a rate."""
        rate = float(np.degrees(self.axle.beam.rate_Nm_per_deg))
        if not rate:
            return None
        return TwistBar(f"arm_{RIGHT}", f"arm_{LEFT}", ACROSS, rate, TwistBeamParts.beam_twist)

    def bar_loads(self, poses: Mapping[str, Any]) -> dict[str, list[Load]]:
        """Return the couples of a unit torque of the beam."""
        return {"": poses[""].beam_by_torque()} if self.bar else {}

    def bar_twist(self, poses: Mapping[str, Any]) -> dict[str, Array]:
        """Return the twist of the beam, (n,) [rad]."""
        return {"": poses[""].beam_twist()}


def _com(axle: TwistBeamAxle, side: str) -> Array:
    """Return the centre of mass of an arm at design [m]."""
    right = axle.bodies.arm.centre_of_mass(axle.hardpoints)
    return np.asarray(right if side == RIGHT else _MIRROR @ right)


def _points(
    axle: TwistBeamAxle, centers: Mapping[str, Array], turned: Mapping[str, Array]
) -> dict[str, Array]:
    """Return all points where the arms' centres of mass are at some places, and how they turned."""
    found = {}
    for side in SIDES:
        center, turn = centers[f"arm_{side}"], turned[f"arm_{side}"]
        for name, point in axle.points(side).items():
            still = name.endswith("_top") or name == PIVOT
            moved = center + turn @ (point - _com(axle, side))
            found[f"{name}_{side}"] = np.broadcast_to(point, center.shape) if still else moved
        axis = turn @ axle.wheel.spin_axis(SENSE[side])
        if (radius := axle.tyre_radius()) is not None:
            found[f"{CONTACT}_{side}"] = lowest_point(found[f"{CENTER}_{side}"], axis, radius)
    arm = f"arm_{RIGHT}"
    at_beam = axle.shear_center - _com(axle, RIGHT)
    return found | {SHEAR_CENTER: centers[arm] + turned[arm] @ at_beam}
