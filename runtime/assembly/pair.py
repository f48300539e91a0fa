"""Both wheels of an axle and its anti-roll bar, in many positions."""

from dataclasses import dataclass

import numpy as np

from ..core.errors import InputError
from ..core.named_types import ArrayLike
from ..core.vectors import cross
from ..suspension.axle import Axle
from ..suspension.axle.axle import LEFT, RIGHT
from ..suspension.axle.bar import HalfBar
from ..suspension.corner import Array, Corner
from ..suspension.model import Model
from ..suspension.points import carried
from ..suspension.positions import arm_angles, design_height
from ..suspension.reach import at_rest, height_and_slope
from .from_model import corner

# The slope of a half's angle over travel is exact; its change is a difference of fourth order over
# this step of the arm's angle [rad]: an error of the fourth power of that, and rounding over it.
_STEP = 1e-3
_WEIGHTS = {-2: 1 / 12, -1: -8 / 12, 1: 8 / 12, 2: -1 / 12}


@dataclass(frozen=True)
class Half:
    """Half an anti-roll bar over wheel travel.

    Attributes
    ----------
    turn : ndarray
        Angle from design, right-handed about the axis to the left [rad].
    slope, curvature : ndarray
        First and second derivative by wheel travel [rad/m], [rad/m^2].
    lever : ndarray
        Of the drop link's pull about the bar's axis [m]; signed.
    """

    turn: Array
    slope: Array
    curvature: Array
    lever: Array


@dataclass(frozen=True)
class Pair:
    """Both wheels of an axle; every array has one leading dimension, that of the positions.

    Attributes
    ----------
    axle : Axle
    corners : dict of str to Corner
        By side, the left one first.
    travel : dict of str to ndarray
        Wheel travel of each side [m].
    halves : dict of str to Half
        By side; empty without an anti-roll bar.
    """

    axle: Axle
    corners: dict[str, Corner]
    travel: dict[str, Array]
    halves: dict[str, Half]

    @classmethod
    def at(cls, axle: Axle, left: ArrayLike, right: ArrayLike, rack: ArrayLike) -> "Pair":
        """Return an axle at wheel travels and displacements of the rack [m].

        Raises
        ------
        PositionError
            If a wheel cannot be there; the message states the range.
        InputError
            If a drop link does not reach, or is at its dead centre.
        """
        one, two, racks = np.broadcast_arrays(*(np.asarray(v, float) for v in (left, right, rack)))
        travels = {LEFT: np.array(one), RIGHT: np.array(two)}
        angles = {
            side: arm_angles(model, design_height(model) + travels[side], racks)
            for side, model in axle.models.items()
        }
        return cls(
            axle=axle,
            corners={s: corner(m, angles[s], racks) for s, m in axle.models.items()},
            travel=travels,
            halves={
                side: _half(axle.models[side], half, angles[side], racks, travels[side], side)
                for side, half in axle.halves.items()
            },
        )

    @property
    def twist(self) -> Array:
        """Twist of the bar, left half less right half [rad]; zero without one."""
        if not self.halves:
            return np.zeros_like(self.travel[LEFT])
        return self.halves[LEFT].turn - self.halves[RIGHT].turn

    @property
    def torque(self) -> Array:
        """Torque of the bar, positive with the left half turned the farther [N m]."""
        bar = self.axle.bar
        if bar is None:
            return np.zeros_like(self.travel[LEFT])
        return bar.rate() * (self.twist - bar.free_twist())


def _half(model: Model, half: HalfBar, angle: Array, rack: Array, travel: Array, side: str) -> Half:
    turn, slope, lever = _turned(model, half, angle, rack)
    lost = ~np.isfinite(turn)
    if lost.any():
        first = 1e3 * float(travel[lost][np.abs(travel[lost]).argmin()])
        problem = (
            f"[anti_roll_bar] the {side} drop link does not reach its lever at {first:+.4g} mm of "
            "wheel travel. Choose less travel, or move link_top, link_foot or bush."
        )
        raise InputError([problem], "axle")
    changes = (
        weight / _STEP * _turned(model, half, angle + by * _STEP, rack)[1]
        for by, weight in _WEIGHTS.items()
    )
    _, rise = height_and_slope(model, angle, rack)
    return Half(turn, slope, np.sum(list(changes), axis=0) / rise, lever)


def _turned(model: Model, half: HalfBar, angle: Array, rack: Array) -> tuple[Array, Array, Array]:
    """Return the angle of a half, its derivative by wheel travel, and the link's lever."""
    states, inputs = at_rest(model, angle, rack)
    foot = carried(model, {"foot": (half.body, half.foot)}, states, inputs)["foot"]
    states, inputs = at_rest(model, angle, rack, arm_rate=1.0)
    which = model.equations.BODIES.index(half.body)
    twist = model.evaluate("velocities", states, inputs)[..., which, :]
    center = model.evaluate("positions", states, inputs)[..., which, :]
    velocity = twist[..., 3:] + cross(twist[..., :3], foot - center)
    turn = half.turn(foot)
    rise = model.signal("wheel_velocity", states, inputs)
    _, lever = half.lever(foot, turn)
    return turn, half.rate_of_turn(foot, turn, velocity) / rise, lever
