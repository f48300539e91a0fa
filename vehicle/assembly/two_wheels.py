"""The bases of the kinematics of both wheels of an axle, for formulas of characteristics."""

from abc import ABC, abstractmethod
from typing import Any

from ...core.named_types import Array
from ..corner.corner import Vehicle
from ..models.sides import LEFT, RIGHT


class SteerableWheels:
    """Both wheels of an axle, or one with its mirror image, in n positions."""

    corners: Any  # by side, the left one first
    design_track: Any  # the distance of the wheel centres at design [m]
    # displacement of the steering for one turn of the steering wheel [m]; None if it is not known
    per_turn: Any
    # steer angles without static toe, of the left and the right wheel, (n,) [rad]
    turned: Any

    @property
    def vehicles(self) -> tuple[Vehicle, ...]:
        """The data of the vehicle for each wheel, the left one first."""
        return tuple(corner.vehicle for corner in self.corners.values())

    @property
    def left(self) -> Any:
        """The left wheel."""
        return self.corners[LEFT]

    @property
    def right(self) -> Any:
        """The right wheel."""
        return self.corners[RIGHT]

    @property
    def wheelbase(self) -> float:
        """The wheelbase [m]."""
        found = self.vehicles[0].wheelbase
        assert found is not None  # measures that need it are left out if it is not known
        return found


class TwoWheels(SteerableWheels, ABC):
    """Both wheels of an axle in n positions, the leading dimension of every array."""

    axle: Any  # its data, with the reactions of brakes and drive

    @property
    def end(self) -> str:
        """The end of the vehicle, 'front' or 'rear'."""
        return str(self.axle.end)

    @abstractmethod
    def contact(self, side: str) -> Array:
        """Return the lowest point of a wheel as a thin disc, (n, 3) [m]."""

    @abstractmethod
    def wheel_force(self, side: str) -> Array:
        """Return the vertical force of springs, stops and bar at a wheel, (n,) [N]."""

    @property
    @abstractmethod
    def springs(self) -> Array:
        """The stiffness of springs and stops at both wheels, (n, 2, 2) [N/m]."""

    @property
    @abstractmethod
    def bar(self) -> Array:
        """The stiffness of the anti-roll bar, or of a beam, at both wheels, (n, 2, 2) [N/m]."""

    @property
    @abstractmethod
    def rolled(self) -> tuple[Array, Array]:
        """Travels of both wheels, and lateral motions of both contacts, per roll of the body.

        The wheel centres move oppositely; (n, 2) each, the left wheel first [m/rad].
        """

    @abstractmethod
    def path_slope(self, torque_on: str, side: str) -> Array:
        """Return the slope v_x / v_z of the path of the point of a longitudinal force [1].

        The point is the contact, fixed to the carrier of the wheel; it is the wheel centre if
        `torque_on` is 'body', which then reacts the torque.
        """
