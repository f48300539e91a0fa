"""A rigid axle at many positions: where it is, how it moves first, and what its springs do.

The two motions are those of the coordinates: heave, the middle of the axle rising by a metre with
its inclination held; and roll, the wheels moving oppositely, by a radian with the left wheel up.
Lengths of springs, and their forces, are differentiated by the equations themselves: velocities at
unit rates are first derivatives, and the derivatives of these are second ones.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...core.vectors import cross
from ..corner.corner import UP, Array
from ..models.rigid_axle.axle import RigidAxle
from ..models.rigid_axle.model import HEAVE, ROLL, RigidAxleModel
from ..models.sides import LEFT, RIGHT, SIDES
from .whole_axle_kinematics import SENSE, WholeAxleKinematics

COORDINATES = (HEAVE, ROLL)


@dataclass(frozen=True)
class RigidAxleKinematics(WholeAxleKinematics):
    """A rigid axle at rest in many positions, of shape (n,).

    Attributes
    ----------
    model : RigidAxleModel
    states : ndarray, shape (n, 8)
    """

    model: RigidAxleModel
    states: Array

    @property
    def axle(self) -> RigidAxle:
        """The axle."""
        return self.model.axle

    # -- where it is ----------------------------------------------------------------------------

    @cached_property
    def _relative(self) -> dict[str, Array]:
        values = self.model.evaluate("relative_coordinates", self.states)
        return {n: values[:, i] for i, n in enumerate(self.model.equations.RELATIVE_COORDINATES)}

    @cached_property
    def _slopes(self) -> dict[str, Array]:
        """Derivatives of the relative coordinates by heave and roll, (n, 2) each."""
        by = self.model.evaluate("relative_jacobian", self.states)[..., : len(COORDINATES)]
        return {n: by[:, i] for i, n in enumerate(self.model.equations.RELATIVE_COORDINATES)}

    def coordinate(self, name: str) -> Array:
        """Return heave, sway (left), shift (forward) [m], roll, yaw (left) or pitch [rad]."""
        return self._relative[name]

    def slope(self, name: str, by: str) -> Array:
        """Return the derivative of such a coordinate by heave or roll."""
        found: Array = self._slopes[name][:, COORDINATES.index(by)]
        return found

    @cached_property
    def center(self) -> Array:
        """The middle between the wheels [m], (n, 3)."""
        moved = np.stack([self.coordinate(name) for name in ("shift", "sway", "heave")], -1)
        return self.axle.center + moved

    @cached_property
    def _axes(self) -> tuple[Array, Array, Array]:
        """About which yaw, roll and pitch turn it, each (n, 3): yaw, then roll, then pitch."""
        yaw, roll = self.coordinate("yaw"), self.coordinate("roll")
        ahead = np.stack([np.cos(yaw), np.sin(yaw), np.zeros_like(yaw)], -1)
        across = np.stack(
            [-np.sin(yaw) * np.cos(roll), np.cos(yaw) * np.cos(roll), np.sin(roll)], -1
        )
        return np.broadcast_to(UP, ahead.shape), ahead, across

    def wheel_center(self, side: str) -> Array:
        """Return the centre of a wheel [m], (n, 3)."""
        return self.center + SENSE[side] * self.axle.half_track * self._axes[2]

    def _spin_axis(self, side: str) -> Array:
        _, ahead, across = self._axes
        pitch = self.coordinate("pitch")[:, None]
        upright = cross(ahead, across)
        forward = np.cos(pitch) * ahead - np.sin(pitch) * upright
        upward = np.sin(pitch) * ahead + np.cos(pitch) * upright
        x, y, z = self.axle.wheel.spin_axis(SENSE[side])
        axis: Array = x * forward + y * across + z * upward
        return axis

    # -- how it moves ---------------------------------------------------------------------------

    def turning(self, by: str) -> Array:
        """Return the angular velocity per unit of heave [rad/m] or roll, (n, 3)."""
        turns = zip(("yaw", "roll", "pitch"), self._axes, strict=True)
        return sum((self.slope(n, by)[:, None] * axis for n, axis in turns), np.zeros(3))

    def velocity(self, place: Array, by: str) -> Array:
        """Return the velocity of a place that is fixed to the axle, per unit of heave or roll."""
        middle = np.stack([self.slope(name, by) for name in ("shift", "sway", "heave")], -1)
        velocity: Array = middle + cross(self.turning(by), place - self.center)
        return velocity

    def carrier_turning(self, side: str, by: str) -> Array:
        """Return the angular velocity of the axle per unit of heave [rad/m] or roll, (n, 3)."""
        del side
        return self.turning(by)

    def center_velocity(self, side: str, by: str) -> Array:
        """Return the velocity of the centre of a wheel per unit of heave or roll, (n, 3)."""
        return self.velocity(self.wheel_center(side), by)

    @cached_property
    def lever(self) -> Array:
        """How fast the left wheel rises in roll, and the right one falls [m/rad]."""
        return self.axle.half_track * np.cos(self.coordinate("roll"))

    @cached_property
    def rolled(self) -> tuple[Array, Array]:
        """Travels of both wheels, and lateral motion of both contacts, by a roll of the body.

        The body rolls by -roll; (n, 2) each, the left wheel first [m/rad].
        """
        senses = np.array([SENSE[side] for side in SIDES])
        moved = [-self.contact_rate(side, ROLL)[:, 1] for side in SIDES]
        return -senses * self.lever[:, None], np.stack(moved, -1)

    def path_slope(self, torque_on: str, side: str = "") -> Array:
        """Return how far forward the axle goes per rise in heave, where a force acts [1].

        That is the middle of the contacts if the axle holds the torque, the middle of the wheels
        if the body does.
        """
        del side
        place = self.wheel_center if torque_on == "body" else self.contact
        velocity = self.velocity(0.5 * (place(LEFT) + place(RIGHT)), HEAVE)
        slope: Array = velocity[:, 0] / velocity[:, 2]
        return slope

    # -- its springs ----------------------------------------------------------------------------

    @cached_property
    def of_bar(self) -> tuple[Array, Array]:
        """The same of the anti-roll bar."""
        rate, roll = self.model.parameters["bar_rate"], self.coordinate("roll")
        nothing = np.zeros_like(roll)
        return np.stack([nothing, -rate * roll], -1), np.broadcast_to(
            np.diag([0.0, -rate]), (roll.size, 2, 2)
        )

    def wheel_force(self, side: str) -> Array:
        """Return the vertical force at a wheel that springs, stops and bar take [N]."""
        work = self.of_springs[0] + self.of_bar[0]
        return -0.5 * (work[:, 0] + SENSE[side] * work[:, 1] / self.lever)

    @cached_property
    def springs(self) -> Array:
        """The stiffness of springs and stops at both wheels, (n, 2, 2) [N/m]."""
        return self._stiffness(*self.of_springs)

    @cached_property
    def bar(self) -> Array:
        """The stiffness of the anti-roll bar at both wheels, (n, 2, 2) [N/m]."""
        return self._stiffness(*self.of_bar)

    def _stiffness(self, forces: Array, slopes: Array) -> Array:
        """Return the derivatives of both wheels' forces by both travels, left first [N/m].

        Vertical forces through the wheel centres do the same virtual work as springs and bar: with
        the heights z of both wheels and the coordinates q, ``F = -Q (dz/dq)^-1``.
        """
        lever, bend = self.lever, -self.axle.half_track * np.sin(self.coordinate("roll"))
        signs = np.array([SENSE[side] for side in SIDES])
        # of -(Q_heave + s Q_roll / lever) / 2 by heave and roll
        by_roll = slopes[:, 1, :] / lever[:, None]
        by_roll[:, 1] -= forces[:, 1] * bend / lever**2
        by_coordinates = -0.5 * (slopes[:, None, 0, :] + signs[:, None] * by_roll[:, None, :])
        # heave is the mean of the travels; roll grows by half their difference over the lever
        heave, roll = by_coordinates[..., 0], by_coordinates[..., 1] / lever[:, None]
        return np.stack([0.5 * (heave + sign * roll) for sign in signs], -1)
