"""The base of assemblies with two wheels that one rack or Pitman arm may steer."""

from abc import abstractmethod
from functools import cached_property
from typing import ClassVar

import numpy as np

from ...core.named_types import Array
from ...core.validator import Validator
from ..models.sides import LEFT, RIGHT, SIDES
from . import motions
from .assembly import HeldAssembly
from .measures.measure import Measure
from .quantity import ROLL, STEERING_WHEEL, TRAVEL
from .rig import STEERING, RigMotion, RigPosition, SweepRange
from .steering_wheel import SteeringWheel


class SteerableAssembly(HeldAssembly):
    """An axle whose wheels may be steered."""

    MEASURES: ClassVar[tuple[Measure, ...]]  # characteristics over motions of the wheels
    # those over angles of the steering wheel, and over displacements of the steering
    OVER_STEERING: ClassVar[tuple[Measure, ...]] = ()
    OVER_RACK: ClassVar[tuple[Measure, ...]] = ()
    wheels = SIDES

    # -- its steering -----------------------------------------------------------------------------

    @cached_property
    def steering_wheel(self) -> SteeringWheel:
        """Its steering wheel; only if it is steered."""
        return SteeringWheel(
            self.wheeled[-1].steering_gear,
            self.subject.steering,
            lambda: self.kinematics(self.at_travel(np.zeros(1))).corners,
        )

    def of_steering(self) -> dict[str, RigMotion]:
        """Return the motions of the steering; none if the wheels are not steered."""
        if not self.steered:
            return {}
        by_gear = self.motion_of_steering("both wheels")
        over = STEERING_WHEEL if self.steering_wheel.known else by_gear.along
        return {
            "steer": RigMotion(over, motions.MOTIONS["steer"], "steering"),
            "rack": by_gear,
        }

    @property
    def missing_ratio(self) -> str:
        """The problem of a file without the ratio of the steering wheel, and what to add."""
        key, own = self.steering_wheel.gear.TURN_KEY, "the file of the axle"
        if self.subject.whole:
            return f"the ratio of the steering wheel is missing: add {key} to {own}."
        return (
            f"the ratio of the steering wheel is missing: add {key} to the file of the axle's "
            f"side, or a curve as [steering] to {own}."
        )

    @property
    def steering_motion(self) -> str | None:
        """The motion of the steering wheel, or of the rack if no file has the steering's ratio."""
        turns = self.steered and self.steering_wheel.known
        return "steer" if turns else "rack" if self.steered else None

    def _turns_the_wheel(self, motion: str) -> bool:
        """Return whether the positions of a motion are angles of the steering wheel."""
        return motion == "steer" and self.steering_wheel.known

    def measures(self, motion: str) -> tuple[Measure, ...]:
        if motion not in STEERING:
            return self.MEASURES
        return self.OVER_STEERING if self._turns_the_wheel(motion) else self.OVER_RACK

    def refuse_positions(self, given: Validator, motion: str, along: Array) -> None:
        """Refuse steering-wheel angles without a known ratio to the rack, or beyond its curve."""
        if motion != "steer":
            return
        wheel = self.steering_wheel
        if not wheel.known:
            given.fail(
                f"along: {self.missing_ratio} Or take the motion 'rack', over displacements of it."
            )
        elif wheel.curve is not None:
            problem = wheel.curve.beyond(along)
            if problem:
                given.fail(problem)

    # -- its positions on a rig -------------------------------------------------------------------

    def usual(
        self, motion: str, ends: SweepRange | None = None, *, travel: float = 0.0, rack: float = 0.0
    ) -> Array:
        far = ends or SweepRange()
        if motion not in STEERING:
            return self.usual_travel(motion, far)
        racks = self.usual_racks(far)
        angles = self.steering_wheel.usual(float(racks[-1])) if motion == "steer" else None
        return racks if angles is None else angles

    @abstractmethod
    def usual_travel(self, motion: str, far: SweepRange) -> Array:
        """Return the default positions of a motion of the wheels, zero included [m] or [rad]."""

    @abstractmethod
    def usual_racks(self, far: SweepRange) -> Array:
        """Return default displacements of the steering within its range, zero included [m]."""

    def position(
        self, motion: str, along: Array, *, travel: float = 0.0, rack: float = 0.0
    ) -> RigPosition:
        if motion in STEERING:
            wheel, travels = self.steering_wheel, np.full_like(along, travel)
            racks, per_turn = (
                wheel.rack(along)
                if self._turns_the_wheel(motion)
                else (along, wheel.per_turn_at(along))
            )
            return RigPosition(dict.fromkeys(SIDES, travels), racks, per_turn)
        left, right = self.travels_in(motion, along, rack)
        return RigPosition({LEFT: left, RIGHT: right}, np.asarray(rack, float))

    @abstractmethod
    def travels_in(self, motion: str, along: Array, rack: float) -> tuple[Array, Array]:
        """Return the travels of the left and the right wheel in a motion of the wheels [m].

        Raises `PositionError` for a roll that is out of reach.
        """


def motions_of_two() -> dict[str, RigMotion]:
    """Return the motions of a rig with two wheels, except steering."""
    words = motions.MOTIONS
    return {
        "bump": RigMotion(TRAVEL, words["bump"], "parallel wheel travel"),
        "roll": RigMotion(ROLL, words["roll"], "roll"),
        LEFT: RigMotion(TRAVEL, words[LEFT], "travel of the left wheel"),
        RIGHT: RigMotion(TRAVEL, words[RIGHT], "travel of the right wheel"),
    }
