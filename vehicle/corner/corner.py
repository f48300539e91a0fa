"""The data of a corner for its characteristics: points, directions and velocities.

They do not depend on the mechanism. Every array has the same leading dimensions, one element for
each position; vectors have three components in the last dimension, in chassis axes (ISO 8855:
x forward, y left, z up). SI units.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ...core.named_types import Array
from ...core.vectors import cross
from ...systems.system import System

UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class CarrierMotion:
    """The velocity of the wheel carrier, per unit of the quantity that moves it."""

    velocity: Array  # velocity of the wheel centre, (..., 3) [m per unit]
    turning: Array  # angular velocity, (..., 3) [rad per unit]

    def minus(self, other: "CarrierMotion", times: Array) -> "CarrierMotion":
        """Return this motion less a multiple of another."""
        factor = times[..., None]
        velocity = self.velocity - factor * other.velocity
        return CarrierMotion(velocity, self.turning - factor * other.turning)

    def per(self, unit: Array) -> "CarrierMotion":
        """Return the motion per unit of another quantity, from this quantity's rate."""
        return CarrierMotion(self.velocity / unit[..., None], self.turning / unit[..., None])

    def axis_nearest(self, center: Array) -> Array:
        """Return the point on the screw axis nearest to the wheel centre, (..., 3) [m].

        It is infinite or NaN without rotation.
        """
        square = np.einsum("...i,...i->...", self.turning, self.turning)[..., None]
        with np.errstate(divide="ignore", invalid="ignore"):
            nearest: Array = center + cross(self.turning, self.velocity) / square
        return nearest


class SteeringAxis(Protocol):
    """The steering axis of a wheel, by two points on it."""

    @property
    def lower(self) -> Array:
        """The lower point, (..., 3) [m]."""

    @property
    def upper(self) -> Array:
        """The upper point, (..., 3) [m]."""

    @property
    def rate(self) -> Array:
        """Derivative of the vector between the points with respect to wheel travel, (..., 3)."""


@dataclass(frozen=True)
class Plane:
    """A plane through a point."""

    # a point [m], and a vector of any length, (..., 3)
    point: Array
    normal: Array


@dataclass(frozen=True)
class Stroke:
    """The length of a spring, a damper or a stop over wheel travel."""

    length: Array  # [m]
    # first and second derivative with respect to wheel travel [1], [1/m]
    slope: Array
    curvature: Array


@dataclass(frozen=True)
class SpringForce:
    """A force that depends on the position alone."""

    stroke: Stroke  # length between its ends
    force: Array  # positive when it pushes its ends apart [N]
    force_slope: Array  # derivative of the force with respect to wheel travel [N/m]


@dataclass(frozen=True)
class Vehicle:
    """Data of the vehicle for a wheel; None if not known."""

    side: float  # +1 left, -1 right
    tyre_radius: float | None = None  # radius of the wheel as a thin disc [m]
    tyre_rate: float | None = None  # vertical stiffness of the tyre [N/m]
    # stiffnesses of the stationary tyre [N/m]
    tyre_lateral_rate: float | None = None
    tyre_longitudinal_rate: float | None = None
    wheelbase: float | None = None  # [m]
    center_of_gravity_height: float | None = None  # [m]
    front_brake_share: float | None = None  # part of the braking force at the front wheels
    # true for the end of the wheel, None for the other one
    front: bool | None = True
    rear: bool | None = None
    travel_per_turn: float | None = None  # rack travel for one turn of the steering wheel [m]
    steered: bool | None = True  # true for a steered wheel, None for others


@dataclass(frozen=True)
class RoadWheel:
    """A wheel in n positions."""

    vehicle: Vehicle
    center: Array  # wheel centre, (..., 3) [m]
    design_center: Array  # at design, (3,) [m]
    axis: Array  # unit vector along the spin axis, pointing outboard, (..., 3)
    design_axis: Array  # at design, (3,)


@dataclass(frozen=True)
class Corner(RoadWheel):
    """A wheel, its steering axis and its velocities, in n positions."""

    steering_axis: SteeringAxis | None  # None if the wheel is not steered
    travel: CarrierMotion  # per unit of wheel travel, with the steering held [per m]
    # per unit of rack travel with the wheel centre at constant height [per m]; None as above
    steering: CarrierMotion | None
    # two planes of the links; their intersection is the instantaneous axis of the carrier. For a
    # wishbone it is the plane of its three joints, for a strut the plane normal to it at its upper
    # mount; for links without a plane any two planes through the instantaneous axis.
    links: tuple[Plane, Plane]
    spring: SpringForce
    stops: tuple[SpringForce, ...]
    damper: Stroke
    arm_rotation: Array  # rotation of the lower link from design, positive with the wheel up [rad]


class Strokes:
    """Lengths and forces of a model's force elements in n positions at rest.

    `arm` is the state of the arm's angle.
    """

    def __init__(self, model: System, states: Array, inputs: Array, arm: str) -> None:
        # at unit rate velocities are first derivatives, and their derivatives second ones
        states = states.copy()
        states[..., model.state_names.index(f"{arm}_rate")] = 1.0
        self.parameters = model.parameters
        self._signals = model.signals(states, inputs)
        by_arm = model.evaluate("signals_jacobian", states, inputs)[..., 0]
        self._by_arm = dict(zip(model.signal_names, np.moveaxis(by_arm, -1, 0), strict=True))

    def __contains__(self, signal: str) -> bool:
        """Return whether the model has a signal of this name."""
        return signal in self._signals

    def stroke(self, path: str) -> Stroke:
        """Return the length of a path, such as "strut"."""
        rise, rise_change = self._signals["wheel_velocity"], self._by_arm["wheel_velocity"]
        slope = self._signals[f"{path}_velocity"] / rise
        change = self._by_arm[f"{path}_velocity"]
        return Stroke(
            length=self._signals[f"{path}_length"],
            slope=slope,
            curvature=(change - slope * rise_change) / rise**2,
        )

    def spring(self, force: str, path: str) -> SpringForce:
        """Return a force along a path, from the name of its signal."""
        slope = self._by_arm[force] / self._signals["wheel_velocity"]
        return SpringForce(self.stroke(path), self._signals[force], slope)
