"""Kinematics of an axle without sides over n positions, and the rates of its springs.

Motions are those of the two coordinates that move the wheels up and down, or of both wheels:
``heave``, both rise by a metre; ``roll``, the left one rises by a metre and the right one falls;
``left`` and ``right``, one of them rises by a metre and the other one keeps its height.

The compiled equations differentiate lengths and forces of springs: velocities at unit rates of the
coordinates are first derivatives, and the derivatives of these are second ones.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...core.named_types import Array
from ...core.vectors import cross
from ..corner.corner import CarrierMotion, RoadWheel
from ..input.spring import rate_at
from ..models.sides import SIDES
from ..models.whole_axle import of_side
from ..models.whole_axle_model import WholeAxleModel
from .part_poses import CENTER, CONTACT
from .two_wheels import TwoWheels
from .wheel import lowest_point_rate
from .wheel_centre_line import inclination_rate
from .whole_axle_parts import WholeAxleParts

RISES = {"bump": (1.0, 1.0), "roll": (1.0, -1.0), "left": (1.0, 0.0), "right": (0.0, 1.0)}
"""Rise of the left and the right wheel per metre of a motion of both."""


@dataclass(frozen=True)
class TravellingWheel(RoadWheel):
    """A wheel, and the motion of its carrier per metre of travel of both wheels."""

    travel: CarrierMotion


@dataclass(frozen=True)
class WholeAxleKinematics(TwoWheels):
    """An axle without sides at rest in n positions."""

    parts: WholeAxleParts
    # signed displacement of the steering for one turn of the steering wheel there [m]; None if it
    # is not known
    per_turn: Array | None = None

    @property
    def model(self) -> WholeAxleModel:
        """Its equations."""
        return self.parts.model

    @property
    def axle(self) -> Any:
        """The axle."""
        return self.model.axle

    @cached_property
    def corners(self) -> dict[str, TravellingWheel]:
        """Both wheels, each with its motion in parallel travel."""
        return {
            side: TravellingWheel(**vars(wheel), travel=self.motion(side, "bump"))
            for side, wheel in zip(SIDES, self.parts.wheels.values(), strict=True)
        }

    def wheel_center(self, side: str) -> Array:
        """Return the centre of a wheel [m], (n, 3)."""
        return self.parts.points[f"{CENTER}_{side}"]

    def contact(self, side: str) -> Array:
        return self.parts.points[f"{CONTACT}_{side}"]

    @property
    def heave(self) -> Array:
        """The height of the middle between the wheels above design [m], (n,)."""
        heights = [self.wheel_center(side)[:, 2] for side in SIDES]
        return 0.5 * sum(heights) - self.axle.center[2]

    # -- derivatives with respect to its coordinates ---------------------------------------------

    @cached_property
    def _twists(self) -> dict[str, Array]:
        """Angular velocities and velocities at a unit rate of each coordinate, by part."""
        return self.parts.twists()

    def turning_of(self, part: str, by: str) -> Array:
        """Return the angular velocity of a part per unit of a coordinate, (n, 3)."""
        return self._twists[part][:, self.model.COORDINATES.index(by), :3]

    def velocity_of(self, part: str, place: Array, by: str) -> Array:
        """Return the velocity of a point of a part per unit of a coordinate, (n, 3).

        `place` is its position, (n, 3) [m], `by` the coordinate.
        """
        twist = self._twists[part][:, self.model.COORDINATES.index(by)]
        return self.parts.velocity_at(part, place, twist)

    def turning(self, side: str, by: str) -> Array:
        """Return the angular velocity of a wheel's carrier per unit of a coordinate, (n, 3)."""
        return self.turning_of(self.parts.carrier(side), by)

    def velocity(self, side: str, place: Array, by: str) -> Array:
        """Return the velocity of a point of a wheel's carrier per unit of a coordinate, (n, 3)."""
        return self.velocity_of(self.parts.carrier(side), place, by)

    def contact_rate(self, side: str, by: str) -> Array:
        """Return the velocity of the lowest point of a wheel per unit of a coordinate, (n, 3)."""
        (radius,) = {vehicle.tyre_radius for vehicle in self.vehicles}
        assert radius is not None
        velocity = self.velocity(side, self.wheel_center(side), by)
        axis = self.parts.wheel_axis(side)
        return lowest_point_rate(velocity, axis, self.turning(side, by), radius)

    # -- derivatives in motions of both wheels ----------------------------------------------------

    @cached_property
    def heights(self) -> Array:
        """Derivatives of both heights with respect to both coordinates, (n, 2, 2) [m/rad]."""
        names = self.model.COORDINATES
        rows = [[self.velocity(s, self.wheel_center(s), by)[:, 2] for by in names] for s in SIDES]
        return np.moveaxis(np.array(rows), -1, 0)

    @cached_property
    def _of_motions(self) -> dict[str, Array]:
        """Rates of both coordinates in each motion of the wheels, (n, 2) [rad/m]."""
        return {
            how: np.linalg.solve(self.heights, np.array(rise)[:, None])[..., 0]
            for how, rise in RISES.items()
        }

    def in_motion(self, how: str, by_coordinate: list[Array]) -> Array:
        """Return a rate per metre of a motion, (n, 3), from those per unit of the coordinates."""
        first, second = (
            rate[:, None] * part
            for rate, part in zip(self._of_motions[how].T, by_coordinate, strict=True)
        )
        return first + second

    def motion(self, side: str, how: str) -> CarrierMotion:
        """Return the motion of the carrier of a wheel per metre of a motion of both wheels."""
        names, center = self.model.COORDINATES, self.wheel_center(side)
        return CarrierMotion(
            self.in_motion(how, [self.velocity(side, center, by) for by in names]),
            self.in_motion(how, [self.turning(side, by) for by in names]),
        )

    def contact_in(self, side: str, how: str) -> Array:
        """Return the velocity of the lowest point of a wheel per metre of a motion, (n, 3) [1]."""
        rates = [self.contact_rate(side, by) for by in self.model.COORDINATES]
        return self.in_motion(how, rates)

    def carried_in(self, side: str, place: Array, how: str) -> Array:
        """Return the velocity of a point of a wheel's carrier per metre of a motion, (n, 3) [1].

        `place` is its position, (n, 3) [m]; `how` is 'heave', 'roll', 'left' or 'right'.
        """
        motion = self.motion(side, how)
        return motion.velocity + cross(motion.turning, place - self.wheel_center(side))

    @cached_property
    def inclination_rate(self) -> Array:
        """The rotation of the line through the wheel centres in roll, left end up [rad/m]."""
        left, right = (self.wheel_center(side) for side in SIDES)
        up, down = (self.motion(side, "roll").velocity for side in SIDES)
        return inclination_rate(left - right, up - down)

    @cached_property
    def rolled(self) -> tuple[Array, Array]:
        by_travel = -self.inclination_rate[:, None]
        moved = np.stack([self.contact_in(side, "roll")[:, 1] for side in SIDES], -1)
        return np.array(RISES["roll"]) / by_travel, moved / by_travel

    def path_slope(self, torque_on: str, side: str = "") -> Array:
        """Return the slope v_x / v_z of the path of the point of a longitudinal force [1].

        Both wheels rise. Without `side` the point is the middle of those of both sides.
        """
        place = self.wheel_center if torque_on == "body" else self.contact
        sides = (side,) if side else SIDES
        velocity = np.mean([self.carried_in(one, place(one), "bump") for one in sides], axis=0)
        return velocity[:, 0] / velocity[:, 2]

    # -- its springs ----------------------------------------------------------------------------

    @cached_property
    def _signals(self) -> dict[str, Array]:
        return self.parts.signals()

    @cached_property
    def _at_unit_rate(self) -> dict[str, tuple[dict[str, Array], dict[str, Array]]]:
        """Signals at unit rates of both coordinates, and their derivatives by both, (n, 2)."""
        found = {}
        for by in self.model.COORDINATES:
            states = self.parts.states.copy()
            states[:, self.model.state_names.index(f"{by}_rate")] = 1.0
            slopes = self.model.evaluate("signals_jacobian", states, self.parts.inputs)[..., :2]
            by_name = dict(zip(self.model.signal_names, np.moveaxis(slopes, -2, 0), strict=True))
            found[by] = self.model.signals(states, self.parts.inputs), by_name
        return found

    def signal(self, name: str) -> Array:
        """Return a signal of the equations at rest."""
        return self._signals[name]

    def compression_in(self, part: str, how: str) -> Array:
        """Return the compression of a spring or a damper per metre of a motion [1]."""
        return -(self.growth(part) * self._of_motions[how]).sum(-1)

    @cached_property
    def of_springs(self) -> tuple[Array, Array]:
        """Generalised forces of springs and stops, (n, 2), and their derivatives, (n, 2, 2)."""
        forces = [self._virtual_work(f"{side}_{part}", force) for side, part, force in _SPRINGS]
        work, slopes = zip(*forces, strict=True)
        return np.sum(work, axis=0), np.sum(slopes, axis=0)

    @cached_property
    def of_bar(self) -> tuple[Array, Array]:
        """The same of the anti-roll bar or the beam, which resists the second coordinate."""
        rate = self.model.parameters[self.parts.RATE]
        turned = self.parts.states[:, self.model.state_names.index(self.model.COORDINATES[1])]
        slopes = np.broadcast_to(np.diag([0.0, -rate]), (turned.size, 2, 2))
        return np.stack([np.zeros_like(turned), -rate * turned], -1), slopes

    def wheel_force(self, side: str) -> Array:
        return self._at_wheels(self.of_springs[0] + self.of_bar[0])[:, SIDES.index(side)]

    def _at_wheels(self, work: Array) -> Array:
        """Return vertical forces at the wheels that balance generalised forces, (n, 2) [N]."""
        forces = np.linalg.solve(self.heights.mT, work[..., None])
        return np.asarray(-forces[..., 0], dtype=float)

    @cached_property
    def springs(self) -> Array:
        return self._stiffness(*self.of_springs)

    @cached_property
    def bar(self) -> Array:
        return self._stiffness(*self.of_bar)

    def _stiffness(self, work: Array, slopes: Array) -> Array:
        """Return the derivatives of both wheels' forces with respect to both travels [N/m].

        Vertical forces F through the wheel centres have the virtual work of springs and bar:
        with the heights z and the coordinates q, ``Q + J' F = 0`` and ``J = dz/dq``, so that
        ``J' dF/dz J = -dQ/dq - F d2z/dq2``.
        """
        forces, rows = self._at_wheels(work), []
        for by in self.model.COORDINATES:
            changes = self._at_unit_rate[by][1]
            bend = (changes[f"{side}_axle_wheel_velocity"] for side in SIDES)
            rows.append(
                sum(force[:, None] * own for force, own in zip(forces.T, bend, strict=True))
            )
        inverse = np.linalg.inv(self.heights)
        return -inverse.mT @ (slopes + np.stack(rows, -2)) @ inverse

    def growth(self, path: str) -> Array:
        """Return the derivatives of a spring's or damper's length by both coordinates, (n, 2)."""
        rates = [self._at_unit_rate[by][0][f"{path}_velocity"] for by in self.model.COORDINATES]
        return np.stack(rates, -1)

    def rate_of_stops(self, side: str) -> Array:
        """Return the rate of the stops beside a damper, along it, (n,) [N/m]."""
        path = f"{side}_damper"
        growth, slopes = self.growth(path), self._at_unit_rate[self.model.COORDINATES[0]][1]
        changes = slopes[f"{path}_bump_stop_force"] + slopes[f"{path}_rebound_stop_force"]
        return -(changes * growth).sum(-1) / (growth * growth).sum(-1)

    def rate_of_spring(self, side: str) -> Array:
        """Return the rate of a spring, along it, (n,) [N/m]."""
        parameters = of_side(self.model.parameters, side)
        return rate_at(parameters, self._signals[f"{side}_spring_length"])

    def _virtual_work(self, path: str, force: str) -> tuple[Array, Array]:
        """Return the generalised forces of a force along a path, and their derivatives."""
        acting, growth = self._signals[force], self.growth(path)
        bends = [self._at_unit_rate[by][1][f"{path}_velocity"] for by in self.model.COORDINATES]
        changes = self._at_unit_rate[self.model.COORDINATES[0]][1][force]
        work = acting[:, None] * growth
        slopes_of_work = growth[..., :, None] * changes[..., None, :]
        return work, slopes_of_work + acting[:, None, None] * np.stack(bends, -2)


_SPRINGS = tuple(
    (side, part, f"{side}_{part}_{force}")
    for side in SIDES
    for part, force in (
        ("spring", "spring_force"),
        ("damper", "bump_stop_force"),
        ("damper", "rebound_stop_force"),
    )
)


@dataclass(frozen=True)
class RigidAxleKinematics(WholeAxleKinematics):
    """A rigid axle at rest in many positions, of shape (n,)."""

    @cached_property
    def _relative(self) -> dict[str, Array]:
        values = self.model.evaluate("relative_coordinates", self.parts.states, self.parts.inputs)
        return {n: values[:, i] for i, n in enumerate(self.model.equations.RELATIVE_COORDINATES)}

    @cached_property
    def _slopes(self) -> dict[str, Array]:
        """Derivatives of the relative coordinates with respect to heave and roll, (n, 2) each."""
        by = self.model.evaluate("relative_jacobian", self.parts.states, self.parts.inputs)[..., :2]
        return {n: by[:, i] for i, n in enumerate(self.model.equations.RELATIVE_COORDINATES)}

    def coordinate(self, name: str) -> Array:
        """Return heave, sway (left), shift (forward) [m], roll, yaw (left) or pitch [rad]."""
        return self._relative[name]

    def slope(self, name: str, by: str) -> Array:
        """Return the derivative of such a coordinate with respect to heave or roll."""
        return self._slopes[name][:, self.model.COORDINATES.index(by)]
