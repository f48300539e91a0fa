"""A twist-beam axle at many positions: where its wheels are, how they move first, and its springs.

Motions are those of the coordinates, or of both wheels: ``heave``, both rise by a metre; ``roll``,
the left one rises by a metre and the right one falls; ``left`` and ``right``, one of them rises by
a metre and the other one keeps its height.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...core.vectors import cross
from ..corner.corner import Array, CarrierMotion, RoadWheel
from ..models.sides import SIDES
from ..models.twist_beam import LIFT, TWIST, TwistBeamAxle, TwistBeamModel
from .wheel_centre_line import inclination_rate
from .whole_axle_kinematics import SENSE, WholeAxleKinematics

COORDINATES = (LIFT, TWIST)
_WHEELS = {"heave": (1.0, 1.0), "roll": (1.0, -1.0), "left": (1.0, 0.0), "right": (0.0, 1.0)}


@dataclass(frozen=True)
class TravellingWheel(RoadWheel):
    """A wheel, and how its carrier moves where both wheels rise by a metre.

    Attributes
    ----------
    travel : CarrierMotion
    """

    travel: CarrierMotion


@dataclass(frozen=True)
class TwistBeamKinematics(WholeAxleKinematics):
    """A twist-beam axle at rest in many positions, of shape (n,).

    Attributes
    ----------
    model : TwistBeamModel
    states : ndarray, shape (n, 8)
    """

    model: TwistBeamModel
    states: Array

    @property
    def axle(self) -> TwistBeamAxle:
        """The axle."""
        return self.model.axle

    # -- where it is ----------------------------------------------------------------------------

    def _angle(self, name: str) -> Array:
        angle: Array = self.states[:, self.model.state_names.index(name)]
        return angle

    @cached_property
    def _poses(self) -> tuple[Array, Array]:
        positions = self.model.evaluate("positions", self.states)
        return positions, self.model.evaluate("orientations", self.states)

    def _body(self, side: str) -> int:
        which: int = self.model.equations.BODIES.index(f"{side}_arm")
        return which

    def _spoke(self, side: str) -> Array:
        """Return the wheel centre from the centre of mass of its arm [m], (n, 3)."""
        com = self.axle.bodies.arm.centre_of_mass(self.axle.hardpoints) * [1.0, -SENSE[side], 1.0]
        spoke: Array = self._poses[1][:, self._body(side)] @ (
            self.axle.points(side)["wheel_center"] - com
        )
        return spoke

    def wheel_center(self, side: str) -> Array:
        """Return the centre of a wheel [m], (n, 3)."""
        center: Array = self._poses[0][:, self._body(side)] + self._spoke(side)
        return center

    def _spin_axis(self, side: str) -> Array:
        axis: Array = self._poses[1][:, self._body(side)] @ self.axle.wheel.spin_axis(SENSE[side])
        return axis

    @cached_property
    def corners(self) -> dict[str, TravellingWheel]:
        """Both wheels, each with its motion in parallel travel."""
        return {
            side: TravellingWheel(
                vehicle,
                self.wheel_center(side),
                self.axle.points(side)["wheel_center"],
                SENSE[side] * self._spin_axis(side),
                SENSE[side] * self.axle.wheel.spin_axis(SENSE[side]),
                self.motion(side, "heave"),
            )
            for side, vehicle in zip(SIDES, self.vehicles, strict=True)
        }

    # -- how it moves ---------------------------------------------------------------------------

    @cached_property
    def _rates(self) -> dict[str, Array]:
        """Angular velocity and velocity of all bodies at a unit rate of each coordinate."""
        found = {}
        for by in COORDINATES:
            states = self.states.copy()
            states[:, self.model.state_names.index(f"{by}_rate")] = 1.0
            found[by] = self.model.evaluate("velocities", states)
        return found

    def carrier_turning(self, side: str, by: str) -> Array:
        """Return the angular velocity of an arm per unit of a coordinate, (n, 3)."""
        turning: Array = self._rates[by][:, self._body(side), :3]
        return turning

    def center_velocity(self, side: str, by: str) -> Array:
        """Return the velocity of the centre of a wheel per unit of a coordinate, (n, 3)."""
        velocity: Array = self._rates[by][:, self._body(side), 3:]
        return velocity + cross(self.carrier_turning(side, by), self._spoke(side))

    @cached_property
    def heights(self) -> Array:
        """The derivatives of both heights by both coordinates, (n, 2, 2) [m/rad]."""
        rows = [[self.center_velocity(s, by)[:, 2] for by in COORDINATES] for s in SIDES]
        return np.moveaxis(np.array(rows), -1, 0)

    @cached_property
    def _of_motions(self) -> dict[str, Array]:
        """Rates of both coordinates in each motion of the wheels, (n, 2) [rad/m]."""
        return {
            how: np.linalg.solve(self.heights, np.array(rise)[:, None])[..., 0]
            for how, rise in _WHEELS.items()
        }

    def motion(self, side: str, how: str) -> CarrierMotion:
        """Return how a wheel moves per metre of a motion of both."""
        rates = [rate[:, None] for rate in self._of_motions[how].T]
        pairs = [
            (self.center_velocity(side, by), self.carrier_turning(side, by)) for by in COORDINATES
        ]
        velocity, turning = (
            sum((rate * part for rate, part in zip(rates, parts, strict=True)), np.zeros(3))
            for parts in zip(*pairs, strict=True)
        )
        return CarrierMotion(velocity, turning)

    def contact_in(self, side: str, how: str) -> Array:
        """Return how fast the lowest point of a wheel goes per metre of a motion, (n, 3) [1]."""
        lift, twist = (
            rate[:, None] * self.contact_rate(side, by)
            for rate, by in zip(self._of_motions[how].T, COORDINATES, strict=True)
        )
        velocity: Array = lift + twist
        return velocity

    def carried_in(self, side: str, place: Array, how: str) -> Array:
        """Return the velocity of a place fixed to an arm per metre of a motion, (n, 3) [1]."""
        motion = self.motion(side, how)
        velocity: Array = motion.velocity + cross(motion.turning, place - self.wheel_center(side))
        return velocity

    @cached_property
    def inclination_rate(self) -> Array:
        """How fast the line through the wheel centres turns in roll, left end up [rad/m]."""
        left, right = (self.wheel_center(side) for side in SIDES)
        up, down = (self.motion(side, "roll").velocity for side in SIDES)
        return inclination_rate(left - right, up - down)

    @cached_property
    def rolled(self) -> tuple[Array, Array]:
        """Travels of both wheels, and lateral motion of both contacts, by a roll of the body.

        The wheel centres move oppositely; (n, 2) each, the left wheel first [m/rad].
        """
        by_travel = -self.inclination_rate[:, None]
        moved = np.stack([self.contact_in(side, "roll")[:, 1] for side in SIDES], -1)
        return np.array(_WHEELS["roll"]) / by_travel, moved / by_travel

    def path_slope(self, torque_on: str, side: str) -> Array:
        """Return how far forward goes per rise where a longitudinal force acts, v_x / v_z [1].

        That is the contact, fixed to the arm; the wheel centre if the body holds the torque. Both
        wheels rise.
        """
        place = self.wheel_center(side) if torque_on == "body" else self.contact(side)
        velocity = self.carried_in(side, place, "heave")
        slope: Array = velocity[:, 0] / velocity[:, 2]
        return slope

    # -- its springs ----------------------------------------------------------------------------

    def compression_in(self, part: str, how: str) -> Array:
        """Return how a spring or a damper is compressed per metre of a motion [1]."""
        compressed: Array = -(self.growth(part) * self._of_motions[how]).sum(-1)
        return compressed

    @property
    def beam_twist(self) -> Array:
        """The twist of the beam, positive with the left wheel up [rad]."""
        return self.axle.twist_ratio * self._angle(TWIST)

    @property
    def beam_torque(self) -> Array:
        """Its torque, positive as the twist [N m]."""
        rate = float(np.degrees(self.axle.beam.rate_Nm_per_deg))
        return rate * self.beam_twist

    @cached_property
    def _of_beam(self) -> tuple[Array, Array]:
        """What the beam does by both coordinates, (n, 2), and its derivatives, (n, 2, 2)."""
        rate, twist = self.model.parameters["beam_rate"], self._angle(TWIST)
        slopes = np.broadcast_to(np.diag([0.0, -rate]), (twist.size, 2, 2))
        return np.stack([np.zeros_like(twist), -rate * twist], -1), slopes

    def wheel_force(self, side: str) -> Array:
        """Return the vertical force at a wheel that springs, stops and beam take [N]."""
        work = self.of_springs[0] + self._of_beam[0]
        return self._at_wheels(work)[:, SIDES.index(side)]

    def _at_wheels(self, work: Array) -> Array:
        """Return vertical forces at the wheel centres that hold some generalised ones, (n, 2)."""
        forces = np.linalg.solve(self.heights.mT, work[..., None])
        return np.asarray(-forces[..., 0], dtype=float)

    @cached_property
    def springs(self) -> Array:
        """The stiffness of springs and stops at both wheels, (n, 2, 2) [N/m]."""
        return self._stiffness(*self.of_springs)

    @cached_property
    def bar(self) -> Array:
        """The stiffness of the beam at both wheels, (n, 2, 2) [N/m]."""
        return self._stiffness(*self._of_beam)

    def _stiffness(self, work: Array, slopes: Array) -> Array:
        """Return the derivatives of both wheels' forces by both travels, left first [N/m].

        Vertical forces F through the wheel centres do the same virtual work as springs and beam:
        with the heights z and the coordinates q, ``Q + J' F = 0`` and ``J = dz/dq``, so that
        ``J' dF/dz J = -dQ/dq - F d2z/dq2``.
        """
        forces, rows = self._at_wheels(work), []
        for by in COORDINATES:
            changes = self._at_unit_rate[by][1]
            bend = (changes[f"{side}_axle_wheel_velocity"] for side in SIDES)
            rows.append(
                sum(force[:, None] * own for force, own in zip(forces.T, bend, strict=True))
            )
        inverse = np.linalg.inv(self.heights)
        stiffness: Array = -inverse.mT @ (slopes + np.stack(rows, -2)) @ inverse
        return stiffness
