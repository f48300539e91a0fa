"""Kinematics of both wheels of an axle and of its anti-roll bar, over n positions."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...core.errors import InputError
from ...core.named_types import Array, ArrayLike
from ..corner.corner import Corner
from ..models.axle import Axle
from ..models.axle.bar import HalfBar
from ..models.model import Model
from ..models.points import carried, carried_velocity
from ..models.positions import PositionError, arm_angles, design_height
from ..models.reach import at_rest, height_and_slope
from ..models.sides import LEFT, RIGHT, SENSE
from . import motions, wheel
from .corner_kinematics import corner
from .two_wheels import TwoWheels
from .wheel_centre_line import inclination_rate

# The slope of a half's angle over travel is exact; its derivative is a difference of fourth order
# with this step of the arm's angle [rad]: the error is its fourth power, and rounding over it.
_STEP = 1e-3
_WEIGHTS = {-2: 1 / 12, -1: -8 / 12, 1: 8 / 12, 2: -1 / 12}


@dataclass(frozen=True)
class Half:
    """Half an anti-roll bar over wheel travel."""

    turn: Array  # angle from design, right-handed about the axis to the left [rad]
    # first and second derivative with respect to wheel travel [rad/m], [rad/m^2]
    slope: Array
    curvature: Array
    lever: Array  # lever of the drop link's pull about the bar's axis [m]; signed


@dataclass(frozen=True)
class AxleKinematics(TwoWheels):
    """Both wheels of an axle in n positions, the leading dimension of every array."""

    axle: Axle
    corners: dict[str, Corner]  # by side, the left one first
    travel: dict[str, Array]  # wheel travel of each side [m]
    halves: dict[str, Half]  # by side; empty without an anti-roll bar
    rack: Array  # displacement of the rack [m]
    # signed rack travel for one turn of the steering wheel there [m]; None if no steering wheel
    # turns
    per_turn: Array | None = None

    @classmethod
    def at(
        cls,
        axle: Axle,
        left: ArrayLike,
        right: ArrayLike,
        rack: ArrayLike,
        per_turn: Array | None = None,
    ) -> "AxleKinematics":
        """Return the axle at wheel travels and displacements of the rack [m].

        Raises `PositionError` if a wheel cannot be there, with the range; `InputError` if a drop
        link does not reach, or is at its dead centre.
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
            rack=racks,
            per_turn=per_turn,
        )

    # -- its anti-roll bar ------------------------------------------------------------------------

    @property
    def twist(self) -> Array:
        """Twist of the bar, left half less right half [rad]; zero without one."""
        if not self.halves:
            return np.zeros_like(self.travel[LEFT])
        return self.halves[LEFT].turn - self.halves[RIGHT].turn

    @property
    def torque(self) -> Array:
        """Torque of the bar, positive with the left half turned farther [N m]."""
        bar = self.axle.bar
        if bar is None:
            return np.zeros_like(self.travel[LEFT])
        return bar.rate() * (self.twist - bar.free_twist())

    # -- forces and rates -------------------------------------------------------------------------

    def contact(self, side: str) -> Array:
        return wheel.contact(self.corners[side])

    def wheel_force(self, side: str) -> Array:
        force = wheel.wheel_force(self.corners[side])
        if side in self.halves:
            force = force + SENSE[side] * self.torque * self.halves[side].slope
        return force

    @property
    def springs(self) -> Array:
        return _diagonal(*(wheel.wheel_rate(corner) for corner in self.corners.values()))

    @property
    def bar(self) -> Array:
        given = self.axle.bar
        if given is None:
            return np.zeros((*self.twist.shape, 2, 2))
        slopes = np.stack([SENSE[side] * self.halves[side].slope for side in (LEFT, RIGHT)], -1)
        bent = (SENSE[s] * self.torque * self.halves[s].curvature for s in (LEFT, RIGHT))
        stiffness: Array = given.rate() * slopes[..., :, None] * slopes[..., None, :]
        return stiffness + _diagonal(*bent)

    @property
    def rolled(self) -> tuple[Array, Array]:
        line = self.left.center - self.right.center
        # per travel of the right wheel up and the left one down
        rate = self.left.travel.velocity + self.right.travel.velocity
        by_travel = inclination_rate(line, rate)
        opposite = np.stack([-np.ones_like(by_travel), np.ones_like(by_travel)], -1)
        travels = opposite / by_travel[:, None]
        moved = [wheel.contact_rate(corner)[..., 1] for corner in self.corners.values()]
        return travels, np.stack(moved, -1) * travels

    def path_slope(self, torque_on: str, side: str) -> Array:
        corner = self.corners[side]
        on_body = torque_on == "body"
        velocity = corner.travel.velocity if on_body else wheel.contact_velocity(corner)
        with np.errstate(divide="ignore", invalid="ignore"):
            slope: Array = velocity[..., 0] / velocity[..., 2]
        return slope

    # -- steered ----------------------------------------------------------------------------------

    @cached_property
    def design_track(self) -> float:
        """The distance of the wheel centres at design [m]."""
        return motions.track(self.axle)

    @cached_property
    def turned(self) -> tuple[Array, Array]:
        """Steer angles without static toe, the left wheel first [rad].

        NaN if the wheels cannot be straight ahead at these heights.
        """
        try:
            middle = AxleKinematics.at(
                self.axle, self.travel[LEFT][:1], self.travel[RIGHT][:1], 0.0
            )
            static = [wheel.steer(corner) for corner in middle.corners.values()]
        except PositionError:
            static = [np.array([np.nan])] * 2
        return wheel.steer(self.left) - static[0], wheel.steer(self.right) - static[1]


def refuse_loose_link(side: str, turn: Array, travels: Array, racks: Array) -> None:
    """Raise an `InputError` for positions in which the drop link of a side does not reach.

    Travels of the wheel and displacements of the rack are broadcast [m]; the position nearest to
    the design position is named.
    """
    lost = ~np.isfinite(turn)
    if lost.any():
        there, rack = (1e3 * np.broadcast_to(v, lost.shape)[lost] for v in (travels, racks))
        first = np.hypot(there, rack).argmin()
        steered = f", the rack at {rack[first]:+.4g} mm" if rack[first] else ""
        problem = (
            f"[anti_roll_bar] the {side} drop link does not reach its lever at {there[first]:+.4g} "
            f"mm of wheel travel{steered}. Choose less travel, or move link_top, link_foot or bush."
        )
        raise InputError([problem], "axle")


def _diagonal(left: Array, right: Array) -> Array:
    nothing = np.zeros_like(left)
    return np.stack([np.stack([left, nothing], -1), np.stack([nothing, right], -1)], -2)


def _half(model: Model, half: HalfBar, angle: Array, rack: Array, travel: Array, side: str) -> Half:
    turn, slope, lever = _turned(model, half, angle, rack)
    refuse_loose_link(side, turn, travel, rack)
    changes = (
        weight / _STEP * _turned(model, half, angle + by * _STEP, rack)[1]
        for by, weight in _WEIGHTS.items()
    )
    _, rise = height_and_slope(model, angle, rack)
    return Half(turn, slope, np.sum(list(changes), axis=0) / rise, lever)


def _turned(model: Model, half: HalfBar, angle: Array, rack: Array) -> tuple[Array, Array, Array]:
    """Return the angle of a half, its derivative with respect to travel, and the link's lever."""
    states, inputs = at_rest(model, angle, rack)
    foot = carried(model, {"foot": (half.body, half.foot)}, states, inputs)["foot"]
    states, inputs = at_rest(model, angle, rack, arm_rate=1.0)
    velocity = carried_velocity(model, half.body, foot, states, inputs)
    turn = half.turn(foot)
    rise = model.signal("wheel_velocity", states, inputs)
    _, lever = half.lever(foot, turn)
    return turn, half.rate_of_turn(foot, turn, velocity) / rise, lever
