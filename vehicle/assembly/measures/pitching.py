"""Anti-dive, anti-lift and anti-squat: the formulas.

Of the change of load by a longitudinal acceleration, m a h / L, they say which part the path of a
wheel, or of a rigid axle, takes up without the springs. A force F along the road at a point that
moves by (v_x, v_z) lifts the body by F v_x / v_z. The point is the contact, fixed to the carrier,
where the torque is held there; the wheel centre, where a shaft leads it to the body.
"""

from collections.abc import Sequence
from typing import Protocol

from ...corner.corner import Array, Vehicle
from ...models.axle import Axle
from ...models.rigid_axle.axle import RigidAxle


class Pitching(Protocol):
    """What moves in a side view: an `AxleKinematics` or a `RigidAxleKinematics`."""

    @property
    def axle(self) -> Axle | RigidAxle:
        """The axle, which says where brakes and drive are."""

    @property
    def end(self) -> str:
        """At which end of the vehicle it is."""

    @property
    def vehicles(self) -> Sequence[Vehicle]:
        """What the vehicle adds, of each wheel."""

    def path_slope(self, torque_on: str, side: str) -> Array:
        """Return how far forward goes per rise where a longitudinal force acts, v_x / v_z."""


def braking(of: Pitching, side: str = "") -> Array:
    """Return anti-dive of a front axle, anti-lift of a rear axle, under braking [1].

    Parameters
    ----------
    of : Pair or Beam
    side : str, optional
        Which wheel, of an `AxleKinematics`.
    """
    front = of.vehicles[0].front_brake_share
    assert front is not None
    share = front if of.end == "front" else 1.0 - front
    return share * _path(of, side, of.axle.brakes.torque_on)


def driving(of: Pitching, side: str = "") -> Array:
    """Return anti-lift of a front axle, anti-squat of a rear axle, under drive [1]."""
    assert of.axle.drive is not None
    return of.axle.drive.share * _path(of, side, of.axle.drive.torque_on)


def _path(of: Pitching, side: str, torque_on: str) -> Array:
    """Return (L / h) v_x / v_z, positive where the axle's load falls as the force grows."""
    vehicle = of.vehicles[0]
    assert vehicle.wheelbase is not None
    assert vehicle.center_of_gravity_height is not None
    sense = 1.0 if of.end == "front" else -1.0
    ratio = vehicle.wheelbase / vehicle.center_of_gravity_height
    return sense * ratio * of.path_slope(torque_on, side)
