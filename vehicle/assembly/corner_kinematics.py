"""Kinematics of a corner, from its compiled model.

All derivatives are exact, except the rate of a steering axis that is the axis of a screw.
"""

from functools import cached_property
from typing import Any

import numpy as np

from ...core.columns import BatchNumber, spread
from ...core.named_types import Array, ArrayLike
from ...core.vectors import cross, turned
from ...systems.inputs import rates_of
from ..corner.corner import CarrierMotion, Corner, SteeringAxis, Strokes, Vehicle
from ..corner.wheeled import WheeledSection
from ..input.units import in_metres
from ..kinds import Suspension
from ..models.model import Model
from ..models.points import hardpoints
from ..models.reach import at_rest
from .steering_axis import AxisOfPoints, AxisOfTheScrew, of_the_screw

# The least motion ratio of a spring that holds the wheel when its length is fixed.
_LEAST_RATIO = 0.05


def corner(model: Model, arm_angle: ArrayLike, rack_position: ArrayLike = 0.0) -> Corner:
    """Return the corner at arm angles [rad] and rack positions [m], which broadcast."""
    kind = model.suspension
    states, inputs = at_rest(model, arm_angle, rack_position)
    pose = _Pose(model, states, inputs)
    points, travel = pose.points, pose.travel
    rotation = pose.rotations[..., pose.carrier, :, :]
    at_design = spread(design_axis(model.suspension))
    strokes = _strokes(model, states, inputs)
    return Corner(
        vehicle=vehicle_of(model.suspension),
        center=points["wheel_center"],
        design_center=spread(model.suspension.hardpoints.metres("wheel_center")),
        axis=turned(rotation, at_design),
        design_axis=at_design,
        steering_axis=_steering_axis(pose) if kind.steered() else None,
        travel=travel,
        steering=pose.steering if kind.steered() else None,
        links=kind.links_at(points, travel),
        spring=kind.spring_at(strokes),
        stops=kind.stops_at(strokes),
        damper=kind.damper_at(strokes),
        arm_rotation=model.design_state[..., 0] - np.broadcast_to(arm_angle, states.shape[:-1]),
    )


def gaps(model: Model, arm_angle: ArrayLike, rack_position: ArrayLike = 0.0) -> tuple[Array, ...]:
    """Return the gap of each stop at arm angles and rack positions, see `corner`.

    A gap is positive if the stop is free, negative if it is compressed [m]. The measures `AT_STOPS`
    jump where a gap closes.
    """
    return model.suspension.gaps_at(_strokes(model, *at_rest(model, arm_angle, rack_position)))


def vehicle(described: WheeledSection, side: float, end: str | None) -> Vehicle:
    """Return the data of the vehicle for one of the wheels of a file, in SI units.

    `side` is +1 left, -1 right; `end` is 'front' or 'rear', None if the file does not have this.
    """
    given, tyre, steered = described.vehicle, described.tyre, described.steered()
    rear = end == "rear"
    per_turn = described.steering_gear.travel_per_turn() if steered else None
    return Vehicle(
        side=side,
        tyre_radius=_spread(described.tyre_radius()),
        tyre_rate=_spread(tyre.rate_N_per_m),
        tyre_lateral_rate=_spread(tyre.lateral_rate_N_per_m),
        tyre_longitudinal_rate=_spread(tyre.longitudinal_rate_N_per_m),
        wheelbase=_metres(given.wheelbase_mm),
        center_of_gravity_height=_metres(given.center_of_gravity_height_mm),
        front_brake_share=_spread(given.front_brake_share),
        front=None if rear else True,
        rear=True if rear else None,
        travel_per_turn=_spread(per_turn),
        steered=True if steered else None,
    )


def vehicle_of(suspension: Suspension) -> Vehicle:
    """Return the data of the vehicle in the file of a suspension, in SI units."""
    return vehicle(suspension, suspension.vehicle.sign, suspension.vehicle.end)


def _strokes(model: Model, states: Array, inputs: Array) -> Strokes:
    return Strokes(model, states, inputs, model.names.arm)


def _metres(length: float | None) -> float | None:
    return None if length is None else _spread(in_metres(length, "mm"))


def _spread(value: Any) -> Any:
    """Return a number as it is, and the numbers of a batch over its positions."""
    return spread(value) if isinstance(value, BatchNumber) else value


def design_axis(suspension: Suspension) -> Array:
    """Return the spin axis at design, pointing outboard."""
    side = suspension.vehicle.sign
    return side * suspension.wheel.spin_axis(side)


class _Pose:
    """A model at rest in n positions, and the velocities of its wheel carrier at unit rates."""

    def __init__(self, model: Model, states: Array, inputs: Array) -> None:
        self.model, self.states, self.inputs = model, states, inputs
        self.centers = model.evaluate("positions", states, inputs)
        self.rotations = model.evaluate("orientations", states, inputs)
        poses = self.centers, self.rotations
        self.points = hardpoints(model, states, inputs, poses=poses)
        self.carrier: int = model.equations.BODIES.index(model.suspension.carrier)
        self.by_arm = self._motion("arm")
        self.travel = self.by_arm.per(self.by_arm.velocity[..., 2])

    @cached_property
    def by_rack(self) -> CarrierMotion:
        """The motion for a unit rate of the rack, with the arm held."""
        return self._motion("rack")

    @property
    def steering(self) -> CarrierMotion:
        """The motion per unit of rack travel, with the wheel centre at constant height."""
        return self.by_rack.minus(self.travel, self.by_rack.velocity[..., 2])

    def steering_with_spring_locked(self) -> CarrierMotion:
        """Return the motion per unit of rack travel with the spring's length held.

        NaN where the spring hardly moves with the wheel, so that it does not hold the wheel.
        """
        by_arm, by_rack = (
            self.model.signal("spring_velocity", *self._at_unit_rate(what))
            for what in ("arm", "rack")
        )
        locks = np.abs(by_arm) >= _LEAST_RATIO * np.abs(self.by_arm.velocity[..., 2])
        by_arm = np.where(locks, by_arm, np.nan)
        return self.by_rack.minus(self.by_arm, by_rack / by_arm)

    def _motion(self, what: str) -> CarrierMotion:
        """Return the motion for a unit rate of the arm angle or of the rack; the other is held."""
        model = self.model
        states, inputs = self._at_unit_rate(what)
        twist = model.evaluate("velocities", states, inputs)[..., self.carrier, :]
        turning, velocity = twist[..., :3], twist[..., 3:]
        arm = self.points["wheel_center"] - self.centers[..., self.carrier, :]
        return CarrierMotion(velocity + cross(turning, arm), turning)

    def _at_unit_rate(self, what: str) -> tuple[Array, Array]:
        """Return states and inputs with a unit rate of the arm angle, or of the rack.

        Velocities are linear in the rates: at unit rate they are the derivatives.
        """
        model, states, inputs = self.model, self.states.copy(), self.inputs.copy()
        if what == "arm":
            states[..., model.state_names.index(f"{model.names.arm}_rate")] = 1.0
        elif model.free_rack:
            states[..., model.state_names.index(f"{model.names.rack}_rate")] = 1.0
        else:
            velocity_input, *_ = rates_of("rack_position", model.equations.INPUTS)
            inputs[..., model.input_names.index(velocity_input)] = 1.0
        return states, inputs


def _steering_axis(pose: _Pose) -> SteeringAxis:
    """Return the steering axis of the wheel; see `SteeringAxis`."""
    given, points, travel = pose.model.suspension.hardpoints, pose.points, pose.travel
    if given.STEERING_AXIS is None:
        return _axis_of_the_motion(pose)

    def rate(point: str) -> Array:
        # a strut turns about its mount on the chassis
        if point not in given.CARRIERS:
            return np.zeros_like(travel.velocity)
        return travel.velocity + cross(travel.turning, points[point] - points["wheel_center"])

    low, high = given.STEERING_AXIS
    return AxisOfPoints(points[low], points[high], rate(high) - rate(low))


def _axis_of_the_motion(pose: _Pose) -> AxisOfTheScrew:
    """Return the screw axis of the carrier's velocity when it is steered."""
    place = pose.model.state_names.index(pose.model.names.arm)

    def ends(turn: float) -> tuple[Array, Array]:
        states = pose.states.copy()
        states[..., place] += turn
        moved = _Pose(pose.model, states, pose.inputs)
        return of_the_screw(moved.points["wheel_center"], moved.steering_with_spring_locked())

    return AxisOfTheScrew(ends, pose.by_arm.velocity[..., 2])
