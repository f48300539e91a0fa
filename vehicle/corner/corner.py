"""One corner of a vehicle as its characteristics see it: points, directions and first motions.

Nothing here knows which mechanism guides the wheel. Every array has the same leading dimensions,
one element for each position; vectors have three components behind them, in chassis axes
(ISO 8855: x forward, y left, z up). SI units.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ...core.vectors import cross

Array = NDArray[np.float64]

UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class CarrierMotion:
    """How the wheel carrier moves first, per unit of what moves it.

    Attributes
    ----------
    velocity : ndarray, shape (..., 3)
        Of the wheel centre [m per unit].
    turning : ndarray, shape (..., 3)
        Angular velocity [rad per unit].
    """

    velocity: Array
    turning: Array

    def minus(self, other: "CarrierMotion", times: Array) -> "CarrierMotion":
        """Return this motion less a multiple of another."""
        return CarrierMotion(
            **{
                name: part - times[..., None] * vars(other)[name]
                for name, part in vars(self).items()
            }
        )

    def per(self, unit: Array) -> "CarrierMotion":
        """Return the motion for one of another unit, given how many of them one of these makes."""
        return CarrierMotion(**{name: part / unit[..., None] for name, part in vars(self).items()})

    def axis_nearest(self, center: Array) -> Array:
        """Return the point on the axis of this motion, that of a screw, nearest to the wheel's.

        Parameters
        ----------
        center : ndarray, shape (..., 3)
            The wheel centre [m].

        Returns
        -------
        ndarray, shape (..., 3)
            [m]; infinitely far, or no number, where nothing turns.
        """
        square = np.einsum("...i,...i->...", self.turning, self.turning)[..., None]
        with np.errstate(divide="ignore", invalid="ignore"):
            nearest: Array = center + cross(self.turning, self.velocity) / square
        return nearest


class SteeringAxis(Protocol):
    """The axis about which a wheel is steered, by two points on it."""

    @property
    def lower(self) -> Array:
        """The lower point, (..., 3) [m]."""

    @property
    def upper(self) -> Array:
        """The upper point, (..., 3) [m]."""

    @property
    def rate(self) -> Array:
        """Derivative of the vector from the lower to the upper one by wheel travel, (..., 3)."""


@dataclass(frozen=True)
class Plane:
    """A plane through a point.

    Attributes
    ----------
    point, normal : ndarray, shape (..., 3)
        [m], and any length but zero.
    """

    point: Array
    normal: Array


@dataclass(frozen=True)
class Stroke:
    """A length that changes over wheel travel: of a spring, a damper, a stop.

    Attributes
    ----------
    length : ndarray
        [m].
    slope, curvature : ndarray
        First and second derivative by wheel travel [1], [1/m].
    """

    length: Array
    slope: Array
    curvature: Array


@dataclass(frozen=True)
class SpringForce:
    """A force that the position alone decides.

    Attributes
    ----------
    stroke : Stroke
        Length between its ends.
    force : ndarray
        Positive when it pushes its ends apart [N].
    force_slope : ndarray
        Derivative of the force by wheel travel [N/m].
    """

    stroke: Stroke
    force: Array
    force_slope: Array


@dataclass(frozen=True)
class Vehicle:
    """What the vehicle adds; None where it is not known.

    Attributes
    ----------
    side : float
        +1 left, -1 right.
    tyre_radius : float or None
        Of the wheel as a thin disc [m].
    tyre_rate : float or None
        Vertical stiffness of the tyre [N/m].
    tyre_lateral_rate, tyre_longitudinal_rate : float or None
        Of the stationary tyre [N/m].
    wheelbase, center_of_gravity_height : float or None
        [m].
    front_brake_share : float or None
        Part of the braking force at the front wheels.
    front, rear : bool or None
        Which end it is at: True for the one, None for the other.
    travel_per_turn : float or None
        Rack travel for one turn of the steering wheel [m].
    steered : bool or None
        Whether the wheel can be steered; None where it cannot.
    """

    side: float
    tyre_radius: float | None = None
    tyre_rate: float | None = None
    tyre_lateral_rate: float | None = None
    tyre_longitudinal_rate: float | None = None
    wheelbase: float | None = None
    center_of_gravity_height: float | None = None
    front_brake_share: float | None = None
    front: bool | None = True
    rear: bool | None = None
    travel_per_turn: float | None = None
    steered: bool | None = True


@dataclass(frozen=True)
class RoadWheel:
    """A wheel at many positions.

    Attributes
    ----------
    vehicle : Vehicle
    center : ndarray, shape (..., 3)
        Wheel centre [m].
    design_center : ndarray, shape (3,)
        The same at design [m].
    axis : ndarray, shape (..., 3)
        Unit vector along the spin axis, pointing outboard.
    design_axis : ndarray, shape (3,)
        The same at design.
    """

    vehicle: Vehicle
    center: Array
    design_center: Array
    axis: Array
    design_axis: Array


@dataclass(frozen=True)
class Corner(RoadWheel):
    """A wheel, its steering axis and its first motions, at many positions.

    Attributes
    ----------
    vehicle, center, design_center, axis, design_axis
        As of `RoadWheel`.
    steering_axis : SteeringAxis or None
        About which it is steered; None where nothing steers it.
    travel : CarrierMotion
        Per unit of wheel travel (height of the wheel centre) with the steering held [per m].
    steering : CarrierMotion or None
        Per unit of rack travel with the wheel centre held at its height [per m]; None where
        nothing steers it.
    links : tuple of Plane
        The two planes whose common line is the axis about which the carrier turns first when it
        is held by the links in them: for a wishbone the plane of its three joints, for a strut the
        plane across it through its upper mount; for links in no plane any two planes through the
        axis about which it turns.
    spring : SpringForce
    stops : tuple of SpringForce
        What else pushes by its position.
    damper : Stroke
    arm_rotation : ndarray
        Of the lower link, zero at design, positive with the wheel up [rad].
    """

    steering_axis: SteeringAxis | None
    travel: CarrierMotion
    steering: CarrierMotion | None
    links: tuple[Plane, Plane]
    spring: SpringForce
    stops: tuple[SpringForce, ...]
    damper: Stroke
    arm_rotation: Array
