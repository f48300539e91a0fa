"""The steering wheel of an axle: its ratio to a rack or a Pitman arm, and its sign."""

from collections.abc import Callable, Mapping
from functools import cached_property

import numpy as np

from ...core.errors import InputError
from ...core.named_types import Array
from ..corner.corner import Corner
from ..input.pitman_arm import PitmanArmSection
from ..input.vehicle import Steering
from ..models.axle import SteeringCurve
from .usual import grid
from .wheel import steer_gradient

_USUAL_STEP = np.deg2rad(10.0)
_MOST_TURNS = 40.0 * np.pi  # twenty turns of it


class SteeringWheel:
    """The steering wheel of an axle; displacements are those of the rack, or of a Pitman arm.

    `curve` has the displacement over the angle, instead of the ratio of the gear; `design` returns
    the wheels at design by name.
    """

    def __init__(
        self,
        gear: Steering | PitmanArmSection,
        curve: SteeringCurve | None,
        design: Callable[[], Mapping[str, Corner]],
    ) -> None:
        self.gear, self.curve, self._design = gear, curve, design

    @cached_property
    def sense(self) -> float:
        """+1 if a positive displacement steers to the left, else -1."""
        gradients = [steer_gradient(wheel) for wheel in self._design().values()]
        return float(np.sign(np.sum(gradients)))

    @property
    def known(self) -> bool:
        """Whether the files have the ratio of steering wheel and rack."""
        return self.curve is not None or self.gear.travel_per_turn() is not None

    def usual(self, most: float) -> Array | None:
        """Return default angles for displacements up to `most` to either side [m], in rad.

        None if no file has the ratio.
        """
        inside = None
        if self.curve is not None:
            low, high = self.curve.limits()
            dense = np.linspace(low, high, 2001)
            inside = dense[np.abs(self.curve.rack(dense)) <= most * (1.0 + 1e-9)]
            ends = (float(inside[0]), float(inside[-1])) if inside.size else (1.0, 1.0)
        else:
            per_turn = self.gear.travel_per_turn()
            if per_turn is None:
                return None
            ends = -2.0 * np.pi * most / per_turn, 2.0 * np.pi * most / per_turn
        if not -_MOST_TURNS < ends[0] <= 0.0 <= ends[1] < _MOST_TURNS:
            correct = (
                self.gear.TURN_KEY
                if self.curve is None
                else "[steering] angle_deg and rack_mm (0 mm in the middle)"
            )
            problem = (
                f"the steering wheel turns from {np.degrees(ends[0]):.4g} deg to "
                f"{np.degrees(ends[1]):.4g} deg as the rack moves {1e3 * most:.4g} mm to either "
                "side; the range must contain 0 deg, and have 20 turns at most. Correct "
                f"{correct}."
                if inside is None or inside.size
                else f"[steering] rack_mm has no displacement within the {1e3 * most:.4g} mm that "
                "the rack moves to either side. Measure it from the middle position."
            )
            raise InputError([problem], "axle")
        return grid(*ends, _USUAL_STEP)

    def rack(self, angles: Array) -> tuple[Array, Array]:
        """Return displacements at angles, and the signed displacement per turn there [m].

        `angles` are positive to the left [rad].
        """
        if self.curve is not None:
            rises = self.curve.rack_mm[-1] > self.curve.rack_mm[0]
            if (1.0 if rises else -1.0) * self.sense < 0.0:
                problem = (
                    f"[steering] rack_mm {'rises' if rises else 'falls'} with the angle, and that "
                    "steers to the right: angles of the steering wheel are positive to the left. "
                    "Change the sign of angle_deg or of rack_mm."
                )
                raise InputError([problem], "axle")
            return self.curve.rack(angles), self.curve.travel_per_turn(angles)
        amount = self.gear.travel_per_turn()
        assert amount is not None
        # files have it without sign: a steering wheel turned to the left steers to the left
        per_turn = amount * self.sense
        return angles * per_turn / (2.0 * np.pi), np.full_like(angles, per_turn)

    def per_turn_at(self, racks: Array) -> Array | None:
        """Return the signed displacement per turn at displacements [m].

        None if no file has it, and NaN beyond the points of a curve.
        """
        if self.curve is not None:
            return self.curve.travel_per_turn_at(racks)
        amount = self.gear.travel_per_turn()
        return None if amount is None else np.full_like(racks, amount * self.sense)

    def motion(self, angle: Array, rate: Array, acceleration: Array) -> tuple[Array, Array, Array]:
        """Return displacement, velocity and acceleration [m, m/s, m/s^2].

        Those of the steering wheel are positive to the left [rad, rad/s, rad/s^2].
        """
        position, per_turn = self.rack(angle)
        slope = per_turn / (2.0 * np.pi)
        bend = np.zeros_like(slope) if self.curve is None else self.curve.bend(angle)
        return position, slope * rate, slope * acceleration + bend * rate * rate
